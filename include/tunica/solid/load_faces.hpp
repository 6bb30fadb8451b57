// SPDX-License-Identifier: MIT
// The faces of a loaded patch with the cells behind them: what acts on them is scattered as the cells' own.
#pragma once

#include "tunica/core/error.hpp"
#include "tunica/fem/quadrature.hpp"
#include "tunica/mesh/adjacency.hpp"
#include "tunica/mesh/cells_behind.hpp"
#include "tunica/mesh/mesh.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace tunica::solid {

template <mesh::Cell C>
struct LoadFace {
  Index cell = 0;
  std::array<int, static_cast<std::size_t>(C::Face::nodes)> local{};  // its nodes in the cell's numbering
};

/// MeshError if a face of the patch belongs to no cell.
template <mesh::Cell C>
[[nodiscard]] std::vector<LoadFace<C>> load_faces(const mesh::Mesh<C, 3>& mesh,
                                                  const mesh::Patch<typename C::Face>& patch) {
  const mesh::Rows around = mesh::cells_of_nodes(mesh.cells, mesh.node_count());
  const auto behind = mesh::cells_behind(mesh.cells, around, patch.faces);
  std::vector<LoadFace<C>> faces;
  faces.reserve(behind.size());
  for (std::size_t f = 0; f < behind.size(); ++f) {
    if (behind[f] < 0)
      throw MeshError("patch \"" + patch.name + "\": face " + std::to_string(f) + " belongs to no cell");
    LoadFace<C> face{.cell = behind[f]};
    const auto cell = mesh.cells.col(behind[f]);
    for (int k = 0; k < C::Face::nodes; ++k)
      face.local[static_cast<std::size_t>(k)] = static_cast<int>(
          std::find(cell.data(), cell.data() + C::nodes, patch.faces(k, static_cast<Eigen::Index>(f))) -
          cell.data());
    faces.push_back(face);
  }
  return faces;
}

/// The current points of a face, x the nodes of its cell: 3 x face nodes [m].
template <mesh::Cell C>
[[nodiscard]] Eigen::Matrix<double, 3, C::Face::nodes> face_points(
    const LoadFace<C>& face, const Eigen::Matrix<double, 3, C::nodes>& x) {
  Eigen::Matrix<double, 3, C::Face::nodes> y;
  for (int k = 0; k < C::Face::nodes; ++k) y.col(k) = x.col(face.local[static_cast<std::size_t>(k)]);
  return y;
}

/// Integrates a product of two shape functions of a flat face exactly: degree 2 on Tri3, 3 in each
/// coordinate on Quad4, twice the order on quadratic faces.
template <class Face>
using FaceRule = fem::Gauss<Face, Face::nodes == 3   ? 2
                                  : Face::nodes == 4 ? 3
                                  : Face::nodes == 6 ? 4
                                                     : 5>;

}  // namespace tunica::solid
