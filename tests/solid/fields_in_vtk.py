#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Reads with VTK the fields that output_test.cpp wrote to a folder, a file a kind of cell: all of one affine
deformation, so that each array is constant and von Mises, principal values and directions follow from the
tensor, by VTK's order of its six components."""
import glob
import os
import sys

import numpy as np
import vtk
from vtk.util.numpy_support import vtk_to_numpy

F = np.array([[1.2, 0.3, -0.1], [0.1, 0.95, 0.2], [-0.05, 0.1, 1.08]])
fibre = np.array([1, 2, -2]) / 3
types = {4: vtk.VTK_TETRA, 10: vtk.VTK_QUADRATIC_TETRA, 8: vtk.VTK_HEXAHEDRON, 20: vtk.VTK_QUADRATIC_HEXAHEDRON,
         27: vtk.VTK_TRIQUADRATIC_HEXAHEDRON, 6: vtk.VTK_WEDGE}
J = np.linalg.det(F)
b = F @ F.T * J ** (-2 / 3)
slope = 1 + 2 * 0.3 * (np.trace(b) - 3)
sigma = 2 / J * slope * (b - np.trace(b) / 3 * np.eye(3)) + 20 * (J - 1 / J) * np.eye(3)
deviator = sigma - np.trace(sigma) / 3 * np.eye(3)
values, vectors = np.linalg.eigh(sigma)
want = {'cauchy_stress': sigma[[0, 1, 2, 0, 1, 0], [0, 1, 2, 1, 2, 2]],
        'von_mises': np.sqrt(1.5 * (deviator ** 2).sum()),
        'principal_stress': values[::-1],
        'J': J,
        'fibre_stretch': np.linalg.norm(F @ fibre)}
files = sorted(glob.glob(os.path.join(sys.argv[1], '*.vtu')))
if len(files) != 17:
    sys.exit('%d files, expected 17' % len(files))
for path in files:
    said = vtk.vtkStringOutputWindow()
    vtk.vtkOutputWindow.SetInstance(said)
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(path)
    reader.Update()
    if said.GetOutput():
        sys.exit('%s: VTK says: %s' % (path, said.GetOutput()))
    grid = reader.GetOutput()
    kind = types[int(os.path.basename(path).split('_')[0])]
    if not (vtk_to_numpy(grid.GetCellTypesArray()) == kind).all():
        sys.exit('%s: cells of another type' % path)
    for data, count in ((grid.GetPointData(), grid.GetNumberOfPoints()),
                        (grid.GetCellData(), grid.GetNumberOfCells())):
        for name, value in want.items():
            got = vtk_to_numpy(data.GetArray(name))
            if len(got) != count or not np.allclose(got, value, rtol=1e-11, atol=1e-11 * np.abs(value).max()):
                sys.exit('%s: %s: VTK reads %s, expected %s' % (path, name, got[0], value))
        for k in range(3):
            got = vtk_to_numpy(data.GetArray('principal_direction_%d' % (k + 1)))
            if not np.allclose(np.abs(got @ vectors[:, 2 - k]), 1, atol=1e-11):
                sys.exit('%s: principal_direction_%d' % (path, k + 1))
