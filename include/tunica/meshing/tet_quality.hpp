// SPDX-License-Identifier: MIT
// Quality of one tetrahedron: the smallest sine of its dihedral angles, its angles, its mean ratio.
#pragma once

#include "tunica/core/types.hpp"
#include "tunica/core/vec.hpp"
#include "tunica/meshing/predicates.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace tunica::meshing {

/// min over the six edges of sin(dihedral) = 6 V l / (N1 N2), N = twice the area of a face. It is
/// small for angles near 0 and near pi alike; negative when the volume is not positive (exact).
[[nodiscard]] inline double sine_quality(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const double det = orient3d(a, b, c, d);  // 6 V
  if (!(det > 0)) return -1;
  using vec::cross, vec::minus, vec::squared;
  const Vec3 ab = minus(b, a), ac = minus(c, a), ad = minus(d, a);
  const Vec3 bc = minus(c, b), bd = minus(d, b), cd = minus(d, c);
  const double na = squared(cross(bc, bd)), nb = squared(cross(ac, ad));  // opposite to a, b ...
  const double nc = squared(cross(ab, ad)), nd = squared(cross(ab, ac));
  // The faces that meet at an edge are opposite to the two nodes that it has not.
  const double least = std::min({squared(ab) / (nc * nd), squared(ac) / (nb * nd), squared(ad) / (nb * nc),
                                 squared(bc) / (na * nd), squared(bd) / (na * nc), squared(cd) / (na * nb)});
  return det * std::sqrt(least);
}

/// The six dihedral angles [rad], at the edges of mesh::Tet4.
[[nodiscard]] inline std::array<double, 6> dihedral_angles(const Vec3& a, const Vec3& b, const Vec3& c,
                                                           const Vec3& d) {
  using vec::cross, vec::minus;
  const Vec3 ab = minus(b, a), ac = minus(c, a), ad = minus(d, a);
  const std::array<Vec3, 4> normal{cross(minus(c, b), minus(d, b)), cross(ad, ac), cross(ab, ad),
                                   cross(ac, ab)};  // outward, of the face opposite to a, b, c, d
  constexpr std::array<std::array<std::size_t, 2>, 6> faces{{{2, 3}, {1, 3}, {1, 2}, {0, 3}, {0, 2}, {0, 1}}};
  std::array<double, 6> angle{};
  for (std::size_t e = 0; e < 6; ++e) {
    const Vec3 &m = normal[faces[e][0]], &n = normal[faces[e][1]];
    angle[e] = std::atan2(vec::length(cross(m, n)), -vec::dot(m, n));
  }
  return angle;
}

/// 12 (3 V)^(2/3) / (sum of the squared edges): 1 for the regular tetrahedron, 0 for a flat one.
[[nodiscard]] inline double mean_ratio(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  using vec::minus, vec::squared;
  const Vec3 ab = minus(b, a), ac = minus(c, a), ad = minus(d, a);
  const double volume = vec::dot(vec::cross(ab, ac), ad) / 6;
  if (!(volume > 0)) return 0;
  const double edges = squared(ab) + squared(ac) + squared(ad) + squared(minus(c, b)) + squared(minus(d, b)) +
                       squared(minus(d, c));
  return 12 * std::cbrt(9 * volume * volume) / edges;
}

}  // namespace tunica::meshing
