// SPDX-License-Identifier: MIT
// Symmetric tensors as six numbers: stresses for output.
#pragma once

#include <Eigen/Core>

#include <array>
#include <cstddef>

namespace tunica::solid {

/// Components of a symmetric tensor: xx yy zz xy yz xz. Shears are tensor components, not doubled.
template <class S>
using Symmetric = Eigen::Matrix<S, 6, 1>;
inline constexpr std::array<std::array<int, 2>, 6> symmetric_pairs{
    {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {0, 2}}};
inline constexpr std::array<std::array<int, 3>, 3> symmetric_index{{{0, 3, 5}, {3, 1, 4}, {5, 4, 2}}};

template <class S>
[[nodiscard]] Symmetric<S> symmetric_part(const Eigen::Matrix<S, 3, 3>& A) {
  Symmetric<S> s;
  for (int k = 0; k < 6; ++k) {
    const auto [i, j] = symmetric_pairs[static_cast<std::size_t>(k)];
    s[k] = i == j ? A(i, i) : S(0.5) * (A(i, j) + A(j, i));
  }
  return s;
}

template <class S>
[[nodiscard]] S trace(const Symmetric<S>& a) {
  return a[0] + a[1] + a[2];
}

/// dev a = a - tr(a)/3 1
template <class S>
[[nodiscard]] Symmetric<S> deviator(Symmetric<S> a) {
  const S mean = trace(a) * S(1. / 3);
  for (int k = 0; k < 3; ++k) a[k] -= mean;
  return a;
}

}  // namespace tunica::solid
