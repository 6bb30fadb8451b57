// SPDX-License-Identifier: MIT
// Jet<T, N>: a number with N first and N (N + 1)/2 second derivatives, at half the work of nested duals.
#pragma once

#include "tunica/core/select.hpp"

#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <type_traits>

namespace tunica {

/// The Taylor polynomial of second order at a point: value, slopes d[i], and h[k] of the pairs i <= j in the
/// order 00 01 .. 0n 11 12 ..; T is double, a pack or a dual. Comparisons see the value alone and give what
/// those of T give. A plain number (0.5 * x) costs less than one made a Jet first (S(0.5) * x).
///   const auto x = Jet<double, 1>::variable(3.0, 0);  (x * x * x).h[0] == 18
template <class T, int N>
struct Jet {
  static constexpr std::size_t variables = N, pairs = variables * (variables + 1) / 2;
  T value{};
  std::array<T, variables> d{};
  std::array<T, pairs> h{};

  constexpr Jet() = default;
  constexpr Jet(const T& v) : value(v) {}  // implicit: constants mix with variables as they do in formulae
  template <class A>
  requires(std::is_arithmetic_v<A> && !std::same_as<A, T>) constexpr Jet(A v) : value(static_cast<T>(v)) {}

  /// The i-th independent variable.
  [[nodiscard]] static constexpr Jet variable(const T& v, int i) {
    Jet x(v);
    x.d[static_cast<std::size_t>(i)] = T(1);
    return x;
  }
  /// Place of the pair i, j in h.
  [[nodiscard]] static constexpr std::size_t pair(std::size_t i, std::size_t j) {
    return i <= j ? i * (2 * variables - i - 1) / 2 + j : pair(j, i);
  }

  constexpr Jet& operator+=(const Jet& b) {
    value += b.value;
    for (std::size_t i = 0; i < variables; ++i) d[i] += b.d[i];
    for (std::size_t k = 0; k < pairs; ++k) h[k] += b.h[k];
    return *this;
  }
  constexpr Jet& operator-=(const Jet& b) {
    value -= b.value;
    for (std::size_t i = 0; i < variables; ++i) d[i] -= b.d[i];
    for (std::size_t k = 0; k < pairs; ++k) h[k] -= b.h[k];
    return *this;
  }
  constexpr Jet& operator*=(const Jet& b) { return *this = *this * b; }
  constexpr Jet& operator/=(const Jet& b) { return *this = *this / b; }

  friend constexpr Jet operator+(const Jet& a) { return a; }
  friend constexpr Jet operator-(const Jet& a) { return a.scaled(T(-1)); }
  friend constexpr Jet operator+(Jet a, const Jet& b) { return a += b; }
  friend constexpr Jet operator-(Jet a, const Jet& b) { return a -= b; }
  friend constexpr Jet operator*(const Jet& a, const Jet& b) {
    Jet r(a.value * b.value);
    for (std::size_t i = 0, k = 0; i < variables; ++i) {
      r.d[i] = a.value * b.d[i] + b.value * a.d[i];
      for (std::size_t j = i; j < variables; ++j, ++k)
        r.h[k] = a.value * b.h[k] + b.value * a.h[k] + (a.d[i] * b.d[j] + a.d[j] * b.d[i]);
    }
    return r;
  }
  friend constexpr Jet operator/(const Jet& a, const Jet& b) {
    const T q = T(1) / b.value;
    return a * b.chain(q, -q * q, T(2) * q * q * q);
  }

  // Plain numbers have no derivatives.
  template <class A>
  requires std::is_arithmetic_v<A>
  friend constexpr Jet operator*(const Jet& a, A s) { return a.scaled(T(s)); }
  template <class A>
  requires std::is_arithmetic_v<A>
  friend constexpr Jet operator*(A s, const Jet& a) { return a.scaled(T(s)); }
  template <class A>
  requires std::is_arithmetic_v<A>
  friend constexpr Jet operator/(const Jet& a, A s) { return a.scaled(T(1) / T(s)); }
  template <class A>
  requires std::is_arithmetic_v<A>
  friend constexpr Jet operator+(Jet a, A s) { return a.value += T(s), a; }
  template <class A>
  requires std::is_arithmetic_v<A>
  friend constexpr Jet operator+(A s, Jet a) { return a.value += T(s), a; }
  template <class A>
  requires std::is_arithmetic_v<A>
  friend constexpr Jet operator-(Jet a, A s) { return a.value -= T(s), a; }

  friend constexpr auto operator==(const Jet& a, const Jet& b) { return a.value == b.value; }
  friend constexpr auto operator<(const Jet& a, const Jet& b) { return a.value < b.value; }
  friend constexpr auto operator>(const Jet& a, const Jet& b) { return a.value > b.value; }
  friend constexpr auto operator<=(const Jet& a, const Jet& b) { return a.value <= b.value; }
  friend constexpr auto operator>=(const Jet& a, const Jet& b) { return a.value >= b.value; }

  /// Lane by lane where T has lanes; a bool is taken by the general one.
  template <class Mask>
  requires(!std::same_as<Mask, bool>) [[nodiscard]] friend constexpr Jet
      select(const Mask& mask, const Jet& a, const Jet& b) {
    Jet r(select(mask, a.value, b.value));
    for (std::size_t i = 0; i < variables; ++i) r.d[i] = select(mask, a.d[i], b.d[i]);
    for (std::size_t k = 0; k < pairs; ++k) r.h[k] = select(mask, a.h[k], b.h[k]);
    return r;
  }

  // The functions of T are found beside it or in std.
  friend Jet sqrt(const Jet& a) {
    using std::sqrt;
    const T root = sqrt(a.value), slope = T(0.5) / root;
    return a.chain(root, slope, T(-0.5) * slope / a.value);
  }
  friend Jet cbrt(const Jet& a) {
    using std::cbrt;
    const T root = cbrt(a.value), slope = root / (T(3) * a.value);
    return a.chain(root, slope, T(-2. / 3) * slope / a.value);
  }
  friend Jet exp(const Jet& a) {
    using std::exp;
    const T e = exp(a.value);
    return a.chain(e, e, e);
  }
  friend Jet log(const Jet& a) {
    using std::log;
    const T q = T(1) / a.value;
    return a.chain(log(a.value), q, -q * q);
  }
  friend Jet sin(const Jet& a) {
    using std::cos, std::sin;
    const T s = sin(a.value);
    return a.chain(s, cos(a.value), -s);
  }
  friend Jet cos(const Jet& a) {
    using std::cos, std::sin;
    const T c = cos(a.value);
    return a.chain(c, -sin(a.value), -c);
  }
  friend Jet pow(const Jet& a, double exponent) {
    using std::pow;
    const T slope = T(exponent) * pow(a.value, exponent - 1);
    return a.chain(pow(a.value, exponent), slope, T(exponent * (exponent - 1)) * pow(a.value, exponent - 2));
  }
  friend Jet abs(const Jet& a) { return select(a.value < T(0), -a, a); }

 private:
  [[nodiscard]] constexpr Jet scaled(const T& s) const {
    Jet r(s * value);
    for (std::size_t i = 0; i < variables; ++i) r.d[i] = s * d[i];
    for (std::size_t k = 0; k < pairs; ++k) r.h[k] = s * h[k];
    return r;
  }
  /// f(this) with f' and f'' there.
  [[nodiscard]] constexpr Jet chain(const T& f, const T& f1, const T& f2) const {
    Jet r(f);
    for (std::size_t i = 0, k = 0; i < variables; ++i) {
      r.d[i] = f1 * d[i];
      const T turn = f2 * d[i];
      for (std::size_t j = i; j < variables; ++j, ++k) r.h[k] = f1 * h[k] + turn * d[j];
    }
    return r;
  }
};

}  // namespace tunica
