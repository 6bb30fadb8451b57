// SPDX-License-Identifier: MIT
// Whether two triangles of a surface cross: signs of orient3d and orient2d alone decide.
#pragma once

#include "tunica/core/types.hpp"
#include "tunica/mesh/triangle.hpp"
#include "tunica/meshing/predicates.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

namespace tunica::meshing {

namespace detail {

[[nodiscard]] constexpr int sign(double x) {
  return (x > 0) - (x < 0);
}

/// x without its component `axis`.
[[nodiscard]] inline std::array<double, 2> dropped(const Vec3& x, int axis) {
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
    for (int k = 0; k < 3; ++k)
      if (x[k] < std::min(a[k], b[k]) || x[k] > std::max(a[k], b[k])) return false;
    return true;
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
  const std::array<const Vec3*, 4> p{&a.a, &a.b, &a.c, &a.a}, q{&b.a, &b.b, &b.c, &b.a};
  for (std::size_t e = 0; e < 3; ++e)
    if (detail::meets(*p[e], *p[e + 1], b)) return true;
  for (std::size_t e = 0; e < 3; ++e)
    if (detail::meets(*q[e], *q[e + 1], a)) return true;
  return false;
}

}  // namespace tunica::meshing
