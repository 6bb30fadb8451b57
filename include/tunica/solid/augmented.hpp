// SPDX-License-Identifier: MIT
// The incompressible limit with a moderate bulk modulus: an augmented Lagrangian of the volumes   [SIMO91].
#pragma once

#include "tunica/solid/statics.hpp"

#include <vector>

namespace tunica::solid {

struct AugmentedOptions {
  double tolerance = 1e-8;  // on theta - 1 of every cell, |v/V - 1| with MeanVolume: see Interior::augment
  int most = 20;            // augmentations
};

struct [[nodiscard]] AugmentedReport {
  SolveReport solve;                  // iterations: of Newton in all; residual: the last of these errors
  std::vector<double> volume_errors;  // the largest of all cells after each solve

  [[nodiscard]] explicit operator bool() const { return static_cast<bool>(solve); }
};

/// Solves, makes multipliers of the pressures and solves again until the volumes are kept: each round takes
/// their error down by about the ratio of the wall's stiffness to kappa, so kappa = 1e3 mu does what 1e9
/// would, and its tangents are as good as those of 1e3. `wall`: a Statics whose cells keep pressures
/// (MeanVolume, LinearVolume, FBar of a pair).
/// `stalled` when the error no longer falls, `max_iterations` after `most` rounds.
template <class Wall>
AugmentedReport solve_incompressible(Wall& wall, AugmentedOptions options = {}) {
  AugmentedReport report;
  for (int round = 0;; ++round) {
    const StaticsReport solved = wall.solve();
    report.solve.iterations += solved.solve.iterations;
    report.solve.status = solved.solve.status;
    if (!solved) return report;
    const double error = wall.augment();
    const bool falls = report.volume_errors.empty() || error < report.volume_errors.back();
    report.volume_errors.push_back(error);
    report.solve.residual = error;
    if (error <= options.tolerance) return report;
    if (!falls || round == options.most) {
      report.solve.status = falls ? Status::max_iterations : Status::stalled;
      return report;
    }
  }
}

}  // namespace tunica::solid
