// SPDX-License-Identifier: MIT
// Do two triangles of a surface meet elsewhere than in the nodes that they share? By exact signs.
#pragma once

#include "tunica/core/types.hpp"
#include "tunica/meshing/predicates.hpp"

#include <Eigen/Geometry>

#include <array>
#include <cstddef>

namespace tunica::meshing {

using Corners = std::array<Vec3, 3>;

namespace detail {

/// The two coordinates that are left when the largest of the normal is dropped.
[[nodiscard]] inline std::array<Eigen::Index, 2> flat_axes(const Vec3& normal) {
  Eigen::Index drop = 0;
  normal.cwiseAbs().maxCoeff(&drop);
  return {(drop + 1) % 3, (drop + 2) % 3};
}

[[nodiscard]] inline int sign(double x) {
  return (x > 0) - (x < 0);
}

/// Does the closed segment (p, q) meet the closed triangle b that lies in the same plane?
[[nodiscard]] inline bool segment_meets_flat(const Vec3& p, const Vec3& q, const Corners& b) {
  const auto axes = flat_axes((b[1] - b[0]).cross(b[2] - b[0]));
  const auto flat = [&](const Vec3& x) { return Point<2>(x[axes[0]], x[axes[1]]); };
  const Point<2> s = flat(p), t = flat(q);
  const std::array<Point<2>, 3> c{flat(b[0]), flat(b[1]), flat(b[2])};
  const int turn = sign(orient2d(c[0], c[1], c[2]));
  for (const auto& x : {s, t}) {
    int inside = 0;
    for (std::size_t i = 0; i < 3; ++i) inside += turn * sign(orient2d(c[i], c[(i + 1) % 3], x)) >= 0;
    if (inside == 3) return true;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const Point<2>&u = c[i], &v = c[(i + 1) % 3];
    if (sign(orient2d(s, t, u)) * sign(orient2d(s, t, v)) <= 0 &&
        sign(orient2d(u, v, s)) * sign(orient2d(u, v, t)) < 0)
      return true;
  }
  return false;
}

}  // namespace detail

/// Does the closed segment (p, q) meet the closed triangle b?
[[nodiscard]] inline bool segment_meets(const Vec3& p, const Vec3& q, const Corners& b) {
  const int sp = detail::sign(orient3d(b[0], b[1], b[2], p)),
            sq = detail::sign(orient3d(b[0], b[1], b[2], q));
  if (sp == 0 && sq == 0) return detail::segment_meets_flat(p, q, b);
  if (sp == sq) return false;
  int positive = 0, negative = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double s = orient3d(p, q, b[i], b[(i + 1) % 3]);
    positive += s > 0, negative += s < 0;
  }
  return positive == 0 || negative == 0;
}

/// Nodes i of a and j of b with equal numbers are shared: there, and along a shared edge, the
/// triangles may touch.
[[nodiscard]] inline bool triangles_cross(const std::array<Index, 3>& a, const Corners& pa,
                                          const std::array<Index, 3>& b, const Corners& pb) {
  std::array<bool, 3> in_b{}, in_a{};
  int shared = 0;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      if (a[i] == b[j]) in_b[i] = in_a[j] = true, ++shared;
  if (shared == 3) return true;
  const auto apex = [](const std::array<bool, 3>& in, bool wanted) {
    std::size_t i = 0;
    while (in[i] != wanted) ++i;
    return i;
  };
  if (shared == 2) {  // they cross only when one is folded onto the other
    const std::size_t i = apex(in_b, false), j = apex(in_a, false);
    if (orient3d(pa[0], pa[1], pa[2], pb[j]) != 0) return false;
    const auto axes = detail::flat_axes((pa[1] - pa[0]).cross(pa[2] - pa[0]));
    const auto flat = [&](const Vec3& x) { return Point<2>(x[axes[0]], x[axes[1]]); };
    const Point<2> u = flat(pa[(i + 1) % 3]), v = flat(pa[(i + 2) % 3]);
    return detail::sign(orient2d(u, v, flat(pa[i]))) == detail::sign(orient2d(u, v, flat(pb[j])));
  }
  if (shared == 1) {
    const std::size_t i = apex(in_b, true), j = apex(in_a, true);
    return segment_meets(pa[(i + 1) % 3], pa[(i + 2) % 3], pb) ||
           segment_meets(pb[(j + 1) % 3], pb[(j + 2) % 3], pa);
  }
  for (std::size_t i = 0; i < 3; ++i)
    if (segment_meets(pa[i], pa[(i + 1) % 3], pb) || segment_meets(pb[i], pb[(i + 1) % 3], pa)) return true;
  return false;
}

}  // namespace tunica::meshing
