// SPDX-License-Identifier: MIT
// The switch of tension: fibres that are pressed do nothing, smoothly, and the wall stays elliptic.
#include "support/laws.hpp"
#include "tunica/core/tensor.hpp"
#include "tunica/solid/fibre_laws.hpp"
#include "tunica/solid/hyperelastic.hpp"
#include "tunica/solid/laws.hpp"
#include "tunica/solid/volumetric.hpp"

#include <doctest/doctest.h>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

using namespace tunica;

namespace {

constexpr solid::HolzapfelGasserOgden media{.c = 3.0e3, .k1 = 2.3632e3, .k2 = .8393};
constexpr solid::GasserOgdenHolzapfel spread{.c = 7.64e3, .k1 = 996.6e3, .k2 = 524.6, .kappa = .226};

/// The least eigenvalue of the acoustic tensors n_J A_iJkL n_L over directions n of a sphere [Pa].
double least_acoustic(const std::array<double, 81>& A) {
  double least = std::numeric_limits<double>::infinity();
  for (int a = 0; a <= 18; ++a)
    for (int b = 0; b < 36; ++b) {
      const double t = a * std::numbers::pi / 36, f = b * std::numbers::pi / 18;
      const Vec3 n(std::sin(t) * std::cos(f), std::sin(t) * std::sin(f), std::cos(t));
      Eigen::Matrix3d Q = Eigen::Matrix3d::Zero();
      for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k)
          for (int J = 0; J < 3; ++J)
            for (int L = 0; L < 3; ++L)
              Q(i, k) += n[J] * n[L] * A[static_cast<std::size_t>(9 * (3 * i + J) + 3 * k + L)];
      least = std::min(least, Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(Q).eigenvalues()[0]);
    }
  return least;
}

/// The same energy without the switch: fibres that push back.
struct Unswitched {
  double c, k1, k2;
  static constexpr std::array reads{solid::Invariant::I1, solid::Invariant::I4, solid::Invariant::I6};
  template <class S>
  using Point = solid::Fibres<S, 2>;
  template <class S>
  [[nodiscard]] S energy(const std::array<S, 3>& I) const {
    using std::exp;
    const auto f = [&](const S& e) { return S(k1 / (2 * k2)) * (exp(S(k2) * e * e) - S(1)); };
    return S(c / 2) * (I[0] - S(3)) + f(I[1] - S(1)) + f(I[2] - S(1));
  }
};

}  // namespace

TEST_SUITE("hard") {
  TEST_CASE("solid: the switch of tension keeps energy and stress whole and the stiffness one-sided") {
    // Stretch l along a single family, l^-1/2 across: I4 = l^2 passes 1, and with dispersion E passes 0, at l
    // = 1.
    solid::Fibres<double, 2> fibre;
    fibre.set(0, {1, 0, 0});
    const auto stretched = [](double l) {
      const double w = 1 / std::sqrt(l);
      return Tensor<double>{.m = {l, 0, 0, 0, w, 0, 0, 0, w}};
    };
    const auto check = [&](const auto& law, double ground, double jump) {
      const solid::NeoHooke soft{.c10 = ground / 2};
      constexpr double h = 1e-7;
      const auto above = solid::response(law, stretched(1 + h), fibre);
      const auto below = solid::response(law, stretched(1 - h), fibre);
      const auto plain = solid::response(soft, stretched(1 - h));
      for (std::size_t k = 0; k < 9; ++k) {
        CHECK(std::abs(above.P.m[k] - below.P.m[k]) < 10 * h * test::largest(above.A));
        CHECK(std::abs(below.P.m[k] - plain.P.m[k]) <
              1e-14 * test::largest(plain.A));  // pressed: the ground alone
      }
      CHECK(std::abs(solid::energy(law, stretched(1 + h), fibre) -
                     solid::energy(law, stretched(1 - h), fibre)) < 100 * h * h * jump);
      for (std::size_t k = 0; k < 81; ++k)
        CHECK(std::abs(below.A[k] - plain.A[k]) < 1e-14 * test::largest(plain.A));
      // dP_xx/dF_xx jumps by k1 (dE/dF_xx)^2 = k1 (1 - 3 kappa)^2 (4/3)^2, as dI4/dF_xx = 2 - 2/3 there.
      CHECK(above.A[0] - below.A[0] == doctest::Approx(jump).epsilon(1e-4));
      // At the switch itself it is that of compression: one value, not a mean.
      const auto on = solid::response(law, identity<double>(), fibre);
      CHECK(on.A[0] == doctest::Approx(below.A[0]).epsilon(1e-5));
    };
    check(media, media.c, media.k1 * 16 / 9);
    const double along = 1 - 3 * spread.kappa;
    check(spread, spread.c, spread.k1 * along * along * 16 / 9);

    // With dispersion E, not I4, throws the switch: here I4 < 1 and E > 0, and the fibres pull.
    const Tensor<double> F{.m = {0.99, 0, 0, 0, 1.3, 0, 0, 0, 1 / (0.99 * 1.3)}};
    const double I1 = double_dot(F, F), E = spread.kappa * (I1 - 3) + along * (0.99 * 0.99 - 1);
    REQUIRE(E > 0);
    const double want =
        spread.c / 2 * (I1 - 3) + spread.k1 / (2 * spread.k2) * (std::exp(spread.k2 * E * E) - 1);
    CHECK(solid::energy(spread, F, fibre) == doctest::Approx(want));
  }

  TEST_CASE("solid: fibres with the switch of tension stay elliptic under compression") {
    // From 0.4 to 1.3 of the length along the bisector of the families, alone and with shear.
    const solid::Quadratic bulk{.kappa = 3e6};
    const auto along_path = [&](const auto& law, double angle) {
      double least = std::numeric_limits<double>::infinity();
      for (double l = 0.4; l < 1.31; l += 0.05)
        for (const double g : {0.0, 0.3}) {
          const double w = 1 / std::sqrt(l);
          const Tensor<double> F{.m = {l, g, 0, 0, w, 0, 0, 0, w}};
          const auto r = solid::response(solid::Hyperelastic{law, bulk}, F, test::crossed(angle));
          least = std::min(least, least_acoustic(r.A));
        }
      return least;
    };
    const solid::HolzapfelGasserOgden stiff{.c = 3e3, .k1 = 200e3, .k2 = 20};
    const solid::GasserOgdenHolzapfel dispersed{.c = 7.64e3, .k1 = 996.6e3, .k2 = 20, .kappa = .1};
    for (const double angle : {0.0, 0.5, 0.9}) {
      const double a = along_path(stiff, angle), b = along_path(dispersed, angle);
      MESSAGE("angle " << angle << ": least eigenvalue " << a / stiff.c << " c and " << b / dispersed.c
                       << " c");
      CHECK(a > 0);
      CHECK(b > 0);
    }
    // The control: fibres that push back lose it.
    CHECK(along_path(Unswitched{.c = 3e3, .k1 = 200e3, .k2 = 20}, 0.0) < 0);
  }
}
