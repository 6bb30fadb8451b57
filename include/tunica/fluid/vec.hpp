// SPDX-License-Identifier: MIT
// Vectors and lists of vectors in plain arithmetic: without a type for every expression the headers of the
// flow compile in half the time.
#pragma once

#include "tunica/core/types.hpp"

#include <cmath>
#include <cstddef>

namespace tunica::fluid {

[[nodiscard]] inline Vec3 column(const Points<3>& field, Index n) {
  return {field(0, n), field(1, n), field(2, n)};
}

inline void set_column(Points<3>& field, Index n, const Vec3& v) {
  for (int c = 0; c < 3; ++c) field(c, n) = v[c];
}

/// Column n += s v.
inline void add(Points<3>& field, Index n, double s, const Vec3& v) {
  for (int c = 0; c < 3; ++c) field(c, n) += s * v[c];
}

[[nodiscard]] inline double dot(const Vec3& a, const Vec3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

[[nodiscard]] inline double length(const Vec3& a) {
  return std::sqrt(dot(a, a));
}

/// y = a p + b q of fields.
inline void combine(double a, const Points<3>& p, double b, const Points<3>& q, Points<3>& y) {
  y.resize(3, p.cols());
  for (Eigen::Index k = 0; k < y.size(); ++k) y.data()[k] = a * p.data()[k] + b * q.data()[k];
}

/// Column n times scale[n].
inline void scale_columns(Points<3>& field, const Eigen::VectorXd& scale) {
  double* f = field.data();
  for (Eigen::Index n = 0; n < scale.size(); ++n)
    for (int c = 0; c < 3; ++c) *f++ *= scale[n];
}

/// Not a NaN nor an infinity among the n numbers.
[[nodiscard]] inline bool finite(const double* x, std::ptrdiff_t n) {
  double sum = 0;
  for (std::ptrdiff_t k = 0; k < n; ++k) sum += 0 * x[k];
  return sum == 0;
}

}  // namespace tunica::fluid
