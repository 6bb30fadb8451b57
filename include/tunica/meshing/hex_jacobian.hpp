// SPDX-License-Identifier: MIT
// Scaled Jacobians [KNUPP00] of the corners and the centre of a hexahedron, with derivatives.
#pragma once

#include "tunica/core/vec.hpp"
#include "tunica/mesh/quality.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace tunica::meshing::detail {

using HexNodes = std::array<Index, 8>;

/// det(u, v, w) / (|u| |v| |w|) and its derivatives by the three edges.
struct CornerShape {
  double s = -1;
  std::array<Vec3, 3> by;
};

[[nodiscard]] inline double corner_jacobian(const Vec3& u, const Vec3& v, const Vec3& w) {
  const double l = std::sqrt(vec::squared(u) * vec::squared(v) * vec::squared(w));
  return l > 0 ? vec::dot(vec::cross(u, v), w) / l : -1.0;
}

[[nodiscard]] inline CornerShape corner_shape(const Vec3& u, const Vec3& v, const Vec3& w) {
  CornerShape c;
  const double lu = vec::length(u), lv = vec::length(v), lw = vec::length(w);
  c.by.fill(Vec3(0, 0, 0));
  if (!(lu > 0 && lv > 0 && lw > 0)) return c;
  const Vec3 a = vec::scaled(1 / lu, u), b = vec::scaled(1 / lv, v), d = vec::scaled(1 / lw, w);
  const Vec3 bd = vec::cross(b, d), da = vec::cross(d, a), ab = vec::cross(a, b);
  c.s = vec::dot(ab, d);
  c.by[0] = vec::scaled(1 / lu, vec::along(bd, -c.s, a));
  c.by[1] = vec::scaled(1 / lv, vec::along(da, -c.s, b));
  c.by[2] = vec::scaled(1 / lw, vec::along(ab, -c.s, d));
  return c;
}

/// The least scaled Jacobian of the corners and of the centre of a cell.
[[nodiscard]] inline double hex_jacobian(const std::vector<Vec3>& x, const HexNodes& cell) {
  mesh::HexCorners corner;
  for (std::size_t k = 0; k < 8; ++k) corner[k] = x[static_cast<std::size_t>(cell[k])];
  return mesh::scaled_jacobian(corner);
}

/// The edges that leave a corner, right-handed where the cell is sound.
[[nodiscard]] inline std::array<Vec3, 3> corner_edges(const std::vector<Vec3>& x, const HexNodes& cell,
                                                      std::size_t corner) {
  const auto& ax = mesh::hex_corner_axes[corner];
  const Vec3& o = x[static_cast<std::size_t>(cell[corner])];
  const auto edge = [&](std::size_t a) {
    return vec::minus(x[static_cast<std::size_t>(cell[static_cast<std::size_t>(ax[a])])], o);
  };
  return {edge(0), edge(1), edge(2)};
}

}  // namespace tunica::meshing::detail
