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
  std::vector<StaticsStep> path{};  // each step

  [[nodiscard]] explicit operator bool() const { return static_cast<bool>(solve); }
};

}  // namespace tunica::solid
