// SPDX-License-Identifier: MIT
// Parts closed sheets that touch along edges or at nodes: around an edge of more than two facets each is
// paired with the one across the inside, each fan of facets at a node gets a node of its own, a little
// inside.
#pragma once

#include "tunica/mesh/measures.hpp"
#include "tunica/meshing/repair_edges.hpp"
#include "tunica/meshing/repair_report.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

namespace tunica::meshing::detail {

/// The half-edges of edge ab by their angle around it, paired so that the inside lies between the two of a
/// pair; false where they do not run the edge in turns.
[[nodiscard]] inline bool pair_around(const mesh::Surface& s, const SharedEdges& edges, Index e,
                                      std::vector<Index>& twin) {
  const auto [a, b] = edges.nodes[static_cast<std::size_t>(e)];
  const Vec3 x = mesh::node(s, a), axis = vec::unit(vec::minus(mesh::node(s, b), x));
  const Vec3 u = vec::orthogonal(axis), v = vec::cross(axis, u);
  std::vector<std::pair<double, Index>> order;
  for (const Index h : edges.half_edges[e]) {
    const Vec3 d = vec::minus(mesh::node(s, s.cells(mesh::previous_in_triangle(h) % 3, h / 3)), x);
    order.emplace_back(std::atan2(vec::dot(v, d), vec::dot(u, d)), h);
  }
  std::sort(order.begin(), order.end());
  const std::size_t n = order.size();
  const auto runs = [&](std::size_t i) { return mesh::half_edge(s.cells, order[i % n].second).from == a; };
  for (std::size_t i = 0; i < n; ++i)
    if (runs(i) == runs(i + 1)) return false;
  // the normal of one that runs a -> b points to greater angles: the inside lies below it
  for (std::size_t i = runs(0) ? 1 : 0; i < n; i += 2) {
    const Index g = order[i].second, h = order[(i + 1) % n].second;
    twin[static_cast<std::size_t>(g)] = h, twin[static_cast<std::size_t>(h)] = g;
  }
  return true;
}

inline constexpr double drawn_in = 0.05;  // of the way to the neighbours within the same sheet

/// Edges whose ends both stay one node although they have several pairs of facets: each pair is split at a
/// node of its own.
inline void split_pairs(mesh::Surface& s, const std::vector<Index>& twin) {
  const SharedEdges edges(s.cells);
  const auto at = [](Index i) { return static_cast<std::size_t>(i); };
  std::vector<Index> middle(twin.size(), -1);
  std::vector<Vec3> extra;
  for (Index e = 0; e < edges.size(); ++e) {
    if (edges.facets(e) < 4) continue;
    for (const Index h : edges.half_edges[e]) {
      const Index g = twin[at(h)];
      if (g < h) continue;  // done, or without a pair
      const auto [a, b] = mesh::half_edge(s.cells, h);
      const auto apex = [&](Index i) {
        return mesh::node(s, s.cells(mesh::previous_in_triangle(i) % 3, i / 3));
      };
      middle[at(h)] = middle[at(g)] = s.node_count() + static_cast<Index>(extra.size());
      extra.push_back(vec::between(vec::between(mesh::node(s, a), mesh::node(s, b), 0.5),
                                   vec::between(apex(h), apex(g), 0.5), drawn_in));
    }
  }
  if (extra.empty()) return;
  append_nodes(s, extra);
  std::vector<char> kept(at(s.cell_count()), 1);
  std::vector<std::array<Index, 3>> made;
  std::vector<Index> like;
  for (Index t = 0; t < s.cell_count(); ++t) {
    std::vector<Index> ring;  // corners and middles
    Index first = -1;         // a middle
    for (Index h = 3 * t; h < 3 * t + 3; ++h) {
      ring.push_back(s.cells(h % 3, t));
      if (middle[at(h)] < 0) continue;
      if (first < 0) first = static_cast<Index>(ring.size());
      ring.push_back(middle[at(h)]);
    }
    if (first < 0) continue;
    kept[at(t)] = 0;
    std::rotate(ring.begin(), ring.begin() + first, ring.end());
    if (ring.size() == 6) {  // middles at 0, 2, 4
      made.push_back({ring[0], ring[2], ring[4]}), like.push_back(t);
      for (std::size_t k = 0; k < 6; k += 2)
        made.push_back({ring[k], ring[k + 1], ring[(k + 2) % 6]}), like.push_back(t);
    } else {  // a fan from the first middle
      for (std::size_t k = 1; k + 1 < ring.size(); ++k)
        made.push_back({ring[0], ring[k], ring[k + 1]}), like.push_back(t);
    }
  }
  add_facets(s, made, like);
  kept.resize(at(s.cell_count()), 1);
  keep_facets(s, kept);
}

/// Parts what touches. Facets must agree and face outward.
inline void part_sheets(mesh::Surface& s, RepairReport& report) {
  const SharedEdges edges(s.cells);
  const auto at = [](Index i) { return static_cast<std::size_t>(i); };
  std::vector<Index> twin(at(3 * s.cell_count()), -1);
  for (Index e = 0; e < edges.size(); ++e) {
    const auto row = edges.half_edges[e];
    if (row.size() == 2) twin[at(row[0])] = row[1], twin[at(row[1])] = row[0];
    if (row.size() < 4 || row.size() % 2 != 0 || !pair_around(s, edges, e, twin)) continue;
    const auto [a, b] = edges.nodes[at(e)];
    report.split_edges.add(vec::between(mesh::node(s, a), mesh::node(s, b), 0.5));
  }
  // corners (named by the half-edge that leaves them) joined to fans over the paired edges
  std::vector<Index> fan(twin.size());
  std::iota(fan.begin(), fan.end(), Index{0});
  const auto root = [&](Index c) {
    while (fan[at(c)] != c) c = fan[at(c)] = fan[at(fan[at(c)])];
    return c;
  };
  const auto join = [&](Index c, Index d) {
    const Index p = root(c), q = root(d);
    fan[at(std::max(p, q))] = std::min(p, q);
  };
  for (Index h = 0; h < 3 * s.cell_count(); ++h)
    if (const Index g = twin[at(h)]; g > h)
      join(h, mesh::next_in_triangle(g)), join(g, mesh::next_in_triangle(h));
  std::vector<Index> owner(at(s.node_count()), -1);  // the fan that keeps a node
  std::vector<Index> copy(twin.size(), -1);          // the node of a fan
  std::vector<char> parted(owner.size(), 0);
  std::vector<Vec3> extra;
  for (Index h = 0; h < 3 * s.cell_count(); ++h) {
    if (root(h) != h) continue;
    const Index n = s.cells(h % 3, h / 3);
    if (owner[at(n)] < 0) {
      owner[at(n)] = h, copy[at(h)] = n;
      continue;
    }
    if (parted[at(n)] == 0) report.split_nodes.add(mesh::node(s, n));
    parted[at(n)] = 1;
    copy[at(h)] = s.node_count() + static_cast<Index>(extra.size());
    extra.push_back(mesh::node(s, n));
  }
  if (extra.empty() && report.split_edges.count == 0) return;
  const Index old_count = s.node_count();
  append_nodes(s, extra);
  // each of them is drawn towards the nodes of its own fan
  std::vector<Vec3> sum(at(s.node_count()), Vec3(0, 0, 0));
  std::vector<int> count(sum.size(), 0);
  const Connectivity<3> old_cells = s.cells;
  for (Index h = 0; h < 3 * s.cell_count(); ++h) {
    const Index n = copy[at(root(h))];
    s.cells(h % 3, h / 3) = n;
    const bool moves = n >= old_count || parted[at(n)] != 0;
    if (!moves) continue;
    for (const Index c : {mesh::next_in_triangle(h), mesh::previous_in_triangle(h)})
      sum[at(n)] = vec::plus(sum[at(n)], mesh::node(s, old_cells(c % 3, c / 3))), ++count[at(n)];
  }
  for (Index n = 0; n < s.node_count(); ++n)
    if (count[at(n)] > 0) {
      const Vec3 mean = vec::divided(sum[at(n)], count[at(n)]);
      vec::set_column(s.nodes, n, vec::between(mesh::node(s, n), mean, drawn_in));
    }
  split_pairs(s, twin);
}

}  // namespace tunica::meshing::detail
