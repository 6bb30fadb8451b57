#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Draws meshes side by side, volumes cut open: one panel a file (needs python3-vtk9).

mesh_pictures.py OUT.png COLUMNS TITLE=MESH.vtu|SURFACE.vtp ...; without a display through xvfb-run -a.
bench/mesh_pictures.sh makes those of docs/figures/meshes.png. Labels of cells have colours of their own.
"""
import sys

import vtk

from drawing import actor, behind, read, save, view, window

WIDTH, HEIGHT = 420, 420
COLOURS = [(0.85, 0.45, 0.42), (0.95, 0.87, 0.75), (0.5, 0.62, 0.8), (0.6, 0.75, 0.5), (0.8, 0.7, 0.9)]


def parts(mesh):
    """The cells of each label, where there are labels."""
    for name in ("material", "region", "layers"):
        if mesh.GetCellData().GetArray(name):
            low, high = (int(v) for v in mesh.GetCellData().GetArray(name).GetRange())
            for label in range(low, high + 1):
                some = vtk.vtkThreshold()
                some.SetInputData(mesh)
                some.SetInputArrayToProcess(0, 0, 0, vtk.vtkDataObject.FIELD_ASSOCIATION_CELLS, name)
                some.SetLowerThreshold(label - 0.5)
                some.SetUpperThreshold(label + 0.5)
                some.Update()
                if some.GetOutput().GetNumberOfCells():
                    yield label - low, some.GetOutput()
            return
    yield 0, mesh


def panel(shown, part, title, name):
    mesh = read(name)
    x0, x1, y0, y1, z0, z1 = mesh.GetBounds()
    centre = ((x0 + x1) / 2, (y0 + y1) / 2, (z0 + z1) / 2)
    opened = mesh if name.endswith(".vtp") else behind(mesh, centre, (0, 0, 1))
    actors = [actor(some, colour=COLOURS[label % len(COLOURS)], edges=True) for label, some in parts(opened)]
    for a in actors:
        a.GetProperty().SetLineWidth(0.6)
    renderer = view(shown, part, actors, centre, (centre[0] + 0.35, centre[1] - 0.25, centre[2] + 1))
    renderer.ResetCamera()
    renderer.GetActiveCamera().SetParallelScale(0.5 * 1.08 * max(x1 - x0, y1 - y0))
    text = vtk.vtkTextActor()
    text.SetInput(title)
    text.GetTextProperty().SetColor(0.1, 0.1, 0.1)
    text.GetTextProperty().SetFontSize(17)
    text.SetPosition(12, HEIGHT - 30)
    renderer.AddActor2D(text)


def main(out, columns, *panels):
    columns = int(columns)
    rows = -(-len(panels) // columns)
    shown = window(columns * WIDTH, rows * HEIGHT)
    for k, (title, _, name) in enumerate(p.partition("=") for p in panels):
        row, column = rows - 1 - k // columns, k % columns
        panel(shown, (column / columns, row / rows, (column + 1) / columns, (row + 1) / rows), title, name)
    save(shown, out)


if __name__ == "__main__":
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    main(*sys.argv[1:])
