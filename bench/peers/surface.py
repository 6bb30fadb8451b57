# SPDX-License-Identifier: MIT
"""surface.py FOLDER N FILTER...: VTK's filters on FOLDER/volume.raw (N^3 float32 on the unit cube, iso 0).

Filters in order, the last one timed (least CPU time of five runs, one thread):
flying_edges, windowed_sinc:SWEEPS, laplacian:SWEEPS. Writes points.raw (float32) and triangles.raw (int64)
and prints: version, CPU seconds, points, triangles.
"""
import os
import sys
import time

import vtk

vtk.vtkSMPTools.Initialize(1)
folder, n = sys.argv[1], int(sys.argv[2])
reader = vtk.vtkImageReader2()
reader.SetFileName(os.path.join(folder, "volume.raw"))
reader.SetFileDimensionality(3)
reader.SetDataScalarTypeToFloat()
reader.SetDataByteOrderToLittleEndian()
reader.FileLowerLeftOn()  # y upwards, as written
reader.SetDataExtent(0, n - 1, 0, n - 1, 0, n - 1)
reader.SetDataSpacing(1 / (n - 1), 1 / (n - 1), 1 / (n - 1))
reader.Update()
data = reader.GetOutput()

for name in sys.argv[3:]:
    name, _, sweeps = name.partition(":")
    if name == "flying_edges":
        step = vtk.vtkFlyingEdges3D()
        step.SetValue(0, 0.0)
        step.ComputeNormalsOff()
        step.ComputeGradientsOff()
        step.ComputeScalarsOff()
    elif name == "windowed_sinc":
        step = vtk.vtkWindowedSincPolyDataFilter()
        step.SetNumberOfIterations(int(sweeps))
        step.SetPassBand(0.1)
        step.NormalizeCoordinatesOn()
        step.FeatureEdgeSmoothingOff()
        step.BoundarySmoothingOff()
    elif name == "laplacian":
        step = vtk.vtkSmoothPolyDataFilter()
        step.SetNumberOfIterations(int(sweeps))
        step.SetRelaxationFactor(0.5)
    else:
        sys.exit("unknown filter " + name)
    step.SetInputData(data)
    best = float("inf")
    for _ in range(5):
        step.Modified()
        start = time.process_time()
        step.Update()
        best = min(best, time.process_time() - start)
    data = step.GetOutput()

with open(os.path.join(folder, "points.raw"), "wb") as out:
    out.write(bytes(memoryview(data.GetPoints().GetData())))
cells = vtk.vtkTypeInt64Array()
cells.DeepCopy(data.GetPolys().GetConnectivityArray())
with open(os.path.join(folder, "triangles.raw"), "wb") as out:
    out.write(bytes(memoryview(cells)))
print("vtk-" + vtk.VTK_VERSION, best, data.GetNumberOfPoints(), data.GetNumberOfPolys())
