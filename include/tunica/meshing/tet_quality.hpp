// SPDX-License-Identifier: MIT
// Quality of one tetrahedron: the smallest sine of its dihedral angles, its angles, its mean ratio.
#pragma once

#include "tunica/core/types.hpp"
#include "tunica/meshing/predicates.hpp"

#include <Eigen/Geometry>

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
  const Vec3 ab = b - a, ac = c - a, ad = d - a, bc = c - b, bd = d - b, cd = d - c;
  const double na = bc.cross(bd).squaredNorm(), nb = ac.cross(ad).squaredNorm();  // opposite to a, b ...
  const double nc = ab.cross(ad).squaredNorm(), nd = ab.cross(ac).squaredNorm();
  // The faces that meet at an edge are opposite to the two nodes that it has not.
  const double least =
      std::min({ab.squaredNorm() / (nc * nd), ac.squaredNorm() / (nb * nd), ad.squaredNorm() / (nb * nc),
                bc.squaredNorm() / (na * nd), bd.squaredNorm() / (na * nc), cd.squaredNorm() / (na * nb)});
  return det * std::sqrt(least);
}

/// The six dihedral angles [rad], at the edges of mesh::Tet4.
[[nodiscard]] inline std::array<double, 6> dihedral_angles(const Vec3& a, const Vec3& b, const Vec3& c,
                                                           const Vec3& d) {
  const std::array<Vec3, 4> normal{(c - b).cross(d - b), (d - a).cross(c - a), (b - a).cross(d - a),
                                   (c - a).cross(b - a)};  // outward, of the face opposite to a, b, c, d
  constexpr std::array<std::array<std::size_t, 2>, 6> faces{{{2, 3}, {1, 3}, {1, 2}, {0, 3}, {0, 2}, {0, 1}}};
  std::array<double, 6> angle{};
  for (std::size_t e = 0; e < 6; ++e) {
    const Vec3 &m = normal[faces[e][0]], &n = normal[faces[e][1]];
    angle[e] = std::atan2(m.cross(n).norm(), -m.dot(n));
  }
  return angle;
}

/// 12 (3 V)^(2/3) / (sum of the squared edges): 1 for the regular tetrahedron, 0 for a flat one.
[[nodiscard]] inline double mean_ratio(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const double volume = (b - a).cross(c - a).dot(d - a) / 6;
  if (!(volume > 0)) return 0;
  const double edges = (b - a).squaredNorm() + (c - a).squaredNorm() + (d - a).squaredNorm() +
                       (c - b).squaredNorm() + (d - b).squaredNorm() + (d - c).squaredNorm();
  return 12 * std::cbrt(9 * volume * volume) / edges;
}

}  // namespace tunica::meshing
