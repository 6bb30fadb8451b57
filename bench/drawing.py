# SPDX-License-Identifier: MIT
"""What picture.py and mesh_pictures.py draw with: files, meshes cut open, windows without a display (python3-vtk9)."""
import sys

import vtk


def read(name):
    """A VTU or VTP file with cells in it."""
    reader = vtk.vtkXMLPolyDataReader() if name.endswith(".vtp") else vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(name)
    reader.Update()
    if reader.GetOutput().GetNumberOfCells() == 0:
        sys.exit(f"error: {name}: no cells; make it first")
    return reader.GetOutput()


def behind(grid, centre, normal):
    """The cells that lie behind a plane, whole."""
    plane = vtk.vtkPlane()
    plane.SetOrigin(centre)
    plane.SetNormal(normal)
    part = vtk.vtkExtractGeometry()
    part.SetInputData(grid)
    part.SetImplicitFunction(plane)
    part.ExtractBoundaryCellsOn()
    part.Update()
    return part.GetOutput()


def actor(data, **how):
    surface = vtk.vtkDataSetSurfaceFilter()
    surface.SetInputData(data)
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputConnection(surface.GetOutputPort())
    a = vtk.vtkActor()
    a.SetMapper(mapper)
    mapper.ScalarVisibilityOff()
    a.GetProperty().SetColor(how.get("colour", (1, 1, 1)))
    a.GetProperty().SetAmbient(0.25)
    if how.get("edges"):
        a.GetProperty().EdgeVisibilityOn()
        a.GetProperty().SetEdgeColor(0.25, 0.25, 0.3)
    if "array" in how:
        mapper.ScalarVisibilityOn()
        mapper.SetScalarModeToUsePointFieldData()
        mapper.SelectColorArray(how["array"])
        mapper.SetLookupTable(how["colours"])
        mapper.UseLookupTableScalarRangeOn()
    return a


def window(width, height):
    w = vtk.vtkRenderWindow()
    w.SetOffScreenRendering(1)
    w.SetMultiSamples(8)
    w.SetSize(width, height)
    return w


def view(shown, part, actors, centre, eye):
    """A white part (x0, y0, x1, y1) of a window that shows actors from eye to centre, y upwards, without perspective."""
    renderer = vtk.vtkRenderer()
    renderer.SetViewport(*part)
    renderer.SetBackground(1, 1, 1)
    for a in actors:
        renderer.AddActor(a)
    camera = renderer.GetActiveCamera()
    camera.ParallelProjectionOn()
    camera.SetFocalPoint(*centre)
    camera.SetPosition(*eye)
    camera.SetViewUp(0, 1, 0)
    shown.AddRenderer(renderer)
    return renderer


def save(shown, out):
    shown.Render()
    image = vtk.vtkWindowToImageFilter()
    image.SetInput(shown)
    image.ReadFrontBufferOff()
    writer = vtk.vtkPNGWriter()
    writer.SetFileName(out)
    writer.SetInputConnection(image.GetOutputPort())
    writer.Write()
