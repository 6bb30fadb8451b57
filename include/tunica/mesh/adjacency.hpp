// SPDX-License-Identifier: MIT
// Who touches whom: cells of a node, twins of half-edges, neighbours of a node on a surface.
#pragma once

#include "tunica/mesh/mesh.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace tunica::mesh {

/// Rows of indices in compressed form: row i is item[offset[i]] .. item[offset[i+1]-1].
struct Rows {
  std::vector<Index> offset{0};  // rows + 1
  std::vector<Index> item;

  [[nodiscard]] Index size() const { return static_cast<Index>(offset.size()) - 1; }
  [[nodiscard]] std::span<const Index> operator[](Index i) const {
    const auto r = static_cast<std::size_t>(i);
    return {item.data() + offset[r], item.data() + offset[r + 1]};
  }
};

/// Row n holds the cells (columns of `cells`) that use node n, ascending.
template <class Cells>
[[nodiscard]] Rows cells_of_nodes(const Cells& cells, Index node_count) {
  Rows rows;
  rows.offset.assign(static_cast<std::size_t>(node_count) + 1, 0);
  for (Eigen::Index c = 0; c < cells.cols(); ++c)
    for (Eigen::Index k = 0; k < cells.rows(); ++k) ++rows.offset[static_cast<std::size_t>(cells(k, c)) + 1];
  for (std::size_t n = 1; n < rows.offset.size(); ++n) rows.offset[n] += rows.offset[n - 1];
  rows.item.resize(static_cast<std::size_t>(cells.size()));
  std::vector<Index> at(rows.offset.begin(), rows.offset.end() - 1);
  for (Eigen::Index c = 0; c < cells.cols(); ++c)
    for (Eigen::Index k = 0; k < cells.rows(); ++k)
      rows.item[static_cast<std::size_t>(at[static_cast<std::size_t>(cells(k, c))]++)] =
          static_cast<Index>(c);
  return rows;
}

/// Half-edge h = 3 t + k runs along triangle t from its node k to its node (k+1) mod 3.
struct HalfEdge {
  Index from, to;
};

[[nodiscard]] constexpr Index next_in_triangle(Index h) {
  return h % 3 == 2 ? h - 2 : h + 1;
}
[[nodiscard]] constexpr Index previous_in_triangle(Index h) {
  return h % 3 == 0 ? h + 2 : h - 1;
}

[[nodiscard]] inline HalfEdge half_edge(const Connectivity<3>& triangles, Index h) {
  return {triangles(h % 3, h / 3), triangles(next_in_triangle(h) % 3, h / 3)};
}

/// What lies across a half-edge where it is not exactly one half-edge of opposite direction.
inline constexpr Index open_edge = -1, nonmanifold_edge = -2, misoriented_edge = -3;

/// For each half-edge its twin (the same edge run the other way by the neighbour), or open_edge (no other
/// triangle), nonmanifold_edge (more than two triangles), misoriented_edge (two that run the same way).
[[nodiscard]] inline std::vector<Index> twins(const Connectivity<3>& triangles, Index node_count) {
  const Rows rows = cells_of_nodes(triangles, node_count);
  const auto half_edges = static_cast<Index>(triangles.size());
  std::vector<Index> twin(static_cast<std::size_t>(half_edges), open_edge);
  for (Index h = 0; h < half_edges; ++h) {
    const auto [from, to] = half_edge(triangles, h);
    Index others = 0, opposite = -1;
    for (const Index t : rows[from])
      for (Index g = 3 * t; g < 3 * t + 3; ++g) {
        const auto [p, q] = half_edge(triangles, g);
        if (g == h || !((p == from && q == to) || (p == to && q == from))) continue;
        ++others;
        if (p == to) opposite = g;
      }
    if (others == 1) twin[static_cast<std::size_t>(h)] = opposite >= 0 ? opposite : misoriented_edge;
    if (others > 1) twin[static_cast<std::size_t>(h)] = nonmanifold_edge;
  }
  return twin;
}

/// Row n holds the nodes joined to node n by an edge, each once, in order of first appearance.
[[nodiscard]] inline Rows neighbours_of_nodes(const Connectivity<3>& triangles, Index node_count) {
  const Rows cells = cells_of_nodes(triangles, node_count);
  Rows rows;
  rows.offset.reserve(static_cast<std::size_t>(node_count) + 1);
  rows.item.reserve(static_cast<std::size_t>(triangles.size()));
  std::vector<Index> seen(static_cast<std::size_t>(node_count), -1);
  for (Index n = 0; n < node_count; ++n) {
    for (const Index t : cells[n])
      for (int k = 0; k < 3; ++k) {
        const Index m = triangles(k, t);
        if (m == n || seen[static_cast<std::size_t>(m)] == n) continue;
        seen[static_cast<std::size_t>(m)] = n;
        rows.item.push_back(m);
      }
    rows.offset.push_back(static_cast<Index>(rows.item.size()));
  }
  return rows;
}

}  // namespace tunica::mesh
