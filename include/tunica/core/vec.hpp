// SPDX-License-Identifier: MIT
// Points in and out of lists and the products of vectors as plain functions, with the bits of Eigen's: the
// headers that walk over many faces compile in half the time of one expression type after another.
#pragma once

#include "tunica/core/types.hpp"

#include <cmath>
#include <cstddef>
#include <vector>

namespace tunica::vec {

[[nodiscard]] inline Vec3 column(const Points<3>& points, Index n) {
  return {points(0, n), points(1, n), points(2, n)};
}

inline void set_column(Points<3>& points, Index n, const Vec3& x) {
  for (int a = 0; a < 3; ++a) points(a, n) = x[a];
}

[[nodiscard]] inline Points<3> columns(const std::vector<Vec3>& list) {
  Points<3> points(3, static_cast<Eigen::Index>(list.size()));
  for (std::size_t n = 0; n < list.size(); ++n) set_column(points, static_cast<Index>(n), list[n]);
  return points;
}

/// Four node numbers a face, one after the other.
[[nodiscard]] inline Connectivity<4> quads(const std::vector<Index>& list) {
  Connectivity<4> faces(4, static_cast<Eigen::Index>(list.size() / 4));
  for (std::size_t i = 0; i < list.size(); ++i) faces.data()[i] = list[i];
  return faces;
}

[[nodiscard]] inline Vec3 plus(const Vec3& a, const Vec3& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}

[[nodiscard]] inline Vec3 minus(const Vec3& a, const Vec3& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

/// a + s d
[[nodiscard]] inline Vec3 along(const Vec3& a, double s, const Vec3& d) {
  return {a[0] + s * d[0], a[1] + s * d[1], a[2] + s * d[2]};
}

[[nodiscard]] inline Vec3 scaled(double s, const Vec3& a) {
  return {s * a[0], s * a[1], s * a[2]};
}

[[nodiscard]] inline Vec3 divided(const Vec3& a, double s) {
  return {a[0] / s, a[1] / s, a[2] / s};
}

/// Of length 1 and orthogonal to a unit vector: that of Eigen's unitOrthogonal.
[[nodiscard]] inline Vec3 orthogonal(const Vec3& a) {
  constexpr double tiny = 1e-12;
  if (std::abs(a[0]) > tiny * std::abs(a[2]) || std::abs(a[1]) > tiny * std::abs(a[2])) {
    const double inverse = 1 / std::sqrt(a[0] * a[0] + a[1] * a[1]);
    return {-a[1] * inverse, a[0] * inverse, 0};
  }
  const double inverse = 1 / std::sqrt(a[1] * a[1] + a[2] * a[2]);
  return {0, -a[2] * inverse, a[1] * inverse};
}

/// The point between a and b at the fraction t.
[[nodiscard]] inline Vec3 between(const Vec3& a, const Vec3& b, double t) {
  return {(1 - t) * a[0] + t * b[0], (1 - t) * a[1] + t * b[1], (1 - t) * a[2] + t * b[2]};
}

[[nodiscard]] inline bool equal(const Vec3& a, const Vec3& b) {
  return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

[[nodiscard]] inline double dot(const Vec3& a, const Vec3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

[[nodiscard]] inline Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

[[nodiscard]] inline double squared(const Vec3& a) {
  return dot(a, a);
}

[[nodiscard]] inline double length(const Vec3& a) {
  return std::sqrt(dot(a, a));
}

[[nodiscard]] inline double distance(const Vec3& a, const Vec3& b) {
  return length(minus(a, b));
}

/// Of length 1; zero stays zero.
[[nodiscard]] inline Vec3 unit(const Vec3& a) {
  const double size = length(a);
  return size > 0 ? Vec3(a[0] / size, a[1] / size, a[2] / size) : Vec3(0, 0, 0);
}

}  // namespace tunica::vec
