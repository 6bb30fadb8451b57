// SPDX-License-Identifier: MIT
// Wedges and pyramids: the cells of layers that are kept as they grew, in the numbering of VTK's parameters.
#pragma once

#include "tunica/mesh/mesh.hpp"

#include <array>

namespace tunica::mesh {

/// Triangle (0, 1, 2) with its normal towards triangle (3, 4, 5), node 3 above node 0. Triangular faces have
/// their last node twice.
struct Wedge6 {
  static constexpr int dim = 3, nodes = 6, vtk_type = 13;
  using Face = Quad4;
  static constexpr std::array<std::array<int, 4>, 5> faces{
      {{0, 2, 1, 1}, {3, 4, 5, 5}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}}};
  static constexpr std::array<std::array<int, 2>, 9> edges{
      {{0, 1}, {1, 2}, {0, 2}, {3, 4}, {4, 5}, {3, 5}, {0, 3}, {1, 4}, {2, 5}}};
};

/// Quadrilateral (0, 1, 2, 3) with its normal towards node 4. Triangular faces have their last node twice.
struct Pyramid5 {
  static constexpr int dim = 3, nodes = 5, vtk_type = 14;
  using Face = Quad4;
  static constexpr std::array<std::array<int, 4>, 5> faces{
      {{0, 3, 2, 1}, {0, 1, 4, 4}, {1, 2, 4, 4}, {2, 3, 4, 4}, {3, 0, 4, 4}}};
  static constexpr std::array<std::array<int, 2>, 8> edges{
      {{0, 1}, {1, 2}, {2, 3}, {0, 3}, {0, 4}, {1, 4}, {2, 4}, {3, 4}}};
};

using WedgeMesh = Mesh<Wedge6, 3>;
using PyramidMesh = Mesh<Pyramid5, 3>;

}  // namespace tunica::mesh
