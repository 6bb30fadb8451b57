#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Draws the last frame of artery_fsi: meshes, speed of the blood, stress in the wall (needs python3-vtk9).

picture.py RESULTS OUT.png; without a display: xvfb-run -a python3 bench/picture.py build/release/results \
docs/figures/bifurcation.png
"""
import glob
import os
import sys

import vtk

from drawing import actor, behind, read, save, view, window


def last(pattern):
    names = sorted(glob.glob(pattern))
    if not names:
        sys.exit(f"error: {pattern}: no such file; run the main job first")
    return read(names[-1])


def colours(low, high, points):
    f = vtk.vtkColorTransferFunction()
    for k, rgb in enumerate(points):
        f.AddRGBPoint(low + (high - low) * k / (len(points) - 1), *rgb)
    return f


def bar(table, title):
    b = vtk.vtkScalarBarActor()
    b.SetLookupTable(table)
    b.SetTitle(title)
    b.SetNumberOfLabels(4)
    b.SetLabelFormat("%.2g")
    b.UnconstrainedFontSizeOn()
    for text in (b.GetTitleTextProperty(), b.GetLabelTextProperty()):
        text.SetColor(0.1, 0.1, 0.1)
        text.ItalicOff()
        text.BoldOff()
        text.ShadowOff()
        text.SetFontSize(15)
    b.SetPosition(0.74, 0.62)
    b.SetWidth(0.2)
    b.SetHeight(0.33)
    return b


def main(folder, out):
    lumen = last(os.path.join(folder, "lumen_*.vtu"))
    wall = last(os.path.join(folder, "wall_*.vtu"))
    scale = vtk.vtkArrayCalculator()
    scale.SetInputData(lumen)
    scale.AddVectorArrayName("velocity")
    scale.SetFunction("mag(velocity)")
    scale.SetResultArrayName("speed")
    scale.Update()
    lumen = scale.GetOutput()
    stress = vtk.vtkArrayCalculator()
    stress.SetInputData(wall)
    stress.AddScalarArrayName("von_mises")
    stress.SetFunction("von_mises / 1000")
    stress.SetResultArrayName("stress")
    stress.Update()
    wall = stress.GetOutput()

    x0, x1, y0, y1, z0, z1 = wall.GetBounds()
    centre = ((x0 + x1) / 2, (y0 + y1) / 2, (z0 + z1) / 2)
    flow = colours(0, lumen.GetPointData().GetArray("speed").GetRange()[1],
                   [(0.05, 0.05, 0.35), (0.0, 0.45, 0.6), (0.3, 0.75, 0.4), (0.99, 0.9, 0.2)])
    load = colours(0, wall.GetPointData().GetArray("stress").GetRange()[1],
                   [(0.96, 0.94, 0.9), (0.95, 0.7, 0.5), (0.8, 0.25, 0.25), (0.4, 0.0, 0.15)])

    half = [behind(g, centre, (0, 0, 1)) for g in (lumen, wall)]
    cut = vtk.vtkCutter()
    plane = vtk.vtkPlane()
    plane.SetOrigin(centre)
    plane.SetNormal(0, 0, 1)
    cut.SetCutFunction(plane)
    cut.SetInputData(lumen)
    cut.Update()
    views = [
        ([actor(half[0], colour=(0.85, 0.35, 0.35), edges=True),
          actor(half[1], colour=(0.95, 0.87, 0.75), edges=True)], None),
        ([actor(cut.GetOutput(), array="speed", colours=flow),
          actor(half[1], colour=(0.95, 0.87, 0.75))], bar(flow, "speed [m/s]\n ")),
        ([actor(wall, array="stress", colours=load, edges=True)], bar(load, "von Mises [kPa]\n ")),
    ]
    shown = window(1200, 540)
    for k, (actors, legend) in enumerate(views):
        renderer = view(shown, (k / len(views), 0, (k + 1) / len(views), 1), actors, centre,
                        (centre[0], centre[1], centre[2] + 1))
        if legend:
            renderer.AddActor2D(legend)
        renderer.GetActiveCamera().SetParallelScale(0.53 * (y1 - y0))
        renderer.ResetCameraClippingRange()
    save(shown, out)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit("usage: picture.py RESULTS OUT.png")
    main(sys.argv[1], sys.argv[2])
