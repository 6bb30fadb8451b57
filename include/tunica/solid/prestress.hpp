// SPDX-License-Identifier: MIT
// Prestress of an imaged shape that carries its load already: modified updated Lagrange (MULF) [GEE10].
#pragma once

#include "tunica/core/expect.hpp"
#include "tunica/la/newton.hpp"
#include "tunica/solid/history.hpp"
#include "tunica/solid/statics.hpp"

#include <Eigen/Core>

#include <limits>
#include <type_traits>

namespace tunica::solid {

struct PrestressOptions {
  int steps = 20;          // of the load; drift and residual after them fall with 1/steps
  double residual = 1e-6;  // of the image itself: above it the drift is stored too, again and again
  int settlings = 20;      // how often at most; none with residual = 1
};

struct [[nodiscard]] PrestressReport {
  SolveReport solve{};       // iterations: in all; status: of the last step
  double load = 0;           // reached factor of the loads: 1 if it converged
  int steps = 0, cuts = 0;   // that held; halved by Statics
  int settlings = 0;         // drifts stored after them
  Index inverted_cell = -1;  // where J <= 0 in the last failed step, -1 if nowhere
  double residual = 0;       // |r| / scale of the imaged shape itself under the whole load
  double drift = 0;          // max |u| of the equilibrium next to it [m]

  [[nodiscard]] explicit operator bool() const { return static_cast<bool>(solve); }
};

namespace detail {
template <class Wall>
[[nodiscard]] PrestressReport balanced_image(Wall& wall, const PrestressOptions& options) {
  TUNICA_EXPECT(options.steps > 0, "the load is raised in steps");
  PrestressReport report;
  for (int left = options.steps; left > 0; --left) {
    const double limit = 1.0 / left;  // of what is left of the load
    while (wall.load() < limit) {
      const StaticsStep step = wall.step(limit);
      report.solve.iterations += step.iterations;
      report.solve.status = step.solve.status;
      report.solve.residual = step.solve.residual;
      report.cuts += step.cuts;
      report.inverted_cell = step.inverted_cell;
      if (!step) return report;
    }
    wall.absorb();
    ++report.steps;
    report.load = static_cast<double>(report.steps) / options.steps;
  }
  while (true) {
    Eigen::VectorXd r;
    const auto info = wall.residual(wall.unknowns(), 1, r, la::no_step);
    report.residual = r.norm() / info.scale;
    const StaticsReport free = wall.solve();
    report.solve.iterations += free.solve.iterations;
    report.solve.status = free.solve.status;
    report.solve.residual = free.solve.residual;
    if (!free) return report;
    report.drift = wall.displacement().colwise().norm().maxCoeff();
    if (report.residual <= options.residual) return report;
    if (report.settlings == options.settlings) break;
    wall.absorb();
    ++report.settlings;
  }
  report.solve.status = Status::max_iterations;
  return report;
}

}  // namespace detail

/// `wall` is composed on the mesh of the imaged shape, with the loads that act there as end values. Raises
/// them in steps and stores the deformation of each, so that the mesh stays the image and its stresses
/// balance the loads; then stores what is left, which each time is less by the stress over the stiffness. The
/// wall is left in the equilibrium next to the image, `drift` away: what follows starts there;
/// wall.body().laws().prestress() is what a Dynamics on the same mesh takes. The stresses are one equilibrium
/// of the image; those of a body that was loaded from a shape free of stress (unloaded_shape) are another.
/// Laws with a history have carried these stresses for ever: the wall is as stiff as after infinite time, and
/// remembers that. A Dynamics then takes both:
///   moving.laws().prestress(wall.body().laws().prestress());
///   remember(moving.laws(), remembered(wall.laws()));  moving.start(wall.displacement(), v);
template <class Wall>
[[nodiscard]] PrestressReport prestress(Wall& wall, const PrestressOptions& options = {}) {
  using Body = std::remove_cvref_t<decltype(wall.body())>;
  static_assert(!std::is_same_v<typename Body::Form::Locking, FBar>,
                "F-bar takes no prestress: it knows F at the centre of the unstressed cell alone");
  if constexpr (has_history<Body>) begin_step(wall.laws(), std::numeric_limits<double>::infinity());
  const PrestressReport report = detail::balanced_image(wall, options);
  if constexpr (has_history<Body>) advance(wall.laws(), wall.body(), wall.unknowns());
  return report;
}

}  // namespace tunica::solid
