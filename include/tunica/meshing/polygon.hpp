// SPDX-License-Identifier: MIT
// Triangulation of a plane polygon with holes that uses its corners alone: bridges to the holes, ears in the
// order of their shape, then flips that raise the smallest angle. Signs are those of orient2d.
#pragma once

#include "tunica/core/error.hpp"
#include "tunica/meshing/predicates.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace tunica::meshing {

using Corners = std::vector<Index>;  // numbers of points, in the order of a closed walk

namespace detail {

class PolygonFill {
 public:
  explicit PolygonFill(const Points<2>& x) : x_(x) {}

  /// Outer loops counter-clockwise, holes clockwise, in any order.
  [[nodiscard]] std::vector<std::array<Index, 3>> run(const std::vector<Corners>& loops) {
    std::vector<Corners> outers, holes;
    double wanted = 0;
    for (const Corners& l : loops) {
      const double a = area(l);
      wanted += a;
      (a > 0 ? outers : holes).push_back(l);
    }
    // a hole belongs to the smallest outer loop that holds it
    std::sort(outers.begin(), outers.end(),
              [&](const Corners& p, const Corners& q) { return area(p) < area(q); });
    std::vector<std::vector<Corners>> inner(outers.size());
    for (Corners& h : holes) {
      std::size_t o = 0;
      while (o < outers.size() && !holds(outers[o], at(h.front()))) ++o;
      if (o == outers.size()) throw MeshError("a hole of a section lies in no part of it");
      inner[o].push_back(std::move(h));
    }
    for (std::size_t o = 0; o < outers.size(); ++o)
      clip_ears(bridged(std::move(outers[o]), std::move(inner[o])));
    improve(loops);
    double got = 0;
    for (const auto& t : triangles_) got += 0.5 * std::abs(orient2d(at(t[0]), at(t[1]), at(t[2])));
    if (!(std::abs(got - wanted) <= 1e-9 * std::abs(wanted)))
      throw MeshError("a section is no simple polygon");
    return std::move(triangles_);
  }

 private:
  [[nodiscard]] Point<2> at(Index n) const { return {x_(0, n), x_(1, n)}; }
  [[nodiscard]] double dot(Index o, Index a, Index b) const {  // (a - o) . (b - o)
    return (x_(0, a) - x_(0, o)) * (x_(0, b) - x_(0, o)) + (x_(1, a) - x_(1, o)) * (x_(1, b) - x_(1, o));
  }
  [[nodiscard]] double squared(Index a, Index b) const { return dot(a, b, b); }
  [[nodiscard]] double turn(Index a, Index b, Index c) const { return orient2d(at(a), at(b), at(c)); }

  [[nodiscard]] double area(const Corners& l) const {
    double sum = 0;
    const Point<2> o = at(l.front());
    for (std::size_t i = 0; i < l.size(); ++i) {
      const Point<2> p = at(l[i]), q = at(l[(i + 1) % l.size()]);
      sum += 0.5 * ((p[0] - o[0]) * (q[1] - o[1]) - (p[1] - o[1]) * (q[0] - o[0]));
    }
    return sum;
  }

  [[nodiscard]] bool holds(const Corners& l, const Point<2>& p) const {
    bool inside = false;
    for (std::size_t i = 0; i < l.size(); ++i) {
      const Point<2> a = at(l[i]), b = at(l[(i + 1) % l.size()]);
      if ((a[1] > p[1]) != (b[1] > p[1])) inside ^= (orient2d(a, b, p) > 0) == (b[1] > a[1]);
    }
    return inside;
  }

  /// The segment between two corners meets no side of the loop other than at those corners.
  [[nodiscard]] bool visible(Index a, Index b, const Corners& l) const {
    for (std::size_t i = 0; i < l.size(); ++i) {
      const Index p = l[i], q = l[(i + 1) % l.size()];
      if (p == a || p == b || q == a || q == b) {
        for (const Index r : {p, q})
          if (r != a && r != b && turn(a, b, r) == 0 && dot(r, a, b) < 0) return false;
        continue;
      }
      if (turn(a, b, p) * turn(a, b, q) <= 0 && turn(p, q, a) * turn(p, q, b) <= 0) return false;
    }
    return true;
  }

  /// One walk round the outer loop and its holes: each hole is joined by the shortest visible bridge.
  [[nodiscard]] Corners bridged(Corners outer, std::vector<Corners> holes) const {
    while (!holes.empty()) {
      struct Bridge {
        double squared = std::numeric_limits<double>::infinity();
        std::size_t hole = 0, from = 0, to = 0;
      } best;
      for (std::size_t h = 0; h < holes.size(); ++h)
        for (std::size_t i = 0; i < holes[h].size(); ++i)
          for (std::size_t j = 0; j < outer.size(); ++j) {
            const double d = squared(holes[h][i], outer[j]);
            if (d >= best.squared || !visible(holes[h][i], outer[j], outer)) continue;
            bool clear = true;
            for (const Corners& other : holes) clear = clear && visible(holes[h][i], outer[j], other);
            if (clear) best = {d, h, i, j};
          }
      if (!(best.squared < std::numeric_limits<double>::infinity()))
        throw MeshError("a section is no simple polygon");
      Corners& hole = holes[best.hole];
      std::rotate(hole.begin(), hole.begin() + static_cast<std::ptrdiff_t>(best.from), hole.end());
      hole.push_back(hole.front());
      hole.push_back(outer[best.to]);
      outer.insert(outer.begin() + static_cast<std::ptrdiff_t>(best.to) + 1, hole.begin(), hole.end());
      holes.erase(holes.begin() + static_cast<std::ptrdiff_t>(best.hole));
    }
    return outer;
  }

  /// Squared sine, as a measure, of the smallest angle of a triangle: 4 area^2 over its two longest squared
  /// sides.
  [[nodiscard]] double shape(Index a, Index b, Index c) const {
    const double area = turn(a, b, c);
    std::array<double, 3> l{squared(a, b), squared(b, c), squared(c, a)};
    std::sort(l.begin(), l.end());
    return area <= 0 || l[1] == 0 ? 0 : area * area / (l[1] * l[2]);
  }

  [[nodiscard]] bool is_ear(const Corners& l, std::size_t i) const {
    const Index a = l[(i + l.size() - 1) % l.size()], b = l[i], c = l[(i + 1) % l.size()];
    if (turn(a, b, c) <= 0) return false;
    for (const Index p : l)
      if (p != a && p != b && p != c && turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0)
        return false;
    return true;
  }

  void clip_ears(Corners l) {
    while (l.size() > 3) {
      std::vector<std::pair<double, std::size_t>> order;
      for (std::size_t i = 0; i < l.size(); ++i)
        order.emplace_back(-shape(l[(i + l.size() - 1) % l.size()], l[i], l[(i + 1) % l.size()]), i);
      std::sort(order.begin(), order.end());
      const auto ear =
          std::find_if(order.begin(), order.end(), [&](const auto& o) { return is_ear(l, o.second); });
      if (ear == order.end()) throw MeshError("a section is no simple polygon");
      const std::size_t i = ear->second;
      triangles_.push_back({l[(i + l.size() - 1) % l.size()], l[i], l[(i + 1) % l.size()]});
      l.erase(l.begin() + static_cast<std::ptrdiff_t>(i));
    }
    if (turn(l[0], l[1], l[2]) <= 0) throw MeshError("a section is no simple polygon");
    triangles_.push_back({l[0], l[1], l[2]});
  }

  /// Flips inner edges while the smaller of the two worst angles rises.
  void improve(const std::vector<Corners>& loops) {
    std::vector<std::pair<Index, Index>> rim;
    for (const Corners& l : loops)
      for (std::size_t i = 0; i < l.size(); ++i) rim.emplace_back(l[i], l[(i + 1) % l.size()]);
    std::sort(rim.begin(), rim.end());
    const auto on_rim = [&](Index a, Index b) {
      return std::binary_search(rim.begin(), rim.end(), std::pair(a, b));
    };
    bool changed = true;
    for (std::size_t pass = 0; changed && pass < triangles_.size(); ++pass) {
      changed = false;
      std::vector<std::array<Index, 4>> edges;  // (low, high, triangle, corner)
      for (std::size_t t = 0; t < triangles_.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k) {
          const Index a = triangles_[t][k], b = triangles_[t][(k + 1) % 3];
          if (!on_rim(a, b))
            edges.push_back({std::min(a, b), std::max(a, b), static_cast<Index>(t), static_cast<Index>(k)});
        }
      std::sort(edges.begin(), edges.end());
      std::vector<char> used(triangles_.size(), 0);
      for (std::size_t e = 0; e + 1 < edges.size(); ++e) {
        if (edges[e][0] != edges[e + 1][0] || edges[e][1] != edges[e + 1][1]) continue;
        const auto t = static_cast<std::size_t>(edges[e][2]), u = static_cast<std::size_t>(edges[e + 1][2]);
        if (used[t] || used[u]) continue;
        const auto k = static_cast<std::size_t>(edges[e][3]), m = static_cast<std::size_t>(edges[e + 1][3]);
        const Index a = triangles_[t][k], b = triangles_[t][(k + 1) % 3];
        const Index c = triangles_[t][(k + 2) % 3], d = triangles_[u][(m + 2) % 3];
        const double before = std::min(shape(a, b, c), shape(b, a, d));
        const double after = std::min(shape(a, d, c), shape(d, b, c));
        if (!(after > before * (1 + 1e-9)) || turn(a, d, c) <= 0 || turn(d, b, c) <= 0) continue;
        triangles_[t] = {a, d, c}, triangles_[u] = {d, b, c};
        used[t] = used[u] = 1;
        changed = true;
      }
    }
  }

  const Points<2>& x_;
  std::vector<std::array<Index, 3>> triangles_;
};

}  // namespace detail

/// Triangles, counter-clockwise, of the polygon that the loops bound: outer loops counter-clockwise, holes
/// clockwise; a loop may have flat corners. MeshError if it is no simple polygon. O(n^2 log n).
[[nodiscard]] inline std::vector<std::array<Index, 3>> triangulate(const Points<2>& x,
                                                                   const std::vector<Corners>& loops) {
  return detail::PolygonFill(x).run(loops);
}

}  // namespace tunica::meshing
