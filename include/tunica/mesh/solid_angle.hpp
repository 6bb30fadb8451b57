// SPDX-License-Identifier: MIT
// The solid angle under which a point sees a triangle: summed over a closed surface, 4 pi inside, 0 outside.
#pragma once

#include "tunica/mesh/measures.hpp"

#include <cmath>

namespace tunica::mesh {

/// Signed: positive when the normal of the triangle points away from p.
/// tan(omega/2) = a.(b x c) / (abc + (a.b) c + (b.c) a + (c.a) b)   [OOSTEROM83, (8)]
[[nodiscard]] inline double solid_angle(const Triangle& t, const Vec3& p) {
  const Vec3 a = vec::minus(t.a, p), b = vec::minus(t.b, p), c = vec::minus(t.c, p);
  const double la = vec::length(a), lb = vec::length(b), lc = vec::length(c);
  return 2 * std::atan2(vec::dot(a, vec::cross(b, c)),
                        la * lb * lc + vec::dot(a, b) * lc + vec::dot(b, c) * la + vec::dot(c, a) * lb);
}

/// 4 pi times the number of times that the surface winds round p.
[[nodiscard]] inline double solid_angle(const Surface& s, const Vec3& p) {
  double sum = 0;
  for (Index t = 0; t < s.cell_count(); ++t) sum += solid_angle(triangle(s, t), p);
  return sum;
}

}  // namespace tunica::mesh
