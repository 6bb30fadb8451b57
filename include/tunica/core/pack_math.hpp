// SPDX-License-Identifier: MIT
// exp, log, cbrt and pow of packs, in the registers, for doubles and floats. exp and log are within 1 ulp and
// cbrt within 2 of the true value (held by a test over the whole range), and right at 0, denormals, inf and
// NaN.
#pragma once

#include "tunica/core/pack.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>

namespace tunica {

namespace registers {

/// The bits of a number, and the constants that the functions below take them apart with.
template <class T>
struct Bits;
template <>
struct Bits<double> {
  using Integer = std::uint64_t;
  static constexpr int mantissa = 52, bias = 1023;
  static constexpr double round = 0x1.8p52;  // x + round - round: the nearest integer to x
  static constexpr double ln2_high = 0x1.62e42feep-1, ln2_low = 0x1.a39ef35793c76p-33;  // k ln2_high is exact
  static constexpr double exp_low = -746, exp_high = 710;                               // beyond: 0 and inf
  static constexpr int exp_terms = 13, log_terms = 10;
};
template <>
struct Bits<float> {
  using Integer = std::uint32_t;
  static constexpr int mantissa = 23, bias = 127;
  static constexpr float round = 0x1.8p23F;
  static constexpr float ln2_high = 0x1.62e4p-1F, ln2_low = 0x1.7f7d1cp-20F;
  static constexpr float exp_low = -104, exp_high = 89;
  static constexpr int exp_terms = 7, log_terms = 4;
};

template <class T, int W>
struct Functions {
  using B = Bits<T>;
  using Integer = typename B::Integer;
  using V = typename Register<T, W>::type;
  using I = typename Register<Integer, W>::type;
  static constexpr T inf = std::numeric_limits<T>::infinity();
  static constexpr T nan = std::numeric_limits<T>::quiet_NaN();

  TUNICA_INLINE static V all(T a) { return a - V{}; }
  TUNICA_INLINE static I bits(const V& x) { return std::bit_cast<I>(x); }
  TUNICA_INLINE static V number(const I& i) { return std::bit_cast<V>(i); }
  /// 2^n, n from its two's complement.
  TUNICA_INLINE static V power_of_two(const I& n) { return number((n + Integer{B::bias}) << B::mantissa); }

  /// exp x = 2^n exp r, n = round(x / ln 2), |r| <= ln(2)/2; Taylor's series of exp r.
  TUNICA_INLINE static V exp(const V& y) {
    V x = y < B::exp_low ? all(B::exp_low) : y;
    x = x > B::exp_high ? all(B::exp_high) : x;
    constexpr T log2_e = T(1.44269504088896340736L);
    const V shifted = x * log2_e + B::round, n = shifted - B::round;
    const V first = x - n * B::ln2_high, r = first - n * B::ln2_low;
    const V rest = (first - r) - n * B::ln2_low;  // what rounding took from r
    V even = all(0), odd = all(0);  // of (exp r - 1 - r) / r^2 in r^2: two short chains instead of a long one
    const V r2 = r * r;
    T factor = 1;
    constexpr int top = B::exp_terms;
    T inverse[top + 1] = {1};
    for (int k = 1; k <= top; ++k) factor *= T(k), inverse[k] = T(1) / factor;
#pragma GCC unroll 16
    for (int k = top; k >= 2; --k) (k % 2 ? odd : even) = (k % 2 ? odd : even) * r2 + inverse[k];
    const V e = T(1) + (r + (rest + r2 * (even + r * odd)));
    // 2^n in two factors: n reaches beyond the exponents of a number, and so may the result
    const I k = bits(shifted) - std::bit_cast<Integer>(B::round);
    constexpr Integer offset = Integer{1} << (B::mantissa - 2);
    const I half = ((k + 2 * offset) >> 1) - offset;
    return (e * power_of_two(half)) * power_of_two(k - half);
  }

  /// x = 2^k m with m in [sqrt(1/2), sqrt 2); denormals are scaled first.
  struct Split {
    V k, m;
  };
  TUNICA_INLINE static Split split(const V& x) {
    constexpr T scale = T(Integer{1} << (B::mantissa + 2));
    const auto tiny = x < std::numeric_limits<T>::min();
    const V scaled = tiny ? x * scale : x;
    constexpr Integer one = Integer{B::bias} << B::mantissa,
                      root = std::bit_cast<Integer>(T(0.70710678118654752440L));
    const I exponent = (bits(scaled) + (one - root)) >> B::mantissa;  // biased
    constexpr T anchor = T(Integer{1} << B::mantissa);
    const V k = number(exponent | std::bit_cast<Integer>(anchor)) - (anchor + B::bias);
    return {tiny ? k - T(B::mantissa + 2) : k, number(bits(scaled) - (exponent << B::mantissa) + one)};
  }

  /// log x = k ln 2 + log m; log(1 + f) = f - f^2/2 + s (f^2/2 + R), R = sum_j 2/(2j+1) s^2j, s = f/(2 + f).
  TUNICA_INLINE static V log(const V& x) {
    const Split at = split(x);
    const V f = at.m - T(1), s = f / (T(2) + f), z = s * s, z2 = z * z;
    V even = all(0), odd = all(0);
#pragma GCC unroll 16
    for (int j = B::log_terms; j >= 1; --j)
      (j % 2 ? odd : even) = (j % 2 ? odd : even) * z2 + T(2) / T(2 * j + 1);
    const V R = z * (odd + z * even), half = T(0.5) * f * f;
    const V value = at.k * B::ln2_high - ((half - (s * (half + R) + at.k * B::ln2_low)) - f);
    const V edge = x == T(0) ? all(-inf) : all(nan);
    return x > T(0) ? (x < inf ? value : x) : edge;
  }

  /// The cube root: 2^q t^(1/3) with t = 2^(k - 3q) m. A parabola within 0.0018 of m^(-1/3), then the step
  /// z (1 + h/3 + 2 h^2/9 + 14 h^3/81), h = 1 - t z^3, of fourth order and without division, then Newton's.
  TUNICA_INLINE static V cbrt(const V& y) {
    const V x = y < T(0) ? -y : y;
    const Split at = split(x);
    const V shifted = at.k * T(1. / 3) + B::round, q = shifted - B::round,
            rest = at.k - T(3) * q;                  // -1, 0, 1
    constexpr T root2 = T(1.25992104989487316477L);  // 2^(1/3)
    const V above = rest > T(0) ? all(1 / root2) : all(1), scale = rest < T(0) ? all(root2) : above;
    const V twice = rest > T(0) ? all(2) : all(1), t = at.m * (rest < T(0) ? all(T(0.5)) : twice);
    V z = (T(1.55815340) + at.m * (T(-0.76722662) + at.m * T(0.20967122))) * scale;
    const V h = T(1) - t * z * z * z;
    z += z * h * (T(1. / 3) + h * (T(2. / 9) + h * T(14. / 81)));
    V root = t * z * z;
    root += T(1. / 3) * (t - root * root * root) * z * z;
    root *= power_of_two(bits(shifted) - std::bit_cast<Integer>(B::round));
    const V positive = x < inf ? root : x, value = x > T(0) ? positive : x;  // 0, inf and NaN are their own
    return y < T(0) ? -value : value;
  }
};

}  // namespace registers

template <class T, int N, int W>
[[nodiscard]] TUNICA_INLINE Pack<T, N, W> exp(const Pack<T, N, W>& a) {
  return Pack<T, N, W>::map([](const auto& x) { return registers::Functions<T, W>::exp(x); }, a);
}
template <class T, int N, int W>
[[nodiscard]] TUNICA_INLINE Pack<T, N, W> log(const Pack<T, N, W>& a) {
  return Pack<T, N, W>::map([](const auto& x) { return registers::Functions<T, W>::log(x); }, a);
}
template <class T, int N, int W>
[[nodiscard]] TUNICA_INLINE Pack<T, N, W> cbrt(const Pack<T, N, W>& a) {
  return Pack<T, N, W>::map([](const auto& x) { return registers::Functions<T, W>::cbrt(x); }, a);
}
/// exp(exponent log a) for a > 0: off by some (1 + |exponent log a|) ulp.
template <class T, int N, int W>
[[nodiscard]] TUNICA_INLINE Pack<T, N, W> pow(const Pack<T, N, W>& a, double exponent) {
  return exp(Pack<T, N, W>(exponent) * log(a));
}

}  // namespace tunica
