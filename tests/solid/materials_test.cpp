// SPDX-License-Identifier: MIT
#include "support/laws.hpp"
#include "tunica/core/dual.hpp"
#include "tunica/solid/compressible_laws.hpp"
#include "tunica/solid/fibre_laws.hpp"
#include "tunica/solid/guccione_law.hpp"
#include "tunica/solid/hyperelastic.hpp"
#include "tunica/solid/isochoric_law.hpp"
#include "tunica/solid/laws.hpp"
#include "tunica/solid/volumetric.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <string>

using namespace tunica;

namespace {

constexpr solid::NeoHooke neo_hooke{.c10 = 1e3};
constexpr solid::MooneyRivlin mooney_rivlin{.c10 = 1e3, .c01 = 5e2};
constexpr solid::Yeoh yeoh{.c10 = 174e3, .c20 = 1880e3};
constexpr solid::Demiray demiray{.mu = 2e3, .a = 1.3};
constexpr solid::HolzapfelGasserOgden hgo{.c = 3e3, .k1 = 2.3632e3, .k2 = .8393};
constexpr solid::GasserOgdenHolzapfel goh{.c = 7.64e3, .k1 = 996.6e3, .k2 = 5.24, .kappa = .226};
constexpr solid::Guccione guccione{.C = 2e3, .bf = 8, .bt = 2, .bfs = 4};
constexpr solid::CompressibleNeoHooke compressible{.mu = 3e3, .lambda = 5e3};
constexpr solid::StVenantKirchhoff kirchhoff{.mu = 3e3, .lambda = 5e3};
constexpr solid::Quadratic bulk{.kappa = 4e5};

/// Each law of the library, with a name and what its point holds.
template <class Visit>
void for_each_law(const Visit& visit) {
  const auto fibres = test::crossed(0.5);
  const auto frame = test::frame(0.4, 0.9);
  visit("neo-Hooke", neo_hooke, solid::NoPoint<double>{});
  visit("Mooney-Rivlin", mooney_rivlin, solid::NoPoint<double>{});
  visit("Yeoh", yeoh, solid::NoPoint<double>{});
  visit("Demiray", demiray, solid::NoPoint<double>{});
  visit("Holzapfel-Gasser-Ogden", hgo, fibres);
  visit("Gasser-Ogden-Holzapfel", goh, fibres);
  visit("Guccione", guccione, frame);
  visit("Guccione of J^-1/3 F", solid::Isochoric{guccione}, frame);
  visit("compressible neo-Hooke", compressible, solid::NoPoint<double>{});
  visit("St Venant-Kirchhoff", kirchhoff, solid::NoPoint<double>{});
  visit("Mooney-Rivlin and quadratic", solid::Hyperelastic{mooney_rivlin, bulk}, solid::NoPoint<double>{});
  visit("Yeoh and logarithmic", solid::Hyperelastic{yeoh, solid::Logarithmic{.kappa = 3e6}},
        solid::NoPoint<double>{});
  visit("HGO and Simo-Taylor", solid::Hyperelastic{hgo, solid::SimoTaylor{.kappa = 3e5}}, fibres);
}

/// A user's: an energy in ten lines and nothing else.
struct Mine {
  double mu, lambda;
  template <class S>
  [[nodiscard]] S energy(const Tensor<S>& F) const {
    using std::log;
    const S l = log(determinant(F));
    return S(0.5 * mu) * (double_dot(F, F) - S(3)) - S(mu) * l + S(0.5 * lambda) * l * l;
  }
};

/// One that gives its stress.
struct MineByStress {
  double mu, lambda;
  template <class S>
  [[nodiscard]] Tensor<S> stress(const Tensor<S>& F) const {
    return solid::CompressibleNeoHooke{mu, lambda}.stress(F);
  }
};

/// J^-1/3 of it is 1: stretches a along x, b along y, 1/(a b) along z.
Tensor<double> stretched(double a, double b) {
  return {.m = {a, 0, 0, 0, b, 0, 0, 0, 1 / (a * b)}};
}

/// sigma_xx - sigma_zz and sigma_xy: what a pressure leaves as it is.
double difference(const auto& law, const Tensor<double>& F, const auto& point) {
  const auto s = test::cauchy(solid::stress(law, F, point), F);
  return s(0, 0) - s(2, 2);
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("solid: written derivatives of every law are those of its energy") {
    for_each_law([](const std::string& name, const auto& law, const auto& point) {
      const auto e = test::errors_of(law, point);
      MESSAGE(name << ": duals " << e.duals << " differences " << e.differences << " frame " << e.frame
                   << " symmetry " << e.symmetry);
      CHECK(e.duals < 1e-10);
      CHECK(e.differences < 1e-7);
      CHECK(e.frame < 1e-12);
      CHECK(e.symmetry < 1e-12);
    });
  }

  TEST_CASE("solid: laws are free of energy and stress at rest and stiff against every shear") {
    const auto one = identity<double>();
    for_each_law([&](const std::string& name, const auto& law, const auto& point) {
      CAPTURE(name);
      const auto r = solid::response(law, one, point);
      const double scale = test::largest(r.A);
      CHECK(std::abs(solid::energy(law, one, point)) < 1e-15 * scale);
      for (const double p : r.P.m) CHECK(std::abs(p) < 1e-14 * scale);
      for (int i = 0; i < 3; ++i) {  // 2 e_xy e_xy: A_xyxy + 2 A_xyyx + A_yxyx, positive but not for turning
        const int j = (i + 1) % 3;
        const auto a = [&](int m, int n) { return r.A[static_cast<std::size_t>(9 * m + n)]; };
        const int ij = 3 * i + j, ji = 3 * j + i;
        CHECK(a(ij, ij) + 2 * a(ij, ji) + a(ji, ji) > 1e-4 * scale);
        CHECK(std::abs(a(ij, ij) - 2 * a(ij, ji) + a(ji, ji)) < 1e-13 * scale);
      }
    });
  }

  TEST_CASE("solid: small strains find the shear and bulk moduli that the laws are said to have") {
    const auto one = identity<double>();
    const auto shear = [&](const auto& law) { return solid::response(law, one).A[9 + 1]; };  // A_xyxy
    const auto axial = [&](const auto& law) { return solid::response(law, one).A[0]; };      // A_xxxx
    CHECK(shear(neo_hooke) == doctest::Approx(2 * neo_hooke.c10));
    CHECK(shear(mooney_rivlin) == doctest::Approx(2 * (mooney_rivlin.c10 + mooney_rivlin.c01)));
    CHECK(shear(yeoh) == doctest::Approx(2 * yeoh.c10));
    CHECK(shear(demiray) == doctest::Approx(demiray.mu));
    CHECK(shear(compressible) == doctest::Approx(compressible.mu));
    CHECK(shear(kirchhoff) == doctest::Approx(kirchhoff.mu));
    CHECK(axial(compressible) == doctest::Approx(compressible.lambda + 2 * compressible.mu));
    CHECK(axial(kirchhoff) == doctest::Approx(kirchhoff.lambda + 2 * kirchhoff.mu));
    CHECK(axial(demiray) == doctest::Approx(4 * demiray.mu / 3));
    CHECK(axial(solid::Hyperelastic{demiray, bulk}) == doctest::Approx(bulk.kappa + 4 * demiray.mu / 3));
  }

  TEST_CASE("solid: stretches and shears have the stresses of the textbook") {
    // Incompressible, isotropic: s_x - s_z = 2 (l_x^2 - l_z^2)(W1 + l_y^2 W2), and s_xy = 2 g (W1 + W2).
    constexpr double l = 1.37, g = 0.8;
    const auto isotropic = [&](const auto& law, const auto& W1, double W2) {
      const solid::NoPoint<double> none;
      const auto want = [&](double x, double y) {
        const double z = 1 / (x * y), I1 = x * x + y * y + z * z;
        return 2 * (x * x - z * z) * (W1(I1) + y * y * W2);
      };
      const double uniaxial = 1 / std::sqrt(l);
      CHECK(difference(law, stretched(l, uniaxial), none) ==
            doctest::Approx(want(l, uniaxial)).epsilon(1e-12));
      CHECK(difference(law, stretched(l, l), none) == doctest::Approx(want(l, l)).epsilon(1e-12));
      CHECK(difference(law, stretched(l, 1), none) == doctest::Approx(want(l, 1)).epsilon(1e-12));
      const Tensor<double> F{.m = {1, g, 0, 0, 1, 0, 0, 0, 1}};
      const auto s = test::cauchy(solid::stress(law, F, none), F);
      CHECK(s(0, 1) == doctest::Approx(2 * g * (W1(3 + g * g) + W2)).epsilon(1e-12));
      CHECK(s(0, 0) - s(1, 1) == doctest::Approx(g * s(0, 1)).epsilon(1e-12));  // universal relation
    };
    isotropic(
        neo_hooke, [](double) { return neo_hooke.c10; }, 0);
    isotropic(
        mooney_rivlin, [](double) { return mooney_rivlin.c10; }, mooney_rivlin.c01);
    isotropic(
        yeoh, [](double I1) { return yeoh.c10 + 2 * yeoh.c20 * (I1 - 3); }, 0);
    isotropic(
        demiray, [](double I1) { return demiray.mu / 2 * std::exp(demiray.a * (I1 - 3)); }, 0);

    // Uniaxial strain F = diag(l, 1, 1) of the laws of the whole F.
    const Tensor<double> F{.m = {l, 0, 0, 0, 1, 0, 0, 0, 1}};
    const auto P = solid::stress(compressible, F);
    CHECK(P(0, 0) == doctest::Approx(compressible.mu * (l - 1 / l) + compressible.lambda * std::log(l) / l));
    CHECK(P(1, 1) == doctest::Approx(compressible.lambda * std::log(l)));
    const double E = (l * l - 1) / 2;
    CHECK(solid::stress(kirchhoff, F)(0, 0) ==
          doctest::Approx(l * E * (kirchhoff.lambda + 2 * kirchhoff.mu)));
    // Guccione along and across the fibres: S = C b E exp(b E^2)
    const auto k = [&](double b) { return l * guccione.C * b * E * std::exp(b * E * E); };
    CHECK(solid::stress(guccione, F, test::frame(0, 0))(0, 0) == doctest::Approx(k(guccione.bf)));
    solid::Fibres<double, 3> across;  // the fibre along y
    across.set(0, {0, 1, 0}), across.set(1, {0, 0, 1}), across.set(2, {1, 0, 0});
    CHECK(solid::stress(guccione, F, across)(0, 0) == doctest::Approx(k(guccione.bt)));
    const Tensor<double> sheared{.m = {1, g, 0, 0, 1, 0, 0, 0, 1}};  // E_xy = g/2, E_yy = g^2/2
    const double Q = guccione.bt * std::pow(g * g / 2, 2) + 2 * guccione.bfs * g * g / 4;
    CHECK(solid::stress(guccione, sheared, test::frame(0, 0))(1, 0) ==
          doctest::Approx(guccione.C * std::exp(Q) * guccione.bfs * g / 2));
  }

  TEST_CASE("solid: a law of ten lines of energy or of its stress has P and A by duals") {
    for (const auto& F : test::states) {
      const auto want = compressible.response(F);
      const double scale = test::largest(want.A);
      const auto by_energy = solid::response(Mine{compressible.mu, compressible.lambda}, F);
      const auto by_stress = solid::response(MineByStress{compressible.mu, compressible.lambda}, F);
      const auto P = solid::stress(Mine{compressible.mu, compressible.lambda}, F);
      for (std::size_t p = 0; p < 9; ++p) {
        CHECK(std::abs(by_energy.P.m[p] - want.P.m[p]) < 1e-13 * scale);
        CHECK(std::abs(by_stress.P.m[p] - want.P.m[p]) < 1e-13 * scale);
        CHECK(std::abs(P.m[p] - want.P.m[p]) < 1e-13 * scale);
      }
      for (std::size_t p = 0; p < 81; ++p) {
        CHECK(std::abs(by_energy.A[p] - want.A[p]) < 1e-13 * scale);
        CHECK(std::abs(by_stress.A[p] - want.A[p]) < 1e-13 * scale);
      }
    }
  }

  TEST_CASE("solid: a pair gives its isochoric part apart, which does not see the volume") {
    const solid::Hyperelastic pair{hgo, bulk};
    const auto fibres = test::crossed(0.5);
    for (const auto& F : test::states) {
      const auto part = pair.isochoric_part(F, fibres);
      CHECK(std::abs(double_dot(part.P, F)) < 1e-12 * test::largest(part.A));  // tr tau = 0
      const double W = solid::energy(hgo, F, fibres);
      CHECK(std::abs(solid::energy(hgo, 1.7 * F, fibres) - W) < 1e-15 * test::largest(part.A) + 1e-14 * W);
      const double J = determinant(F);
      const auto P = part.P + bulk.slope(J) * cofactor(F);
      const auto all = solid::stress(pair, F, fibres);
      for (std::size_t p = 0; p < 9; ++p)
        CHECK(std::abs(P.m[p] - all.m[p]) < 1e-14 * test::largest(solid::response(pair, F, fibres).A));
    }
  }

  TEST_CASE(
      "solid: volumetric laws have the derivatives of their energy at five volumes and one bulk modulus") {
    using D = Dual<double, 1>;
    using DD = Dual<D, 1>;
    const auto check = [](const auto& law) {
      for (const double J : {0.6, 0.9, 1.0, 1.1, 1.7}) {
        const DD U = law.energy(DD::variable(D::variable(J, 0), 0));
        CHECK(std::abs(law.energy(J) - U.value.value) < 1e-14 * law.kappa);
        CHECK(std::abs(law.slope(J) - U.d[0].value) < 1e-14 * law.kappa);
        CHECK(std::abs(law.curvature(J) - U.d[0].d[0]) < 1e-13 * law.kappa);
        CHECK((J == 1 || law.energy(J) > 0));
        CHECK((J == 1 ? law.slope(J) == 0 : law.slope(J) * (J - 1) > 0));  // it pulls back from both sides
      }
      CHECK(law.energy(1.0) == 0);
      CHECK(std::abs(law.curvature(1.0) - law.kappa) < 1e-15 * law.kappa);
    };
    check(solid::Quadratic{.kappa = 7e5}), check(solid::Logarithmic{.kappa = 7e5});
    check(solid::SimoTaylor{.kappa = 7e5});
  }

  TEST_CASE("solid: slopes that a law writes are those of duals") {
    const auto check = [](const auto& law, const auto& I) {
      const auto own = law.slopes(I), dual = solid::dual_slopes(law, I);
      for (std::size_t k = 0; k < I.size(); ++k) {
        CHECK(own.first[k] == doctest::Approx(dual.first[k]).epsilon(1e-12));
        for (std::size_t l = 0; l < I.size(); ++l)
          CHECK(own.second[k][l] == doctest::Approx(dual.second[k][l]).epsilon(1e-12));
      }
    };
    for (const double e : {0.0, 0.2, 1.1}) {
      const std::array one{3 + e};
      check(neo_hooke, one), check(yeoh, one), check(demiray, one);
      check(mooney_rivlin, std::array{3 + e, 3 + 0.9 * e});
      for (const double a : {0.7, 0.99, 1.01, 1.6})
        for (const double b : {0.8, 1.3})
          check(hgo, std::array{3 + e, a, b}), check(goh, std::array{3 + e, a, b});
    }
  }
}
