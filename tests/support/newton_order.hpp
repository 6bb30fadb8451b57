// SPDX-License-Identifier: MIT
// The order of Newton's method at an equilibrium, free of which iterates a load happens to give.
#pragma once

#include "tunica/solid/statics.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace test {

struct NewtonOrder {
  double slope = 9;  // the least of the ratios log(r1/r1') / log(r0/r0'): 2 where Newton is quadratic
  int ratios = 0;    // how many lay in the asymptotic range above rounding
};

/// From an equilibrium that is moved by t times its own displacement (where it is free), one step of Newton
/// takes the residual r0(t) to r1(t). The three last residuals of one solve tell the slope of log r1 over
/// log r0 only if the constant in r1 = C r0^2 is the same in both steps; along one direction it is, so t is
/// halved again and again from 1e-2 on. Counted are the ratios with r0 below a tenth of the forces, r1
/// below a tenth of r0 and above ten times the rounding. The wall is left in equilibrium.
template <class Wall>
NewtonOrder newton_order(Wall& wall) {
  const tunica::Points<3> u = wall.displacement();
  tunica::Points<3> w = u;
  for (Eigen::Index k = 0; k < w.size(); ++k)
    if (wall.body().fixed(static_cast<tunica::Index>(k))) w.reshaped()[k] = 0;
  NewtonOrder order;
  std::vector<double> before;
  for (double t = 1e-2; t > 1e-8; t /= 2) {
    wall.start(u + t * w);
    const auto report = wall.solve();
    const auto& h = report.history;
    const bool counts =
        report && h.size() > 1 && h[0] < 0.1 && h[1] < 0.1 * h[0] && h[1] > 10 * report.rounding;
    if (counts && !before.empty()) {
      order.slope = std::min(order.slope, std::log(h[1] / before[1]) / std::log(h[0] / before[0]));
      ++order.ratios;
    }
    before = counts ? h : std::vector<double>{};
  }
  return order;
}

}  // namespace test
