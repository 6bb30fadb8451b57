// SPDX-License-Identifier: MIT
// The empty scene: what a program costs before it composes anything. One tetrahedron, its volume.
#include "tunica/core/units.hpp"
#include "tunica/mesh/mesh.hpp"

#include <Eigen/LU>

#include <cmath>
#include <cstdio>

int main() {
  using namespace tunica;
  using namespace tunica::literals;

  mesh::TetMesh mesh;
  mesh.nodes.resize(3, 4);
  mesh.nodes.col(0) << 0, 0, 0;
  mesh.nodes.col(1) << 1_mm, 0, 0;
  mesh.nodes.col(2) << 0, 1_mm, 0;
  mesh.nodes.col(3) << 0, 0, 1_mm;
  mesh.cells.resize(4, 1);
  mesh.cells.col(0) << 0, 1, 2, 3;

  const Eigen::Matrix3d edges = mesh.nodes.rightCols<3>().colwise() - mesh.nodes.col(0);
  const double volume = edges.determinant() / 6;  // [m3]
  std::printf("cells %d, volume %.6g mm3\n", mesh.cell_count(), volume * 1e9);
  return std::abs(volume * 6e9 - 1) < 1e-12 ? 0 : 1;
}
