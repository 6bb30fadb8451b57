#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Reads with VTK what vtk_files_test.cpp wrote to a folder and holds every number against its formula."""
import os
import sys

import numpy as np
import vtk
from vtk.util.numpy_support import vtk_to_numpy

folder = sys.argv[1]
checked = 0


def expect(what, got, want):
    global checked
    got, want = np.asarray(got), np.asarray(want)
    if got.shape != want.shape or not np.array_equal(got, want):
        sys.exit('%s: VTK reads %s, expected %s' % (what, got, want))
    checked += 1


def read(reader, name):
    said = vtk.vtkStringOutputWindow()
    vtk.vtkOutputWindow.SetInstance(said)
    reader.SetFileName(os.path.join(folder, name))
    reader.Update()
    if said.GetOutput():
        sys.exit('%s: VTK says: %s' % (name, said.GetOutput()))
    return reader.GetOutput()


def array(data, name):
    a = data.GetArray(name)
    if a is None:
        sys.exit('no array %s' % name)
    return vtk_to_numpy(a)


# A 2 x 2 x 2 box of unit cells: node (i, j, k) has number i + 3 j + 9 k and lies at (i, j, k) / 4.
n = np.arange(27)
points = np.stack([n % 3, n // 3 % 3, n // 9], 1) / 4
for name, cell_type, count in (('tets.vtu', vtk.VTK_TETRA, 48), ('hexes.vtu', vtk.VTK_HEXAHEDRON, 8),
                               ('tets_zlib.vtu', vtk.VTK_TETRA, 48)):
    if not os.path.exists(os.path.join(folder, name)):
        print(name, 'was not written')
        continue
    grid = read(vtk.vtkXMLUnstructuredGridReader(), name)
    expect(name + ' points', vtk_to_numpy(grid.GetPoints().GetData()), points)
    expect(name + ' types', vtk_to_numpy(grid.GetCellTypesArray()), np.full(count, cell_type))
    volume = vtk.vtkCellSizeFilter()
    volume.SetInputData(grid)
    volume.Update()
    total = vtk_to_numpy(volume.GetOutput().GetCellData().GetArray('Volume'))
    if not (total > 0).all() or abs(total.sum() - 1 / 8) > 1e-14:
        sys.exit('%s: volumes %s' % (name, total))
    expect(name + ' pressure', array(grid.GetPointData(), 'pressure'), n / 3)
    expect(name + ' velocity', array(grid.GetPointData(), 'velocity'), points * [1, 2, 3])
    expect(name + ' single', array(grid.GetPointData(), 'single'), np.float32(n / 7))
    expect(name + ' cell number', array(grid.GetCellData(), 'number'), np.arange(count))
    expect(name + ' tensor', array(grid.GetCellData(), 'tensor'),
           (np.arange(count)[:, None] * 9 + np.arange(9)) / 2)
    expect(name + ' byte', array(grid.GetCellData(), 'byte "<&>"'), (np.arange(count) % 256).astype(np.uint8))
    expect(name + ' region', array(grid.GetCellData(), 'region'), np.arange(count) % 3)

for name, corners, count in (('triangles.vtp', 3, 8), ('quads.vtp', 4, 6)):
    surface = read(vtk.vtkXMLPolyDataReader(), name)
    expect(name + ' faces', surface.GetNumberOfPolys(), count)
    expect(name + ' cells', surface.GetNumberOfCells(), count)
    expect(name + ' offsets', vtk_to_numpy(surface.GetPolys().GetOffsetsArray()), np.arange(count + 1) * corners)
    expect(name + ' patch', array(surface.GetCellData(), 'patch'), np.arange(count) % 3)
    expect(name + ' height', array(surface.GetPointData(), 'height'),
           vtk_to_numpy(surface.GetPoints().GetData())[:, 2])
    mass = vtk.vtkMassProperties()
    triangles = vtk.vtkTriangleFilter()
    triangles.SetInputData(surface)
    mass.SetInputConnection(triangles.GetOutputPort())
    if abs(mass.GetVolume() - (4 / 3 if corners == 3 else 8)) > 1e-6:
        sys.exit('%s: volume %g' % (name, mass.GetVolume()))

lines = read(vtk.vtkXMLPolyDataReader(), 'lines.vtp')
expect('lines', (lines.GetNumberOfLines(), lines.GetNumberOfCells()), (2, 2))
expect('lines: points', [lines.GetCell(1).GetPointId(i) for i in range(4)], [5, 4, 3, 2])
expect('lines: radius', array(lines.GetPointData(), 'radius'), np.arange(1, 7) / 2)
expect('lines: parent', array(lines.GetCellData(), 'parent'), [-1, 0])

surface = read(vtk.vtkSTLReader(), 'octahedron.stl')
expect('stl facets', surface.GetNumberOfCells(), 8)
expect('stl points', surface.GetNumberOfPoints(), 6)

v = np.arange(60) % 100
for kind, numpy_type in (('char', np.int8), ('unsigned_char', np.uint8), ('short', np.int16), ('unsigned_short', np.uint16),
                         ('int', np.int32), ('unsigned_int', np.uint32), ('vtktypeint64', np.int64),
                         ('vtktypeuint64', np.uint64), ('float', np.float32), ('double', np.float64)):
    image = read(vtk.vtkStructuredPointsReader(), 'image_%s.vtk' % kind)
    expect(kind + ' size', image.GetDimensions(), (5, 4, 3))
    expect(kind + ' spacing', image.GetSpacing(), (0.878906, 0.5, 1.50009))
    expect(kind + ' origin', image.GetOrigin(), (195.116864, -1, 0))
    values = array(image.GetPointData(), 'mr')
    if values.dtype.kind != numpy_type(0).dtype.kind or values.dtype.itemsize != numpy_type(0).dtype.itemsize:
        sys.exit('image of %s is read as %s' % (kind, values.dtype))
    expect(kind + ' values', values, v.astype(numpy_type))
grid = read(vtk.vtkRectilinearGridReader(), 'uneven.vtk')
expect('uneven size', grid.GetDimensions(), (5, 4, 3))
expect('uneven z', vtk_to_numpy(grid.GetZCoordinates()), [0, 1, 5])
expect('uneven values', array(grid.GetPointData(), 'scalars'), v.astype(float))

document = vtk.vtkXMLDataParser()
document.SetFileName(os.path.join(folder, 'series.pvd'))
if not document.Parse():
    sys.exit('series.pvd: no XML')
sets = document.GetRootElement().GetNestedElement(0)
expect('series steps', sets.GetNumberOfNestedElements(), 3)
for i in range(3):
    step = sets.GetNestedElement(i)
    expect('series time', float(step.GetAttribute('timestep')), 0.1 * i)
    expect('series file', step.GetAttribute('file'), 'tets.vtu')
print('%d arrays and sizes read back as written' % checked)
