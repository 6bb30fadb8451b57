// SPDX-License-Identifier: MIT
// The empty scene: what a program costs before it composes anything. One tetrahedron, its volume.
#include "tunica/core/units.hpp"
#include "tunica/mesh/measures.hpp"
#include "tunica/mesh/mesh.hpp"

#include <cmath>
#include <cstdio>

int main() {
  using namespace tunica;
  using namespace tunica::literals;

  mesh::TetMesh corner;
  corner.nodes.resize(3, 4);
  corner.nodes.col(0) << 0, 0, 0;
  corner.nodes.col(1) << 1_mm, 0, 0;
  corner.nodes.col(2) << 0, 1_mm, 0;
  corner.nodes.col(3) << 0, 0, 1_mm;
  corner.cells.resize(4, 1);
  corner.cells.col(0) << 0, 1, 2, 3;

  const double volume = mesh::volume(corner);  // [m3]
  std::printf("cells %d, volume %.6g mm3\n", corner.cell_count(), volume * 1e9);
  return std::abs(volume * 6e9 - 1) < 1e-12 ? 0 : 1;
}
