// SPDX-License-Identifier: MIT
#include "tunica/core/tensor.hpp"
#include "tunica/core/dual.hpp"
#include "tunica/core/select.hpp"

#include <doctest/doctest.h>
#include <Eigen/LU>

#include <cmath>

using namespace tunica;

namespace {

const Tensor<double> A{.m = {1.2, .3, -.1, .2, .9, .15, -.05, .1, 1.1}};
const Tensor<double> B{.m = {.7, -2, .4, 1, .1, -.6, .3, .2, -1.5}};

Eigen::Matrix3d eigen(const Tensor<double>& a) {
  Eigen::Matrix3d m;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) m(i, j) = a(i, j);
  return m;
}

double distance(const Tensor<double>& a, const Eigen::Matrix3d& b) {
  return (eigen(a) - b).cwiseAbs().maxCoeff();
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("core: tensors have the algebra of matrices") {
    const Eigen::Matrix3d a = eigen(A), b = eigen(B);
    CHECK(distance(A + B, a + b) == 0);
    CHECK(distance(A - B, a - b) == 0);
    CHECK(distance(2.5 * A, 2.5 * a) == 0);
    CHECK(distance(A * 2.5, 2.5 * a) == 0);
    CHECK(distance(transpose(B), b.transpose()) == 0);
    CHECK(distance(identity<double>(), Eigen::Matrix3d::Identity()) == 0);
    CHECK(distance(product(A, B), a * b) < 1e-15);
    CHECK(distance(transpose_product(A, B), a.transpose() * b) < 1e-15);
    CHECK(distance(inverse(B), b.inverse()) < 1e-14);
    CHECK(distance(cofactor(B), b.determinant() * b.inverse().transpose()) < 1e-14);
    CHECK(determinant(B) == doctest::Approx(b.determinant()).epsilon(1e-15));
    CHECK(trace(A) == a.trace());
    CHECK(double_dot(A, B) == doctest::Approx(a.cwiseProduct(b).sum()).epsilon(1e-15));
    const Vector3<double> x{1, -2, 3}, y{.5, .25, -4};
    CHECK(distance(dyad(x, y), Eigen::Vector3d(1, -2, 3) * Eigen::RowVector3d(.5, .25, -4)) == 0);
    CHECK(dot(x, y) == 0.5 - 0.5 - 12);
    const auto Ax = product(A, x);
    const Eigen::Vector3d ax = a * Eigen::Vector3d(1, -2, 3);
    for (int i = 0; i < 3; ++i)
      CHECK(Ax[static_cast<std::size_t>(i)] == doctest::Approx(ax[i]).epsilon(1e-15));
    Tensor<double> C = A;
    C(0, 2) = 7;
    CHECK(C.m[2] == 7);
    CHECK(distance(C, a) > 7);
    // A singular one has cofactors: of diag(1, 1, 0) that of the third axis alone.
    const Tensor<double> flat{.m = {1, 0, 0, 0, 1, 0, 0, 0, 0}};
    CHECK(cofactor(flat).m == std::array<double, 9>{0, 0, 0, 0, 0, 0, 0, 0, 1});
  }

  TEST_CASE("core: tensors of duals carry derivatives and branches are taken by value") {
    using D = Dual<double, 9>;
    Tensor<D> F;
    for (int k = 0; k < 9; ++k)
      F.m[static_cast<std::size_t>(k)] = D::variable(A.m[static_cast<std::size_t>(k)], k);
    const D J = determinant(F);  // dJ/dF = cof F
    const auto cof = cofactor(A);
    for (std::size_t k = 0; k < 9; ++k) CHECK(J.d[k] == doctest::Approx(cof.m[k]).epsilon(1e-14));
    const auto one = product(F, inverse(F));
    for (std::size_t k = 0; k < 9; ++k) {
      CHECK(one.m[k].value == doctest::Approx(k % 4 == 0 ? 1 : 0));
      for (const double d : one.m[k].d) CHECK(std::abs(d) < 1e-14);
    }
    CHECK(cast<float>(A).m[1] == 0.3F);
    CHECK(cast<D>(A).m[1].d[1] == 0);

    const auto ramp = [](const D& x) { return select(x > D(0), x * x, D(0)); };
    CHECK(ramp(D::variable(3, 4)).d[4] == 6);
    CHECK(ramp(D::variable(-3, 4)).d[4] == 0);
    CHECK(select(true, 1.5F, 2.5F) == 1.5F);
    CHECK(abs(D::variable(-2, 0)).d[0] == -1);
    using DD = Dual<Dual<double, 1>, 1>;
    const DD x = DD::variable(Dual<double, 1>::variable(-0.5, 0), 0);
    const DD y = select(x < DD(0), x * x * x, x);
    CHECK(y.d[0].d[0] == -3);
  }
}
