// SPDX-License-Identifier: MIT
// Neighbours across the edges of quadrilaterals, and the nodes joined to a node by an edge.
#pragma once

#include "tunica/mesh/adjacency.hpp"

#include <cstddef>
#include <vector>

namespace tunica::meshing {

/// For each half-edge 4q + k (from corner k of q to the next) the one that runs it the other way, or -1.
[[nodiscard]] inline std::vector<Index> quad_twins(const Connectivity<4>& cells, Index node_count) {
  const mesh::Rows around = mesh::cells_of_nodes(cells, node_count);
  std::vector<Index> twin(static_cast<std::size_t>(cells.size()), -1);
  for (Index h = 0; h < static_cast<Index>(cells.size()); ++h) {
    const Index from = cells(h % 4, h / 4), to = cells((h + 1) % 4, h / 4);
    for (const Index q : around[to])
      for (int k = 0; k < 4; ++k)
        if (cells(k, q) == to && cells((k + 1) % 4, q) == from) twin[static_cast<std::size_t>(h)] = 4 * q + k;
  }
  return twin;
}

/// Row n: the nodes that an edge joins to n, each once.
[[nodiscard]] inline mesh::Rows quad_neighbours(const Connectivity<4>& cells, Index node_count) {
  const mesh::Rows around = mesh::cells_of_nodes(cells, node_count);
  mesh::Rows rows;
  for (Index n = 0; n < node_count; ++n) {
    const std::size_t first = rows.item.size();
    const auto add = [&](Index m) {
      for (std::size_t i = first; i < rows.item.size(); ++i)
        if (rows.item[i] == m) return;
      rows.item.push_back(m);
    };
    for (const Index q : around[n])
      for (int k = 0; k < 4; ++k)
        if (cells(k, q) == n) add(cells((k + 1) % 4, q)), add(cells((k + 3) % 4, q));
    rows.offset.push_back(static_cast<Index>(rows.item.size()));
  }
  return rows;
}

}  // namespace tunica::meshing
