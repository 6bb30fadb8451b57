// SPDX-License-Identifier: MIT
#include "tunica/solid/viscoelastic.hpp"
#include "support/laws.hpp"
#include "tunica/solid/fibre_laws.hpp"
#include "tunica/solid/guccione_law.hpp"
#include "tunica/solid/hyperelastic.hpp"
#include "tunica/solid/isochoric_law.hpp"
#include "tunica/solid/laws.hpp"
#include "tunica/solid/volumetric.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>
#include <vector>

using namespace tunica;

namespace {

constexpr std::array terms{solid::Prony{.ratio = 0.6, .time = 0.2}, solid::Prony{.ratio = 0.25, .time = 3.0}};
constexpr solid::NeoHooke neo_hooke{.c10 = 1e3};
constexpr solid::HolzapfelGasserOgden hgo{.c = 3e3, .k1 = 2.3632e3, .k2 = .8393};
constexpr solid::Isochoric guccione{solid::Guccione{.C = 2e3, .bf = 8, .bt = 2, .bfs = 4}};

template <class Visit>
void for_each_inside(const Visit& visit) {
  visit(neo_hooke, solid::NoPoint<double>{});
  visit(hgo, test::crossed(0.5));
  visit(guccione, test::frame(0.4, 0.9));
}

Tensor<double> sheared(double g) {
  return {.m = {1, g, 0, 0, 1, 0, 0, 0, 1}};
}

/// A small repeatable source of numbers in [-1, 1].
struct Random {
  std::uint64_t state = 88172645463325252ULL;
  double operator()() {
    state ^= state << 13, state ^= state >> 7, state ^= state << 17;
    return static_cast<double>(state >> 11) / 4503599627370496.0 - 1;
  }
};

/// Work per reference volume [Pa] along a path of F, each step taking dt, from rest.
template <class Law>
double work_along(solid::Viscoelastic<Law, 2> law, const solid::PointOf<Law, double>& data,
                  const std::vector<Tensor<double>>& path, double dt) {
  auto point = law.at_rest(data);
  law.begin_step(dt);
  double work = 0;
  Tensor<double> before;
  for (std::size_t n = 1; n < path.size(); ++n) {
    const auto P = solid::stress(law, path[n], point);
    work += 0.5 * double_dot(P + before, path[n] - path[n - 1]);
    point = solid::advance(law, path[n], point);
    before = P;
  }
  return work;
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("solid: a jump of the strain relaxes by the exponentials of the series") {
    for_each_inside([](const auto& inside, const auto& data) {
      for (const auto& F : test::states) {
        solid::Viscoelastic law{inside, terms};
        auto point = law.at_rest(data);
        point = solid::advance(law, F, point);  // begin_step(0) is what it starts with
        const auto P = solid::stress(inside, F, data);
        const double scale = std::sqrt(double_dot(P, P));
        double t = 0;
        for (const double dt : {0.0, 0.01, 0.3, 2.0, 7.0}) {
          t += dt;
          solid::begin_step(law, dt);
          double left = 1;
          for (const auto& [ratio, time] : terms) left += ratio * std::exp(-t / time);
          const auto now = solid::stress(law, F, point);
          point = solid::advance(law, F, point);
          for (std::size_t k = 0; k < 9; ++k) CHECK(std::abs(now.m[k] - left * P.m[k]) < 1e-13 * scale);
        }
      }
    });
  }

  TEST_CASE("solid: a viscoelastic step has the derivatives of its potential and turns with the frame") {
    for_each_inside([](const auto& inside, const auto& data) {
      solid::Viscoelastic law{inside, terms};
      auto point = solid::advance(law, test::states[0], law.at_rest(data));
      solid::begin_step(law, 0.15);
      point = solid::advance(law, test::states[2], point);
      const auto e = test::errors_of(law, point);
      MESSAGE("duals " << e.duals << " differences " << e.differences << " frame " << e.frame << " symmetry "
                       << e.symmetry);
      CHECK(e.duals < 1e-10);
      CHECK(e.differences < 1e-7);
      CHECK(e.frame < 1e-12);
      CHECK(e.symmetry < 1e-12);
      const auto P = solid::stress(law, test::states[1], point);
      CHECK(std::abs(double_dot(P, test::states[1])) < 1e-12 * std::sqrt(double_dot(P, P)));  // tr tau = 0
    });
  }

  TEST_CASE("solid: forgetting at once or never leaves the elastic laws") {
    for_each_inside([](const auto& inside, const auto& data) {
      for (const auto& [time, factor] : {std::pair{1e-14, 1.0}, std::pair{1e14, 1.85}}) {
        const std::array limit{solid::Prony{.ratio = 0.6, .time = time},
                               solid::Prony{.ratio = 0.25, .time = time}};
        solid::Viscoelastic law{inside, limit};
        auto point = law.at_rest(data);
        solid::begin_step(law, 0.1);
        double scale = 0;  // the history is a sum: it rounds as the largest stress there was
        for (const auto& F : test::states) {
          const auto got = solid::response(law, F, point), want = solid::response(inside, F, data);
          scale = std::max(scale, test::largest(want.A));
          for (std::size_t k = 0; k < 9; ++k)
            CHECK(std::abs(got.P.m[k] - factor * want.P.m[k]) < 1e-11 * scale);
          for (std::size_t k = 0; k < 81; ++k) CHECK(std::abs(got.A[k] - factor * want.A[k]) < 1e-11 * scale);
          point = solid::advance(law, F, point);
        }
      }
    });
  }

  TEST_CASE("solid: the update of a viscoelastic law is of second order in the step") {
    // Simple shear g(t) = sin(3 t) of neo-Hooke. By parts, h = ratio (T - 1/time int e^(-(t-s)/time) T ds)
    // with T = 2 c10 (1 - I1/3 C^-1); the stress is F (T + DEV h) where DEV h = h - 1/3 (h : C) C^-1.
    constexpr double end = 1.3;
    using Plane = std::array<double, 4>;  // xx yy zz xy
    const auto inverse_C = [](double g) { return Plane{1 + g * g, 1, 1, -g}; };
    const auto T = [&](double t) {
      const double g = std::sin(3 * t), w = (3 + g * g) / 3;
      const Plane c = inverse_C(g);
      return Plane{2 * neo_hooke.c10 * (1 - w * c[0]), 2 * neo_hooke.c10 * (1 - w * c[1]),
                   2 * neo_hooke.c10 * (1 - w * c[2]), -2 * neo_hooke.c10 * w * c[3]};
    };
    const double g = std::sin(3 * end);
    Plane h{};
    for (const auto& [ratio, time] : terms) {
      constexpr int panels = 4000;  // Simpson
      Plane sum{};
      for (int n = 0; n <= panels; ++n) {
        const double s = end * n / panels, weight = n == 0 || n == panels ? 1 : n % 2 == 0 ? 2 : 4;
        for (std::size_t k = 0; k < 4; ++k)
          sum[k] += weight * end / (3 * panels) * std::exp((s - end) / time) * T(s)[k];
      }
      for (std::size_t k = 0; k < 4; ++k) h[k] += ratio * (T(end)[k] - sum[k] / time);
    }
    const double hC = h[0] + h[1] * (1 + g * g) + h[2] + 2 * h[3] * g;
    Plane S = T(end);
    for (std::size_t k = 0; k < 4; ++k) S[k] += h[k] - hC / 3 * inverse_C(g)[k];
    const double exact = S[3] + g * S[1];  // P_xy = S_xy + g S_yy

    std::vector<double> errors;
    for (const int steps : {20, 40, 80}) {
      solid::Viscoelastic law{neo_hooke, terms};
      auto point = law.at_rest();
      solid::begin_step(law, end / steps);
      double P = 0;
      for (int n = 1; n <= steps; ++n) {
        const auto F = sheared(std::sin(3 * end * n / steps));
        P = solid::stress(law, F, point)(0, 1);
        point = solid::advance(law, F, point);
      }
      errors.push_back(std::abs(P - exact));
    }
    const double first = std::log2(errors[0] / errors[1]), second = std::log2(errors[1] / errors[2]);
    MESSAGE("relative error at 80 steps " << errors[2] / std::abs(exact) << ", orders " << first << " "
                                          << second);
    CHECK(first == doctest::Approx(2).epsilon(0.05));
    CHECK(second == doctest::Approx(2).epsilon(0.05));
  }

  TEST_CASE("solid: small cycles lose the energy of the loss modulus and every closed path loses some") {
    // G'' = mu sum ratio w time/(1 + (w time)^2); a cycle of amplitude a loses pi G'' a^2.
    constexpr double a = 1e-4, w = 4;
    constexpr int steps = 2000, settle = 6;  // cycles before the one that counts
    solid::Viscoelastic law{neo_hooke, terms};
    auto point = law.at_rest();
    solid::begin_step(law, 2 * std::numbers::pi / (w * steps));
    double work = 0, before = 0;
    for (int n = 1; n <= (settle + 1) * steps; ++n) {
      const auto shear = [&](int k) { return a * std::sin(2 * std::numbers::pi * k / steps); };
      const auto F = sheared(shear(n));
      const double P = solid::stress(law, F, point)(0, 1);
      if (n > settle * steps) work += 0.5 * (P + before) * (shear(n) - shear(n - 1));
      point = solid::advance(law, F, point);
      before = P;
    }
    double loss = 0;
    for (const auto& [ratio, time] : terms)
      loss += 2 * neo_hooke.c10 * ratio * w * time / (1 + w * w * time * time);
    CHECK(work == doctest::Approx(std::numbers::pi * loss * a * a).epsilon(1e-3).scale(0));

    Random random;
    for_each_inside([&](const auto& inside, const auto& data) {
      double least = 1e300;
      for (int path_number = 0; path_number < 20; ++path_number) {
        // From rest through four random states with stretches of up to 25 % and back, then at rest for good.
        std::vector<Tensor<double>> corners(1, identity<double>()), path;
        for (int c = 0; c < 4; ++c) {
          auto F = identity<double>();
          for (auto& f : F.m) f += 0.25 * random();
          corners.push_back(F);
        }
        corners.push_back(identity<double>());
        for (std::size_t c = 0; c + 1 < corners.size(); ++c)
          for (int n = 0; n < 100; ++n)
            path.push_back(corners[c] + (0.01 * n) * (corners[c + 1] - corners[c]));
        path.push_back(corners.back());
        for (const double dt : {1e-4, 1e-2, 1.0})
          least = std::min(least, work_along(solid::Viscoelastic{inside, terms}, data, path, dt));
      }
      MESSAGE("the least work of 60 closed paths: " << least << " Pa");
      CHECK(least > 0);
    });
  }

  TEST_CASE("solid: a viscoelastic pair hands its history through") {
    solid::Hyperelastic pair{solid::Viscoelastic{hgo, terms}, solid::Quadratic{.kappa = 4e5}};
    static_assert(solid::HasHistory<decltype(pair)> && solid::point_size<decltype(pair)> == 6 + 18);
    const auto rest = solid::Viscoelastic<solid::HolzapfelGasserOgden, 2>::at_rest(test::crossed(0.5));
    solid::begin_step(pair, 0.1);
    const auto next = solid::advance(pair, test::states[0], rest);
    // Held, it has forgotten some; the pressure is no part of that.
    const auto held = pair.isochoric_part(test::states[0], next).P;
    const auto first = pair.isochoric_part(test::states[0], rest).P;
    CHECK(double_dot(held, held) < 0.95 * double_dot(first, first));
    const auto all = solid::stress(pair, test::states[0], next);
    const auto pressure = 4e5 * (determinant(test::states[0]) - 1) * cofactor(test::states[0]);
    for (std::size_t k = 0; k < 9; ++k) CHECK(all.m[k] == doctest::Approx(held.m[k] + pressure.m[k]));
    CHECK(next.m[0] == rest.m[0]);
    const solid::Hyperelastic elastic{hgo, solid::Quadratic{.kappa = 4e5}};
    static_assert(!solid::HasHistory<decltype(elastic)>);
    CHECK(solid::advance(elastic, test::states[0], test::crossed(0.5)).m == test::crossed(0.5).m);
  }
}
