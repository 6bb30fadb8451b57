// SPDX-License-Identifier: MIT
// Repair of single facets and nodes: equal nodes welded, facets without area and duplicates left out, flaps
// and stray sheets cut off.
#pragma once

#include "tunica/mesh/measures.hpp"
#include "tunica/meshing/intersections.hpp"
#include "tunica/meshing/repair_edges.hpp"
#include "tunica/meshing/repair_report.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>
#include <tuple>
#include <utility>
#include <vector>

namespace tunica::meshing::detail {

/// Puts `to[n]` in the place of node n; facets that lose a corner go and are counted.
inline void merge_nodes(mesh::Surface& s, const std::vector<Index>& to, RepairReport& report) {
  std::vector<char> kept(static_cast<std::size_t>(s.cell_count()), 1);
  for (Index t = 0; t < s.cell_count(); ++t) {
    for (int k = 0; k < 3; ++k) s.cells(k, t) = to[static_cast<std::size_t>(s.cells(k, t))];
    const Index a = s.cells(0, t), b = s.cells(1, t), c = s.cells(2, t);
    if (a != b && b != c && c != a) continue;
    kept[static_cast<std::size_t>(t)] = 0;
    report.degenerate.add(mesh::node(s, a));
  }
  keep_facets(s, kept);
}

/// Nodes at the same place become the first of them.
inline void weld_equal(mesh::Surface& s, RepairReport& report) {
  std::vector<Index> order(static_cast<std::size_t>(s.node_count())), to(order.size());
  std::iota(order.begin(), order.end(), Index{0});
  const auto key = [&](Index n) { return std::tuple(s.nodes(0, n), s.nodes(1, n), s.nodes(2, n)); };
  std::sort(order.begin(), order.end(),
            [&](Index a, Index b) { return std::pair(key(a), a) < std::pair(key(b), b); });
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool same = i > 0 && key(order[i]) == key(order[i - 1]);
    to[static_cast<std::size_t>(order[i])] = same ? to[static_cast<std::size_t>(order[i - 1])] : order[i];
  }
  for (Index n = 0; n < s.node_count(); ++n)
    if (to[static_cast<std::size_t>(n)] != n) report.welded.add(mesh::node(s, n));
  merge_nodes(s, to, report);
}

/// The half-edge along the longest side of a triangle.
[[nodiscard]] inline Index longest_side(const mesh::Surface& s, Index t) {
  Index best = 3 * t;
  double most = -1;
  for (Index h = 3 * t; h < 3 * t + 3; ++h) {
    const auto [a, b] = mesh::half_edge(s.cells, h);
    const double l = vec::distance(mesh::node(s, a), mesh::node(s, b));
    if (l > most) most = l, best = h;
  }
  return best;
}

/// A facet whose corners lie on one line goes; the facet beyond its longest side is split at its third
/// corner, so that no gap is left. Returns how many went.
inline Index drop_flat(mesh::Surface& s, RepairReport& report) {
  const Index cells = s.cell_count();
  std::vector<char> flat(static_cast<std::size_t>(cells), 0);
  bool any = false;
  for (Index t = 0; t < cells; ++t)
    if (projection_axis(mesh::triangle(s, t)) < 0) flat[static_cast<std::size_t>(t)] = 1, any = true;
  if (!any) return 0;
  const SharedEdges edges(s.cells);
  std::vector<char> kept(static_cast<std::size_t>(cells), 1), touched(kept.size(), 0);
  std::vector<std::array<Index, 3>> made;
  std::vector<Index> like;
  Index gone = 0;
  for (Index t = 0; t < cells; ++t) {
    if (touched[static_cast<std::size_t>(t)] != 0 || flat[static_cast<std::size_t>(t)] == 0) continue;
    const Index side = longest_side(s, t);
    const Index c = s.cells(mesh::previous_in_triangle(side) % 3, t);
    const auto row = edges.half_edges[edges.edge(side)];
    bool free = true;  // all that share the side can be split
    for (const Index h : row) {
      const Index d = s.cells(mesh::previous_in_triangle(h) % 3, h / 3);
      free = free && touched[static_cast<std::size_t>(h / 3)] == 0 &&
             (h == side || (d != c && !edges.has(c, d) && flat[static_cast<std::size_t>(h / 3)] == 0));
    }
    if (!free) continue;
    report.degenerate.add(mesh::node(s, c)), ++gone;
    for (const Index h : row) {
      const auto [a, b] = mesh::half_edge(s.cells, h);
      const Index u = h / 3, d = s.cells(mesh::previous_in_triangle(h) % 3, u);
      kept[static_cast<std::size_t>(u)] = 0, touched[static_cast<std::size_t>(u)] = 1;
      if (h == side) continue;
      made.push_back({a, c, d}), made.push_back({c, b, d});
      like.insert(like.end(), 2, u);
    }
  }
  if (gone == 0) return 0;
  add_facets(s, made, like);
  kept.resize(static_cast<std::size_t>(s.cell_count()), 1);
  keep_facets(s, kept);
  return gone;
}

/// Of facets over the same nodes one stays; of two back to back none, unless their edges need one.
inline void drop_duplicates(mesh::Surface& s, RepairReport& report) {
  struct Key {
    std::array<Index, 3> nodes;
    Index facet;
  };
  std::vector<Key> list;
  for (Index t = 0; t < s.cell_count(); ++t) {
    Key k{{s.cells(0, t), s.cells(1, t), s.cells(2, t)}, t};
    std::sort(k.nodes.begin(), k.nodes.end());
    list.push_back(k);
  }
  std::sort(list.begin(), list.end(), [](const Key& a, const Key& b) {
    return std::tie(a.nodes, a.facet) < std::tie(b.nodes, b.facet);
  });
  bool any = false;
  for (std::size_t i = 1; i < list.size(); ++i) any = any || list[i].nodes == list[i - 1].nodes;
  if (!any) return;
  const SharedEdges edges(s.cells);
  const auto even = [&](Index t) {  // it turns as its nodes in ascending order
    const Index a = s.cells(0, t), b = s.cells(1, t), c = s.cells(2, t);
    return (a < b) + (b < c) + (c < a) == 2;
  };
  std::vector<char> kept(list.size(), 1);
  for (std::size_t i = 0, j = 0; i < list.size(); i = j) {
    while (j < list.size() && list[j].nodes == list[i].nodes) ++j;
    if (j == i + 1) continue;
    const auto copies = static_cast<Index>(j - i);
    const Vec3 at = mesh::triangle(s, list[i].facet).centroid();
    Index turns = 0, wanted = 0;
    for (std::size_t k = i; k < j; ++k) turns += even(list[k].facet) ? 1 : -1;
    for (Index h = 3 * list[i].facet; h < 3 * list[i].facet + 3; ++h)
      wanted += (edges.facets(edges.edge(h)) - copies) % 2 != 0 ? 1 : -1;
    const bool back_to_back = turns == 0 && wanted < 0;
    for (std::size_t k = i + (back_to_back ? 0 : 1); k < j; ++k)
      kept[static_cast<std::size_t>(list[k].facet)] = 0;
    for (Index n = 0; n < (back_to_back ? copies / 2 : copies - 1); ++n)
      (back_to_back ? report.folded_sheets : report.duplicates).add(at);
  }
  keep_facets(s, kept);
}

/// Cuts off sheets that hang on edges of more than two facets and are open elsewhere; true if there were any.
inline bool drop_flaps(mesh::Surface& s, RepairReport& report) {
  const SharedEdges edges(s.cells);
  std::vector<Index> sheet;
  const auto count = static_cast<std::size_t>(sheets(edges, 2, sheet));
  std::vector<char> open(count, 0), hangs(count, 0);
  for (Index e = 0; e < edges.size(); ++e) {
    const auto row = edges.half_edges[e];
    const auto of = [&](Index h) { return static_cast<std::size_t>(sheet[static_cast<std::size_t>(h / 3)]); };
    if (row.size() == 1) open[of(row[0])] = 1;
    if (row.size() < 3) continue;
    for (const Index h : row) {
      const auto own = std::count_if(row.begin(), row.end(), [&](Index g) { return of(g) == of(h); });
      if (own % 2 != 0) hangs[of(h)] = 1;
    }
  }
  std::vector<char> kept(sheet.size(), 1);
  bool any = false;
  for (Index t = 0; t < s.cell_count(); ++t) {
    const auto k = static_cast<std::size_t>(sheet[static_cast<std::size_t>(t)]);
    if (open[k] == 0 || hangs[k] == 0) continue;
    kept[static_cast<std::size_t>(t)] = 0, any = true;
    report.flaps.add(mesh::triangle(s, t).centroid());
  }
  keep_facets(s, kept);
  return any;
}

/// Leaves out open parts of less than that share of the area, and all but the largest part that have no node
/// off their rims: closing them would lay facets back to back.
inline void drop_strays(mesh::Surface& s, double share, RepairReport& report) {
  const SharedEdges edges(s.cells);
  const auto at = [](Index i) { return static_cast<std::size_t>(i); };
  std::vector<Index> part;
  const Index count = sheets(edges, s.cell_count(), part);
  if (count == 0) return;
  std::vector<char> on_rim(at(s.node_count()), 0), kept(part.size(), 1);
  for (Index e = 0; e < edges.size(); ++e)
    if (edges.facets(e) == 1)
      for (const Index n : edges.nodes[at(e)]) on_rim[at(n)] = 1;
  std::vector<double> area(at(count), 0);
  std::vector<char> open(area.size(), 0), thick(area.size(), 0);
  for (Index t = 0; t < s.cell_count(); ++t) {
    const std::size_t k = at(part[at(t)]);
    area[k] += mesh::triangle(s, t).area();
    for (Index h = 3 * t; h < 3 * t + 3; ++h) open[k] |= edges.facets(edges.edge(h)) == 1;
    for (int c = 0; c < 3; ++c) thick[k] |= on_rim[at(s.cells(c, t))] == 0;
  }
  thick[static_cast<std::size_t>(std::max_element(area.begin(), area.end()) - area.begin())] = 1;
  const double all = std::accumulate(area.begin(), area.end(), 0.0);
  for (Index t = 0; t < s.cell_count(); ++t) {
    const std::size_t k = at(part[at(t)]);
    if (open[k] == 0 || (thick[k] != 0 && !(area[k] < share * all))) continue;
    kept[at(t)] = 0;
    report.strays.add(mesh::triangle(s, t).centroid());
  }
  keep_facets(s, kept);
}

}  // namespace tunica::meshing::detail
