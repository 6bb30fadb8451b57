// SPDX-License-Identifier: MIT
// Unit normals at the vertices of a surface, weighted by angle, for each region by itself. [THUERMER98]
#pragma once

#include "tunica/core/vec.hpp"
#include "tunica/mesh/measures.hpp"
#include "tunica/mesh/mesh.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace tunica::meshing {

/// The angle at p between q and r [rad].
[[nodiscard]] inline double corner_angle(const Vec3& p, const Vec3& q, const Vec3& r) {
  const Vec3 u = vec::minus(q, p), v = vec::minus(r, p);
  return std::atan2(vec::length(vec::cross(u, v)), vec::dot(u, v));
}

/// One normal a node, from the triangles of one region: zero where it has none.
[[nodiscard]] inline std::vector<Vec3> vertex_normals(const mesh::Surface& surface, Index region) {
  std::vector<Vec3> normals(static_cast<std::size_t>(surface.node_count()), Vec3(0, 0, 0));
  for (Index t = 0; t < surface.cell_count(); ++t) {
    if (surface.region_of(t) != region) continue;
    const mesh::Triangle x = mesh::triangle(surface, t);
    const Vec3 n = vec::unit(vec::cross(vec::minus(x.b, x.a), vec::minus(x.c, x.a)));
    const std::array<double, 3> angle{corner_angle(x.a, x.b, x.c), corner_angle(x.b, x.c, x.a),
                                      corner_angle(x.c, x.a, x.b)};
    for (std::size_t k = 0; k < 3; ++k) {
      Vec3& sum = normals[static_cast<std::size_t>(surface.cells(static_cast<Eigen::Index>(k), t))];
      sum = vec::along(sum, angle[k], n);
    }
  }
  for (Vec3& n : normals) n = vec::unit(n);
  return normals;
}

}  // namespace tunica::meshing
