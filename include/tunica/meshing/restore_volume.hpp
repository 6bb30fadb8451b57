// SPDX-License-Identifier: MIT
// One small offset of the curved regions that gives a closed surface a volume; flat regions stay in their
// planes.
#pragma once

#include "tunica/meshing/flat_regions.hpp"
#include "tunica/meshing/intersections.hpp"
#include "tunica/meshing/keep_volume.hpp"

#include <cstddef>
#include <vector>

namespace tunica::meshing {

/// Offsets by at most `reach`, each node by its share of that (all the same without shares); false, and
/// nothing is changed, when that does not suffice or the surface would cross itself.
inline bool restore_volume(mesh::Surface& s, double volume, double reach,
                           const std::vector<double>& share = {}) {
  const auto planes = flat_regions(s);
  const Bonds bound = bonds(s, planes);
  Points<3> direction = Points<3>::Zero(3, s.node_count());
  for (Index t = 0; t < s.cell_count(); ++t) {
    if (planes[static_cast<std::size_t>(s.region_of(t))]) continue;
    const Vec3 a = mesh::triangle(s, t).area_vector();
    for (int k = 0; k < 3; ++k) direction.col(s.cells(k, t)) += a;
  }
  for (Index n = 0; n < s.node_count(); ++n) {
    Vec3 d = direction.col(n);
    if (bound.of(n) == Bond::rim) {
      const Vec3& m = planes[static_cast<std::size_t>(bound.region[static_cast<std::size_t>(n)])]->normal;
      d -= m.dot(d) * m;
    }
    const double l = bound.of(n) == Bond::none || bound.of(n) == Bond::rim ? d.norm() : 0;
    direction.col(n) = l > 0 ? (d / l).eval() : Vec3::Zero().eval();
    if (!share.empty()) direction.col(n) *= share[static_cast<std::size_t>(n)];
  }
  const std::vector<Index> one_part(static_cast<std::size_t>(s.cell_count()), 0);
  const Vec3 origin = mesh::bounding_box(s.nodes).centre();
  const auto cubic = volume_cubics(s.cells, s.nodes, direction, one_part, 1, origin).front();
  const double d = cubic.offset(6 * volume, reach);
  const Points<3> before = s.nodes;
  s.nodes += d * direction;
  if (d != 0 && self_intersections(s, 1).empty()) return true;
  s.nodes = before;
  return cubic.c[0] == 6 * volume;
}

}  // namespace tunica::meshing
