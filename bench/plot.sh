#!/bin/bash
# SPDX-License-Identifier: MIT
# Regenerates every figure of docs/figures from the rows of bench/results (needs gnuplot).
set -eu
cd "$(dirname "$0")/.."
mkdir -p docs/figures
gnuplot <<'PLOT'
set datafile separator ","
set terminal svg size 1180,420 font "sans,13" background "white"
set output "docs/figures/isosurface.svg"
set logscale xy
set format "10^{%L}"
set xlabel "CPU time [s]"
set grid
rows = "bench/results/isosurface.csv"
of(what, method) = sprintf('< grep "^bifurcation %s,%s," %s', what, method, rows)
set multiplot layout 1,3
set key top right
set ylabel "distance of the vertices, rms [edge of the cube]"
plot of("rms", "marching cubes") using 6:5 with linespoints pt 7 lw 2 title "marching cubes", \
     of("rms", "dual contouring") using 6:5 with linespoints pt 5 lw 2 title "dual contouring", \
     of("rms", "vtkFlyingEdges3D") using 6:5 with linespoints pt 6 lw 2 title "vtkFlyingEdges3D"
set key off
set ylabel "distance of the vertices, largest [edge of the cube]"
plot of("max", "marching cubes") using 6:5 with linespoints pt 7 lw 2 title "marching cubes", \
     of("max", "dual contouring") using 6:5 with linespoints pt 5 lw 2 title "dual contouring", \
     of("max", "vtkFlyingEdges3D") using 6:5 with linespoints pt 6 lw 2 title "vtkFlyingEdges3D"
set ylabel "error of the volume [-]"
plot of("volume", "marching cubes") using 6:5 with linespoints pt 7 lw 2 title "marching cubes", \
     of("volume", "dual contouring") using 6:5 with linespoints pt 5 lw 2 title "dual contouring", \
     of("volume", "vtkFlyingEdges3D") using 6:5 with linespoints pt 6 lw 2 title "vtkFlyingEdges3D"
unset multiplot

set terminal svg size 640,440 font "sans,13" background "white"
set key top right
set output "docs/figures/thick_tube.svg"
set ylabel "error of the inner stretch [-]"
rows = "bench/results/thick_tube.csv"
plot rows using 6:5 with linespoints pt 7 lw 2 title "Hex8, three-field (Q1-P0-J0)"

set output "docs/figures/tetrahedra.svg"
unset logscale y
set format y "%g"
set ylabel "smallest dihedral angle [degrees]"
set yrange [0:25]
rows = "bench/results/tetrahedra.csv"
by(method) = sprintf('< grep "^bifurcation,%s," %s', method, rows)
plot by("ours") using 8:5 with linespoints pt 7 lw 2 title "tunica", \
     by("ours 1.5") using 8:5 with linespoints pt 5 lw 2 title "tunica, inner edges x 1.5", \
     by("tetgen") using 8:5 with linespoints pt 6 lw 2 title "TetGen -pYq1.4", \
     by("gmsh") using 8:5 with linespoints pt 8 lw 2 title "Gmsh Delaunay, optimised", \
     by("hxt") using 8:5 with linespoints pt 4 lw 2 title "Gmsh HXT, optimised", \
     by("netgen") using 8:5 with linespoints pt 10 lw 2 title "Netgen, optimised"

set output "docs/figures/solids.svg"
set terminal svg size 1180,480 font "sans,13" background "white"
set autoscale y
set logscale y
set format "10^{%L}"
rows = "bench/results/solids.csv"
of(case, method) = sprintf('< grep "^%s,%s," %s', case, method, rows)
methods = '"Hex8" "Hex8 F-bar" "Hex20" "Hex27" "Tet10" "Tet4 stabilised" "dolfinx Q2-Q1" "dolfinx P2-P1"'
array mark[8] = [7, 3, 5, 4, 9, 11, 6, 8]
array shade[8] = [0x0060ad, 0x56b4e9, 0x009e73, 0x7fbf3f, 0xd55e00, 0xcc79a7, 0x000000, 0x808080]
dash(i) = int(i) > 6 ? 2 : 1
set multiplot
set key off
set origin 0, 0
set size 0.41, 1
set title "thick tube"
set ylabel "error of the inner stretch [-]"
plot for [i in "1 3 4 5 6 7 8"] of("thick tube", word(methods, int(i))) using 6:5 \
     with linespoints pt mark[int(i)] lw 2 dt dash(i) lc rgb shade[int(i)] notitle
set origin 0.41, 0
set size 0.59, 1
set key outside right center
set title "Cook's membrane, quasi-incompressible"
set ylabel "relative error of the corner's rise [-]"
plot for [i=1:8] of("Cook's membrane", word(methods, i)) using 6:5 \
     with linespoints pt mark[i] lw 2 dt dash(i) lc rgb shade[i] title word(methods, i)
unset multiplot
PLOT
