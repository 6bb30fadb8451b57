// SPDX-License-Identifier: MIT
// Pack<T, N>: N numbers handled as one, a lane an element, in the registers of the machine at hand.
#pragma once

#include "tunica/core/pack_registers.hpp"
#include "tunica/core/select.hpp"

#include <Eigen/Core>

#include <cmath>
#include <concepts>
#include <type_traits>

namespace tunica {

/// How many lanes a pack has where nothing else is asked for: one register. Element kernels of several
/// registers a number are slower by a quarter at 16 bytes.
template <class T>
inline constexpr int default_lanes = (registers::bytes > 0 ? registers::bytes : 16) /
                                     static_cast<int>(sizeof(T));

template <class T, int N = default_lanes<T>, int W = registers::width<T>(N)>
struct Pack;

/// True or false in each lane.
template <class T, int N, int W = registers::width<T>(N)>
struct PackMask {
  using Part = decltype(typename registers::Register<T, W>::type{} <
                        typename registers::Register<T, W>::type{});
  Part part[N / W];

  [[nodiscard]] bool operator[](int lane) const {
    if constexpr (W == 1)
      return part[lane];
    else
      return part[lane / W][lane % W] != 0;
  }
  TUNICA_INLINE friend PackMask operator&&(const PackMask& a, const PackMask& b) {
    return map([](const Part& x, const Part& y) { return static_cast<Part>(x & y); }, a, b);
  }
  TUNICA_INLINE friend PackMask operator||(const PackMask& a, const PackMask& b) {
    return map([](const Part& x, const Part& y) { return static_cast<Part>(x | y); }, a, b);
  }
  TUNICA_INLINE friend PackMask operator!(const PackMask& a) {
    return map([](const Part& x, const Part&) { return static_cast<Part>(x == Part{}); }, a, a);
  }
  [[nodiscard]] friend bool any(const PackMask& m) {
    bool found = false;
    for (int l = 0; l < N; ++l) found = found || m[l];
    return found;
  }
  [[nodiscard]] friend bool all(const PackMask& m) { return !any(!m); }
  [[nodiscard]] friend bool none(const PackMask& m) { return !any(m); }

 private:
  template <class F>
  TUNICA_INLINE static PackMask map(F f, const PackMask& a, const PackMask& b) {
    PackMask m;
#pragma GCC unroll 16
    for (int r = 0; r < N / W; ++r) m.part[r] = f(a.part[r], b.part[r]);
    return m;
  }
};

/// Arithmetic, comparisons and functions work lane by lane, constants go into every lane, and the functions
/// of <cmath> are found beside the type: sqrt, abs, min, max here, exp, log, cbrt, pow in pack_math.hpp.
/// Works as scalar of Dual and of Eigen's fixed matrices. N is a power of two; W is the lanes of a register.
///   const Pack<double> x = Pack<double>::load(values);  select(x > 0.0, sqrt(x), 0.0).store(values);
template <class T, int N, int W>
struct Pack {
  static_assert(std::is_floating_point_v<T>, "a pack is made of floating-point numbers");
  static_assert(N > 0 && N % W == 0, "the lanes of a pack fill whole registers");
  using value_type = T;
  using Part = typename registers::Register<T, W>::type;
  using Mask = PackMask<T, N, W>;
  static constexpr int size = N, parts = N / W;

  Part part[parts];

  Pack() = default;
  template <class A>
  requires std::is_arithmetic_v<A> TUNICA_INLINE Pack(A a) {  // implicit: constants mix with packs
    for_parts([&](int r) { part[r] = static_cast<T>(a) - Part{}; });
  }
  /// Lane l is f(l).
  template <class F>
  requires std::invocable<F, int> &&(!std::is_arithmetic_v<F>) [[nodiscard]] static Pack generate(F&& f) {
    Pack x;
    for (int l = 0; l < N; ++l) x.set(l, static_cast<T>(f(l)));
    return x;
  }
  /// From and to N numbers in a row, of any alignment.
  [[nodiscard]] TUNICA_INLINE static Pack load(const T* from) {
    Pack x;
    __builtin_memcpy(&x, from, N * sizeof(T));
    return x;
  }
  TUNICA_INLINE void store(T* to) const { __builtin_memcpy(to, this, N * sizeof(T)); }

  [[nodiscard]] TUNICA_INLINE T operator[](int lane) const {
    if constexpr (W == 1)
      return part[lane];
    else
      return part[lane / W][lane % W];
  }
  TUNICA_INLINE void set(int lane, T value) {
    if constexpr (W == 1)
      part[lane] = value;
    else
      part[lane / W][lane % W] = value;
  }

  TUNICA_INLINE Pack& operator+=(const Pack& b) { return *this = *this + b; }
  TUNICA_INLINE Pack& operator-=(const Pack& b) { return *this = *this - b; }
  TUNICA_INLINE Pack& operator*=(const Pack& b) { return *this = *this * b; }
  TUNICA_INLINE Pack& operator/=(const Pack& b) { return *this = *this / b; }
  TUNICA_INLINE friend Pack operator+(const Pack& a) { return a; }
  TUNICA_INLINE friend Pack operator-(const Pack& a) {
    return map([](const Part& x) { return -x; }, a);
  }
  TUNICA_INLINE friend Pack operator+(const Pack& a, const Pack& b) {
    return map([](const Part& x, const Part& y) { return x + y; }, a, b);
  }
  TUNICA_INLINE friend Pack operator-(const Pack& a, const Pack& b) {
    return map([](const Part& x, const Part& y) { return x - y; }, a, b);
  }
  TUNICA_INLINE friend Pack operator*(const Pack& a, const Pack& b) {
    return map([](const Part& x, const Part& y) { return x * y; }, a, b);
  }
  TUNICA_INLINE friend Pack operator/(const Pack& a, const Pack& b) {
    return map([](const Part& x, const Part& y) { return x / y; }, a, b);
  }

  TUNICA_INLINE friend Mask operator<(const Pack& a, const Pack& b) {
    return compare([](const Part& x, const Part& y) { return x < y; }, a, b);
  }
  TUNICA_INLINE friend Mask operator<=(const Pack& a, const Pack& b) {
    return compare([](const Part& x, const Part& y) { return x <= y; }, a, b);
  }
  TUNICA_INLINE friend Mask operator>(const Pack& a, const Pack& b) { return b < a; }
  TUNICA_INLINE friend Mask operator>=(const Pack& a, const Pack& b) { return b <= a; }
  TUNICA_INLINE friend Mask operator==(const Pack& a, const Pack& b) {
    return compare([](const Part& x, const Part& y) { return x == y; }, a, b);
  }
  TUNICA_INLINE friend Mask operator!=(const Pack& a, const Pack& b) { return !(a == b); }

  /// a where the mask is true, b elsewhere; both are computed.
  TUNICA_INLINE friend Pack select(const Mask& m, const Pack& a, const Pack& b) {
    Pack x;
    for_parts([&](int r) { x.part[r] = m.part[r] ? a.part[r] : b.part[r]; });
    return x;
  }
  /// As std::min and std::max: of two that do not compare, the first.
  TUNICA_INLINE friend Pack min(const Pack& a, const Pack& b) {
    return map([](const Part& x, const Part& y) { return y < x ? y : x; }, a, b);
  }
  TUNICA_INLINE friend Pack max(const Pack& a, const Pack& b) {
    return map([](const Part& x, const Part& y) { return x < y ? y : x; }, a, b);
  }
  TUNICA_INLINE friend Pack abs(const Pack& a) {
    return map([](const Part& x) { return x < Part{} ? -x : x + T(0); }, a);  // -0 + 0 = 0
  }
  TUNICA_INLINE friend Pack sqrt(const Pack& a) {
    return map([](const Part& x) { return registers::square_root<T, W>(x); }, a);
  }

  /// Over the lanes, first to last.
  [[nodiscard]] friend T sum(const Pack& a) {
    T s = a[0];
    for (int l = 1; l < N; ++l) s += a[l];
    return s;
  }
  [[nodiscard]] friend T smallest(const Pack& a) {
    T s = a[0];
    for (int l = 1; l < N; ++l) s = a[l] < s ? a[l] : s;
    return s;
  }
  [[nodiscard]] friend T largest(const Pack& a) { return -smallest(-a); }

  /// f of each register, for functions of the library beside this header.
  template <class F, class... Packs>
  TUNICA_INLINE static Pack map(F f, const Packs&... p) {
    Pack x;
#pragma GCC unroll 16
    for (int r = 0; r < parts; ++r) x.part[r] = f(p.part[r]...);
    return x;
  }

 private:
  template <class F>
  TUNICA_INLINE static void for_parts(F f) {
#pragma GCC unroll 16
    for (int r = 0; r < parts; ++r) f(r);
  }
  template <class F>
  TUNICA_INLINE static Mask compare(F f, const Pack& a, const Pack& b) {
    Mask m;
    for_parts([&](int r) { m.part[r] = f(a.part[r], b.part[r]); });
    return m;
  }
};

/// Lanes of a scalar: 1 for everything but packs, and the number type of a lane.
template <class S>
struct Lanes {
  static constexpr int count = 1;
  using type = S;
};
template <class T, int N, int W>
struct Lanes<Pack<T, N, W>> {
  static constexpr int count = N;
  using type = T;
};

}  // namespace tunica

template <class T, int N, int W>
struct Eigen::NumTraits<tunica::Pack<T, N, W>> : Eigen::NumTraits<T> {
  using Real = tunica::Pack<T, N, W>;
  using NonInteger = Real;
  using Nested = Real;
  using Literal = T;
  enum {
    IsComplex = 0,
    IsInteger = 0,
    IsSigned = 1,
    RequireInitialization = 0,
    ReadCost = 1,
    AddCost = 1,
    MulCost = 1
  };
  static Real epsilon() { return Real(NumTraits<T>::epsilon()); }
  static Real dummy_precision() { return Real(NumTraits<T>::dummy_precision()); }
  static Real highest() { return Real(NumTraits<T>::highest()); }
  static Real lowest() { return Real(NumTraits<T>::lowest()); }
};
