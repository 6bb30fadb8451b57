// SPDX-License-Identifier: MIT
// The thick tube of law (17) inflated, against its closed form: error and time to equilibrium.
#include "goals/goal.hpp"
#include "support/stopwatch.hpp"
#include "support/thick_tube.hpp"
#include "tunica/mesh/patch_nodes.hpp"
#include "tunica/meshing/tube.hpp"
#include "tunica/solid/laws.hpp"
#include "tunica/solid/statics.hpp"

#include <cmath>

namespace tunica::bench {

std::vector<Goal> solid_goals() {
  const test::ThickTube exact;
  constexpr double stretch = 1.10;
  const auto mesh = meshing::quarter_tube({.inner_radius = exact.inner,
                                           .thickness = exact.outer - exact.inner,
                                           .length = 1e-3,
                                           .cells = {4, 16, 1}});
  double reached = 0;
  bool converged = false;
  const double seconds = best_cpu_seconds(3, [&] {
    solid::Statics wall{mesh, solid::Hyperelastic{solid::Yeoh{.c10 = exact.c10, .c20 = exact.c20},
                                                  solid::Quadratic{.kappa = 2000 * exact.c10}}};
    wall.fix(mesh.patch("ends"), solid::Axis::z);
    wall.fix(mesh.patch("sym_x"), solid::Axis::x);
    wall.fix(mesh.patch("sym_y"), solid::Axis::y);
    wall.pressure(mesh.patch("inner"), exact.pressure(stretch));
    converged = static_cast<bool>(wall.solve());
    const Points<3> x = mesh.nodes + wall.displacement();
    const auto nodes = mesh::patch_nodes(mesh.patch("inner"));
    reached = 0;
    for (const Index n : nodes)
      reached += x.col(n).head<2>().norm() / (exact.inner * static_cast<double>(nodes.size()));
  });
  const double error = std::abs(exact.pressure(reached) / exact.pressure(stretch) - 1);
  return {{.name = "solid: thick tube at inner stretch 1.10",
           .measured = text("pressure off by %.2f %% in %.0f ms with 4 Hex8 through the wall", 100 * error,
                            1e3 * seconds),
           .target = "within 1 % of the closed form",
           .ratio = "-",
           .outcome = reached_if(converged && error <= 0.01)}};
}

}  // namespace tunica::bench
