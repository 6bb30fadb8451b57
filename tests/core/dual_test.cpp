// SPDX-License-Identifier: MIT
#include "tunica/core/dual.hpp"

#include <doctest/doctest.h>
#include <Eigen/LU>

#include <cmath>

using namespace tunica;

TEST_SUITE("unit") {
  TEST_CASE("core: dual functions have their derivatives") {
    using D = Dual<double, 1>;
    const double x = 0.7, h = 1e-5;
    const auto check = [&](auto f) {
      const double central = (f(D(x + h)).value - f(D(x - h)).value) / (2 * h);
      const D y = f(D::variable(x, 0));
      CHECK(y.d[0] == doctest::Approx(central).epsilon(1e-8));
      CHECK(y.value == f(D(x)).value);
    };
    check([](const D& a) { return sqrt(a); });
    check([](const D& a) { return cbrt(a); });
    check([](const D& a) { return exp(a); });
    check([](const D& a) { return log(a); });
    check([](const D& a) { return sin(a); });
    check([](const D& a) { return cos(a); });
    check([](const D& a) { return pow(a, -2.0 / 3); });
    check([](const D& a) { return abs(-a) / (1 + a * a) - 2 / a; });
    D c = D::variable(x, 0);
    c += 1, c *= 2, c -= 3, c /= 4;
    CHECK(c.value == doctest::Approx((2 * (x + 1) - 3) / 4));
    CHECK(c.d[0] == doctest::Approx(0.5));
    CHECK(D::variable(1, 0) < D(2));
  }

  TEST_CASE("core: nested duals give the Hessian") {
    using D = Dual<double, 2>;
    using DD = Dual<D, 2>;
    const double x = 0.3, y = 1.2;
    const DD a = DD::variable(D::variable(x, 0), 0), b = DD::variable(D::variable(y, 1), 1);
    const DD f = a * a * b + exp(a) / b;
    CHECK(f.value.value == doctest::Approx(x * x * y + std::exp(x) / y));
    CHECK(f.d[0].value == doctest::Approx(2 * x * y + std::exp(x) / y));
    CHECK(f.d[0].d[0] == doctest::Approx(2 * y + std::exp(x) / y));
    CHECK(f.d[0].d[1] == doctest::Approx(2 * x - std::exp(x) / (y * y)));
    CHECK(f.d[1].d[0] == doctest::Approx(f.d[0].d[1]));
    CHECK(f.d[1].d[1] == doctest::Approx(2 * std::exp(x) / (y * y * y)));
  }

  TEST_CASE("core: duals work in Eigen matrices") {
    using D = Dual<double, 9>;
    Eigen::Matrix3d A;
    A << 2, .3, -.1, .4, 1.5, .2, 0, -.6, 1.1;
    Eigen::Matrix<D, 3, 3> F;
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 3; ++i) F(i, j) = D::variable(A(i, j), 3 * j + i);
    const D J = F.determinant();
    const Eigen::Matrix3d cofactor = A.determinant() * A.inverse().transpose();  // dJ/dF = J F^-T
    for (int k = 0; k < 9; ++k)
      CHECK(J.d[static_cast<std::size_t>(k)] == doctest::Approx(cofactor(k % 3, k / 3)).epsilon(1e-14));
    const Eigen::Matrix<D, 3, 3> one = F * F.inverse();
    CHECK(one(1, 1).value == doctest::Approx(1));
    for (const double d : one(0, 2).d) CHECK(std::abs(d) < 1e-14);
  }
}
