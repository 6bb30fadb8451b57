// SPDX-License-Identifier: MIT
// How sharply a patch of triangles is folded, along its own edges and along those to its surroundings.
#pragma once

#include "tunica/core/vec.hpp"
#include "tunica/mesh/triangle.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace tunica::meshing {

/// The cosine of the smallest angle at which two triangles meet: -1 for a flat patch, 1 where two lie against
/// each other or one has no area. position(n): place of a node. beyond(a, b): the corners of the triangle
/// that runs the edge from a to b, of a patch edge that runs from b to a and has no triangle of the patch on
/// its other side.
template <class Position, class Beyond>
[[nodiscard]] double sharpest_fold(std::span<const std::array<Index, 3>> patch, const Position& position,
                                   const Beyond& beyond) {
  const auto normal = [&](const std::array<Index, 3>& v) {
    return vec::unit(mesh::Triangle{position(v[0]), position(v[1]), position(v[2])}.area_vector());
  };
  std::vector<Vec3> normals;
  for (const auto& v : patch) normals.push_back(normal(v));
  double most = -1;
  const auto meet = [&](const Vec3& m, const Vec3& n) {
    const bool flat = vec::squared(m) == 0 || vec::squared(n) == 0;
    most = std::max(most, flat ? 1.0 : -vec::dot(m, n));
  };
  for (std::size_t i = 0; i < patch.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const Index b = patch[i][k], a = patch[i][(k + 1) % 3];
      const auto runs = [&](const std::array<Index, 3>& v) {
        return (v[0] == a && v[1] == b) || (v[1] == a && v[2] == b) || (v[2] == a && v[0] == b);
      };
      const auto own = std::find_if(patch.begin(), patch.end(), runs);
      if (own == patch.end())
        meet(normals[i], normal(beyond(a, b)));
      else if (a < b)  // once an edge
        meet(normals[i], normals[static_cast<std::size_t>(own - patch.begin())]);
    }
  return most;
}

}  // namespace tunica::meshing
