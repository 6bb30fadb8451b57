// SPDX-License-Identifier: MIT
// The added mass: where the plain explicit scheme must fail, and where the iterated one must not.
#include <doctest/doctest.h>

#include "coupling/models.hpp"
#include "tunica/coupling/aitken.hpp"
#include "tunica/coupling/iqn_ils.hpp"
#include "tunica/coupling/matching.hpp"
#include "tunica/coupling/relaxed.hpp"
#include "tunica/coupling/staggered.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

using namespace tunica;
using test::NoMesh;
using test::PotentialFlow;
using test::RingWall;
using test::TubeData;

namespace {

/// Displacements of the explicit scheme from a small bump of the first mode: largest before and at
/// the end, and the growth of each step over the last ten.
struct Growth {
  double largest = 0, factor = 0;
};

Growth explicit_scheme(double wall_density, double dt, int steps) {
  const TubeData tube{.wall_density = wall_density};
  PotentialFlow flow(tube);
  flow.pulse = 0;
  RingWall wall(tube, RingWall::Scheme::leap_frog);
  for (Eigen::Index i = 0; i < wall.eta.size(); ++i)
    wall.eta[i] = 1e-4 * std::sin(std::numbers::pi * static_cast<double>(i + 1) / tube.cells);
  flow.eta = wall.eta;
  auto fsi = coupling::staggered(flow, wall, NoMesh{}, coupling::Matching{}, coupling::Explicit{},
                                 {.max_halvings = 0, .predictor = 0});
  Growth growth;
  double before = 0;
  for (int n = 0; n < steps; ++n) {
    if (!fsi.step(dt)) break;
    if (n == steps - 11) before = wall.v.norm();
    growth.largest = std::max(growth.largest, wall.eta.cwiseAbs().maxCoeff());
  }
  growth.factor = std::pow(wall.v.norm() / before, 0.1);
  return growth;
}

struct Effort {
  double mean = 0;
  int most = 0, most_later = 0, halvings = 0;
  bool converged = true;
};

template <class Accelerator>
Effort implicit_scheme(const TubeData& tube, double dt, int steps, Accelerator&& acceleration) {
  PotentialFlow flow(tube);
  RingWall wall(tube);
  auto fsi = coupling::staggered(flow, wall, NoMesh{}, coupling::Matching{}, acceleration,
                                 {.resolution = 1e-7, .max_iterations = 200, .max_halvings = 0});  // cm
  Effort effort;
  for (int n = 0; n < steps; ++n) {
    const auto step = fsi.step(dt);
    effort.mean += static_cast<double>(step.iterations) / steps;
    effort.most = std::max(effort.most, step.iterations);
    if (n > 0) effort.most_later = std::max(effort.most_later, step.iterations);
    effort.halvings += step.halvings;
    if (!step) {
      effort.converged = false;
      break;
    }
  }
  return effort;
}

}  // namespace

TEST_SUITE("hard") {
  TEST_CASE("coupling: the explicit scheme fails at the density ratio that theory names") {
    // stable only if rho_s h > rho_f mu_max; otherwise it grows by rho_f mu / (rho_s h) a step [CGN05]
    const TubeData tube;
    const double mu = tube.added_mass(1), critical = tube.fluid_density * mu / tube.thickness;
    MESSAGE("largest added mass " << mu << " cm and critical density ratio " << critical);
    CHECK(critical == doctest::Approx(102.57).epsilon(1e-3));
    for (const double dt : {1e-5, 1e-6}) {
      for (const double ratio : {200.0, 120.0, 104.0}) {
        const Growth growth = explicit_scheme(ratio, dt, 3000);
        MESSAGE("dt " << dt << " s and density ratio " << ratio << ": largest " << growth.largest << " cm");
        CHECK(growth.largest < 1e-3);
      }
      for (const double ratio : {100.0, 50.0, 10.0, 1.1}) {
        const int steps = ratio > 60 ? 3000 : ratio > 5 ? 60 : 30;
        const Growth growth = explicit_scheme(ratio, dt, steps);
        const double theory = mu / (ratio * tube.thickness);
        MESSAGE("dt " << dt << " s and density ratio " << ratio << ": grows by " << growth.factor
                      << " a step where theory says " << theory);
        CHECK(growth.largest > 1e-3);
        CHECK(growth.factor == doctest::Approx(theory).epsilon(0.1));
      }
    }
  }

  TEST_CASE("coupling: smaller time steps do not save the explicit scheme") {
    for (const double dt : {1e-3, 1e-4, 1e-5}) {
      const TubeData tube{.wall_density = 1.1};
      PotentialFlow flow(tube);
      RingWall wall(tube);
      auto fsi = coupling::staggered(flow, wall, NoMesh{}, coupling::Matching{}, coupling::Explicit{},
                                     {.max_halvings = 0, .predictor = 0});
      int steps = 0;
      while (steps < 60 && fsi.step(dt) && wall.eta.cwiseAbs().maxCoeff() < tube.radius) ++steps;
      MESSAGE("dt " << dt << " s: the tube is lost after " << steps << " steps");
      CHECK(steps < 45);
    }
  }

  TEST_CASE("coupling: IQN-ILS holds over 48 cases of added mass") {
    int failed = 0;
    for (const double ratio : {10.0, 1.0, 0.1, 0.01})
      for (const double length : {2.5, 5.0, 10.0, 20.0}) {
        std::string row;
        for (const double dt : {1e-3, 1e-4, 1e-5}) {
          const TubeData tube{.length = length, .wall_density = ratio};
          const Effort effort = implicit_scheme(tube, dt, 60, coupling::IqnIls{});
          row += "  " + std::to_string(effort.mean).substr(0, 5) + " / " + std::to_string(effort.most_later) +
                 " / " + std::to_string(effort.most);
          failed += effort.converged ? 0 : 1;
          CHECK(effort.halvings == 0);
          if (ratio >= 1) CHECK(effort.most_later <= 25);
          CHECK(effort.mean <= (ratio >= 1 ? 12 : 15));
        }
        MESSAGE("rho_s/rho_f " << ratio << " L/R " << length / 0.5
                               << " mean / most later / most at dt 1e-3 1e-4 1e-5:" << row);
      }
    CHECK(failed == 0);
  }

  TEST_CASE("coupling: IQN-ILS holds for a wall without mass") {
    for (const double dt : {1e-3, 1e-4}) {
      const TubeData tube{.wall_density = 0};
      const Effort effort = implicit_scheme(tube, dt, 40, coupling::IqnIls{});
      MESSAGE("dt " << dt << ": mean " << effort.mean << " most " << effort.most);
      CHECK(effort.converged);
    }
  }

  TEST_CASE("coupling: IQN-ILS needs fewer iterations than Aitken") {
    const TubeData tube;
    const Effort aitken = implicit_scheme(tube, 1e-4, 60, coupling::Aitken{});
    const Effort alone = implicit_scheme(tube, 1e-4, 60, coupling::IqnIls{{.reuse = 0}});
    const Effort reused = implicit_scheme(tube, 1e-4, 60, coupling::IqnIls{});
    MESSAGE("rho_s/rho_f 1.1 and dt 1e-4: Aitken " << aitken.mean << " IQN-ILS " << alone.mean
                                                   << " with reuse " << reused.mean);
    CHECK(reused.mean < 0.6 * alone.mean);
    CHECK(alone.mean < 0.6 * aitken.mean);
  }
}
