// SPDX-License-Identifier: MIT
// Levels a contour with its field: the vertices of dual contouring lie where planes meet, outside of a convex
// surface, its faces cut corners. Offsets bring each face to the iso-value on the average.
#pragma once

#include "tunica/core/expect.hpp"
#include "tunica/meshing/flat_regions.hpp"
#include "tunica/meshing/scalar_field.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace tunica::meshing {

struct LevelOptions {
  double reach = 0;  // no node moves farther than this, in the unit of the surface
  int passes = 4;
};

namespace detail {

/// How far outside of x, along the unit vector n, the field falls to iso; to first order, within the reach.
template <ScalarField F>
[[nodiscard]] double rise_to_iso(const F& field, double iso, const Vec3& x, const Vec3& n, double reach) {
  const Vec3 gradient = field_gradient(field, x, 1e-4 * reach);
  const double above = field_value(field, x) - iso;
  // where the surface is not the field's own (a mask parts it) the field does not fall along n
  const double slope = std::max(-vec::dot(gradient, n), 0.5 * vec::length(gradient));
  const double d = slope > 0 ? above / slope : 0;
  return std::isfinite(d) ? std::clamp(d, -reach, reach) : 0;
}

}  // namespace detail

/// Offsets the nodes of a closed surface along its normals so that its curved regions lie at {field = iso} on
/// the average over each triangle, which the middles of the edges give exactly for a quadratic. Flat regions
/// and their rims stay in their planes. Inside is field >= iso.
template <ScalarField F>
void level(mesh::Surface& s, const F& field, double iso, const LevelOptions& options) {
  TUNICA_EXPECT(options.reach > 0, "nodes may move by a positive length");
  const auto planes = flat_regions(s);
  const Bonds bound = bonds(s, planes);
  const auto count = static_cast<std::size_t>(s.node_count());
  const Points<3> start = s.nodes;
  for (int pass = 0; pass < options.passes; ++pass) {
    std::vector<double> weight(count, 0), rise(count, 0);
    std::vector<Vec3> normal(count, Vec3(0, 0, 0));
    for (Index t = 0; t < s.cell_count(); ++t) {
      if (planes[static_cast<std::size_t>(s.region_of(t))]) continue;
      const mesh::Triangle f = mesh::triangle(s, t);
      const Vec3 area = f.area_vector(), n = vec::unit(area);
      const double a = vec::length(area);
      double mean = 0;
      for (const auto& [p, q] : {std::array{&f.a, &f.b}, std::array{&f.b, &f.c}, std::array{&f.c, &f.a}})
        mean += detail::rise_to_iso(field, iso, vec::between(*p, *q, 0.5), n, options.reach) / 3;
      for (int k = 0; k < 3; ++k) {
        const auto i = static_cast<std::size_t>(s.cells(k, t));
        weight[i] += a, rise[i] += a * mean, normal[i] = vec::plus(normal[i], area);
      }
    }
    for (Index n = 0; n < s.node_count(); ++n) {
      const auto i = static_cast<std::size_t>(n);
      if (!(weight[i] > 0) || bound.of(n) == Bond::corner || bound.of(n) == Bond::plane) continue;
      Vec3 along = normal[i];
      if (bound.of(n) == Bond::rim) {
        const Vec3& m = planes[static_cast<std::size_t>(bound.region[i])]->normal;
        along = vec::along(along, -vec::dot(m, along), m);
      }
      const Vec3 from = vec::column(start, n);
      Vec3 move =
          vec::minus(vec::along(vec::column(s.nodes, n), rise[i] / weight[i], vec::unit(along)), from);
      if (const double l = vec::length(move); l > options.reach) move = vec::scaled(options.reach / l, move);
      vec::set_column(s.nodes, n, vec::plus(from, move));
    }
  }
}

}  // namespace tunica::meshing
