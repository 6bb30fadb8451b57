// SPDX-License-Identifier: MIT
#include "tunica/core/jet.hpp"
#include "tunica/core/dual.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstddef>

using namespace tunica;

namespace {

/// Every operation and function once, of three variables.
template <class S>
S everything(const S& x, const S& y, const S& z) {
  S a = x * y - y / z + 2.0 * x - z * 3.0 + 1.0;
  a += exp(0.3 * x) / 2.0, a -= log(y), a *= sqrt(z), a /= cbrt(x + y);
  const S b = sin(x * z) + cos(y) * pow(z, -1.4) + abs(-x) - 0.5 + (1.0 + +z);
  return a * b + select(x > y, x * x * z, y * y * y) - S(0.7) / a;
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("core: jets have the first and second derivatives of nested duals") {
    using D = Dual<double, 3>;
    using DD = Dual<D, 3>;
    using J = Jet<double, 3>;
    for (const auto& at : {std::array{0.7, 1.3, 2.1}, std::array{1.9, 0.4, 0.8}}) {
      std::array<DD, 3> dual;
      std::array<J, 3> jet;
      for (int i = 0; i < 3; ++i) {
        const auto k = static_cast<std::size_t>(i);
        dual[k] = DD::variable(D::variable(at[k], i), i);
        jet[k] = J::variable(at[k], i);
      }
      const DD want = everything(dual[0], dual[1], dual[2]);
      const J got = everything(jet[0], jet[1], jet[2]);
      CHECK(got.value == doctest::Approx(want.value.value).epsilon(1e-14));
      for (std::size_t i = 0; i < 3; ++i) {
        CHECK(got.d[i] == doctest::Approx(want.d[i].value).epsilon(1e-13));
        for (std::size_t j = 0; j < 3; ++j)
          CHECK(got.h[J::pair(i, j)] == doctest::Approx(want.d[i].d[j]).epsilon(1e-13));
      }
      CHECK(got.value == doctest::Approx(everything(at[0], at[1], at[2])));
    }
    CHECK(J::pair(2, 1) == 4);
    CHECK(J::pair(2, 2) == J::pairs - 1);
    CHECK((J(2) == J::variable(2, 1)));
    CHECK((J(2) >= J(1) && J(1) <= J(2) && J(1) < J(2)));
  }
}
