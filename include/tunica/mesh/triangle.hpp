// SPDX-License-Identifier: MIT
// Geometry of one triangle: area vector, angles, the point of it nearest to a given one.
#pragma once

#include "tunica/core/types.hpp"
#include "tunica/core/vec.hpp"

#include <cmath>

namespace tunica::mesh {

struct Triangle {
  Vec3 a, b, c;

  /// Half the cross product of two edges: normal times area.
  [[nodiscard]] Vec3 area_vector() const {
    return vec::scaled(0.5, vec::cross(vec::minus(b, a), vec::minus(c, a)));
  }
  [[nodiscard]] double area() const { return vec::length(area_vector()); }
  [[nodiscard]] Vec3 centroid() const {
    return {(a[0] + b[0] + c[0]) / 3, (a[1] + b[1] + c[1]) / 3, (a[2] + b[2] + c[2]) / 3};
  }
  [[nodiscard]] Box box() const {
    Box box;
    box.extend(a), box.extend(b), box.extend(c);
    return box;
  }

  /// Smallest inner angle [rad]; 0 for a degenerate triangle.
  [[nodiscard]] double smallest_angle() const {
    const double p = angle(a, b, c), q = angle(b, c, a), r = angle(c, a, b);
    const double least = q < p ? q : p;
    return r < least ? r : least;
  }

  /// Barycentric coordinates (of a, b, c) of the point of the triangle nearest to x.
  [[nodiscard]] Vec3 nearest(const Vec3& x) const {
    const Vec3 ab = vec::minus(b, a), ac = vec::minus(c, a), ax = vec::minus(x, a);
    const double d1 = vec::dot(ab, ax), d2 = vec::dot(ac, ax);
    if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
    const Vec3 bx = vec::minus(x, b);
    const double d3 = vec::dot(ab, bx), d4 = vec::dot(ac, bx);
    if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return {1 - d1 / (d1 - d3), d1 / (d1 - d3), 0};
    const Vec3 cx = vec::minus(x, c);
    const double d5 = vec::dot(ab, cx), d6 = vec::dot(ac, cx);
    if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return {1 - d2 / (d2 - d6), 0, d2 / (d2 - d6)};
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
      const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
      return {0, 1 - w, w};
    }
    const double sum = va + vb + vc;
    if (!(sum > 0)) return {1, 0, 0};
    return {va / sum, vb / sum, vc / sum};
  }

  [[nodiscard]] Vec3 at(const Vec3& barycentric) const {
    const double u = barycentric[0], v = barycentric[1], w = barycentric[2];
    return {u * a[0] + v * b[0] + w * c[0], u * a[1] + v * b[1] + w * c[1], u * a[2] + v * b[2] + w * c[2]};
  }

 private:
  [[nodiscard]] static double angle(const Vec3& p, const Vec3& q, const Vec3& r) {
    const Vec3 u = vec::minus(q, p), v = vec::minus(r, p);
    return std::atan2(vec::length(vec::cross(u, v)), vec::dot(u, v));
  }
};

}  // namespace tunica::mesh
