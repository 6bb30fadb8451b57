// SPDX-License-Identifier: MIT
#include "tunica/solid/hyperelastic.hpp"
#include "tunica/solid/laws.hpp"
#include "tunica/solid/material.hpp"
#include "tunica/solid/volumetric.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

using namespace tunica;

namespace {

Tensor<double> rotation(double a, double b) {
  const Tensor<double> x{.m = {1, 0, 0, 0, std::cos(a), -std::sin(a), 0, std::sin(a), std::cos(a)}};
  const Tensor<double> z{.m = {std::cos(b), -std::sin(b), 0, std::sin(b), std::cos(b), 0, 0, 0, 1}};
  return product(x, z);
}

/// General, strong shear, compression, rotation with stretch, near the reference.
const std::array<Tensor<double>, 5> states{
    {{.m = {1.2, .3, -.1, .2, .9, .15, -.05, .1, 1.1}},
     {.m = {1, 1.8, 0, 0, 1, 0, 0, .4, 1}},
     {.m = {.6, 0, .05, 0, .8, 0, -.1, 0, .7}},
     product(rotation(1.1, 2.3), Tensor<double>{.m = {1.3, 0, 0, 0, 1 / 1.3, 0, 0, 0, 1}}),
     {.m = {1 + 1e-3, 2e-4, 0, 0, 1 - 5e-4, 1e-4, -3e-4, 0, 1}}}};

/// The energy alone: what duals make of it holds the closed forms.
template <class Law>
struct EnergyOnly {
  Law law;
  template <class S>
  using Point = solid::PointOf<Law, S>;
  template <class S>
  requires(!solid::needs_point<Law>) S energy(const Tensor<S>& F)
  const { return solid::energy(law, F); }
  template <class S>
  S energy(const Tensor<S>& F, const Point<S>& point) const {
    return solid::energy(law, F, point);
  }
};

template <class Law>
double worst_of_five(const Law& law, const solid::PointOf<Law, double>& point = {}) {
  double worst = 0;
  for (const auto& F : states) {
    const auto own = solid::response(law, F, point);
    const auto P = solid::stress(law, F, point);
    const auto dual = solid::dual_response(EnergyOnly<Law>{law}, F, point);
    double scale = 0, wrong = 0;
    for (std::size_t k = 0; k < 81; ++k) {
      scale = std::max(scale, std::abs(dual.A[k]));
      wrong = std::max(wrong, std::abs(own.A[k] - dual.A[k]));
    }
    for (std::size_t k = 0; k < 9; ++k)
      wrong = std::max({wrong, std::abs(own.P.m[k] - dual.P.m[k]), std::abs(P.m[k] - dual.P.m[k])});
    worst = std::max(worst, wrong / scale);
  }
  return worst;
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("solid: closed forms of laws are the derivatives of their energies") {
    const solid::Quadratic U{.kappa = 4e5};
    CHECK(worst_of_five(solid::NeoHooke{.c10 = 1e3}) < 1e-10);
    CHECK(worst_of_five(solid::Yeoh{.c10 = 1e3, .c20 = 2e3}) < 1e-10);
    CHECK(worst_of_five(solid::MooneyRivlin{.c10 = 1e3, .c01 = 5e2}) < 1e-10);
    CHECK(worst_of_five(solid::Hyperelastic{solid::NeoHooke{.c10 = 1e3}, U}) < 1e-10);
    CHECK(worst_of_five(solid::Hyperelastic{solid::MooneyRivlin{.c10 = 1e3, .c01 = 5e2},
                                            solid::SimoTaylor{.kappa = 3e5}}) < 1e-10);
  }
}
