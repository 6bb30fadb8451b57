// SPDX-License-Identifier: MIT
// Sews the open edges of a surface: nodes across a narrow gap become one, and a node that lies on an open
// edge splits the facet behind it.
#pragma once

#include "tunica/meshing/repair_facets.hpp"
#include "tunica/search/octree.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

namespace tunica::meshing::detail {

/// The nodes of open edges, ascending.
[[nodiscard]] inline std::vector<Index> open_nodes(const SharedEdges& edges) {
  std::vector<Index> nodes;
  for (Index e = 0; e < edges.size(); ++e)
    if (edges.facets(e) == 1) {
      const auto [a, b] = edges.nodes[static_cast<std::size_t>(e)];
      nodes.push_back(a), nodes.push_back(b);
    }
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

[[nodiscard]] inline Box ball_box(const Vec3& x, double reach) {
  Box box;
  box.extend(Vec3(x[0] - reach, x[1] - reach, x[2] - reach));
  box.extend(Vec3(x[0] + reach, x[1] + reach, x[2] + reach));
  return box;
}

/// Nodes of open edges no farther apart than the gap become the first of them.
inline void weld_seams(mesh::Surface& s, double gap, RepairReport& report) {
  const SharedEdges edges(s.cells);
  const std::vector<Index> nodes = open_nodes(edges);
  if (nodes.empty()) return;
  std::vector<Box> boxes;
  for (const Index n : nodes) boxes.push_back(ball_box(mesh::node(s, n), 0));
  const search::Octree tree(boxes);
  std::vector<Index> to(static_cast<std::size_t>(s.node_count()));
  std::iota(to.begin(), to.end(), Index{0});
  const auto root = [&](Index n) {
    while (to[static_cast<std::size_t>(n)] != n) n = to[static_cast<std::size_t>(n)];
    return n;
  };
  for (const Index n : nodes)
    tree.overlapping(ball_box(mesh::node(s, n), gap), [&](Index i) {
      const Index m = nodes[static_cast<std::size_t>(i)];
      if (m <= n || vec::distance(mesh::node(s, n), mesh::node(s, m)) > gap) return;
      const Index p = root(n), q = root(m);
      if (p != q) to[static_cast<std::size_t>(std::max(p, q))] = std::min(p, q);
    });
  bool any = false;
  for (const Index n : nodes)
    if (to[static_cast<std::size_t>(n)] != n) any = true, report.welded.add(mesh::node(s, n));
  if (!any) return;
  for (Index n = 0; n < s.node_count(); ++n) to[static_cast<std::size_t>(n)] = root(n);
  merge_nodes(s, to, report);
}

/// A node of an open edge that lies within the gap of the inside of another open edge becomes its node; one
/// edge a facet is done at a time. True if there was one.
inline bool sew_nodes(mesh::Surface& s, double gap, RepairReport& report) {
  const SharedEdges edges(s.cells);
  const std::vector<Index> nodes = open_nodes(edges);
  if (nodes.empty()) return false;
  std::vector<Box> boxes;
  for (const Index n : nodes) boxes.push_back(ball_box(mesh::node(s, n), gap));
  const search::Octree tree(boxes);
  std::vector<char> kept(static_cast<std::size_t>(s.cell_count()), 1);
  std::vector<std::array<Index, 3>> made;
  std::vector<Index> like;
  for (Index e = 0; e < edges.size(); ++e) {
    if (edges.facets(e) != 1) continue;
    const Index h = edges.half_edges[e][0], t = h / 3;
    const auto [a, b] = mesh::half_edge(s.cells, h);
    const Index d = s.cells(mesh::previous_in_triangle(h) % 3, t);
    if (kept[static_cast<std::size_t>(t)] == 0) continue;
    const Vec3 x = mesh::node(s, a), way = vec::minus(mesh::node(s, b), x);
    const double l2 = vec::squared(way);
    Box box;
    box.extend(x), box.extend(mesh::node(s, b));
    std::vector<std::pair<double, Index>> on;  // where along the edge
    tree.overlapping(box, [&](Index i) {
      const Index n = nodes[static_cast<std::size_t>(i)];
      if (n == a || n == b || n == d) return;
      const double u = vec::dot(vec::minus(mesh::node(s, n), x), way) / l2;
      const Vec3 foot = vec::along(x, u, way);
      if (u > 0 && u < 1 && vec::distance(foot, mesh::node(s, n)) <= gap) on.emplace_back(u, n);
    });
    if (on.empty()) continue;
    std::sort(on.begin(), on.end());
    kept[static_cast<std::size_t>(t)] = 0;
    Index from = a;
    for (const auto& [u, n] : on) {
      made.push_back({from, n, d}), like.push_back(t);
      report.sewn.add(mesh::node(s, n));
      from = n;
    }
    made.push_back({from, b, d}), like.push_back(t);
  }
  add_facets(s, made, like);
  kept.resize(static_cast<std::size_t>(s.cell_count()), 1);
  keep_facets(s, kept);
  return !made.empty();
}

}  // namespace tunica::meshing::detail
