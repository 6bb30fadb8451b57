// SPDX-License-Identifier: MIT
// Lambda-mu smoothing [TAUBIN95], for comparison: a Laplace sweep that shrinks and one that swells by turns.
// Volume and flat ends are not kept, and nothing hinders the surface from crossing itself: see smooth.hpp.
#pragma once

#include "tunica/core/expect.hpp"
#include "tunica/core/vec.hpp"
#include "tunica/mesh/adjacency.hpp"
#include "tunica/mesh/measures.hpp"

namespace tunica::meshing {

struct TaubinOptions {
  int sweeps = 20;         // pairs of a step with lambda and one with mu
  double lambda = 0.5;     // of the way to the mean of the neighbours, 0 < lambda < 1 [-]
  double pass_band = 0.1;  // k_PB = 1/lambda + 1/mu, 0 <= k_PB < 1/lambda; 0: no shrinking, no swelling [-]
};

struct [[nodiscard]] TaubinReport {
  double volume_before = 0, volume_after = 0;  // in the unit of the surface cubed
};

/// Smooths in place. All neighbours of a node weigh the same; open rims move as other nodes do.
inline TaubinReport taubin(mesh::Surface& s, const TaubinOptions& options = {}) {
  TUNICA_EXPECT(options.lambda > 0 && options.lambda < 1 && options.pass_band * options.lambda < 1,
                "0 < lambda < 1 and the pass band below 1/lambda");
  TaubinReport report{mesh::enclosed_volume(s), 0};
  const double mu = 1 / (options.pass_band - 1 / options.lambda);  // < -lambda
  const mesh::Rows near = mesh::neighbours_of_nodes(s.cells, s.node_count());
  Points<3> next = s.nodes;
  for (int step = 0; step < 2 * options.sweeps; ++step) {
    const double factor = step % 2 == 0 ? options.lambda : mu;
    for (Index n = 0; n < s.node_count(); ++n) {
      if (near[n].empty()) continue;
      Vec3 mean(0, 0, 0);
      for (const Index m : near[n]) mean = vec::plus(mean, mesh::node(s, m));
      mean = vec::divided(mean, static_cast<double>(near[n].size()));
      // x' = x + factor (mean - x)   [TAUBIN95, (2) and (3)]
      vec::set_column(next, n, vec::between(mesh::node(s, n), mean, factor));
    }
    s.nodes.swap(next);
  }
  report.volume_after = mesh::enclosed_volume(s);
  return report;
}

}  // namespace tunica::meshing
