// SPDX-License-Identifier: MIT
#include "tunica/core/counted.hpp"

#include <doctest/doctest.h>
#include <Eigen/LU>

#include <cmath>

using namespace tunica;

TEST_SUITE("unit") {
  TEST_CASE("core: a counted number counts each operation and computes as a double") {
    Counted::count() = {};
    Counted x = 2, y = 0.5;
    Counted z = x * y + sqrt(x) - exp(y) / log(x);
    z += 1, z -= 2, z *= x, z /= -y;
    const FlopCount n = Counted::count();
    CHECK(n.add == 4);
    CHECK(n.multiply == 2);
    CHECK(n.divide == 2);
    CHECK(n.root == 1);
    CHECK(n.function == 2);
    CHECK(n.total() == 11);
    CHECK(z.value == doctest::Approx((1 + std::sqrt(2.0) - std::exp(0.5) / std::log(2.0) - 1) * 2 / -0.5));
    CHECK((x > y && y <= x && x != y));
    CHECK(max(x, abs(-y)).value == 2);
    CHECK(Counted::count().total() == 11);
  }

  TEST_CASE("core: a product of matrices of counted numbers has its 45 operations") {
    Eigen::Matrix<Counted, 3, 3> A, B;
    for (int k = 0; k < 9; ++k) A.data()[k] = k, B.data()[k] = 1;
    Counted::count() = {};
    const Eigen::Matrix<Counted, 3, 3> C = A * B;
    CHECK(Counted::count().multiply == 27);
    CHECK(Counted::count().add == 18);
    CHECK(C(0, 0).value == 9);
    Counted::count() = {};
    CHECK(A.determinant().value == doctest::Approx(0));
    CHECK(Counted::count().total() <= 17);
  }
}
