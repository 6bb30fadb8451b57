// SPDX-License-Identifier: MIT
// Exact arithmetic on expansions: sums of doubles that do not overlap, smallest first [SHEWCHUK97].
#pragma once

#ifdef __FAST_MATH__
#error "tunica/meshing/expansion.hpp is exact only without -ffast-math"
#endif

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace tunica::meshing {

static_assert(std::numeric_limits<double>::is_iec559 && std::numeric_limits<double>::digits == 53,
              "exact predicates need IEEE double precision");

/// hi + lo is the exact result and hi its rounded value.
struct Pair {
  double hi, lo;
};

[[nodiscard]] inline Pair two_sum(double a, double b) {
  const double x = a + b, bv = x - a, av = x - bv;
  return {x, (a - av) + (b - bv)};
}

/// As two_sum, for |a| >= |b|.
[[nodiscard]] inline Pair fast_two_sum(double a, double b) {
  const double x = a + b;
  return {x, b - (x - a)};
}

#ifdef __FMA__
[[nodiscard]] inline Pair two_product(double a, double b) {
  const double x = a * b;
  return {x, std::fma(a, b, -x)};
}
#else
/// Both halves have 26 bits [SHEWCHUK97, fig. 6]; overflows beyond 1e299.
[[nodiscard]] inline Pair halves(double a) {
  const double c = 134217729.0 * a, big = c - a, hi = c - big;  // 2^27 + 1
  return {hi, a - hi};
}

[[nodiscard]] inline Pair two_product(double a, double b) {
  const double x = a * b;
  const Pair p = halves(a), q = halves(b);
  return {x, p.lo * q.lo - (((x - p.hi * q.hi) - p.lo * q.hi) - p.hi * q.lo)};
}
#endif

/// An exact number of at most N components; it has none when it is 0.
template <std::size_t N>
struct Expansion {
  std::array<double, N> part;  // part[0 .. size), by magnitude, none of them 0
  std::size_t size = 0;

  Expansion() {}  // the parts beyond size are never read
  explicit Expansion(const Pair& p) { push(p.lo), push(p.hi); }
  void push(double x) {
    if (x != 0) part[size++] = x;
  }
  /// The largest component: it has the sign of the whole and its value to a rounding.
  [[nodiscard]] double estimate() const { return size == 0 ? 0.0 : part[size - 1]; }
};

/// a - b of two doubles.
[[nodiscard]] inline Expansion<2> difference(double a, double b) {
  return Expansion<2>(two_sum(a, -b));
}

namespace detail {

template <std::size_t A, std::size_t B, std::size_t N>
void sum_into(const Expansion<A>& a, const Expansion<B>& b, double sign, Expansion<N>& h) {
  std::size_t i = 0, j = 0;
  const auto next = [&] {  // merges by magnitude
    if (j == b.size || (i < a.size && std::abs(a.part[i]) <= std::abs(b.part[j]))) return a.part[i++];
    return sign * b.part[j++];
  };
  h.size = 0;
  if (a.size + b.size == 0) return;
  double q = next();
  while (i < a.size || j < b.size) {
    const Pair s = two_sum(q, next());
    h.push(s.lo);
    q = s.hi;
  }
  h.push(q);
}

}  // namespace detail

template <std::size_t A, std::size_t B>
[[nodiscard]] Expansion<A + B> operator+(const Expansion<A>& a, const Expansion<B>& b) {
  Expansion<A + B> h;
  detail::sum_into(a, b, 1, h);
  return h;
}

template <std::size_t A, std::size_t B>
[[nodiscard]] Expansion<A + B> operator-(const Expansion<A>& a, const Expansion<B>& b) {
  Expansion<A + B> h;
  detail::sum_into(a, b, -1, h);
  return h;
}

template <std::size_t A>
[[nodiscard]] Expansion<2 * A> operator*(const Expansion<A>& a, double b) {
  Expansion<2 * A> h;
  if (a.size == 0 || b == 0) return h;
  Pair q = two_product(a.part[0], b);
  h.push(q.lo);
  for (std::size_t i = 1; i < a.size; ++i) {
    const Pair p = two_product(a.part[i], b), s = two_sum(q.hi, p.lo);
    h.push(s.lo);
    q = fast_two_sum(p.hi, s.hi);
    h.push(q.lo);
  }
  h.push(q.hi);
  return h;
}

template <std::size_t A, std::size_t B>
[[nodiscard]] Expansion<2 * A * B> operator*(const Expansion<A>& a, const Expansion<B>& b) {
  Expansion<2 * A * B> sum, next;
  for (std::size_t i = 0; i < b.size; ++i) {
    detail::sum_into(sum, a * b.part[i], 1, next);
    sum.size = next.size;
    for (std::size_t k = 0; k < next.size; ++k) sum.part[k] = next.part[k];
  }
  return sum;
}

}  // namespace tunica::meshing
