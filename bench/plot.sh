#!/bin/bash
# SPDX-License-Identifier: MIT
# Regenerates every figure of docs/figures from the rows of bench/results (needs gnuplot).
set -eu
cd "$(dirname "$0")/.."
mkdir -p docs/figures
gnuplot <<'PLOT'
set datafile separator ","
set terminal svg size 640,440 font "sans,13" background "white"
set output "docs/figures/isosurface.svg"
set logscale xy
set format "10^{%L}"
set xlabel "CPU time [s]"
set ylabel "rms distance of the vertices to the surface [edge of the cube]"
set grid
set key top right
rows = "bench/results/isosurface.csv"
plot rows using (strcol(2) eq "marching cubes" ? $6 : NaN):5 with linespoints pt 7 lw 2 title "marching cubes", \
     rows using (strcol(2) eq "vtkFlyingEdges3D" ? $6 : NaN):5 with linespoints pt 6 lw 2 title "vtkFlyingEdges3D"

set output "docs/figures/thick_tube.svg"
set ylabel "error of the inner stretch [-]"
rows = "bench/results/thick_tube.csv"
plot rows using 6:5 with linespoints pt 7 lw 2 title "Hex8, three-field (Q1-P0-J0)"
PLOT
