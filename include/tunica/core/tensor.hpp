// SPDX-License-Identifier: MIT
// Tensor<S>: a 3 x 3 matrix of any scalar (double, float, dual, pack), and its algebra in plain loops.
#pragma once

#include <array>
#include <cstddef>

namespace tunica {

template <class S>
using Vector3 = std::array<S, 3>;

/// Row by row: (i, j) is m[3 i + j]. Zero unless it is filled.
template <class S>
struct Tensor {
  std::array<S, 9> m{};

  [[nodiscard]] constexpr S& operator()(int i, int j) { return m[static_cast<std::size_t>(3 * i + j)]; }
  [[nodiscard]] constexpr const S& operator()(int i, int j) const {
    return m[static_cast<std::size_t>(3 * i + j)];
  }

  constexpr Tensor& operator+=(const Tensor& b) {
    for (std::size_t k = 0; k < 9; ++k) m[k] += b.m[k];
    return *this;
  }
  constexpr Tensor& operator-=(const Tensor& b) {
    for (std::size_t k = 0; k < 9; ++k) m[k] -= b.m[k];
    return *this;
  }
  constexpr Tensor& operator*=(const S& s) {
    for (std::size_t k = 0; k < 9; ++k) m[k] *= s;
    return *this;
  }

  friend constexpr Tensor operator+(Tensor a, const Tensor& b) { return a += b; }
  friend constexpr Tensor operator-(Tensor a, const Tensor& b) { return a -= b; }
  friend constexpr Tensor operator*(const S& s, Tensor a) { return a *= s; }
  friend constexpr Tensor operator*(Tensor a, const S& s) { return a *= s; }
};

/// The same numbers as another scalar: constants where T is a dual, all lanes alike where it is a pack.
template <class T, class S>
[[nodiscard]] constexpr Tensor<T> cast(const Tensor<S>& a) {
  Tensor<T> b;
  for (std::size_t k = 0; k < 9; ++k) b.m[k] = T(a.m[k]);
  return b;
}

template <class S>
[[nodiscard]] constexpr Tensor<S> identity() {
  Tensor<S> one;
  for (std::size_t k = 0; k < 9; k += 4) one.m[k] = S(1);
  return one;
}

template <class S>
[[nodiscard]] constexpr S trace(const Tensor<S>& a) {
  return a.m[0] + a.m[4] + a.m[8];
}

template <class S>
[[nodiscard]] constexpr Tensor<S> transpose(const Tensor<S>& a) {
  Tensor<S> b;
  b.m = {a.m[0], a.m[3], a.m[6], a.m[1], a.m[4], a.m[7], a.m[2], a.m[5], a.m[8]};
  return b;
}

/// cof A = det(A) A^-T, also where A has no inverse: its columns are the cross products of those of A.
template <class S>
[[nodiscard]] constexpr Tensor<S> cofactor(const Tensor<S>& a) {
  const auto& m = a.m;
  Tensor<S> c;
  c.m = {m[4] * m[8] - m[5] * m[7], m[5] * m[6] - m[3] * m[8], m[3] * m[7] - m[4] * m[6],
         m[2] * m[7] - m[1] * m[8], m[0] * m[8] - m[2] * m[6], m[1] * m[6] - m[0] * m[7],
         m[1] * m[5] - m[2] * m[4], m[2] * m[3] - m[0] * m[5], m[0] * m[4] - m[1] * m[3]};
  return c;
}

template <class S>
[[nodiscard]] constexpr S determinant(const Tensor<S>& a) {
  const auto& m = a.m;
  return m[0] * (m[4] * m[8] - m[5] * m[7]) + m[1] * (m[5] * m[6] - m[3] * m[8]) +
         m[2] * (m[3] * m[7] - m[4] * m[6]);
}

/// Infinite or NaN where det A = 0.
template <class S>
[[nodiscard]] constexpr Tensor<S> inverse(const Tensor<S>& a) {
  const Tensor<S> c = cofactor(a);
  return (S(1) / (a.m[0] * c.m[0] + a.m[1] * c.m[1] + a.m[2] * c.m[2])) * transpose(c);
}

/// A B
template <class S>
[[nodiscard]] constexpr Tensor<S> product(const Tensor<S>& a, const Tensor<S>& b) {
  Tensor<S> c;
  for (std::size_t i = 0; i < 9; i += 3)
    for (std::size_t j = 0; j < 3; ++j)
      c.m[i + j] = a.m[i] * b.m[j] + a.m[i + 1] * b.m[j + 3] + a.m[i + 2] * b.m[j + 6];
  return c;
}

/// A x
template <class S>
[[nodiscard]] constexpr Vector3<S> product(const Tensor<S>& a, const Vector3<S>& x) {
  Vector3<S> y{};
  for (std::size_t i = 0; i < 3; ++i)
    y[i] = a.m[3 * i] * x[0] + a.m[3 * i + 1] * x[1] + a.m[3 * i + 2] * x[2];
  return y;
}

/// A^T B, as in C = F^T F.
template <class S>
[[nodiscard]] constexpr Tensor<S> transpose_product(const Tensor<S>& a, const Tensor<S>& b) {
  Tensor<S> c;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      c.m[3 * i + j] = a.m[i] * b.m[j] + a.m[i + 3] * b.m[j + 3] + a.m[i + 6] * b.m[j + 6];
  return c;
}

/// A : B = sum_ij A_ij B_ij
template <class S>
[[nodiscard]] constexpr S double_dot(const Tensor<S>& a, const Tensor<S>& b) {
  S sum = a.m[0] * b.m[0];
  for (std::size_t k = 1; k < 9; ++k) sum += a.m[k] * b.m[k];
  return sum;
}

template <class S>
[[nodiscard]] constexpr S dot(const Vector3<S>& a, const Vector3<S>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// a x b: (i, j) is a_i b_j.
template <class S>
[[nodiscard]] constexpr Tensor<S> dyad(const Vector3<S>& a, const Vector3<S>& b) {
  Tensor<S> c;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) c.m[3 * i + j] = a[i] * b[j];
  return c;
}

}  // namespace tunica
