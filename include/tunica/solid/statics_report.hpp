// SPDX-License-Identifier: MIT
// How statics goes along its path of loads, and what it tells of it.
#pragma once

#include "tunica/core/solve_report.hpp"
#include "tunica/core/types.hpp"
#include "tunica/la/newton.hpp"

#include <vector>

namespace tunica::solid {

struct StaticsOptions {
  double first_step = 1;        // of the load, whose end is 1
  double smallest_step = 1e-4;  // below it the solution is given up
  double growth = 2;            // of the step after an easy one (at most easy_iterations)
  int easy_iterations = 6;
  la::NewtonOptions newton{};
};

/// One step that held, or the last attempt at one that did not.
struct [[nodiscard]] StaticsStep {
  SolveReport solve{};            // of Newton
  double load = 0;                // reached factor of the loads
  int cuts = 0;                   // attempts rolled back and halved before it
  int iterations = 0;             // of Newton, with those of the failed attempts
  Index inverted_cell = -1;       // where J <= 0 in the last failed attempt, -1 if nowhere
  std::vector<double> history{};  // |r| / scale of the last Newton solve
  double rounding = 0;            // what of that is rounding
  /// Independent directions in which the last tangent was negative: with any, the equilibrium is one that a
  /// body leaves (past a limit or branching point). -1 where the solver does not count them (Ldlt does).
  Index unstable = -1;

  [[nodiscard]] explicit operator bool() const { return static_cast<bool>(solve); }
};

struct [[nodiscard]] StaticsReport {
  SolveReport solve{};              // iterations: of Newton in all; residual: of the last step that held
  double load = 0;                  // reached factor of the loads: 1 if it converged
  int steps = 0;                    // that held
  int cuts = 0;                     // steps rolled back and halved
  Index inverted_cell = -1;         // where J <= 0 in the last failed step, -1 if nowhere
  std::vector<double> history{};    // |r| / scale of the last Newton solve
  double rounding = 0;              // what of that is rounding
  Index unstable = -1;              // of the last step: see StaticsStep
  std::vector<StaticsStep> path{};  // each step

  [[nodiscard]] explicit operator bool() const { return static_cast<bool>(solve); }
};

/// What Newton tells of a step; `pressures`: unknowns in whose directions a stable tangent is negative.
inline void tell(const la::NewtonReport& newton, Index pressures, StaticsStep& step) {
  step.solve = newton.solve;
  step.iterations += newton.solve.iterations;
  step.history = newton.history;
  step.rounding = newton.rounding;
  if (newton.negative_pivots >= 0) step.unstable = newton.negative_pivots - pressures;
}

/// The report of a path with one more step; the residual is that of steps that held.
inline void tell(const StaticsStep& step, StaticsReport& report) {
  report.solve.iterations += step.iterations;
  report.solve.status = step.solve.status;
  report.history = step.history;
  report.rounding = step.rounding;
  report.unstable = step.unstable;
  report.cuts += step.cuts;
  report.load = step.load;
  if (step.inverted_cell >= 0) report.inverted_cell = step.inverted_cell;
  if (!step) return;
  report.solve.residual = step.solve.residual;
  ++report.steps;
}

}  // namespace tunica::solid
