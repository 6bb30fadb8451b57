// SPDX-License-Identifier: MIT
// The smallest angle at which neighbouring triangles of a closed surface meet, and where.
#pragma once

#include "tunica/core/vec.hpp"
#include "tunica/mesh/adjacency.hpp"
#include "tunica/mesh/measures.hpp"

#include <cmath>
#include <numbers>

namespace tunica::test {

struct Fold {
  double degrees = 180;  // 180: flat; the smaller of the inner and the outer angle
  Vec3 place{0, 0, 0};
};

[[nodiscard]] inline Fold sharpest_fold(const mesh::Surface& s) {
  Fold least;
  const auto twin = mesh::twins(s.cells, s.node_count());
  for (Index h = 0; h < static_cast<Index>(twin.size()); ++h) {
    const Vec3 m = mesh::triangle(s, h / 3).area_vector();
    const Vec3 n = mesh::triangle(s, twin[static_cast<std::size_t>(h)] / 3).area_vector();
    const double turn = std::atan2(vec::length(vec::cross(m, n)), vec::dot(m, n));
    const double degrees = 180 - turn * 180 / std::numbers::pi;
    if (degrees < least.degrees) least = {degrees, mesh::triangle(s, h / 3).centroid()};
  }
  return least;
}

}  // namespace tunica::test
