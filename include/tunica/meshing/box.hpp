// SPDX-License-Identifier: MIT
// Structured boxes of hexahedra and of tetrahedra: six tetrahedra a cell along its main diagonal.
#pragma once

#include "tunica/core/expect.hpp"
#include "tunica/mesh/mesh.hpp"
#include "tunica/meshing/faces_on.hpp"

#include <array>
#include <cstddef>
#include <string>

namespace tunica::meshing {

/// An axis-aligned block cut into cells[0] x cells[1] x cells[2] equal boxes.
struct Block {
  std::array<int, 3> cells{1, 1, 1};
  Vec3 lo = Vec3::Zero(), hi = Vec3::Ones();  // [m]
};

namespace detail {

/// The corners of a box cell as offsets in its three directions, in the order of Hex8.
inline constexpr std::array<std::array<Index, 3>, 8> box_corners{
    {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}};

/// Kuhn's six positive tetrahedra of a Hex8: one for each order in which its axes are walked, from
/// corner 0 to corner 6, so that the diagonals of neighbouring cells agree.
inline constexpr std::array<std::array<int, 4>, 6> kuhn_tets{
    {{0, 1, 2, 6}, {0, 5, 1, 6}, {0, 2, 3, 6}, {0, 3, 7, 6}, {0, 4, 5, 6}, {0, 7, 4, 6}}};

/// Node grid index along each axis: i + (nx+1) (j + (ny+1) k).
[[nodiscard]] inline std::array<Index, 3> grid_index(const Block& block, Index node) {
  const Index nx = block.cells[0] + 1, ny = block.cells[1] + 1;
  return {node % nx, node / nx % ny, node / nx / ny};
}

template <mesh::Cell C>
void name_box_sides(const Block& block, mesh::Mesh<C>& mesh) {
  for (std::size_t a = 0; a < 3; ++a)
    for (const int side : {0, 1})
      mesh.patches.push_back(faces_on(mesh, std::string(1, "xyz"[a]) + std::to_string(side), [&](Index node) {
        return grid_index(block, node)[a] == side * block.cells[a];
      }));
}

}  // namespace detail

/// Patches "x0", "x1", "y0", "y1", "z0", "z1"; nodes with x fastest.
[[nodiscard]] inline mesh::HexMesh box_hexes(const Block& block) {
  const auto [nx, ny, nz] = block.cells;
  TUNICA_EXPECT(nx > 0 && ny > 0 && nz > 0, "a block needs cells along each axis");
  mesh::HexMesh mesh;
  const Index nodes = (nx + 1) * (ny + 1) * (nz + 1);
  mesh.nodes.resize(3, nodes);
  for (Index n = 0; n < nodes; ++n) {
    const auto at = detail::grid_index(block, n);
    for (std::size_t a = 0; a < 3; ++a) {
      const auto e = static_cast<Eigen::Index>(a);
      const double t = double(at[a]) / block.cells[a];
      mesh.nodes(e, n) = (1 - t) * block.lo[e] + t * block.hi[e];
    }
  }
  mesh.cells.resize(8, nx * ny * nz);
  Eigen::Index cell = 0;
  for (Index k = 0; k < nz; ++k)
    for (Index j = 0; j < ny; ++j)
      for (Index i = 0; i < nx; ++i, ++cell)
        for (std::size_t c = 0; c < 8; ++c) {
          const auto& o = detail::box_corners[c];
          mesh.cells(static_cast<Eigen::Index>(c), cell) =
              i + o[0] + (nx + 1) * (j + o[1] + (ny + 1) * (k + o[2]));
        }
  detail::name_box_sides(block, mesh);
  return mesh;
}

/// Six tetrahedra a cell; patches and nodes as box_hexes.
[[nodiscard]] inline mesh::TetMesh box_tets(const Block& block) {
  const mesh::HexMesh hexes = box_hexes(block);
  mesh::TetMesh mesh;
  mesh.nodes = hexes.nodes;
  mesh.cells.resize(4, 6 * hexes.cells.cols());
  Eigen::Index cell = 0;
  for (Index h = 0; h < hexes.cell_count(); ++h)
    for (const auto& tet : detail::kuhn_tets) {
      for (std::size_t k = 0; k < 4; ++k)
        mesh.cells(static_cast<Eigen::Index>(k), cell) = hexes.cells(tet[k], h);
      ++cell;
    }
  detail::name_box_sides(block, mesh);
  return mesh;
}

/// The unit cube with n cells a side.
[[nodiscard]] inline mesh::HexMesh box_hexes(int n) {
  return box_hexes(Block{.cells = {n, n, n}});
}
[[nodiscard]] inline mesh::TetMesh box_tets(int n) {
  return box_tets(Block{.cells = {n, n, n}});
}

}  // namespace tunica::meshing
