// SPDX-License-Identifier: MIT
#include "tunica/fem/shape.hpp"
#include "tunica/core/types.hpp"
#include "tunica/fem/geometry.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

using namespace tunica;

namespace {

template <class C>
fem::LocalPoint<C::dim> random_point(std::mt19937& random) {
  std::uniform_real_distribution<double> u(0.05, 0.3);
  fem::LocalPoint<C::dim> xi;
  for (double& x : xi) x = u(random);
  return xi;
}

template <class C>
fem::LocalPoint<C::dim> corner(std::size_t a) {
  fem::LocalPoint<C::dim> xi{};
  if constexpr (C::nodes == C::dim + 1) {
    if (a > 0) xi[a - 1] = 1;
  } else {
    for (std::size_t i = 0; i < C::dim; ++i) xi[i] = fem::detail::corners<C::dim, C::nodes>[a][i];
  }
  return xi;
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE_TEMPLATE("fem: shape functions interpolate and sum to one", C, mesh::Tri3, mesh::Quad4,
                     mesh::Tet4, mesh::Hex8) {
    using S = fem::Lagrange<C>;
    static_assert(fem::Shape<S>);
    for (std::size_t a = 0; a < C::nodes; ++a) {
      const auto N = S::values(corner<C>(a));
      for (std::size_t b = 0; b < C::nodes; ++b) CHECK(N[b] == (a == b ? 1 : 0));
    }
    std::mt19937 random(1);
    for (int trial = 0; trial < 10; ++trial) {
      const auto xi = random_point<C>(random);
      const auto N = S::values(xi);
      const auto G = S::gradients(xi);
      double sum = 0;
      for (const double v : N) sum += v;
      CHECK(sum == doctest::Approx(1).epsilon(1e-15));
      for (std::size_t i = 0; i < C::dim; ++i) {
        double zero = 0;
        for (std::size_t a = 0; a < C::nodes; ++a) {
          zero += G[a][i];
          auto up = xi, down = xi;
          up[i] += 1e-4, down[i] -= 1e-4;
          const double slope = (S::values(up)[a] - S::values(down)[a]) / 2e-4;
          CHECK(std::abs(slope - G[a][i]) < 1e-11);
        }
        CHECK(std::abs(zero) < 1e-15);
      }
    }
  }

  TEST_CASE_TEMPLATE("fem: the map of an affine cell has exact gradients and volume", C, mesh::Quad4,
                     mesh::Tet4, mesh::Hex8) {
    constexpr int dim = C::dim;
    using Rule = fem::Gauss<C, 1>;
    using Tables = fem::Tables<fem::Lagrange<C>, Rule>;
    Eigen::Matrix<double, dim, dim> A = Eigen::Matrix<double, dim, dim>::Identity();
    A(0, 1) = 0.4, A(1, 0) = -0.3, A(0, 0) = 2;
    Eigen::Matrix<double, dim, C::nodes> X;
    for (int a = 0; a < C::nodes; ++a) {
      const auto xi = corner<C>(static_cast<std::size_t>(a));
      X.col(a) = A * Eigen::Map<const Point<dim>>(xi.data());
    }
    const auto map = fem::map_point<double, dim>(X, Tables::gradients[0]);
    CHECK(map.det == doctest::Approx(A.determinant()));
    // sum_a X_a x grad N_a = 1
    CHECK((X * map.gradient.transpose() - Eigen::Matrix<double, dim, dim>::Identity()).norm() < 1e-14);
  }
}
