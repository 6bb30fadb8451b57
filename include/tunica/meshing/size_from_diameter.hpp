// SPDX-License-Identifier: MIT
// So many edges across each vessel: its local diameter, seen from each node of the surface by a cone of rays
// inward. [SHAPIRA08]
#pragma once

#include "tunica/core/parallel.hpp"
#include "tunica/meshing/flat_regions.hpp"
#include "tunica/meshing/graded_size.hpp"
#include "tunica/meshing/vertex_normals.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

namespace tunica::meshing {

/// Lengths in the unit of the surface.
struct DiameterSizeOptions {
  double edge = 0;          // longest edge
  double cells_across = 8;  // edges over the diameter
  double least = 0;         // shortest edge; 0: an eighth of the longest
  double growth = 0.25;     // of the edge per length, along the surface and away from it
};

namespace detail {

/// Directions about the z axis: rings of rays up to 50 degrees from it.
[[nodiscard]] inline std::vector<Vec3> ray_cone() {
  constexpr std::array<double, 3> angles{17, 34, 50};  // [degrees]
  constexpr std::array<int, 3> rays{6, 8, 10};
  std::vector<Vec3> cone{{0, 0, 1}};
  for (std::size_t ring = 0; ring < angles.size(); ++ring)
    for (int k = 0; k < rays[ring]; ++k) {
      const double a = angles[ring] * std::numbers::pi / 180;
      const double turn = 2 * std::numbers::pi * (k + 0.5 * static_cast<double>(ring)) / rays[ring];
      cone.push_back({std::sin(a) * std::cos(turn), std::sin(a) * std::sin(turn), std::cos(a)});
    }
  return cone;
}

/// What rays are shot from and at: the curved regions, or all where all is flat. Rays through the flat ends
/// of a vessel would say where it was cut.
struct CurvedPart {
  std::vector<Vec3> normal;  // mean normal at each node, by angle; zero inside flat ends
  TriangleTree tree;
};

[[nodiscard]] inline CurvedPart curved_part(const mesh::Surface& s) {
  const auto planes = flat_regions(s);
  CurvedPart part{std::vector<Vec3>(static_cast<std::size_t>(s.node_count()), Vec3(0, 0, 0)), {}};
  bool all_flat = true;
  for (Index t = 0; t < s.cell_count(); ++t)
    all_flat = all_flat && planes[static_cast<std::size_t>(s.region_of(t))];
  std::vector<ValuedTriangle> items;
  for (Index t = 0; t < s.cell_count(); ++t) {
    if (!all_flat && planes[static_cast<std::size_t>(s.region_of(t))]) continue;
    const mesh::Triangle f = mesh::triangle(s, t);
    items.push_back({f, {}});
    const std::array<double, 3> angle{corner_angle(f.a, f.b, f.c), corner_angle(f.b, f.c, f.a),
                                      corner_angle(f.c, f.a, f.b)};
    for (std::size_t k = 0; k < 3; ++k) {
      Vec3& sum = part.normal[static_cast<std::size_t>(s.cells(static_cast<Eigen::Index>(k), t))];
      sum = vec::along(sum, angle[k], vec::unit(f.area_vector()));
    }
  }
  for (Vec3& n : part.normal) n = vec::unit(n);
  part.tree = TriangleTree(std::move(items));
  return part;
}

/// Nodes without a value take the mean of their neighbours that have one, from ring to ring; those with one
/// take the median of their neighbours and themselves, `sweeps` times.
inline void spread_and_smooth(const mesh::Surface& s, std::vector<double>& value, int sweeps) {
  const mesh::Rows next = mesh::neighbours_of_nodes(s.cells, s.node_count());
  const auto known = [&](Index n) { return std::isfinite(value[static_cast<std::size_t>(n)]); };
  std::vector<double> now = value, around;
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    for (Index n = 0; n < s.node_count(); ++n) {
      if (!known(n)) continue;
      around.assign(1, value[static_cast<std::size_t>(n)]);
      for (const Index m : next[n])
        if (known(m)) around.push_back(value[static_cast<std::size_t>(m)]);
      const auto middle = around.begin() + static_cast<std::ptrdiff_t>(around.size() / 2);
      std::nth_element(around.begin(), middle, around.end());
      now[static_cast<std::size_t>(n)] = *middle;
    }
    value = now;
  }
  for (bool changed = true; changed;) {
    changed = false;
    now = value;
    for (Index n = 0; n < s.node_count(); ++n) {
      if (known(n)) continue;
      double sum = 0;
      int count = 0;
      for (const Index m : next[n])
        if (known(m)) sum += value[static_cast<std::size_t>(m)], ++count;
      if (count > 0) now[static_cast<std::size_t>(n)] = sum / count, changed = true;
    }
    value = now;
  }
}

}  // namespace detail

/// Local diameter at each node of a closed surface: of the spheres that touch the surface at the node and
/// pass through where a ray of a cone of 50 degrees inward leaves, the lower eighth of their diameters. It is
/// exact for a sphere, and for a tube within a few hundredths; nodes of flat ends have the diameter at their
/// rim. Infinite where hardly a ray leaves.
[[nodiscard]] inline std::vector<double> local_diameters(const mesh::Surface& s) {
  constexpr double quantile = 0.12;  // rays along a vessel or into a branch are long, few short by chance
  constexpr std::size_t least_rays = 8;
  constexpr int sweeps = 3;
  constexpr double skin = 1e-3;  // of the mean edge: hits nearer than that are of the surface at the node
  const double from = skin * std::sqrt(mesh::area(s) / std::max<Index>(1, s.cell_count()));
  const auto [normals, tree] = detail::curved_part(s);
  const auto cone = detail::ray_cone();
  std::vector<double> diameter(normals.size(), std::numeric_limits<double>::infinity());
  constexpr std::ptrdiff_t chunk = 256;
  parallel_chunks(s.node_count(), chunk, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    std::vector<double> seen;
    for (auto n = static_cast<Index>(begin); n < static_cast<Index>(end); ++n) {
      const Vec3 axis = vec::scaled(-1, normals[static_cast<std::size_t>(n)]);
      if (!(vec::squared(axis) > 0)) continue;
      const Vec3 u = vec::orthogonal(axis), v = vec::cross(axis, u), x = mesh::node(s, n);
      seen.clear();
      for (const Vec3& c : cone) {
        const Vec3 direction = vec::along(vec::along(vec::scaled(c[2], axis), c[0], u), c[1], v);
        const double length = tree.exit(x, direction, from);
        if (std::isfinite(length)) seen.push_back(length / c[2]);  // |x - y|^2 = d n.(x - y)
      }
      if (seen.size() < least_rays) continue;
      const auto at = seen.begin() + static_cast<std::ptrdiff_t>(quantile * static_cast<double>(seen.size()));
      std::nth_element(seen.begin(), at, seen.end());
      diameter[static_cast<std::size_t>(n)] = *at;
    }
  });
  detail::spread_and_smooth(s, diameter, sweeps);
  return diameter;
}

/// h = diameter / cells_across between `least` and `edge`, for a closed surface; then graded.
[[nodiscard]] inline GradedSize size_from_diameter(const mesh::Surface& s,
                                                   const DiameterSizeOptions& options) {
  TUNICA_EXPECT(options.edge > 0 && options.cells_across > 0,
                "the longest edge and the number of cells across are positive");
  constexpr double least_share = 1.0 / 8;
  const double least = std::min(options.least > 0 ? options.least : least_share * options.edge, options.edge);
  std::vector<double> size;
  for (const double d : local_diameters(s))
    size.push_back(std::clamp(d / options.cells_across, least, options.edge));
  return graded_size(s, std::move(size), options.growth, options.edge, [](Index) { return true; });
}

}  // namespace tunica::meshing
