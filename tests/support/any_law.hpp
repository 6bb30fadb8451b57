// SPDX-License-Identifier: MIT
// A law that is any of many, chosen while a program runs: every cell meets every law in one instance of its
// code.
#pragma once

#include "support/laws.hpp"
#include "tunica/solid/compressible_laws.hpp"
#include "tunica/solid/fibre_laws.hpp"
#include "tunica/solid/guccione_law.hpp"
#include "tunica/solid/hyperelastic.hpp"
#include "tunica/solid/isochoric_law.hpp"
#include "tunica/solid/laws.hpp"
#include "tunica/solid/viscoelastic.hpp"
#include "tunica/solid/volumetric.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <functional>
#include <string>
#include <variant>
#include <vector>

namespace tunica::test {

/// A point holds as many numbers as the law with the most of them; each law reads the first of these.
template <class... Laws>
class AnyLaw {
 public:
  static constexpr std::size_t most = std::max({solid::point_size<Laws>...});
  template <class S>
  struct Point {
    std::array<S, most> m{};
  };

  template <class Law>
  requires(std::same_as<Law, Laws> || ...) AnyLaw(const Law& law) : law_(law) {}

  template <class S>
  [[nodiscard, gnu::noinline]] S energy(const Tensor<S>& F, const Point<S>& point) const {
    return std::visit([&]<class Law>(const Law& law) -> S { return solid::energy(law, F, own<Law>(point)); },
                      law_);
  }
  template <class S>
  [[nodiscard, gnu::noinline]] Tensor<S> stress(const Tensor<S>& F, const Point<S>& point) const {
    return std::visit(
        [&]<class Law>(const Law& law) -> Tensor<S> { return solid::stress(law, F, own<Law>(point)); }, law_);
  }
  template <class S>
  [[nodiscard, gnu::noinline]] solid::Response<S> response(const Tensor<S>& F, const Point<S>& point) const {
    return std::visit(
        [&]<class Law>(const Law& law) -> solid::Response<S> {
          return solid::response(law, F, own<Law>(point));
        },
        law_);
  }

 private:
  template <class Law, class S>
  static solid::PointOf<Law, S> own(const Point<S>& point) {
    solid::PointOf<Law, S> p{};
    for (std::size_t k = 0; k < solid::point_size<Law>; ++k) p.m[k] = point.m[k];
    return p;
  }

  std::variant<Laws...> law_;
};

/// A user's law in invariants, without slopes: Gent's.
struct GentsEnergy {
  double mu, m;
  static constexpr std::array reads{solid::Invariant::I1};
  template <class S>
  S energy(const std::array<S, 1>& I) const {
    using std::log;
    return S(-0.5 * mu * m) * log(S(1) - (I[0] - S(3)) / S(m));
  }
};

/// A user's law of the whole F: its energy alone, neo-Hooke's with fibres along x that also push.
struct EnergyWithFibres {
  double mu, lambda, fibres;
  template <class S>
  S energy(const Tensor<S>& F) const {
    using std::exp, std::log;
    const S l = log(determinant(F)), E = F(0, 0) * F(0, 0) + F(1, 0) * F(1, 0) + F(2, 0) * F(2, 0) - S(1);
    return S(0.5 * mu) * (double_dot(F, F) - S(3)) - S(mu) * l + S(0.5 * lambda) * l * l +
           S(0.5 * fibres) * (exp(E * E) - S(1));
  }
};

using SlowNeoHooke = solid::Viscoelastic<solid::NeoHooke, 2>;
using SlowFibres = solid::Viscoelastic<solid::HolzapfelGasserOgden, 1>;
using SlowGuccione = solid::Viscoelastic<solid::Isochoric<solid::Guccione>, 1>;
using AnyIsochoric =
    AnyLaw<solid::NeoHooke, solid::MooneyRivlin, solid::Yeoh, solid::Demiray, solid::HolzapfelGasserOgden,
           solid::GasserOgdenHolzapfel, solid::Isochoric<solid::Guccione>, SlowNeoHooke, SlowFibres,
           SlowGuccione, GentsEnergy>;
using AnyPair = solid::Hyperelastic<AnyIsochoric, solid::Quadratic>;
/// Those of the whole F, and the pairs.
using AnyMaterial =
    AnyLaw<solid::CompressibleNeoHooke, solid::StVenantKirchhoff, solid::Guccione, EnergyWithFibres, AnyPair>;

/// A law with what its points hold where fibres are turned by `angle` [rad].
template <class Law, class Point>
struct NamedLaw {
  std::string name;
  Law law;
  std::function<Point(double angle)> point;
};
using NamedPair = NamedLaw<AnyPair, AnyPair::Point<double>>;
using NamedMaterial = NamedLaw<AnyMaterial, AnyMaterial::Point<double>>;

namespace detail {

template <class Point, class From>
Point padded(const From& from) {
  Point p{};
  std::copy(from.m.begin(), from.m.end(), p.m.begin());
  return p;
}

inline auto two_families(double angle) {
  solid::Fibres<double, 2> f;
  f.set(0, {std::cos(0.5 + angle), std::sin(0.5 + angle), 0});
  f.set(1, {std::cos(0.5 - angle), -std::sin(0.5 - angle), 0});
  return f;
}

/// In the middle of a step of 0.15 s that began with a strained past.
template <class Law, std::size_t Terms>
solid::Viscoelastic<Law, Terms> amid_step(solid::Viscoelastic<Law, Terms> law) {
  law.begin_step(0.15);
  return law;
}
template <class Law, std::size_t Terms>
auto strained_past(const solid::Viscoelastic<Law, Terms>& law, const solid::PointOf<Law, double>& data) {
  return law.advance(Tensor<double>{.m = {1.04, .05, 0, 0, .98, .03, .02, 0, .99}}, law.at_rest(data));
}

}  // namespace detail

/// Every law of the isochoric C, mu about 1, with the bulk modulus kappa.
inline std::vector<NamedPair> every_pair(double kappa) {
  using namespace solid;
  using Point = AnyPair::Point<double>;
  std::vector<NamedPair> all;
  const auto add = [&](const char* name, const auto& law, auto data) {
    all.push_back({name, AnyPair{law, Quadratic{.kappa = kappa}},
                   [data](double angle) { return detail::padded<Point>(data(angle)); }});
  };
  const auto none = [](double) { return NoPoint<double>{}; };
  const auto families = [](double angle) { return detail::two_families(angle); };
  const auto axes = [](double angle) { return frame(0.4, 0.9 + angle); };
  const HolzapfelGasserOgden hgo{.c = 1, .k1 = 2, .k2 = .84};
  const Isochoric guccione{Guccione{.C = 1.5, .bf = 3, .bt = 1, .bfs = 1.6}};
  add("neo-Hooke", NeoHooke{.c10 = .5}, none);
  add("Mooney-Rivlin", MooneyRivlin{.c10 = .3, .c01 = .2}, none);
  add("Yeoh", Yeoh{.c10 = .5, .c20 = 1.5}, none);
  add("Demiray", Demiray{.mu = 1, .a = 2}, none);
  add("Holzapfel-Gasser-Ogden", hgo, families);
  add("Gasser-Ogden-Holzapfel", GasserOgdenHolzapfel{.c = 1, .k1 = 3, .k2 = 2, .kappa = .226}, families);
  add("Guccione of J^-1/3 F", guccione, axes);
  const SlowNeoHooke slow =
      detail::amid_step(SlowNeoHooke{NeoHooke{.c10 = .5}, {{{.ratio = .6, .time = .2}, {.25, 3}}}});
  const SlowFibres slow_fibres = detail::amid_step(SlowFibres{hgo, {{{.ratio = .6, .time = .2}}}});
  const SlowGuccione slow_frame = detail::amid_step(SlowGuccione{guccione, {{{.ratio = .4, .time = .1}}}});
  add("viscous neo-Hooke", slow, [slow](double) { return detail::strained_past(slow, {}); });
  add("viscous Holzapfel-Gasser-Ogden", slow_fibres,
      [slow_fibres, families](double angle) { return detail::strained_past(slow_fibres, families(angle)); });
  add("viscous Guccione", slow_frame,
      [slow_frame, axes](double angle) { return detail::strained_past(slow_frame, axes(angle)); });
  add("a user's energy in invariants", GentsEnergy{.mu = 1, .m = 4}, none);
  return all;
}

/// Every law of the whole F, and the pairs.
inline std::vector<NamedMaterial> every_material(double kappa) {
  using namespace solid;
  using Point = AnyMaterial::Point<double>;
  std::vector<NamedMaterial> all;
  const auto add = [&](const char* name, const auto& law, auto data) {
    all.push_back({name, law, [data](double angle) { return detail::padded<Point>(data(angle)); }});
  };
  const auto none = [](double) { return NoPoint<double>{}; };
  add("compressible neo-Hooke", CompressibleNeoHooke{.mu = 1, .lambda = 2}, none);
  add("St Venant-Kirchhoff", StVenantKirchhoff{.mu = 1, .lambda = 1}, none);
  add("Guccione", Guccione{.C = 1.5, .bf = 3, .bt = 1, .bfs = 1.6},
      [](double angle) { return frame(0.4, 0.9 + angle); });
  add("a user's energy of F", EnergyWithFibres{.mu = 1, .lambda = 2, .fibres = 1}, none);
  for (const NamedPair& pair : every_pair(kappa))
    all.push_back(
        {pair.name, pair.law, [pair](double angle) { return detail::padded<Point>(pair.point(angle)); }});
  return all;
}

}  // namespace tunica::test
