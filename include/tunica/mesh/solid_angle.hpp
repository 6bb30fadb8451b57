// SPDX-License-Identifier: MIT
// The solid angle under which a point sees a triangle: summed over a closed surface, 4 pi inside, 0 outside.
#pragma once

#include "tunica/mesh/measures.hpp"

#include <cmath>

namespace tunica::mesh {

/// Signed: positive when the normal of the triangle points away from p.
/// tan(omega/2) = a.(b x c) / (abc + (a.b) c + (b.c) a + (c.a) b)   [OOSTEROM83, (8)]
[[nodiscard]] inline double solid_angle(const Triangle& t, const Vec3& p) {
  const Vec3 a = t.a - p, b = t.b - p, c = t.c - p;
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  return 2 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
}

/// 4 pi times the number of times that the surface winds round p.
[[nodiscard]] inline double solid_angle(const Surface& s, const Vec3& p) {
  double sum = 0;
  for (Index t = 0; t < s.cell_count(); ++t) sum += solid_angle(triangle(s, t), p);
  return sum;
}

}  // namespace tunica::mesh
