#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Holds the nodes, functions and faces that shape_quadratic_test.cpp wrote against VTK's cells."""
import sys

import numpy as np
import vtk

cell = faces = None
checked = 0


def close_faces():
    """Every face has the nodes of one of VTK's."""
    global checked
    if cell is None or cell.GetCellDimension() < 2:
        return
    plane = cell.GetCellDimension() == 2
    count = cell.GetNumberOfEdges() if plane else cell.GetNumberOfFaces()
    known = []
    for i in range(count):
        ids = (cell.GetEdge(i) if plane else cell.GetFace(i)).GetPointIds()
        known.append(frozenset(ids.GetId(k) for k in range(ids.GetNumberOfIds())))
    if sorted(map(sorted, known)) != sorted(map(sorted, faces)):
        sys.exit('cell %d: faces %s, those of VTK %s' % (cell.GetCellType(), faces, known))
    checked += count


for line in open(sys.argv[1]):
    key, *rest = line.split()
    numbers = [float(x) for x in rest]
    if key == 'cell':
        close_faces()
        cell, faces = vtk.vtkGenericCell.InstantiateCell(int(rest[0])), []
        n = int(rest[1])
        if cell.GetNumberOfPoints() != n:
            sys.exit('cell %s has %d nodes in VTK, not %d' % (rest[0], cell.GetNumberOfPoints(), n))
        for k in range(n):
            cell.GetPointIds().SetId(k, k)
    elif key == 'nodes':
        places = cell.GetParametricCoords()
        want = [places[k] for k in range(3 * n)] if not hasattr(places, 'shape') else np.ravel(places)
        if not np.allclose(numbers, want, atol=1e-12):
            sys.exit('cell %d: nodes at %s, those of VTK %s' % (cell.GetCellType(), numbers, want))
        checked += n
    elif key == 'functions':
        values = [0.0] * n
        cell.InterpolateFunctions(numbers[:3], values)
        if not np.allclose(numbers[3:], values, atol=1e-12):
            sys.exit('cell %d: functions %s, those of VTK %s' % (cell.GetCellType(), numbers[3:], values))
        checked += n
    else:
        faces.append(frozenset(int(x) for x in rest))
close_faces()
print('%d figures are those of VTK' % checked)
