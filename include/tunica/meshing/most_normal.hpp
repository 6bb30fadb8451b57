// SPDX-License-Identifier: MIT
// The direction that makes the smallest greatest angle with a set of normals: the axis of the narrowest
// cone that holds them all. [AUBRY08]
#pragma once

#include "tunica/core/types.hpp"
#include "tunica/core/vec.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

namespace tunica::meshing {

/// `cosine` is that of the cone's half angle: positive where the direction sees every face.
struct MostNormal {
  Vec3 direction{0, 0, 0};
  double cosine = -1;
};

/// Exact: the cone touches two or three of the normals (unit vectors), all of which are tried.
[[nodiscard]] inline MostNormal most_normal(const std::vector<Vec3>& normals) {
  MostNormal best;
  const auto try_axis = [&](const Vec3& axis) {
    const double size = vec::length(axis);
    if (!(size > 1e-12)) return;
    double cosine = std::numeric_limits<double>::infinity();
    for (const Vec3& n : normals) {
      cosine = std::min(cosine, vec::dot(n, axis) / size);
      if (!(cosine > best.cosine)) return;
    }
    if (cosine > best.cosine) best = {vec::scaled(1 / size, axis), cosine};
  };
  for (std::size_t i = 0; i < normals.size(); ++i) {
    try_axis(normals[i]);
    for (std::size_t j = i + 1; j < normals.size(); ++j) {
      try_axis(vec::along(normals[i], 1, normals[j]));
      for (std::size_t k = j + 1; k < normals.size(); ++k) {
        const Vec3 &a = normals[i], &b = normals[j], &c = normals[k];
        const Vec3 axis = vec::cross(vec::minus(b, a), vec::minus(c, a));  // equally far from all three
        try_axis(vec::scaled(vec::dot(axis, a) < 0 ? -1 : 1, axis));
      }
    }
  }
  return best;
}

}  // namespace tunica::meshing
