// SPDX-License-Identifier: MIT
// Nodal vector fields in plain arithmetic: sums, scaling, and whether all of it are numbers.
#pragma once

#include "tunica/core/vec.hpp"

#include <cstddef>

namespace tunica::fluid {

using vec::column;
using vec::dot;
using vec::length;
using vec::set_column;

/// Column n += s v.
inline void add(Points<3>& field, Index n, double s, const Vec3& v) {
  for (int c = 0; c < 3; ++c) field(c, n) += s * v[c];
}

/// y = a p + b q.
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

/// Neither a NaN nor an infinity among the n numbers.
[[nodiscard]] inline bool finite(const double* x, std::ptrdiff_t n) {
  double sum = 0;
  for (std::ptrdiff_t k = 0; k < n; ++k) sum += 0 * x[k];
  return sum == 0;
}

}  // namespace tunica::fluid
