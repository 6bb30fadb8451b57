// SPDX-License-Identifier: MIT
#include "support/laws.hpp"
#include "tunica/core/counted.hpp"
#include "tunica/core/pack_math.hpp"
#include "tunica/solid/compressible_laws.hpp"
#include "tunica/solid/fibre_laws.hpp"
#include "tunica/solid/guccione_law.hpp"
#include "tunica/solid/hyperelastic.hpp"
#include "tunica/solid/isochoric_law.hpp"
#include "tunica/solid/laws.hpp"
#include "tunica/solid/viscoelastic.hpp"
#include "tunica/solid/volumetric.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>

using namespace tunica;

namespace {

/// An energy and nothing else, of a ground with fibres along x that pull only; plain numbers need no S(...).
struct EnergyOfFibres {
  template <class S>
  [[nodiscard]] S energy(const Tensor<S>& F) const {
    using std::exp, std::log;
    const S J = determinant(F), I4 = F(0, 0) * F(0, 0) + F(1, 0) * F(1, 0) + F(2, 0) * F(2, 0);
    const S E = select(I4 > S(1), I4 - 1.0, S(0));
    return 1e3 * (double_dot(F, F) - 3.0) - 2e3 * log(J) + 5e2 * (exp(0.8 * E * E) - 1.0);
  }
};

/// Lanes with fibres pulled and fibres pressed: the five states, and pulled and pressed along x and y.
constexpr int lanes = 8;
Tensor<double> state(int lane) {
  if (lane < 5) return test::states[static_cast<std::size_t>(lane)];
  const double a = lane == 5 ? 1.2 : lane == 6 ? 0.8 : 1.0, b = lane == 7 ? 0.7 : 1.0;
  return {.m = {a, 0, 0, 0, b, 0, 0, 0, 1 / (a * b)}};
}

/// The largest difference of P and A of the lanes of packs to those of doubles, of the largest entry of A.
template <class Number, class Law>
double off(const Law& law, const solid::PointOf<Law, double>& point) {
  using P = Pack<Number, lanes>;
  Tensor<P> F;
  for (std::size_t k = 0; k < 9; ++k) {
    std::array<Number, lanes> values{};
    for (int l = 0; l < lanes; ++l) values[static_cast<std::size_t>(l)] = static_cast<Number>(state(l).m[k]);
    F.m[k] = P::load(values.data());
  }
  solid::PointOf<Law, P> points{};
  for (std::size_t k = 0; k < solid::point_size<Law>; ++k) points.m[k] = P(static_cast<Number>(point.m[k]));
  const auto packed = solid::response(law, F, points);
  const auto stress = solid::stress(law, F, points);
  double worst = 0;
  for (int l = 0; l < lanes; ++l) {
    const auto want = solid::response(law, state(l), point);
    const double scale = test::largest(want.A);
    const auto keep = [&](Number got, double exact) {
      const double e = std::abs(static_cast<double>(got) - exact) / scale;
      worst = e <= worst ? worst : e;
    };
    for (std::size_t k = 0; k < 9; ++k)
      keep(packed.P.m[k][l], want.P.m[k]), keep(stress.m[k][l], want.P.m[k]);
    for (std::size_t k = 0; k < 81; ++k) keep(packed.A[k][l], want.A[k]);
  }
  return worst;
}

template <class Law>
void check(const std::string& name, const Law& law, const solid::PointOf<Law, double>& point = {}) {
  const double doubles = off<double>(law, point), floats = off<float>(law, point);
  Tensor<Counted> F;
  for (std::size_t k = 0; k < 9; ++k) F.m[k] = state(0).m[k];
  Counted::count() = {};
  (void)solid::response(law, F, solid::cast_point<Law, Counted, double>(point));
  MESSAGE(name << ": doubles " << doubles << ", floats " << floats << ", " << Counted::count().total()
               << " operations");
  CHECK(doubles < 1e-13);
  CHECK(floats < 1e-5);
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("solid: every lane of a pack has the response of its own state") {
    const auto fibres = test::crossed(0.5);
    const auto frame = test::frame(0.4, 0.9);
    const solid::HolzapfelGasserOgden hgo{.c = 3e3, .k1 = 2.3632e3, .k2 = .8393};
    const solid::Guccione guccione{.C = 2e3, .bf = 3, .bt = 1, .bfs = 2};
    check("compressible neo-Hooke", solid::CompressibleNeoHooke{.mu = 3e3, .lambda = 5e3});
    check("St Venant-Kirchhoff", solid::StVenantKirchhoff{.mu = 3e3, .lambda = 5e3});
    check("neo-Hooke", solid::NeoHooke{.c10 = 1e3});
    check("Mooney-Rivlin, quadratic",
          solid::Hyperelastic{solid::MooneyRivlin{.c10 = 1e3, .c01 = 5e2}, solid::Quadratic{.kappa = 1e5}});
    check("Demiray, Simo-Taylor",
          solid::Hyperelastic{solid::Demiray{.mu = 2e3, .a = .7}, solid::SimoTaylor{.kappa = 1e5}});
    check("Yeoh, logarithmic",
          solid::Hyperelastic{solid::Yeoh{.c10 = 1e3, .c20 = 2e3}, solid::Logarithmic{.kappa = 1e5}});
    check("Holzapfel-Gasser-Ogden", solid::Hyperelastic{hgo, solid::Quadratic{.kappa = 1e5}}, fibres);
    check("Gasser-Ogden-Holzapfel", solid::GasserOgdenHolzapfel{.c = 3e3, .k1 = 2e3, .k2 = .8, .kappa = .226},
          fibres);
    check("Guccione", guccione, frame);
    check("Guccione of J^-1/3 F", solid::Isochoric{guccione}, frame);
    check("energy alone", EnergyOfFibres{});
    solid::Viscoelastic slow{hgo, std::array{solid::Prony{.ratio = 0.6, .time = 0.2}}};
    const auto point = solid::advance(slow, test::states[0], slow.at_rest(fibres));
    solid::begin_step(slow, 0.1);
    check("Holzapfel-Gasser-Ogden, viscoelastic", slow, point);
  }
}
