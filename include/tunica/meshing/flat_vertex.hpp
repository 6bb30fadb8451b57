// SPDX-License-Identifier: MIT
// The vertex of a cell in which the surface has a flat part: it lies in that plane exactly, in its cell, and
// where the error of the other crossings is least there, so that rims are sharp.
#pragma once

#include "tunica/core/vec.hpp"
#include "tunica/meshing/hermite.hpp"
#include "tunica/meshing/least_error.hpp"
#include "tunica/meshing/qef.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

namespace tunica::meshing::detail {

/// Nodes nearer to a plane than this share of the grid's spacing lie on it, for rounding not to tell.
inline constexpr double on_plane = 1e-9;

/// n . (x - point), 0 on the plane; spacing: of the grid [length].
[[nodiscard]] inline double plane_distance(const HermiteRegion& plane, const Vec3& x, double spacing) {
  const double d = vec::dot(plane.normal, vec::minus(x, plane.point));
  return std::abs(d) <= on_plane * spacing ? 0 : d;
}

/// A cell from its low corner: its sides; a cell of the layer around the grid is as thin as the border.
struct FlatCell {
  Vec3 corner;  // in the image
  Box box;      // relative to it
  double spacing;

  [[nodiscard]] bool thin(int axis) const { return !(box.lo[axis] < box.hi[axis]); }
};

/// A point in the plane and in the cell (not on its sides, unless the plane only touches it there): the mean
/// of the places where the plane meets the edges of the cell.
[[nodiscard]] inline Vec3 inside_section(const FlatCell& cell, const HermiteRegion& plane,
                                         const Vec3& other) {
  Vec3 sum(0, 0, 0);
  int count = 0;
  const auto corner = [&](int c) {
    return Vec3((c & 1) != 0 ? cell.box.hi[0] : cell.box.lo[0],
                (c & 2) != 0 ? cell.box.hi[1] : cell.box.lo[1],
                (c & 4) != 0 ? cell.box.hi[2] : cell.box.lo[2]);
  };
  for (int a = 0; a < 3; ++a) {
    if (cell.thin(a)) continue;
    for (int c = 0; c < 8; ++c) {
      if ((c >> a & 1) != 0) continue;
      const Vec3 p = corner(c), q = corner(c | 1 << a);
      const double d = plane_distance(plane, vec::plus(cell.corner, p), cell.spacing),
                   e = plane_distance(plane, vec::plus(cell.corner, q), cell.spacing);
      if ((d < 0) == (e < 0)) continue;
      sum = vec::plus(sum, vec::between(p, q, d / (d - e)));
      ++count;
    }
  }
  return count > 0 ? vec::divided(sum, count) : other;
}

/// From a point of the box towards another, no farther than the box; what lies outside of it is not left.
[[nodiscard]] inline Vec3 within(const Box& box, const Vec3& from, const Vec3& to) {
  double t = 1;
  for (int a = 0; a < 3; ++a) {
    const double step = to[a] - from[a];
    const double bound = step > 0 ? std::max(box.hi[a], from[a]) : std::min(box.lo[a], from[a]);
    if (step != 0) t = std::min(t, std::max(0.0, (bound - from[a]) / step));
  }
  return vec::between(from, to, t);
}

/// Relative to the low corner of the cell. planes: those that cut the crossings of this vertex; it keeps the
/// share `hold` of the cell from the cell's sides if the plane allows.
[[nodiscard]] inline Vec3 flat_vertex(const PlaneSums& sums, std::span<const HermiteRegion* const> planes,
                                      const FlatCell& cell, double hold, const LeastErrorOptions& options) {
  Box box = cell.box;
  int thin = -1, count = 0;
  for (int a = 0; a < 3; ++a) {
    const double margin = hold * (box.hi[a] - box.lo[a]);
    box.lo[a] += margin, box.hi[a] -= margin;
    if (cell.thin(a)) thin = a, ++count;
  }
  if (planes.empty()) return least_error_held(sums, box, options);
  if (planes.size() > 1 || count > 1) {  // an edge or a corner of flat parts
    Qef meeting;
    for (const HermiteRegion* p : planes) meeting.add(vec::minus(p->point, cell.corner), p->normal);
    for (int a = 0; a < 3; ++a)
      if (cell.thin(a)) meeting.add(box.lo, Vec3(a == 0, a == 1, a == 2));
    constexpr double parallel = 1e-6;
    Vec3 x = meeting.minimum(least_error_held(sums, box, options), {.cut = parallel}).position;
    for (int a = 0; a < 3; ++a)
      if (cell.thin(a)) x[a] = box.lo[a];
    return x;
  }
  const Vec3& n = planes[0]->normal;
  Vec3 mass = sums.mass_point();
  const Vec3 anchor = inside_section(cell, *planes[0], mass);
  Vec3 u = vec::orthogonal(n), w = vec::cross(n, u);
  if (count == 1) {  // along the line in which the border is cut
    u = vec::unit(vec::cross(n, Vec3(thin == 0, thin == 1, thin == 2)));
    w = Vec3(0, 0, 0);
  }
  const Vec3 off = vec::minus(mass, anchor);
  const Vec3 start = vec::along(vec::along(anchor, vec::dot(u, off), u), vec::dot(w, off), w);
  const Vec3 r = sums.descent(start), au = sums.applied(u), aw = sums.applied(w);
  const Vec3 values = SymmetricEigen(sums.matrix()).values;
  const auto step =
      least_step(vec::dot(u, au), vec::dot(w, aw), vec::dot(u, aw), vec::dot(u, r), vec::dot(w, r),
                 options.cut * std::max({0.0, values[0], values[1], values[2]}));
  return within(box, anchor, vec::along(vec::along(start, step[0], u), step[1], w));
}

}  // namespace tunica::meshing::detail
