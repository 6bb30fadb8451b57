// SPDX-License-Identifier: MIT
// Nodal fields on one linear tetrahedron: values, means and gradients in plain arithmetic.
#pragma once

#include "tunica/fem/p1_tets.hpp"
#include "tunica/fluid/field.hpp"

#include <cstddef>

namespace tunica::fluid {

using Nodal3 = Eigen::Matrix<double, 3, 4>;  // a vector at the four nodes, one column each
using Matrix3 = Eigen::Matrix<double, 3, 3>;

[[nodiscard]] inline Nodal3 nodal(const Points<3>& field, const Connectivity<4>& cells, Index e) {
  Nodal3 values;
  const Index* node = cells.data() + 4 * std::ptrdiff_t{e};
  for (int a = 0; a < 4; ++a) {
    const double* v = field.data() + 3 * std::ptrdiff_t{node[a]};
    values(0, a) = v[0], values(1, a) = v[1], values(2, a) = v[2];
  }
  return values;
}

[[nodiscard]] inline Eigen::Vector4d nodal(const Eigen::VectorXd& p, const Connectivity<4>& cells, Index e) {
  return {p[cells(0, e)], p[cells(1, e)], p[cells(2, e)], p[cells(3, e)]};
}

[[nodiscard]] inline Vec3 sum(const Nodal3& u) {
  return {u(0, 0) + u(0, 1) + u(0, 2) + u(0, 3), u(1, 0) + u(1, 1) + u(1, 2) + u(1, 3),
          u(2, 0) + u(2, 1) + u(2, 2) + u(2, 3)};
}

[[nodiscard]] inline Vec3 mean(const Nodal3& u) {
  const Vec3 s = sum(u);
  return {s[0] / 4, s[1] / 4, s[2] / 4};
}

[[nodiscard]] inline double mean(const Eigen::Vector4d& p) {
  return (p[0] + p[1] + p[2] + p[3]) / 4;
}

/// a . grad N_i
[[nodiscard]] inline double along(const Vec3& a, const Nodal3& grad, int i) {
  return a[0] * grad(0, i) + a[1] * grad(1, i) + a[2] * grad(2, i);
}

/// (i, j): du_i / dx_j
[[nodiscard]] inline Matrix3 gradient(const Nodal3& u, const Nodal3& grad) {
  Matrix3 g;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      g(i, j) = u(i, 0) * grad(j, 0) + u(i, 1) * grad(j, 1) + u(i, 2) * grad(j, 2) + u(i, 3) * grad(j, 3);
  return g;
}

[[nodiscard]] inline Vec3 gradient(const Eigen::Vector4d& p, const Nodal3& grad) {
  Vec3 g;
  for (int j = 0; j < 3; ++j)
    g[j] = p[0] * grad(j, 0) + p[1] * grad(j, 1) + p[2] * grad(j, 2) + p[3] * grad(j, 3);
  return g;
}

[[nodiscard]] inline Vec3 product(const Matrix3& A, const Vec3& x) {
  return {A(0, 0) * x[0] + A(0, 1) * x[1] + A(0, 2) * x[2], A(1, 0) * x[0] + A(1, 1) * x[1] + A(1, 2) * x[2],
          A(2, 0) * x[0] + A(2, 1) * x[1] + A(2, 2) * x[2]};
}

}  // namespace tunica::fluid
