// SPDX-License-Identifier: MIT
// Backward differences of order one and two with steps of any ratio.
#pragma once

namespace tunica::fluid {

/// d/dt f at the new time = now f^{n+1} + last f^n + before f^{n-1}  [1/s];
/// f^{n+1} ~ extrapolate_last f^n + extrapolate_before f^{n-1}.
struct Bdf {
  double now, last, before;
  double extrapolate_last, extrapolate_before;
};

/// BDF1: the first step of a run.
[[nodiscard]] constexpr Bdf bdf1(double dt) {
  return {1 / dt, -1 / dt, 0, 1, 0};
}

/// BDF2 over dt after a step of dt_last; for equal steps (3 f^{n+1} - 4 f^n + f^{n-1}) / (2 dt).
[[nodiscard]] constexpr Bdf bdf2(double dt, double dt_last) {
  const double r = dt / dt_last;
  return {(1 + 2 * r) / (1 + r) / dt, -(1 + r) / dt, r * r / (1 + r) / dt, 1 + r, -r};
}

}  // namespace tunica::fluid
