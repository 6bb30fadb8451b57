// SPDX-License-Identifier: MIT
#include "tunica/la/time_scheme.hpp"

#include <doctest/doctest.h>
#include <Eigen/Eigenvalues>

#include <cmath>

using namespace tunica;

namespace {

/// Spectral radius of the amplification matrix of (u, dt v, dt^2 a) for u'' + w^2 u = 0, z = w dt.
double spectral_radius(const la::SecondOrder& s, double z) {
  // Unknown a1: am a1 + (1-am) a0 + z^2 (u0 + af (v0 + (1/2-beta) a0 + beta a1)) = 0
  const double left = s.am + z * z * s.af * s.beta;
  const Eigen::RowVector3d a1 =
      -Eigen::RowVector3d(z * z, z * z * s.af, 1 - s.am + z * z * s.af * (0.5 - s.beta)) / left;
  Eigen::Matrix3d G;
  G.row(0) = Eigen::RowVector3d(1, 1, 0.5 - s.beta) + s.beta * a1;
  G.row(1) = Eigen::RowVector3d(0, 1, 1 - s.gamma) + s.gamma * a1;
  G.row(2) = a1;
  return G.eigenvalues().cwiseAbs().maxCoeff();
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("la: generalised alpha in the convention n + alpha") {
    const auto undamped = la::GeneralizedAlpha{.rho_inf = 1}.second_order();
    CHECK(undamped.am == 0.5);
    CHECK(undamped.af == 0.5);
    CHECK(undamped.gamma == 0.5);
    CHECK(undamped.beta == 0.25);
    const auto killing = la::GeneralizedAlpha{.rho_inf = 0}.second_order();
    CHECK(killing.am == 2);
    CHECK(killing.af == 1);
    CHECK(killing.gamma == 1.5);
    CHECK(killing.beta == 1);
    CHECK_THROWS(static_cast<void>(la::GeneralizedAlpha{.rho_inf = 1.5}.second_order()));
  }

  TEST_CASE("la: generalised alpha is stable at every step length and has its radius at infinity") {
    for (const double rho : {0.0, 0.2, 0.5, 0.8, 1.0}) {
      const auto s = la::GeneralizedAlpha{.rho_inf = rho}.second_order();
      // beyond 1e3 both eigenvalues of rho = 1 merge at -1, and the eigenvalue solver loses half its digits
      for (double z = 1e-3; z < 1e3; z *= 1.5) CHECK(spectral_radius(s, z) < 1 + 1e-9);
      CHECK(spectral_radius(s, 1e8) == doctest::Approx(rho).epsilon(1e-3).scale(1));
    }
    CHECK(spectral_radius(la::Newmark{}.second_order(), 3.0) == doctest::Approx(1));
  }

  TEST_CASE("la: BDF weights are exact for polynomials of their order") {
    for (const double ratio : {0.5, 1.0, 1.7}) {
      const auto w = la::Bdf2::weights(ratio);
      // times 1, 0, -1/ratio in units of dt
      const double t[] = {1, 0, -1 / ratio};
      double zero = 0, one = 0, two = 0;
      for (std::size_t k = 0; k < 3; ++k) zero += w[k], one += w[k] * t[k], two += w[k] * t[k] * t[k];
      CHECK(std::abs(zero) < 1e-15);
      CHECK(one == doctest::Approx(1));
      CHECK(two == doctest::Approx(2));  // d(t^2)/dt at t = 1
    }
    CHECK(la::Bdf2::weights()[0] == 1.5);
    CHECK(la::Bdf1::weights()[1] == -1);
  }
}
