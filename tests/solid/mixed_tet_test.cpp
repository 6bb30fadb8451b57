// SPDX-License-Identifier: MIT
#include "tunica/solid/mixed_tet.hpp"
#include "tunica/core/dual.hpp"
#include "tunica/solid/isochoric_part.hpp"
#include "tunica/solid/laws.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

using namespace tunica;
using solid::MixedTet;

namespace {

const MixedTet cell(MixedTet::Nodes{{{0.1, 0, 0}, {1.2, 0.1, -0.1}, {0.2, 0.9, 0.2}, {-0.1, 0.3, 1.1}}});
constexpr MixedTet::Moduli moduli{.mu = 80, .inverse_kappa = 1 / 4e5, .pressure_scale = 70};

template <class S>
MixedTet::Unknowns<S> deformed() {
  MixedTet::Unknowns<S> x;
  for (std::size_t k = 0; k < MixedTet::size; ++k)
    x[k] = S(0.15 * std::sin(2.3 * static_cast<double>(k) + 0.4));
  return x;
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE_TEMPLATE("solid: forces and tangent of the mixed tetrahedron are the derivatives of its energy",
                     Law, solid::NeoHooke, solid::MooneyRivlin) {
    Law law{};
    law.c10 = 40;
    if constexpr (requires { law.c01; }) law.c01 = 7;
    const Law& material = law;
    using D = Dual<double, 16>;
    using DD = Dual<D, 16>;
    const auto x = deformed<double>();
    MixedTet::Unknowns<DD> y;
    for (std::size_t k = 0; k < x.size(); ++k)
      y[k] = DD::variable(D::variable(x[k], static_cast<int>(k)), static_cast<int>(k));
    const DD energy = cell.energy(material, {}, moduli, y);
    const auto at = cell.tangent(material, {}, moduli, x);
    const auto forces = cell.forces(material, {}, moduli, x);
    CHECK(energy.value.value == doctest::Approx(cell.energy(material, {}, moduli, x)).epsilon(1e-14));
    double force_scale = 0, K_scale = 0, force_error = 0, K_error = 0;
    for (std::size_t a = 0; a < 16; ++a) {
      force_scale = std::max(force_scale, std::abs(at.r[a]));
      force_error =
          std::max({force_error, std::abs(at.r[a] - energy.d[a].value), std::abs(forces.r[a] - at.r[a])});
      for (std::size_t b = 0; b < 16; ++b) {
        K_scale = std::max(K_scale, std::abs(at.K[16 * a + b]));
        K_error = std::max(K_error, std::abs(at.K[16 * a + b] - energy.d[a].d[b]));
      }
    }
    CHECK(force_error < 1e-13 * force_scale);
    CHECK(K_error < 1e-13 * K_scale);
  }

  TEST_CASE("solid: a constant pressure costs the mixed tetrahedron nothing but its compression") {
    MixedTet::Unknowns<double> x{};
    for (std::size_t a = 0; a < 4; ++a) x[12 + a] = 0.3;
    const solid::NeoHooke material{.c10 = 40};
    const double p = 0.3 * moduli.pressure_scale;
    CHECK(cell.energy(material, {}, moduli, x) ==
          doctest::Approx(-0.5 * p * p * moduli.inverse_kappa * cell.volume).epsilon(1e-12));
    // any other pressure costs int (p - mean p)^2 / (2 mu): here p = p1 N_1, whose variance is V (1/10 -
    // 1/16)
    MixedTet::Unknowns<double> y{};
    y[13] = 0.3;
    const MixedTet::Moduli incompressible{.mu = 80, .inverse_kappa = 0, .pressure_scale = 70};
    CHECK(cell.energy(material, {}, incompressible, y) ==
          doctest::Approx(-p * p / (2 * 80) * cell.volume * (0.1 - 0.0625)).epsilon(1e-12));
  }
}
