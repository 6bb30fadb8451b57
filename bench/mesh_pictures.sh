#!/bin/bash
# SPDX-License-Identifier: MIT
# mesh_pictures.sh BIN: makes the meshes of the phantom with the programs of that folder (build/release/bin) and
# draws docs/figures/meshes.png (needs python3-vtk9 and xvfb).
set -eu
bin=$(cd "$1" && pwd)
cd "$(dirname "$0")/.."
root=$PWD
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
python=python3
for candidate in /usr/bin/python3 python3; do
  if "$candidate" -c "import vtk" 2>/dev/null; then python=$candidate && break; fi
done
cd "$scratch"
mesh() { "$bin/image_to_mesh" phantom "${@:2}" -o "$1.vtu" >/dev/null 2>&1; }
mesh contour --edge 0 --smooth 0 --fill none
mesh tets --edge 2
mesh diameter --edge 2 --size-from diameter
mesh layers --edge 2 --layers 3
mesh hexes --edge 1.5 --fill hexes
mesh voxels --fill voxels
"$bin/labels_to_mesh" phantom --edge 1.8 -o labels.vtu >/dev/null
xvfb-run -a "$python" "$root/bench/mesh_pictures.py" "$root/docs/figures/meshes.png" 4 \
  contour=contour.surface.vtp remeshed=tets.surface.vtp tetrahedra=tets.vtu "size from diameter=diameter.vtu" \
  layers=layers.vtu hexahedra=hexes.vtu voxels=voxels.vtu materials=labels.vtu
