// SPDX-License-Identifier: MIT
#include "tunica/solid/parameters.hpp"
#include "support/laws.hpp"
#include "tunica/core/dual.hpp"
#include "tunica/meshing/box.hpp"
#include "tunica/solid/compressible_laws.hpp"
#include "tunica/solid/fibre_laws.hpp"
#include "tunica/solid/guccione_law.hpp"
#include "tunica/solid/isochoric_law.hpp"
#include "tunica/solid/laws.hpp"
#include "tunica/solid/statics.hpp"
#include "tunica/solid/viscoelastic.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <limits>
#include <string>

using namespace tunica;
using namespace tunica::solid;

namespace {

constexpr double no_number = std::numeric_limits<double>::quiet_NaN(),
                 infinity = std::numeric_limits<double>::infinity();

template <class Do>
std::string refusal(const Do& act) {
  try {
    act();
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

/// What a wall of that law says: as its first one, and as that of another region.
template <class Law>
std::string wall_of(const Law& law, const Law& good) {
  const auto mesh = meshing::box_hexes(1);
  const std::string first = refusal([&] { Statics wall{mesh, law}; });
  Statics wall{mesh, good};
  CHECK(refusal([&] { wall.laws().material(2, law); }) == first);
  return first;
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("solid: a wall refuses parameters that cannot be and names law and parameter and value") {
    const Quadratic bulk{.kappa = 1e6};
    const auto isochoric = [&](const auto& law, const auto& good) {
      return wall_of(Hyperelastic{law, bulk}, Hyperelastic{good, bulk});
    };
    const NeoHooke rubber{.c10 = 1e4};
    CHECK(isochoric(NeoHooke{.c10 = no_number}, rubber) ==
          "NeoHooke: c10: nan, expected a number not below 0");
    CHECK(isochoric(NeoHooke{.c10 = -3e4}, rubber) == "NeoHooke: c10: -30000, expected a number not below 0");
    CHECK(isochoric(NeoHooke{.c10 = infinity}, rubber) ==
          "NeoHooke: c10: inf, expected a number not below 0");
    CHECK(isochoric(Yeoh{.c10 = 1, .c20 = no_number}, Yeoh{.c10 = 1}) == "Yeoh: c20: nan, expected a number");
    CHECK(isochoric(MooneyRivlin{.c10 = 1, .c01 = -2}, MooneyRivlin{.c10 = 1, .c01 = -0.5}) ==
          "MooneyRivlin: c10 + c01: -1, expected a number not below 0");
    CHECK(isochoric(Demiray{.mu = 1, .a = 0}, Demiray{.mu = 1, .a = 1}) ==
          "Demiray: a: 0, expected a number above 0");

    const HolzapfelGasserOgden hgo{.c = 3e3, .k1 = 2e3, .k2 = 0};
    CHECK(isochoric(hgo, hgo).empty());
    const auto fibrous = [&](double c, double k1, double k2) {
      return isochoric(HolzapfelGasserOgden{.c = c, .k1 = k1, .k2 = k2}, hgo);
    };
    CHECK(fibrous(-1, 1, 1) == "HolzapfelGasserOgden: c: -1, expected a number not below 0");
    CHECK(fibrous(1, -1, 1) == "HolzapfelGasserOgden: k1: -1, expected a number not below 0");
    CHECK(fibrous(1, 1, -0.1) == "HolzapfelGasserOgden: k2: -0.1, expected a number not below 0");
    CHECK(fibrous(1, 1, no_number) == "HolzapfelGasserOgden: k2: nan, expected a number not below 0");
    const GasserOgdenHolzapfel spread{.c = 1, .k1 = 1, .k2 = 1, .kappa = 1. / 3};
    CHECK(isochoric(spread, spread).empty());
    for (const double kappa : {0.34, -1e-3, no_number}) {
      GasserOgdenHolzapfel wrong = spread;
      wrong.kappa = kappa;
      CHECK(isochoric(wrong, spread).find("GasserOgdenHolzapfel: kappa: ") == 0);
    }
    const Isochoric muscle{Guccione{.C = 2e3, .bf = 8, .bt = 2, .bfs = 4}};
    auto slack = muscle;
    slack.law.bt = -2;
    CHECK(isochoric(slack, muscle) == "Guccione: bt: -2, expected a number not below 0");

    const auto volumetric = [&](const auto& law) {
      auto good = law;
      good.kappa = 1e6;
      return wall_of(Hyperelastic{rubber, law}, Hyperelastic{rubber, good});
    };
    for (const double kappa : {0.0, -1e6, no_number}) {
      CHECK(volumetric(Quadratic{.kappa = kappa}).find("Quadratic: kappa: ") == 0);
      CHECK(volumetric(SimoTaylor{.kappa = kappa}).find("SimoTaylor: kappa: ") == 0);
      CHECK(volumetric(Logarithmic{.kappa = kappa}).find("Logarithmic: kappa: ") == 0);
    }
    const CompressibleNeoHooke foam{.mu = 1e3, .lambda = -5e2};
    CHECK(wall_of(foam, foam).empty());
    CHECK(wall_of(CompressibleNeoHooke{.mu = 1e3, .lambda = -1e3}, foam) ==
          "CompressibleNeoHooke: lambda + 2/3 mu: -333.3333, expected a number not below 0");
    CHECK(wall_of(StVenantKirchhoff{.mu = no_number, .lambda = 0}, StVenantKirchhoff{.mu = 1, .lambda = 1}) ==
          "StVenantKirchhoff: mu: nan, expected a number not below 0");
    // Through a cure of locking as well.
    CHECK(refusal([&] {
            Statics wall{meshing::box_tets(1), with<NodalPressure>(Hyperelastic{NeoHooke{.c10 = -1}, bulk})};
          }) == "NeoHooke: c10: -1, expected a number not below 0");
  }

  TEST_CASE("solid: a series of branches is refused by branch and an empty one is the law inside") {
    const NeoHooke rubber{.c10 = 1e4};
    const auto series = [&](const Prony& second) {
      return refusal([&] { Viscoelastic law{rubber, std::array{Prony{.ratio = 1, .time = 1}, second}}; });
    };
    CHECK(series({.ratio = 5, .time = 1e-9}).empty());  // no bound on the sum: of the long-term stress
    CHECK(series({.ratio = 0, .time = infinity}).empty());
    CHECK(series({.ratio = 1, .time = 0}) == "Viscoelastic: branch 2, time: 0, expected a time above 0");
    CHECK(series({.ratio = 1, .time = -1}) == "Viscoelastic: branch 2, time: -1, expected a time above 0");
    CHECK(series({.ratio = 1, .time = no_number}) ==
          "Viscoelastic: branch 2, time: nan, expected a time above 0");
    CHECK(series({.ratio = -0.1, .time = 1}) ==
          "Viscoelastic: branch 2, ratio: -0.1, expected a number not below 0");
    CHECK(series({.ratio = no_number, .time = 1}) ==
          "Viscoelastic: branch 2, ratio: nan, expected a number not below 0");
    CHECK(refusal([&] {
            Viscoelastic law{NeoHooke{.c10 = no_number}, std::array{Prony{.ratio = 1, .time = 1}}};
          }) == "NeoHooke: c10: nan, expected a number not below 0");

    Viscoelastic<NeoHooke, 0> none{rubber, {}};
    none.begin_step(0.1);
    for (const auto& F : test::states) {
      auto point = none.at_rest();
      point = none.advance(F, point);
      const auto a = none.response(F, point), b = response(rubber, F);
      for (std::size_t k = 0; k < 81; ++k) CHECK(std::abs(a.A[k] - b.A[k]) < 1e-13 * test::largest(b.A));
      for (std::size_t k = 0; k < 9; ++k) CHECK(std::abs(a.P.m[k] - b.P.m[k]) < 1e-13 * test::largest(b.A));
    }
  }

  TEST_CASE("solid: fibres without stiffening are the limit of those with little") {
    const FibreEnergy none{.k1 = 3e3, .k2 = 0};
    for (const double E : {-0.3, 0.0, 1e-9, 1e-3, 0.2, 3.0}) {
      CHECK(none.energy(E) == doctest::Approx(E > 0 ? 1.5e3 * E * E : 0).epsilon(1e-15));
      CHECK(none.slopes(E).first == doctest::Approx(E > 0 ? 3e3 * E : 0).epsilon(1e-15));
      CHECK(none.slopes(E).second == (E > 0 ? 3e3 : 0));
      for (const double k2 : {1e-12, 1e-6, 1e-4, 0.01, 0.8}) {
        const FibreEnergy some{.k1 = 3e3, .k2 = k2};
        const long double x = static_cast<long double>(k2) * E * E;
        const auto exact = static_cast<double>(E > 0 ? 1.5e3L / k2 * std::expm1(x) : 0);
        CHECK(some.energy(E) == doctest::Approx(exact).epsilon(1e-12));
        using D = Dual<double, 1>;
        CHECK(some.energy(D::variable(E, 0)).d[0] == doctest::Approx(some.slopes(E).first).epsilon(1e-12));
      }
    }
    const HolzapfelGasserOgden plain{.c = 1e3, .k1 = 3e3, .k2 = 0}, little{.c = 1e3, .k1 = 3e3, .k2 = 1e-9};
    for (const auto& F : test::states) {
      const auto a = response(plain, F, test::crossed(0.5)), b = response(little, F, test::crossed(0.5));
      for (std::size_t k = 0; k < 81; ++k) CHECK(std::abs(a.A[k] - b.A[k]) < 1e-6 * test::largest(b.A));
    }
  }

  TEST_CASE("solid: a family that is not there does not pull and neither does its dispersion") {
    const GasserOgdenHolzapfel spread{.c = 1e3, .k1 = 4e3, .k2 = 0.7, .kappa = 0.3};
    const Tensor<double> F{.m = {2.5, 0, 0, 0, 1 / 2.5, 0, 0, 0, 1}};  // I1 - 3 = 4.41: E > 0 without I4
    const auto none = response(spread, F, Fibres<double, 2>{});
    const auto ground = response(NeoHooke{.c10 = 0.5e3}, F);
    for (std::size_t k = 0; k < 81; ++k) CHECK(none.A[k] == doctest::Approx(ground.A[k]));
    CHECK(energy(spread, F, Fibres<double, 2>{}) == doctest::Approx(energy(NeoHooke{.c10 = 0.5e3}, F)));
  }
}
