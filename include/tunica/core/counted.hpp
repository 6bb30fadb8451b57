// SPDX-License-Identifier: MIT
// Counted: a number that counts what is done with it, so that flops of a kernel are counted, not guessed.
#pragma once

#include <Eigen/Core>

#include <cmath>
#include <compare>
#include <cstdint>
#include <type_traits>

namespace tunica {

/// Operations since the last reset; changes of sign, comparisons and selections are free.
struct FlopCount {
  std::int64_t add = 0;  // also subtractions
  std::int64_t multiply = 0;
  std::int64_t divide = 0;
  std::int64_t root = 0;      // square and cube roots
  std::int64_t function = 0;  // exp, log, pow, sin, cos

  /// Each operation as one.
  [[nodiscard]] std::int64_t total() const { return add + multiply + divide + root + function; }
};

/// A double that counts its operations in count(), a counter of each thread. Sums with an exact 0 and
/// products with an exact 0 or 1 count as any other: they are done.
///   Counted::count() = {};  kernel(Counted(...));  Counted::count().total()
struct Counted {
  double value = 0;

  Counted() = default;
  template <class A>
  requires std::is_arithmetic_v<A> Counted(A a) : value(static_cast<double>(a)) {}  // implicit, as for packs

  [[nodiscard]] static FlopCount& count() {
    static thread_local FlopCount counter;
    return counter;
  }

  Counted& operator+=(const Counted& b) { return *this = *this + b; }
  Counted& operator-=(const Counted& b) { return *this = *this - b; }
  Counted& operator*=(const Counted& b) { return *this = *this * b; }
  Counted& operator/=(const Counted& b) { return *this = *this / b; }
  friend Counted operator+(const Counted& a) { return a; }
  friend Counted operator-(const Counted& a) { return {-a.value}; }
  friend Counted operator+(const Counted& a, const Counted& b) { return ++count().add, a.value + b.value; }
  friend Counted operator-(const Counted& a, const Counted& b) { return ++count().add, a.value - b.value; }
  friend Counted operator*(const Counted& a, const Counted& b) {
    return ++count().multiply, a.value * b.value;
  }
  friend Counted operator/(const Counted& a, const Counted& b) { return ++count().divide, a.value / b.value; }
  friend bool operator==(const Counted& a, const Counted& b) { return a.value == b.value; }
  friend auto operator<=>(const Counted& a, const Counted& b) { return a.value <=> b.value; }

  friend Counted abs(const Counted& a) { return std::abs(a.value); }
  friend Counted min(const Counted& a, const Counted& b) { return b.value < a.value ? b : a; }
  friend Counted max(const Counted& a, const Counted& b) { return a.value < b.value ? b : a; }
  friend Counted sqrt(const Counted& a) { return ++count().root, std::sqrt(a.value); }
  friend Counted cbrt(const Counted& a) { return ++count().root, std::cbrt(a.value); }
  friend Counted exp(const Counted& a) { return ++count().function, std::exp(a.value); }
  friend Counted log(const Counted& a) { return ++count().function, std::log(a.value); }
  friend Counted sin(const Counted& a) { return ++count().function, std::sin(a.value); }
  friend Counted cos(const Counted& a) { return ++count().function, std::cos(a.value); }
  friend Counted pow(const Counted& a, double e) { return ++count().function, std::pow(a.value, e); }
};

}  // namespace tunica

template <>
struct Eigen::NumTraits<tunica::Counted> : Eigen::NumTraits<double> {
  using Real = tunica::Counted;
  using NonInteger = Real;
  using Nested = Real;
  using Literal = double;
  enum {
    IsComplex = 0,
    IsInteger = 0,
    IsSigned = 1,
    RequireInitialization = 1,
    ReadCost = 1,
    AddCost = 1,
    MulCost = 1
  };
  static Real epsilon() { return NumTraits<double>::epsilon(); }
  static Real dummy_precision() { return NumTraits<double>::dummy_precision(); }
  static Real highest() { return NumTraits<double>::highest(); }
  static Real lowest() { return NumTraits<double>::lowest(); }
};
