// SPDX-License-Identifier: MIT
// Dual<T, N>: a number with N derivatives (forward automatic differentiation); nest it for second ones.
#pragma once

#include "tunica/core/select.hpp"

#include <Eigen/Core>

#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <type_traits>

namespace tunica {

/// value + sum_i d[i] e_i with e_i e_j = 0. T is double, a pack or again a Dual. Comparisons see the
/// value alone and give what those of T give (a pack's: a mask). Works in fixed-size Eigen matrices.
///   const auto x = Dual<double, 2>::variable(3.0, 0);  (x * x).d[0] == 6
template <class T, int N>
struct Dual {
  T value{};
  std::array<T, N> d{};

  constexpr Dual() = default;
  constexpr Dual(const T& v) : value(v) {}  // implicit: constants mix with variables as they do in formulae
  template <class A>
  requires(std::is_arithmetic_v<A> && !std::same_as<A, T>) constexpr Dual(A v) : value(static_cast<T>(v)) {}

  /// The i-th independent variable.
  [[nodiscard]] static constexpr Dual variable(const T& v, int i) {
    Dual x(v);
    x.d[static_cast<std::size_t>(i)] = T(1);
    return x;
  }

  constexpr Dual& operator+=(const Dual& b) { return *this = *this + b; }
  constexpr Dual& operator-=(const Dual& b) { return *this = *this - b; }
  constexpr Dual& operator*=(const Dual& b) { return *this = *this * b; }
  constexpr Dual& operator/=(const Dual& b) { return *this = *this / b; }

  friend constexpr Dual operator+(const Dual& a) { return a; }
  friend constexpr Dual operator-(const Dual& a) { return combine(-a.value, a, T(-1)); }
  friend constexpr Dual operator+(const Dual& a, const Dual& b) {
    return combine(a.value + b.value, a, T(1), b, T(1));
  }
  friend constexpr Dual operator-(const Dual& a, const Dual& b) {
    return combine(a.value - b.value, a, T(1), b, T(-1));
  }
  friend constexpr Dual operator*(const Dual& a, const Dual& b) {
    return combine(a.value * b.value, a, b.value, b, a.value);
  }
  friend constexpr Dual operator/(const Dual& a, const Dual& b) {
    const T q = a.value / b.value, inverse = T(1) / b.value;
    return combine(q, a, inverse, b, -q * inverse);
  }

  friend constexpr auto operator==(const Dual& a, const Dual& b) { return a.value == b.value; }
  friend constexpr auto operator<(const Dual& a, const Dual& b) { return a.value < b.value; }
  friend constexpr auto operator>(const Dual& a, const Dual& b) { return a.value > b.value; }
  friend constexpr auto operator<=(const Dual& a, const Dual& b) { return a.value <= b.value; }
  friend constexpr auto operator>=(const Dual& a, const Dual& b) { return a.value >= b.value; }

  /// Lane by lane where T has lanes; a bool is taken by the general one.
  template <class Mask>
  requires(!std::same_as<Mask, bool>) [[nodiscard]] friend constexpr Dual
      select(const Mask& mask, const Dual& a, const Dual& b) {
    Dual r(select(mask, a.value, b.value));
    for (std::size_t i = 0; i < N; ++i) r.d[i] = select(mask, a.d[i], b.d[i]);
    return r;
  }

  // f(a) has the derivatives f'(a) a.d; the functions of T are found beside it or in std.
  friend Dual sqrt(const Dual& a) {
    using std::sqrt;
    const T root = sqrt(a.value);
    return combine(root, a, T(0.5) / root);
  }
  friend Dual cbrt(const Dual& a) {
    using std::cbrt;
    const T root = cbrt(a.value);
    return combine(root, a, root / (T(3) * a.value));
  }
  friend Dual exp(const Dual& a) {
    using std::exp;
    const T e = exp(a.value);
    return combine(e, a, e);
  }
  friend Dual log(const Dual& a) {
    using std::log;
    return combine(log(a.value), a, T(1) / a.value);
  }
  friend Dual sin(const Dual& a) {
    using std::cos, std::sin;
    return combine(sin(a.value), a, cos(a.value));
  }
  friend Dual cos(const Dual& a) {
    using std::cos, std::sin;
    return combine(cos(a.value), a, -sin(a.value));
  }
  friend Dual pow(const Dual& a, double exponent) {
    using std::pow;
    return combine(pow(a.value, exponent), a, T(exponent) * pow(a.value, exponent - 1));
  }
  friend Dual abs(const Dual& a) { return select(a.value < T(0), -a, a); }

 private:
  static constexpr Dual combine(const T& v, const Dual& a, const T& fa) {
    Dual r(v);
    for (std::size_t i = 0; i < N; ++i) r.d[i] = fa * a.d[i];
    return r;
  }
  static constexpr Dual combine(const T& v, const Dual& a, const T& fa, const Dual& b, const T& fb) {
    Dual r(v);
    for (std::size_t i = 0; i < N; ++i) r.d[i] = fa * a.d[i] + fb * b.d[i];
    return r;
  }
};

}  // namespace tunica

template <class T, int N>
struct Eigen::NumTraits<tunica::Dual<T, N>> : Eigen::NumTraits<double> {
  using Real = tunica::Dual<T, N>;
  using NonInteger = Real;
  using Nested = Real;
  using Literal = double;
  enum {
    IsComplex = 0,
    IsInteger = 0,
    IsSigned = 1,
    RequireInitialization = 1,
    ReadCost = N + 1,
    AddCost = N + 1,
    MulCost = 3 * N + 1
  };
  static Real epsilon() { return Real(NumTraits<double>::epsilon()); }
  static Real dummy_precision() { return Real(NumTraits<double>::dummy_precision()); }
  static Real highest() { return Real(NumTraits<double>::highest()); }
  static Real lowest() { return Real(NumTraits<double>::lowest()); }
};
