// SPDX-License-Identifier: MIT
// Where a body goes first when some of its nodes are moved: along the tangent, unless that misleads.
#pragma once

#include "tunica/la/newton.hpp"

#include <Eigen/Core>

#include <limits>

namespace tunica::solid {

/// u += d + dx, d being the steps of the prescribed unknowns and dx = -K_ff^-1 (r + K_fp d) the rest along
/// the tangent at u. Fibres that are slack and about to be taut are not in that tangent, and the rest then
/// goes astray by their stiffness over that of their ground: where the forces, with the pressures predicted,
/// are out of balance by more than if nothing followed, u += d alone. False, with u + d, if cells have J <= 0
/// either way.
template <class Solver, class Problem>
bool follow(la::Newton<Solver>& newton, Problem& problem, Eigen::VectorXd& u, const Eigen::VectorXd& d) {
  constexpr double nowhere = std::numeric_limits<double>::infinity();
  // K d by a difference of the forces along d: a length of 1e-7 of it is exact enough for a start.
  constexpr double length = 1e-7;
  Eigen::VectorXd r0, r1, dx;
  const bool known = problem.residual(u + length * d, r1, la::no_step).admissible &&
                     problem.residual(u, r0, la::no_step).admissible;
  if (!known) return false;
  const bool led = static_cast<bool>(newton.linear(problem, u, (r0 - r1) / length - r0, dx));
  const auto out_of_balance = [&](const Eigen::VectorXd& step) {
    (void)problem.residual(u, r0, la::no_step);
    problem.direction(step);
    const auto info = problem.residual(u + step, r1, 1);
    return info.admissible && info.merit < nowhere ? info.merit : nowhere;
  };
  const double alone = out_of_balance(d), together = led ? out_of_balance(d + dx) : nowhere;
  u += d;
  if (together < nowhere && together <= alone) u += dx;
  return alone < nowhere || together < nowhere;
}

}  // namespace tunica::solid
