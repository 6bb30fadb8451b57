// SPDX-License-Identifier: MIT
#include "tunica/core/pack.hpp"
#include "tunica/core/dual.hpp"
#include "tunica/core/pack_math.hpp"

#include <doctest/doctest.h>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

using namespace tunica;

namespace {

template <class P>
using Number = typename P::value_type;

/// |got - exact| in units in the last place of the exact value, which long double holds.
template <class T>
double ulps(T got, long double exact) {
  const T rounded = static_cast<T>(exact);
  if (std::isinf(rounded) || std::isinf(got)) return got == rounded ? 0 : 1e30;
  int exponent = 0;
  std::frexp(std::abs(exact), &exponent);
  const int digits = std::numeric_limits<T>::digits, least = std::numeric_limits<T>::min_exponent;
  const long double ulp = std::ldexp(1.0L, std::max(exponent, least) - digits);
  return static_cast<double>(std::abs(static_cast<long double>(got) - exact) / ulp);
}

/// The largest error of f over numbers x in ulp, each lane on its own.
template <class P, class F, class Exact>
double worst_ulps(const std::vector<Number<P>>& xs, F f, Exact exact) {
  double worst = 0;
  for (std::size_t k = 0; k + P::size <= xs.size(); k += P::size) {
    const P y = f(P::load(xs.data() + k));
    for (int l = 0; l < P::size; ++l)
      worst =
          std::max(worst, ulps(y[l], exact(static_cast<long double>(xs[k + static_cast<std::size_t>(l)]))));
  }
  return worst;
}

/// Positive numbers whose exponents cover all of T, denormals too, and many near 1.
template <class T>
std::vector<T> all_sizes() {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> mantissa(1, 2), near_one(0.5, 2);
  std::vector<T> x;
  for (int e = std::numeric_limits<T>::min_exponent - std::numeric_limits<T>::digits;
       e < std::numeric_limits<T>::max_exponent; ++e)
    for (int k = 0; k < 32; ++k) x.push_back(std::ldexp(static_cast<T>(mantissa(random)), e));
  for (int k = 0; k < 64000; ++k) x.push_back(static_cast<T>(near_one(random)));
  std::erase_if(x, [](T v) { return !(v > 0) || std::isinf(v); });
  return x;
}

template <class P>
bool every(const P& a, Number<P> value) {
  bool same = true;
  for (int l = 0; l < P::size; ++l)
    same = same && (std::isnan(value) ? std::isnan(a[l])
                                      : a[l] == value && std::signbit(a[l]) == std::signbit(value));
  return same;
}

}  // namespace

// A register of any machine, less and more, and the fallback of single numbers.
using Doubles2 = Pack<double, 2>;
using Doubles4 = Pack<double, 4>;
using Doubles8 = Pack<double, 8>;
using Doubles16 = Pack<double, 16>;
using PlainDoubles8 = Pack<double, 8, 1>;
using Floats4 = Pack<float, 4>;
using Floats8 = Pack<float, 8>;
using Floats16 = Pack<float, 16>;
using Floats32 = Pack<float, 32>;
using PlainFloats8 = Pack<float, 8, 1>;
#ifndef TUNICA_PLAIN_PACKS
TYPE_TO_STRING(PlainDoubles8);
TYPE_TO_STRING(PlainFloats8);
#endif
TYPE_TO_STRING(Doubles2);
TYPE_TO_STRING(Doubles4);
TYPE_TO_STRING(Doubles8);
TYPE_TO_STRING(Doubles16);
TYPE_TO_STRING(Floats4);
TYPE_TO_STRING(Floats8);
TYPE_TO_STRING(Floats16);
TYPE_TO_STRING(Floats32);
#define TUNICA_PACKS \
  Doubles2, Doubles4, Doubles8, Doubles16, PlainDoubles8, Floats4, Floats8, Floats16, Floats32, PlainFloats8

TEST_SUITE("unit") {
  TEST_CASE_TEMPLATE("core: arithmetic of packs is that of their lanes", P, TUNICA_PACKS) {
    using T = Number<P>;
    static_assert(P::size * sizeof(T) == sizeof(P));
    std::mt19937 random(3);
    std::uniform_real_distribution<T> draw(-2, 2);
    for (int repeat = 0; repeat < 20; ++repeat) {
      const P a = P::generate([&](int) { return draw(random); }),
              b = P::generate([&](int) { return draw(random); });
      P c = a;
      c += b, c *= a, c -= T(1), c /= b;
      const auto less = a < b, both = less && a > T(0), either = less || a == a;
      const P chosen = select(a <= b, -a, 2 * b), root = sqrt(abs(a)), low = min(a, b), high = max(a, b);
      T total = 0, least = a[0], most = a[0];
      bool some = false, each = true;
      for (int l = 0; l < P::size; ++l) {
        const T x = a[l], y = b[l];
        CHECK(c[l] == doctest::Approx(((x + y) * x - 1) / y).epsilon(std::numeric_limits<T>::epsilon() * 40));
        CHECK(less[l] == (x < y));
        CHECK(both[l] == (x < y && x > 0));
        CHECK(either[l]);
        CHECK((!less)[l] == !(x < y));
        CHECK((a != b)[l] == (x != y));
        CHECK((a >= b)[l] == (x >= y));
        CHECK(chosen[l] == (x <= y ? -x : 2 * y));
        CHECK(root[l] == std::sqrt(std::abs(x)));
        CHECK(low[l] == std::min(x, y));
        CHECK(high[l] == std::max(x, y));
        total += x, least = std::min(least, x), most = std::max(most, x);
        some = some || x < y, each = each && x < y;
      }
      CHECK(sum(a) == doctest::Approx(total));
      CHECK(smallest(a) == least);
      CHECK(largest(a) == most);
      CHECK(any(less) == some);
      CHECK(all(less) == each);
      CHECK(none(less) == !some);
    }
    T row[P::size + 1];
    for (int l = 0; l <= P::size; ++l) row[l] = T(l);
    P shifted = P::load(row + 1);
    shifted.set(0, T(7));
    shifted.store(row);
    CHECK(row[0] == 7);
    CHECK(row[P::size - 1] == (P::size == 1 ? 7 : P::size));
    CHECK(every(P(T(-0.0)), T(-0.0)));
    CHECK(every(abs(P(T(-0.0))), T(0)));
    CHECK(every(P(3) - 5, T(-2)));
    CHECK(select(true, 1.0, 2.0) == 1);
  }

  TEST_CASE_TEMPLATE("core: exp and log and cbrt of packs are within their ulps of the truth", P,
                     TUNICA_PACKS) {
    using T = Number<P>;
    const auto positive = all_sizes<T>();
    std::mt19937_64 random(5);
    const T low = std::log(std::numeric_limits<T>::denorm_min()),
            high = std::log(std::numeric_limits<T>::max());
    std::uniform_real_distribution<T> whole(low, high), small(-2, 2);
    std::vector<T> any_sign;
    for (int k = 0; k < 64000; ++k) any_sign.push_back(k % 2 == 0 ? whole(random) : small(random));
    std::vector<T> signed_numbers = positive;
    for (std::size_t k = 0; k < signed_numbers.size(); k += 2) signed_numbers[k] *= -1;
    const double e = worst_ulps<P>(
        any_sign, [](const P& x) { return exp(x); }, [](long double x) { return std::exp(x); });
    const double l = worst_ulps<P>(
        positive, [](const P& x) { return log(x); }, [](long double x) { return std::log(x); });
    const double c = worst_ulps<P>(
        signed_numbers, [](const P& x) { return cbrt(x); }, [](long double x) { return std::cbrt(x); });
    MESSAGE("lanes " << P::size << " of " << sizeof(T) << " bytes: exp " << e << ", log " << l << ", cbrt "
                     << c << " ulp");
    CHECK(e <= 1);
    CHECK(l <= 1);
    CHECK(c <= 2);
  }

  TEST_CASE_TEMPLATE("core: functions of packs are right at zero and infinity and NaN", P, TUNICA_PACKS) {
    using T = Number<P>;
    constexpr T inf = std::numeric_limits<T>::infinity(), nan = std::numeric_limits<T>::quiet_NaN();
    constexpr T most = std::numeric_limits<T>::max();
    CHECK(every(exp(P(T(0))), T(1)));
    CHECK(every(exp(P(T(-0.0))), T(1)));
    CHECK(every(exp(P(inf)), inf));
    CHECK(every(exp(P(-inf)), T(0)));
    CHECK(every(exp(P(most)), inf));
    CHECK(every(exp(P(-most)), T(0)));
    CHECK(every(exp(P(nan)), nan));
    CHECK(every(log(P(T(1))), T(0)));
    CHECK(every(log(P(T(0))), -inf));
    CHECK(every(log(P(T(-0.0))), -inf));
    CHECK(every(log(P(inf)), inf));
    CHECK(every(log(P(T(-1))), nan));
    CHECK(every(log(P(-inf)), nan));
    CHECK(every(log(P(nan)), nan));
    CHECK(every(cbrt(P(T(0))), T(0)));
    CHECK(every(cbrt(P(T(-0.0))), T(-0.0)));
    CHECK(every(cbrt(P(T(-8))), T(-2)));
    CHECK(every(cbrt(P(T(27))), T(3)));
    CHECK(every(cbrt(P(inf)), inf));
    CHECK(every(cbrt(P(-inf)), -inf));
    CHECK(every(cbrt(P(nan)), nan));
    CHECK(every(sqrt(P(T(-1))), nan));
    // the last that is finite, the first that is not, and the least that is not 0
    const T edge = std::log(most);
    CHECK(exp(P(edge * (1 - std::numeric_limits<T>::epsilon())))[0] < inf);
    CHECK(every(exp(P(edge * (1 + 4 * std::numeric_limits<T>::epsilon()))), inf));
    CHECK(exp(P(std::log(std::numeric_limits<T>::denorm_min())))[0] > 0);
    CHECK(pow(P(T(1.7)), -2.0 / 3)[0] == doctest::Approx(std::pow(1.7, -2.0 / 3)).epsilon(1e-6));
  }

  TEST_CASE_TEMPLATE("core: packs work in duals and in the matrices of Eigen", P, TUNICA_PACKS) {
    using T = Number<P>;
    using D = Dual<P, 2>;
    const P x = P::generate([](int l) { return T(0.3) + T(0.1) * T(l); });
    const D a = D::variable(x, 0), b = D::variable(T(2) - x / 10, 1);
    const D f = sqrt(a) * b + exp(a) / b - log(b) * cbrt(a);
    const double eps = 50 * std::numeric_limits<T>::epsilon();
    for (int l = 0; l < P::size; ++l) {
      using S = Dual<T, 2>;
      const S as = S::variable(x[l], 0), bs = S::variable(T(2) - x[l] / 10, 1);
      const S fs = sqrt(as) * bs + exp(as) / bs - log(bs) * cbrt(as);
      CHECK(f.value[l] == doctest::Approx(fs.value).epsilon(eps));
      CHECK(f.d[0][l] == doctest::Approx(fs.d[0]).epsilon(eps));
      CHECK(f.d[1][l] == doctest::Approx(fs.d[1]).epsilon(eps));
    }
    Eigen::Matrix<P, 3, 3> F;
    for (int k = 0; k < 9; ++k) F.data()[k] = P(k % 4 == 0) + x * T(0.1) * std::sin(T(k));
    const Eigen::Matrix<P, 3, 3> I = F * F.inverse();
    const P J = F.determinant(), trace = I.trace();
    for (int l = 0; l < P::size; ++l) {
      Eigen::Matrix<T, 3, 3> lane;
      for (int k = 0; k < 9; ++k) lane.data()[k] = F.data()[k][l];
      CHECK(J[l] == doctest::Approx(lane.determinant()).epsilon(eps));
      CHECK(trace[l] == doctest::Approx(3).epsilon(eps));
    }
  }
}
