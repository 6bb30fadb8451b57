// SPDX-License-Identifier: MIT
// Fills the holes of a surface: a loop is triangulated, refined to the edges around it, made locally Delaunay
// and its new nodes are drawn to a membrane. After [LIEPA03].
#pragma once

#include "tunica/meshing/repair_loops.hpp"
#include "tunica/meshing/repair_report.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

namespace tunica::meshing::detail {

/// The filling of one hole; corners 0 .. rim-1 are those of the loop, new nodes follow.
class HolePatch {
 public:
  std::vector<Vec3> x;
  std::vector<std::array<Index, 3>> triangles;

  template <class FreeChord>
  HolePatch(const std::vector<Vec3>& loop, const std::vector<double>& edge, const FreeChord& free_chord)
      : x(loop), triangles(loop_triangles(loop, free_chord)), edge_(edge), rim_(loop.size()) {
    constexpr int most_rounds = 20;
    for (int round = 0; round < most_rounds && !triangles.empty(); ++round) {
      const bool more = split();
      constexpr int most_passes = 10;
      for (int pass = 0; pass < most_passes && flip(free_chord); ++pass) {
      }
      if (!more) break;
      relax();
    }
  }

 private:
  using Sides = std::map<std::pair<Index, Index>, std::pair<std::size_t, std::size_t>>;

  [[nodiscard]] const Vec3& at(Index n) const { return x[static_cast<std::size_t>(n)]; }

  /// Halves inner edges longer than 4/3 of those asked for at their ends, the longest first, one a triangle.
  bool split() {
    struct Long {
      double length;
      Index from, to;
      std::size_t t, k;
    };
    constexpr double most = 4.0 / 3;
    Sides side = sides();
    std::vector<Long> list;
    for (const auto& [e, at_side] : side) {
      const auto [a, b] = e;
      const double wanted = 0.5 * (edge_[static_cast<std::size_t>(a)] + edge_[static_cast<std::size_t>(b)]);
      const double l = vec::distance(at(a), at(b));
      if (a < b && l > most * wanted && side.count({b, a}) > 0)
        list.push_back({l, a, b, at_side.first, at_side.second});
    }
    std::stable_sort(list.begin(), list.end(),
                     [](const Long& p, const Long& q) { return p.length > q.length; });
    std::vector<char> used(triangles.size(), 0);
    bool any = false;
    for (const auto& [l, a, b, t, k] : list) {
      const auto [u, m] = side[{b, a}];
      if (used[t] != 0 || used[u] != 0) continue;
      used[t] = used[u] = 1, any = true;
      const Index c = triangles[t][(k + 2) % 3], d = triangles[u][(m + 2) % 3];
      const auto n = static_cast<Index>(x.size());
      x.push_back(vec::between(at(a), at(b), 0.5));
      edge_.push_back(0.5 * (edge_[static_cast<std::size_t>(a)] + edge_[static_cast<std::size_t>(b)]));
      triangles[t] = {a, n, c}, triangles[u] = {b, n, d};
      triangles.push_back({n, b, c}), triangles.push_back({n, a, d});
    }
    return any;
  }

  /// (from, to) -> (triangle, corner)
  [[nodiscard]] Sides sides() const {
    Sides side;
    for (std::size_t t = 0; t < triangles.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k) side[{triangles[t][k], triangles[t][(k + 1) % 3]}] = {t, k};
    return side;
  }

  /// Flips inner edges whose opposite angles exceed 180 degrees together; true if there was one.
  template <class FreeChord>
  bool flip(const FreeChord& free_chord) {
    const Sides side = sides();
    std::vector<char> used(triangles.size(), 0);
    bool any = false;
    for (std::size_t t = 0; t < triangles.size(); ++t)
      for (std::size_t k = 0; k < 3 && used[t] == 0; ++k) {
        const Index a = triangles[t][k], b = triangles[t][(k + 1) % 3], c = triangles[t][(k + 2) % 3];
        const auto other = side.find({b, a});
        if (other == side.end() || used[other->second.first] != 0) continue;
        const auto [u, m] = other->second;
        const Index d = triangles[u][(m + 2) % 3];
        const bool inner = static_cast<std::size_t>(std::max(c, d)) >= rim_;
        if (side.count({c, d}) + side.count({d, c}) > 0 || (!inner && !free_chord(c, d))) continue;
        if (corner(c, a, b) + corner(d, a, b) <= std::numbers::pi * (1 + 1e-9)) continue;
        const mesh::Triangle p{at(a), at(d), at(c)}, q{at(d), at(b), at(c)};
        if (!(vec::dot(p.area_vector(), q.area_vector()) > 0)) continue;
        triangles[t] = {a, d, c}, triangles[u] = {d, b, c};
        used[t] = used[u] = 1, any = true;
      }
    return any;
  }

  [[nodiscard]] double corner(Index p, Index q, Index r) const {
    const Vec3 u = vec::minus(at(q), at(p)), v = vec::minus(at(r), at(p));
    return std::atan2(vec::length(vec::cross(u, v)), vec::dot(u, v));
  }

  /// New nodes go to the means of their neighbours, again and again: a membrane over the rim.
  void relax() {
    std::vector<std::vector<Index>> near(x.size());
    for (const auto& t : triangles)
      for (std::size_t k = 0; k < 3; ++k) near[static_cast<std::size_t>(t[k])].push_back(t[(k + 1) % 3]);
    constexpr int sweeps = 40;
    for (int i = 0; i < sweeps; ++i)
      for (std::size_t n = rim_; n < x.size(); ++n) {
        Vec3 sum(0, 0, 0);
        for (const Index m : near[n]) sum = vec::plus(sum, at(m));
        x[n] = vec::divided(sum, static_cast<double>(near[n].size()));
      }
  }

  std::vector<double> edge_;  // asked for at each node
  std::size_t rim_;
};

/// Fills the holes of at most so many edges.
inline void fill_holes(mesh::Surface& s, Index most_edges, RepairReport& report) {
  const SharedEdges edges(s.cells);
  const auto loops = hole_loops(s, edges);
  if (loops.empty()) return;
  std::vector<std::array<Index, 3>> made;
  std::vector<Vec3> extra;
  for (const auto& loop : loops) {
    std::vector<Vec3> x;
    FilledHole hole{.edges = static_cast<Index>(loop.size())};
    for (const Index n : loop) {
      x.push_back(mesh::node(s, n));
      hole.centre = vec::along(hole.centre, 1 / static_cast<double>(loop.size()), x.back());
    }
    if (hole.edges > most_edges) {
      report.left.push_back(hole);
      continue;
    }
    std::vector<double> edge;
    for (std::size_t i = 0; i < x.size(); ++i)
      edge.push_back(0.5 * (vec::distance(x[i], x[(i + 1) % x.size()]) +
                            vec::distance(x[i], x[(i + x.size() - 1) % x.size()])));
    const HolePatch patch(x, edge, [&](Index i, Index j) {
      return !edges.has(loop[static_cast<std::size_t>(i)], loop[static_cast<std::size_t>(j)]);
    });
    if (patch.triangles.empty()) {
      report.left.push_back(hole);
      continue;
    }
    const auto rim = static_cast<Index>(loop.size());
    const auto base = s.node_count() + static_cast<Index>(extra.size());
    for (const auto& t : patch.triangles) {
      std::array<Index, 3> v{};
      for (std::size_t k = 0; k < 3; ++k)
        v[k] = t[k] < rim ? loop[static_cast<std::size_t>(t[k])] : base + t[k] - rim;
      made.push_back(v);
    }
    extra.insert(extra.end(), patch.x.begin() + rim, patch.x.end());
    hole.triangles = static_cast<Index>(patch.triangles.size());
    report.filled.push_back(hole);
  }
  append_nodes(s, extra);
  // a filling is of the region of the facet at its first edge
  std::vector<Index> like;
  for (const auto& t : made) {
    Index h = 0;
    for (std::size_t k = 0; k < 3; ++k)
      if (const auto e = std::array<Index, 2>{std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])};
          edges.has(e[0], e[1]))
        h = edges.half_edges[static_cast<Index>(std::lower_bound(edges.nodes.begin(), edges.nodes.end(), e) -
                                                edges.nodes.begin())][0];
    like.push_back(h / 3);
  }
  add_facets(s, made, like);
}

}  // namespace tunica::meshing::detail
