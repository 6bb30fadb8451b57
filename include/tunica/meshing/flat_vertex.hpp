// SPDX-License-Identifier: MIT
// The vertex of a cell in which the surface has a flat part: it lies in that plane exactly, in its cell, and
// where the error of the other crossings is least there, so that rims are sharp.
#pragma once

#include "tunica/core/vec.hpp"
#include "tunica/meshing/flat_section.hpp"
#include "tunica/meshing/hermite.hpp"
#include "tunica/meshing/least_error.hpp"
#include "tunica/meshing/qef.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

namespace tunica::meshing::detail {

/// The crossings of one vertex that lie in flat regions, relative to the low corner of its cell.
struct FlatCrossings {
  std::uint64_t regions = 0;  // a bit each
  Vec3 sum{0, 0, 0};
  int count = 0;
};

struct RimPoint {
  Vec3 place;
  bool smooth;  // the wall
};

/// From a point of the span to the least error of the wall's crossings in it. The start is level with their
/// mean on the wall, and the step is cut short where the wall is smooth, as in the cells beside.
[[nodiscard]] inline RimPoint least_error_in(const FlatSpan& span, const PlaneSums& sums, const Vec3& from,
                                             const LeastErrorOptions& options) {
  const SymmetricEigen eigen(sums.matrix());
  int most = 0;
  for (int i = 1; i < 3; ++i) most = eigen.values[i] > eigen.values[most] ? i : most;
  const Vec3 wall(eigen.vectors(0, most), eigen.vectors(1, most), eigen.vectors(2, most));
  const Vec3 mean = sums.mass_point();
  Vec3 x = vec::plus(from, span.part(vec::minus(mean, from)));
  constexpr double steep = 0.1;  // of the wall against the span, squared
  const Vec3 fall = span.part(wall);
  if (vec::squared(fall) > steep)
    x = vec::along(x, vec::dot(wall, vec::minus(mean, x)) / vec::squared(fall), fall);
  const Vec3 r = sums.descent(x), au = sums.applied(span.u), aw = sums.applied(span.w);
  const LeastStep step =
      least_step(vec::dot(span.u, au), vec::dot(span.w, aw), vec::dot(span.u, aw), vec::dot(span.u, r),
                 vec::dot(span.w, r), options.cut * eigen.values[most]);
  const double share = step.rank == 1 ? options.smooth : 1;
  return {vec::along(vec::along(x, share * step.x, span.u), share * step.y, span.w), step.rank == 1};
}

/// Rims of smooth walls are met so far outside of a cell, as a share of it: where one passes beside the cell,
/// its plane and its wall enter the cell at different places.
inline constexpr double rim_reach = 1, rim_share = 0.98;

[[nodiscard]] inline bool within(const Box& box, double reach, const Vec3& x) {
  for (int a = 0; a < 3; ++a) {
    const double beyond = reach * (box.hi[a] - box.lo[a]);
    if (!(x[a] >= box.lo[a] - beyond && x[a] <= box.hi[a] + beyond)) return false;
  }
  return true;
}

/// Relative to the low corner of the cell. sums: of the crossings with the wall; cuts: the planes of the
/// others that are no border. Where more planes meet than one and the border is not asked for the cell: they
/// are met wherever that is.
[[nodiscard]] inline Vec3 flat_vertex(const PlaneSums& sums, const FlatCrossings& flat,
                                      std::span<const HermiteRegion* const> cuts, const FlatCell& cell,
                                      double hold, const LeastErrorOptions& options) {
  const int walls = sums.count();
  const Vec3 mean = vec::divided(vec::plus(flat.sum, {sums.px, sums.py, sums.pz}), walls + flat.count);
  Qef meeting;
  std::array<Vec3, 3> normals;
  std::size_t planes = 0;
  const auto add = [&](const Vec3& point, const Vec3& normal) {
    if (planes < 3) normals[planes] = normal;
    meeting.add(point, normal), ++planes;
  };
  for (int a = 0; a < 3; ++a)
    if (cell.thin(a)) add(cell.box.lo, Vec3(a == 0, a == 1, a == 2));
  for (const HermiteRegion* p : cuts) add(vec::minus(p->point, cell.corner), p->normal);
  const FlatSpan span({normals.data(), std::min<std::size_t>(planes, 3)});
  const FlatSection section(cell, cuts, span);
  constexpr double parallel = 1e-6;
  const Vec3 from = section.empty() ? meeting.minimum(mean, {.cut = parallel}).position : section.middle();
  RimPoint rim{vec::plus(from, span.part(vec::minus(mean, from))), false};
  if (walls > 0 && planes < 3) rim = least_error_in(span, sums, from, options);
  Vec3 x = rim.place;
  const bool leaves = planes == 1 && cuts.size() == 1 && rim.smooth && within(cell.box, rim_reach, x);
  // not all of the way: neighbours with the same crossings have the same rim
  if (!section.empty()) x = vec::between(section.held(x, sums, hold), x, leaves ? rim_share : 0);
  for (int a = 0; a < 3; ++a)
    if (cell.thin(a)) x[a] = cell.box.lo[a];
  return x;
}

}  // namespace tunica::meshing::detail
