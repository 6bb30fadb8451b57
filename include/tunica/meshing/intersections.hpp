// SPDX-License-Identifier: MIT
// Exact test of a triangle surface for self-intersection: signs of orient3d and orient2d alone decide.
#pragma once

#include "tunica/core/error.hpp"
#include "tunica/core/text.hpp"
#include "tunica/mesh/measures.hpp"
#include "tunica/meshing/open_stars.hpp"
#include "tunica/meshing/predicates.hpp"
#include "tunica/search/octree.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace tunica::meshing {

namespace detail {

[[nodiscard]] constexpr int sign(double x) {
  return (x > 0) - (x < 0);
}

/// x without its component `axis`.
[[nodiscard]] inline Point<2> dropped(const Vec3& x, int axis) {
  return {x[(axis + 1) % 3], x[(axis + 2) % 3]};
}

/// Sign of (a, b, c) projected along an axis.
[[nodiscard]] inline int turn(const Vec3& a, const Vec3& b, const Vec3& c, int axis) {
  return sign(orient2d(dropped(a, axis), dropped(b, axis), dropped(c, axis)));
}

/// An axis along which the triangle keeps an area, -1 where it has none.
[[nodiscard]] inline int projection_axis(const mesh::Triangle& t) {
  for (int axis = 0; axis < 3; ++axis)
    if (turn(t.a, t.b, t.c, axis) != 0) return axis;
  return -1;
}

/// Segment pq and triangle in one plane, seen along an axis that keeps the triangle's area: any common point.
[[nodiscard]] inline bool meets_in_plane(const Vec3& p, const Vec3& q, const mesh::Triangle& t, int axis) {
  const int up = turn(t.a, t.b, t.c, axis);
  const std::array<const Vec3*, 4> v{&t.a, &t.b, &t.c, &t.a};
  for (const Vec3* x : {&p, &q}) {
    bool within = true;
    for (std::size_t e = 0; e < 3; ++e) within = within && turn(*v[e], *v[e + 1], *x, axis) * up >= 0;
    if (within) return true;
  }
  const auto between = [&](const Vec3& a, const Vec3& b, const Vec3& x) {  // x is on the line ab
    return (x.array() >= a.cwiseMin(b).array()).all() && (x.array() <= a.cwiseMax(b).array()).all();
  };
  for (std::size_t e = 0; e < 3; ++e) {
    const Vec3 &a = *v[e], &b = *v[e + 1];
    const int ap = turn(a, b, p, axis), aq = turn(a, b, q, axis), pa = turn(p, q, a, axis),
              pb = turn(p, q, b, axis);
    if (ap * aq < 0 && pa * pb < 0) return true;
    if (pa == 0 && between(p, q, a)) return true;
  }
  return false;
}

/// Segment pq and triangle (closed sets) have a common point.
[[nodiscard]] inline bool meets(const Vec3& p, const Vec3& q, const mesh::Triangle& t) {
  const int sp = sign(orient3d(t.a, t.b, t.c, p)), sq = sign(orient3d(t.a, t.b, t.c, q));
  if (sp * sq > 0) return false;
  if (sp == 0 && sq == 0) return meets_in_plane(p, q, t, projection_axis(t));
  const int ab = sign(orient3d(p, q, t.a, t.b)), bc = sign(orient3d(p, q, t.b, t.c));
  if (ab * bc < 0) return false;
  const int ca = sign(orient3d(p, q, t.c, t.a));
  return ab * ca >= 0 && bc * ca >= 0;
}

/// All of t lies strictly on one side of the plane of s.
[[nodiscard]] inline bool apart(const mesh::Triangle& s, const mesh::Triangle& t) {
  const int a = sign(orient3d(s.a, s.b, s.c, t.a));
  return a != 0 && a == sign(orient3d(s.a, s.b, s.c, t.b)) && a == sign(orient3d(s.a, s.b, s.c, t.c));
}

}  // namespace detail

/// Two triangles, given by the numbers of their nodes, have a common point that is no common node or edge.
/// position(n) is the place of node n; both have an area. The answer is exact.
template <class Position>
[[nodiscard]] bool cross(std::array<Index, 3> s, std::array<Index, 3> t, const Position& position) {
  std::size_t shared = 0;  // bring the common nodes to the front of both
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = shared; j < 3; ++j)
      if (s[i] == t[j]) {
        std::swap(s[i], s[shared]), std::swap(t[j], t[shared]);
        ++shared;
        break;
      }
  if (shared == 3) return true;
  const mesh::Triangle a{position(s[0]), position(s[1]), position(s[2])};
  const mesh::Triangle b{position(t[0]), position(t[1]), position(t[2])};
  if (shared == 2) {  // only folded flat onto each other
    if (orient3d(a.a, a.b, a.c, b.c) != 0) return false;
    const int axis = detail::projection_axis(a);
    return detail::turn(a.a, a.b, a.c, axis) == detail::turn(b.a, b.b, b.c, axis);
  }
  if (shared == 1) return detail::meets(a.b, a.c, b) || detail::meets(b.b, b.c, a);
  if (detail::apart(a, b) || detail::apart(b, a)) return false;
  for (const auto& [p, q] : {std::pair{&a.a, &a.b}, {&a.b, &a.c}, {&a.c, &a.a}})
    if (detail::meets(*p, *q, b)) return true;
  for (const auto& [p, q] : {std::pair{&b.a, &b.b}, {&b.b, &b.c}, {&b.c, &b.a}})
    if (detail::meets(*p, *q, a)) return true;
  return false;
}

/// Pairs (i < j) of triangles that cross or touch other than in a common node or edge, in ascending order; a
/// triangle without area is paired with itself. At most the first `limit` of them. Exact, O(n log n) on
/// surfaces.
[[nodiscard]] inline std::vector<std::pair<Index, Index>> self_intersections(
    const mesh::Surface& s, std::size_t limit = std::numeric_limits<std::size_t>::max()) {
  const auto stars = detail::open_stars(s);
  const auto count = static_cast<std::size_t>(s.cell_count());
  std::vector<std::pair<Index, Index>> pairs;
  std::vector<Box> boxes(count);
  std::vector<std::array<Index, 3>> settled(count);  // corners of open stars, other numbers for the others
  Index other = -1;
  for (std::size_t t = 0; t < count; ++t) {
    const auto cell = static_cast<Index>(t);
    const mesh::Triangle f = mesh::triangle(s, cell);
    const bool flat = stars.unknown[t] && detail::projection_axis(f) < 0;
    if (flat)
      pairs.emplace_back(cell, cell);
    else
      boxes[t] = f.box();
    for (int k = 0; k < 3; ++k) {
      const Index n = s.cells(k, cell);
      settled[t][static_cast<std::size_t>(k)] = stars.open[static_cast<std::size_t>(n)] ? n : other--;
    }
  }
  const auto position = [&](Index n) -> Vec3 { return s.nodes.col(n); };
  const auto nodes = [&](Index t) {
    return std::array<Index, 3>{s.cells(0, t), s.cells(1, t), s.cells(2, t)};
  };
  search::Octree(boxes).pairs([&](Index t, Index u) {
    bool apart = false;  // in the open star of a common corner
    for (const Index n : settled[static_cast<std::size_t>(t)])
      for (const Index m : settled[static_cast<std::size_t>(u)]) apart |= n == m;
    if (!apart && cross(nodes(t), nodes(u), position)) pairs.emplace_back(t, u);
  });
  std::sort(pairs.begin(), pairs.end());
  if (pairs.size() > limit) pairs.resize(limit);
  return pairs;
}

/// MeshError, with a place, where a surface crosses itself.
inline void require_no_crossing(const mesh::Surface& s) {
  const auto pairs = self_intersections(s, 1);
  if (pairs.empty()) return;
  const auto& [t, u] = pairs.front();
  throw MeshError("the surface crosses itself at " + place(mesh::triangle(s, t).centroid()) + ": triangles " +
                  std::to_string(t) + " and " + std::to_string(u));
}

}  // namespace tunica::meshing
