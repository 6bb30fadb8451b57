// SPDX-License-Identifier: MIT
// Geometry of one triangle: area vector, angles, the point of it nearest to a given one.
#pragma once

#include "tunica/core/types.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace tunica::mesh {

struct Triangle {
  Vec3 a, b, c;

  /// Half the cross product of two edges: normal times area.
  [[nodiscard]] Vec3 area_vector() const { return 0.5 * (b - a).cross(c - a); }
  [[nodiscard]] double area() const { return area_vector().norm(); }
  [[nodiscard]] Vec3 centroid() const { return (a + b + c) / 3; }
  [[nodiscard]] Box box() const {
    Box box;
    box.extend(a), box.extend(b), box.extend(c);
    return box;
  }

  /// Smallest inner angle [rad]; 0 for a degenerate triangle.
  [[nodiscard]] double smallest_angle() const {
    const auto angle = [](const Vec3& p, const Vec3& q, const Vec3& r) {
      return std::atan2((q - p).cross(r - p).norm(), (q - p).dot(r - p));
    };
    return std::min({angle(a, b, c), angle(b, c, a), angle(c, a, b)});
  }

  /// Barycentric coordinates (of a, b, c) of the point of the triangle nearest to x.
  [[nodiscard]] Vec3 nearest(const Vec3& x) const {
    const Vec3 ab = b - a, ac = c - a, ax = x - a;
    const double d1 = ab.dot(ax), d2 = ac.dot(ax);
    if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
    const Vec3 bx = x - b;
    const double d3 = ab.dot(bx), d4 = ac.dot(bx);
    if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return {1 - d1 / (d1 - d3), d1 / (d1 - d3), 0};
    const Vec3 cx = x - c;
    const double d5 = ab.dot(cx), d6 = ac.dot(cx);
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
    return barycentric[0] * a + barycentric[1] * b + barycentric[2] * c;
  }
};

}  // namespace tunica::mesh
