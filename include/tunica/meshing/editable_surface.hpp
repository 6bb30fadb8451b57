// SPDX-License-Identifier: MIT
// A closed triangle surface that can be edited: split, collapse, flip and move, each only if no triangle
// turns over or crosses another; what was left out is counted.
#pragma once

#include "tunica/meshing/facets.hpp"
#include "tunica/meshing/folds.hpp"
#include "tunica/meshing/triangle_grid.hpp"
#include "tunica/meshing/triangles_cross.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

namespace tunica::meshing {

/// Edits that were left out, by the reason.
struct LeftOut {
  Index folds = 0;    // a triangle would have turned over or lost its shape
  Index crosses = 0;  // the surface would have crossed itself
};

class EditableSurface {
 public:
  using Nodes = std::array<Index, 3>;

  /// Two triangles may meet at this angle or more (cosine of the turn), or as sharply as those that they
  /// replace: no shallow bulge beside a flat end is drawn flat against it.
  static constexpr double five_degrees = 0.996, twenty_degrees = 0.94;

  EditableSurface(const mesh::Surface& s, const Facets& facets, double edge, double sharp = five_degrees)
      : grid_(mesh::bounding_box(s.nodes), edge), facet_size_(facets.region.size(), 0), sharp_(sharp) {
    for (Index n = 0; n < s.node_count(); ++n) x_.push_back(s.nodes.col(n));
    ring_.resize(x_.size());
    for (Index t = 0; t < s.cell_count(); ++t)
      insert({s.cells(0, t), s.cells(1, t), s.cells(2, t)}, facets.of[static_cast<std::size_t>(t)]);
  }

  [[nodiscard]] Index node_count() const { return static_cast<Index>(x_.size()); }
  [[nodiscard]] Index triangle_count() const { return static_cast<Index>(triangle_.size()); }
  [[nodiscard]] bool alive(Index t) const { return facet_[at(t)] >= 0; }
  [[nodiscard]] bool used(Index n) const { return !ring_[at(n)].empty(); }
  [[nodiscard]] const Vec3& x(Index n) const { return x_[at(n)]; }
  [[nodiscard]] const Nodes& nodes(Index t) const { return triangle_[at(t)]; }
  [[nodiscard]] Index facet(Index t) const { return facet_[at(t)]; }
  [[nodiscard]] const std::vector<Index>& ring(Index n) const { return ring_[at(n)]; }
  void allow_folds(double sharp) { sharp_ = sharp; }
  [[nodiscard]] const LeftOut& left_out() const { return left_out_; }
  [[nodiscard]] double length(Index a, Index b) const { return (x(b) - x(a)).norm(); }
  [[nodiscard]] mesh::Triangle triangle(const Nodes& v) const { return {x(v[0]), x(v[1]), x(v[2])}; }
  [[nodiscard]] mesh::Triangle triangle(Index t) const { return triangle(nodes(t)); }

  /// The triangles of an edge, the first runs it from a to b; {-1, -1} where there is no such edge.
  [[nodiscard]] std::array<Index, 2> sides(Index a, Index b) const {
    std::array<Index, 2> s{-1, -1};
    for (const Index t : ring_[at(a)])
      for (std::size_t k = 0; k < 3; ++k) {
        if (nodes(t)[k] == a && nodes(t)[(k + 1) % 3] == b) s[0] = t;
        if (nodes(t)[k] == b && nodes(t)[(k + 1) % 3] == a) s[1] = t;
      }
    return s;
  }
  [[nodiscard]] bool on_rim(Index a, Index b) const {
    const auto [s, t] = sides(a, b);
    return s >= 0 && facet(s) != facet(t);
  }
  [[nodiscard]] Index opposite(Index t, Index a, Index b) const {
    for (const Index n : nodes(t))
      if (n != a && n != b) return n;
    return -1;
  }

  [[nodiscard]] std::vector<Index> neighbours(Index n) const {
    std::vector<Index> m;  // each triangle gives the node that follows n
    for (const Index t : ring_[at(n)])
      for (std::size_t k = 0; k < 3; ++k)
        if (nodes(t)[k] == n) m.push_back(nodes(t)[(k + 1) % 3]);
    return m;
  }

  /// Moves a node.
  bool move(Index n, const Vec3& to) {
    std::vector<Nodes> made;
    for (const Index t : ring_[at(n)]) made.push_back(nodes(t));
    const std::vector<Index> gone = ring_[at(n)];
    const Vec3 from = x_[at(n)];
    const Before before{facet_normals(gone), n, from};
    x_[at(n)] = to;
    const bool good = allowed(made, gone, before, most_turn);
    x_[at(n)] = from;
    if (!good) return false;
    for (const Index t : gone) grid_.remove(t);
    x_[at(n)] = to;
    for (const Index t : gone) grid_.add(t, triangle(t).box());
    return true;
  }

  /// A new node on edge ab; its number, -1 if left out.
  Index split(Index a, Index b, const Vec3& place) {
    const auto [s, t] = sides(a, b);
    const Index c = opposite(s, a, b), d = opposite(t, a, b), n = node_count();
    const std::vector<Index> gone{s, t};
    const Before before{facet_normals(gone)};
    x_.push_back(place), ring_.emplace_back();
    const std::vector<Nodes> made{{a, n, c}, {n, b, c}, {b, n, d}, {n, a, d}};
    const Index fs = facet(s), ft = facet(t);
    if (!allowed(made, gone, before, most_turn)) {
      x_.pop_back(), ring_.pop_back();
      return -1;
    }
    erase(s), erase(t);
    insert(made[0], fs), insert(made[1], fs), insert(made[2], ft), insert(made[3], ft);
    return n;
  }

  /// Node b is merged into node a, which moves to `place`.
  bool collapse(Index a, Index b, const Vec3& place) {
    auto na = neighbours(a), nb = neighbours(b);
    std::sort(na.begin(), na.end()), std::sort(nb.begin(), nb.end());
    std::vector<Index> common;
    std::set_intersection(na.begin(), na.end(), nb.begin(), nb.end(), std::back_inserter(common));
    const auto [s, t] = sides(a, b);
    if (common.size() != 2 || facet_size_[at(facet(s))] <= 4 || facet_size_[at(facet(t))] <= 4) return false;
    for (const Index c : common)
      if (ring_[at(c)].size() <= 3) return false;
    std::vector<Index> gone = ring_[at(a)];
    for (const Index f : ring_[at(b)])
      if (f != s && f != t) gone.push_back(f);
    std::vector<Nodes> made;
    std::vector<Index> facet_of_made;
    for (const Index f : gone) {
      if (f == s || f == t) continue;
      Nodes v = nodes(f);
      for (Index& n : v) n = n == b ? a : n;
      made.push_back(v), facet_of_made.push_back(facet(f));
    }
    const Vec3 from = x_[at(a)];
    const Before before{facet_normals(gone), a, from};
    x_[at(a)] = place;
    const bool good = allowed(made, gone, before, most_turn, facet_of_made);
    x_[at(a)] = from;
    if (!good) return false;
    for (const Index f : gone) erase(f);
    x_[at(a)] = place;
    for (std::size_t i = 0; i < made.size(); ++i) insert(made[i], facet_of_made[i]);
    return true;
  }

  /// Turns the edge ab of triangles abc and bad to cd.
  bool flip(Index a, Index b) {
    const auto [s, t] = sides(a, b);
    const Index c = opposite(s, a, b), d = opposite(t, a, b), f = facet(s);
    if (f != facet(t) || sides(c, d)[0] >= 0 || ring_[at(a)].size() <= 3 || ring_[at(b)].size() <= 3)
      return false;
    const std::vector<Index> gone{s, t};
    const std::vector<Nodes> made{{a, d, c}, {d, b, c}};
    if (!allowed(made, gone, {facet_normals(gone)}, flip_turn)) return false;
    erase(s), erase(t);
    insert(made[0], f), insert(made[1], f);
    return true;
  }

  /// The surface as it is now, nodes in their order; its regions are the facets.
  [[nodiscard]] mesh::Surface surface() const {
    mesh::Surface r;
    std::vector<Index> number(x_.size(), -1);
    Index count = 0, cells = 0;
    for (Index n = 0; n < node_count(); ++n)
      if (used(n)) number[at(n)] = count++;
    for (Index t = 0; t < triangle_count(); ++t) cells += alive(t);
    r.nodes.resize(3, count), r.cells.resize(3, cells);
    for (Index n = 0; n < node_count(); ++n)
      if (used(n)) r.nodes.col(number[at(n)]) = x(n);
    Index to = 0;
    for (Index t = 0; t < triangle_count(); ++t) {
      if (!alive(t)) continue;
      for (std::size_t k = 0; k < 3; ++k) r.cells(static_cast<Index>(k), to) = number[at(nodes(t)[k])];
      r.region.push_back(facet(t));
      ++to;
    }
    return r;
  }

 private:
  // a triangle may turn from the mean normal of its facet about the edit by at most 75 degrees (cosine); a
  // flip, whose two triangles are nearly in one plane, by 45
  static constexpr double most_turn = 0.26, flip_turn = 0.7;

  [[nodiscard]] static std::size_t at(Index i) { return static_cast<std::size_t>(i); }

  struct FacetNormal {
    Index facet;
    Vec3 area;
  };

  /// The triangles that an edit replaces: the mean normals of their facets, and where a node that moves was.
  struct Before {
    std::vector<FacetNormal> normals;
    Index node = -1;
    Vec3 place{0, 0, 0};
  };

  [[nodiscard]] std::vector<FacetNormal> facet_normals(const std::vector<Index>& triangles) const {
    std::vector<FacetNormal> normals;
    for (const Index t : triangles) {
      std::size_t i = 0;
      while (i < normals.size() && normals[i].facet != facet(t)) ++i;
      if (i == normals.size()) normals.push_back({facet(t), Vec3::Zero()});
      normals[i].area += triangle(t).area_vector();
    }
    return normals;
  }

  /// The triangles `made` may take the place of those `gone`. made_facet: of each; empty: as those gone, in
  /// order (half of them each when there are more).
  [[nodiscard]] bool allowed(const std::vector<Nodes>& made, const std::vector<Index>& gone,
                             const Before& before, double least_cosine,
                             const std::vector<Index>& made_facet = {}) {
    for (std::size_t i = 0; i < made.size(); ++i) {
      const Index f = made_facet.empty() ? facet(gone[i * gone.size() / made.size()]) : made_facet[i];
      const auto n = std::find_if(before.normals.begin(), before.normals.end(),
                                  [&](const FacetNormal& p) { return p.facet == f; });
      const Vec3 a = triangle(made[i]).area_vector();
      if (!(a.dot(n->area) > least_cosine * a.norm() * n->area.norm())) {
        ++left_out_.folds;
        return false;
      }
    }
    const auto position = [&](Index n) { return x(n); };
    if (folds_more(made, gone, before)) {
      ++left_out_.folds;
      return false;
    }
    for (const Nodes& v : made)
      if (grid_.any(triangle(v).box(), [&](Index t) {
            return std::find(gone.begin(), gone.end(), t) == gone.end() && cross(v, nodes(t), position);
          })) {
        ++left_out_.crosses;
        return false;
      }
    return true;
  }

  [[nodiscard]] bool folds_more(const std::vector<Nodes>& made, const std::vector<Index>& gone,
                                const Before& before) const {
    const auto beyond = [&](Index a, Index b) {
      for (const Index t : ring_[at(a)])
        for (std::size_t k = 0; k < 3; ++k)
          if (nodes(t)[k] == a && nodes(t)[(k + 1) % 3] == b &&
              std::find(gone.begin(), gone.end(), t) == gone.end())
            return nodes(t);
      return Nodes{a, b, b};
    };
    const double fold = sharpest_fold(
        made, [&](Index n) { return x(n); }, beyond);
    if (fold <= sharp_) return false;
    std::vector<Nodes> old;
    for (const Index t : gone) old.push_back(nodes(t));
    return fold > sharpest_fold(
                      old, [&](Index n) { return n == before.node ? before.place : x(n); }, beyond);
  }

  void insert(const Nodes& v, Index facet) {
    const Index t = triangle_count();
    triangle_.push_back(v), facet_.push_back(facet);
    for (const Index n : v) ring_[at(n)].push_back(t);
    grid_.add(t, triangle(v).box());
    ++facet_size_[at(facet)];
  }

  void erase(Index t) {
    grid_.remove(t);
    for (const Index n : nodes(t)) {
      auto& r = ring_[at(n)];
      r.erase(std::find(r.begin(), r.end(), t));
    }
    --facet_size_[at(facet(t))];
    facet_[at(t)] = -1;
  }

  std::vector<Vec3> x_;
  std::vector<Nodes> triangle_;
  std::vector<Index> facet_;  // -1: erased
  std::vector<std::vector<Index>> ring_;
  TriangleGrid grid_;
  std::vector<Index> facet_size_;
  double sharp_;
  LeftOut left_out_;
};

}  // namespace tunica::meshing
