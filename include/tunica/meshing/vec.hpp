// SPDX-License-Identifier: MIT
// Points in and out of lists and the products of vectors as plain functions: the headers that walk over
// many faces compile in half the time of one expression type after another.
#pragma once

#include "tunica/core/types.hpp"

#include <cmath>

namespace tunica::meshing::vec {

[[nodiscard]] inline Vec3 column(const Points<3>& points, Index n) {
  return {points(0, n), points(1, n), points(2, n)};
}

inline void set_column(Points<3>& points, Index n, const Vec3& x) {
  for (int a = 0; a < 3; ++a) points(a, n) = x[a];
}

[[nodiscard]] inline double dot(const Vec3& a, const Vec3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

[[nodiscard]] inline Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

[[nodiscard]] inline double length(const Vec3& a) {
  return std::sqrt(dot(a, a));
}

[[nodiscard]] inline double distance(const Vec3& a, const Vec3& b) {
  return length({a[0] - b[0], a[1] - b[1], a[2] - b[2]});
}

/// Of length 1; zero stays zero.
[[nodiscard]] inline Vec3 unit(const Vec3& a) {
  const double size = length(a);
  return size > 0 ? Vec3(a[0] / size, a[1] / size, a[2] / size) : Vec3(0, 0, 0);
}

}  // namespace tunica::meshing::vec
