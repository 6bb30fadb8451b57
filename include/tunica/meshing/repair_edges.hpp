// SPDX-License-Identifier: MIT
// The edges of a surface that may be broken: all half-edges of each edge, however many and however turned.
#pragma once

#include "tunica/core/vec.hpp"
#include "tunica/mesh/adjacency.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

namespace tunica::meshing {

/// Row e holds the half-edges of edge e, ascending; edges are in the order of their nodes.
struct SharedEdges {
  mesh::Rows half_edges;
  std::vector<std::array<Index, 2>> nodes;  // low, high
  std::vector<Index> edge_of;               // of each half-edge

  explicit SharedEdges(const Connectivity<3>& cells) : edge_of(static_cast<std::size_t>(cells.size())) {
    std::vector<std::array<Index, 3>> list;
    list.reserve(edge_of.size());
    for (Index h = 0; h < static_cast<Index>(cells.size()); ++h) {
      const auto [a, b] = mesh::half_edge(cells, h);
      list.push_back({std::min(a, b), std::max(a, b), h});
    }
    std::sort(list.begin(), list.end());
    for (std::size_t i = 0; i < list.size(); ++i) {
      if (i == 0 || list[i][0] != list[i - 1][0] || list[i][1] != list[i - 1][1]) {
        if (i > 0) half_edges.offset.push_back(static_cast<Index>(i));
        nodes.push_back({list[i][0], list[i][1]});
      }
      half_edges.item.push_back(list[i][2]);
      edge_of[static_cast<std::size_t>(list[i][2])] = static_cast<Index>(nodes.size()) - 1;
    }
    if (!list.empty()) half_edges.offset.push_back(static_cast<Index>(list.size()));
  }

  [[nodiscard]] Index size() const { return static_cast<Index>(nodes.size()); }
  [[nodiscard]] Index edge(Index h) const { return edge_of[static_cast<std::size_t>(h)]; }
  [[nodiscard]] Index facets(Index e) const { return static_cast<Index>(half_edges[e].size()); }

  /// There is an edge between a and b.
  [[nodiscard]] bool has(Index a, Index b) const {
    return std::binary_search(nodes.begin(), nodes.end(),
                              std::array<Index, 2>{std::min(a, b), std::max(a, b)});
  }
  /// The other half-edge of an edge of two facets, else -1.
  [[nodiscard]] Index across(Index h) const {
    const auto row = half_edges[edge(h)];
    return row.size() != 2 ? -1 : row[0] == h ? row[1] : row[0];
  }
};

/// Sets of facets joined over edges of at most so many facets:
/// one label a facet, in the order of their first facets. Returns how many there are.
[[nodiscard]] inline Index sheets(const SharedEdges& edges, Index facets_at_most, std::vector<Index>& label) {
  label.assign(edges.edge_of.size() / 3, -1);
  Index count = 0;
  std::vector<Index> stack;
  for (Index seed = 0; seed < static_cast<Index>(label.size()); ++seed) {
    if (label[static_cast<std::size_t>(seed)] >= 0) continue;
    stack.assign(1, seed);
    label[static_cast<std::size_t>(seed)] = count;
    while (!stack.empty()) {
      const Index t = stack.back();
      stack.pop_back();
      for (Index h = 3 * t; h < 3 * t + 3; ++h) {
        if (edges.facets(edges.edge(h)) > facets_at_most) continue;
        for (const Index g : edges.half_edges[edges.edge(h)])
          if (Index& l = label[static_cast<std::size_t>(g / 3)]; l < 0) l = count, stack.push_back(g / 3);
      }
    }
    ++count;
  }
  return count;
}

/// Keeps the facets that are marked, with their regions.
inline void keep_facets(mesh::Surface& s, const std::vector<char>& kept) {
  Index to = 0;
  for (Index t = 0; t < s.cell_count(); ++t) {
    if (kept[static_cast<std::size_t>(t)] == 0) continue;
    for (int k = 0; k < 3; ++k) s.cells(k, to) = s.cells(k, t);
    if (!s.region.empty()) s.region[static_cast<std::size_t>(to)] = s.region[static_cast<std::size_t>(t)];
    ++to;
  }
  s.cells.conservativeResize(3, to);
  if (!s.region.empty()) s.region.resize(static_cast<std::size_t>(to));
}

/// Drops nodes that no facet uses; the others keep their order.
inline void drop_unused_nodes(mesh::Surface& s) {
  std::vector<Index> number(static_cast<std::size_t>(s.node_count()), -1);
  for (Index t = 0; t < s.cell_count(); ++t)
    for (int k = 0; k < 3; ++k) number[static_cast<std::size_t>(s.cells(k, t))] = 0;
  Index count = 0;
  for (Index n = 0; n < s.node_count(); ++n) {
    if (number[static_cast<std::size_t>(n)] < 0) continue;
    for (int a = 0; a < 3; ++a) s.nodes(a, count) = s.nodes(a, n);
    number[static_cast<std::size_t>(n)] = count++;
  }
  if (count == s.node_count()) return;
  s.nodes.conservativeResize(3, count);
  for (Index t = 0; t < s.cell_count(); ++t)
    for (int k = 0; k < 3; ++k) s.cells(k, t) = number[static_cast<std::size_t>(s.cells(k, t))];
}

/// Adds nodes after those that there are.
inline void append_nodes(mesh::Surface& s, const std::vector<Vec3>& extra) {
  const Index n = s.node_count();
  s.nodes.conservativeResize(3, n + static_cast<Index>(extra.size()));
  for (std::size_t i = 0; i < extra.size(); ++i)
    vec::set_column(s.nodes, n + static_cast<Index>(i), extra[i]);
}

/// Adds facets, each with the region of the one that it is given with.
inline void add_facets(mesh::Surface& s, const std::vector<std::array<Index, 3>>& made,
                       const std::vector<Index>& like) {
  Index t = s.cell_count();
  s.cells.conservativeResize(3, t + static_cast<Index>(made.size()));
  for (std::size_t i = 0; i < made.size(); ++i, ++t) {
    for (std::size_t k = 0; k < 3; ++k) s.cells(static_cast<Eigen::Index>(k), t) = made[i][k];
    if (!s.region.empty()) s.region.push_back(s.region[static_cast<std::size_t>(like[i])]);
  }
}

}  // namespace tunica::meshing
