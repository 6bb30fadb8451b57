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
  const double kappa = 2e6 * exact.c10;  // kappa/mu of a million: what is left is the mesh's error
  const auto error = [&](const Inflation& reached) {
    return std::abs(exact.pressure(reached.stretch) / exact.pressure(stretch) - 1);
  };
  const auto mesh = tube_mesh(exact, 4);
  Inflation reached;
  const double seconds = best_cpu_seconds(3, [&] { reached = inflate(mesh, exact, stretch, kappa); });
  const Inflation coarse = inflate(tube_mesh(exact, 2), exact, stretch, kappa);
  const double order = std::log2(error(coarse) / error(reached));
  return {{.name = "solid: thick tube at inner stretch 1.10",
           .measured = text("pressure off by %.3f %% at order %.2f in %.0f ms with 4 Hex8 through the wall",
                            100 * error(reached), order, 1e3 * seconds),
           .target = "within 0.1 % of the closed form at order >= 1.9",
           .ratio = "-",
           .outcome =
               reached_if(coarse.converged && reached.converged && error(reached) <= 1e-3 && order >= 1.9)}};
}

}  // namespace tunica::bench
