// SPDX-License-Identifier: MIT
// The cells behind the faces of a boundary: those that have all nodes of a face.
#pragma once

#include "tunica/mesh/adjacency.hpp"
#include "tunica/mesh/mesh.hpp"

#include <algorithm>
#include <vector>

namespace tunica::mesh {

/// The first cell that has all nodes of each face, -1 where none has; around: cells_of_nodes(cells, ...).
template <class Cells, class Faces>
[[nodiscard]] std::vector<Index> cells_behind(const Cells& cells, const Rows& around, const Faces& faces) {
  const auto has = [&](Index cell, Index node) {
    const auto* const first = cells.data() + cells.rows() * cell;
    return std::find(first, first + cells.rows(), node) != first + cells.rows();
  };
  std::vector<Index> behind;
  for (Eigen::Index f = 0; f < faces.cols(); ++f) {
    Index found = -1;
    for (const Index cell : around[faces(0, f)]) {
      bool all = true;
      for (Eigen::Index k = 1; k < faces.rows() && all; ++k) all = has(cell, faces(k, f));
      if (!all) continue;
      found = cell;
      break;
    }
    behind.push_back(found);
  }
  return behind;
}

}  // namespace tunica::mesh
