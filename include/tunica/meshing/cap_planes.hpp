// SPDX-License-Identifier: MIT
// The planes of the flat caps of a surface; coordinates of single precision will do.
#pragma once

#include "tunica/mesh/measures.hpp"
#include "tunica/mesh/mesh.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

namespace tunica::meshing {

/// A plane through a point with an outward unit normal.
struct CapPlane {
  Vec3 point, normal;
  double deviation = 0;  // largest distance of a node of the region from it [length]
};

[[nodiscard]] inline std::size_t region_count(const mesh::Surface& surface) {
  std::size_t count = std::max<std::size_t>(1, surface.region_names.size());
  for (const Index r : surface.region) count = std::max(count, static_cast<std::size_t>(r) + 1);
  return count;
}

/// One entry a region: empty where the region is curved, as region 0 (the wall) always is. A region
/// is flat when its nodes lie within `tolerance` of the surface's size of the plane; the default
/// takes coordinates of single precision for flat.
[[nodiscard]] inline std::vector<std::optional<CapPlane>> cap_planes(const mesh::Surface& surface,
                                                                     double tolerance = 1e-6) {
  const std::size_t count = region_count(surface);
  std::vector<Vec3> area(count, Vec3::Zero()), moment(count, Vec3::Zero());
  std::vector<double> size(count, 0), deviation(count, 0);
  Box box;
  for (Index t = 0; t < surface.cell_count(); ++t) {
    const auto r = static_cast<std::size_t>(surface.region_of(t));
    const auto triangle = mesh::triangle(surface, t);
    area[r] += triangle.area_vector();
    moment[r] += triangle.area() * triangle.centroid(), size[r] += triangle.area();
    box.extend(triangle.box());
  }
  std::vector<std::optional<CapPlane>> flat(count);
  for (std::size_t r = 1; r < count; ++r)
    if (size[r] > 0 && area[r].norm() > 0.5 * size[r])
      flat[r] = {moment[r] / size[r], area[r].normalized(), 0};
  for (Index t = 0; t < surface.cell_count(); ++t) {
    auto& plane = flat[static_cast<std::size_t>(surface.region_of(t))];
    if (!plane) continue;
    for (int k = 0; k < 3; ++k) {
      const Vec3 x = surface.nodes.col(surface.cells(k, t));
      plane->deviation = std::max(plane->deviation, std::abs(plane->normal.dot(x - plane->point)));
    }
  }
  for (auto& plane : flat)
    if (plane && plane->deviation > tolerance * box.diagonal()) plane.reset();
  return flat;
}

}  // namespace tunica::meshing
