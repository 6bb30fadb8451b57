// SPDX-License-Identifier: MIT
// Principal values and directions of a symmetric tensor, by Jacobi's rotations [GOLUB13, 8.5].
#pragma once

#include "tunica/core/types.hpp"
#include "tunica/solid/symmetric.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace tunica::solid {

struct Principal {
  Vec3 values = Vec3::Zero();                                // descending
  Eigen::Matrix3d directions = Eigen::Matrix3d::Identity();  // a column each, orthonormal, right-handed
};

/// Exact to roundings of the largest value, also where values coincide.
[[nodiscard]] inline Principal principal(const Symmetric<double>& tensor) {
  constexpr int sweeps = 12;  // convergence is quadratic: five do
  Eigen::Matrix3d A;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      A(i, j) = tensor[symmetric_index[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)]];
  Eigen::Matrix3d V = Eigen::Matrix3d::Identity();
  const double small = std::numeric_limits<double>::epsilon() * A.norm() * 1e-3;
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    if (!(std::abs(A(0, 1)) + std::abs(A(0, 2)) + std::abs(A(1, 2)) > small)) break;
    for (int p = 0; p < 2; ++p)
      for (int q = p + 1; q < 3; ++q) {
        if (A(p, q) == 0) continue;
        const double theta = (A(q, q) - A(p, p)) / (2 * A(p, q));
        const double t = std::copysign(1.0, theta) / (std::abs(theta) + std::hypot(1.0, theta));
        const double c = 1 / std::hypot(1.0, t), s = t * c;
        for (int k = 0; k < 3; ++k) {
          const double akp = A(k, p), akq = A(k, q);
          A(k, p) = c * akp - s * akq;
          A(k, q) = s * akp + c * akq;
        }
        for (int k = 0; k < 3; ++k) {
          const double apk = A(p, k), aqk = A(q, k), vkp = V(k, p), vkq = V(k, q);
          A(p, k) = c * apk - s * aqk;
          A(q, k) = s * apk + c * aqk;
          V(k, p) = c * vkp - s * vkq;
          V(k, q) = s * vkp + c * vkq;
        }
      }
  }
  std::array<int, 3> order{0, 1, 2};
  std::sort(order.begin(), order.end(), [&](int a, int b) { return A(a, a) > A(b, b); });
  Principal out;
  for (int k = 0; k < 3; ++k) {
    out.values[k] = A(order[static_cast<std::size_t>(k)], order[static_cast<std::size_t>(k)]);
    out.directions.col(k) = V.col(order[static_cast<std::size_t>(k)]);
  }
  const Vec3 a = out.directions.col(0), b = out.directions.col(1);
  const Vec3 third(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]);
  out.directions.col(2) = third;
  return out;
}

}  // namespace tunica::solid
