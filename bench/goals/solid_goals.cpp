// SPDX-License-Identifier: MIT
// The thick tube of law (17) inflated, against its closed form: error and time to equilibrium.
#include "goals/goal.hpp"
#include "support/inflated_tube.hpp"
#include "support/stopwatch.hpp"

#include <cmath>

namespace tunica::bench {

std::vector<Goal> solid_goals() {
  const test::ThickTube exact;
  constexpr double stretch = 1.10;
  const auto mesh = tube_mesh(exact, 4);
  Inflation reached;
  const double seconds =
      best_cpu_seconds(3, [&] { reached = inflate(mesh, exact, stretch, 2000 * exact.c10); });
  const double error = std::abs(exact.pressure(reached.stretch) / exact.pressure(stretch) - 1);
  return {{.name = "solid: thick tube at inner stretch 1.10",
           .measured = text("pressure off by %.2f %% in %.0f ms with 4 Hex8 through the wall", 100 * error,
                            1e3 * seconds),
           .target = "within 1 % of the closed form",
           .ratio = "-",
           .outcome = reached_if(reached.converged && error <= 0.01)}};
}

}  // namespace tunica::bench
