// SPDX-License-Identifier: MIT
// Volume-preserving smoothing against VTK's filters on the same surface, 20 sweeps.
#include "goals/goal.hpp"
#include "support/stopwatch.hpp"
#include "support/vtk_peer.hpp"
#include "support/work_cases.hpp"
#include "tunica/mesh/measures.hpp"
#include "tunica/meshing/marching_cubes.hpp"
#include "tunica/meshing/smooth.hpp"

#include <cmath>

namespace tunica::bench {

std::vector<Goal> smoothing_goals() {
  constexpr Index n = 128;
  constexpr int sweeps = 20;
  constexpr double h = 1.0 / (n - 1);
  const auto image = test::sampled<float>(n, [](const Vec3& x) { return -test::bifurcation(x); });
  const auto raw = meshing::marching_cubes(image, 0).surface;
  mesh::Surface surface;
  const double ours = best_cpu_seconds(3, [&] {
    surface = raw;
    static_cast<void>(meshing::smooth(surface, {.sweeps = sweeps}));
  });
  const auto drift = [&](const mesh::Surface& s) {
    return std::abs(mesh::enclosed_volume(s) / mesh::enclosed_volume(raw) - 1);
  };
  const auto error = [&](const mesh::Surface& s) {
    return test::distance_to_zero(s.nodes, test::bifurcation).first / h;
  };
  const auto per_move = [&](double seconds) { return 1e9 * seconds / (sweeps * raw.node_count()); };

  Goal volume{.name = "smoothing: volume of the bifurcation",
              .measured = text("drift %.1e at vertex rms %.2e h", drift(surface), error(surface)),
              .target = "drift <= 1e-6 over 20 sweeps",
              .ratio = "-",
              .outcome = reached_if(drift(surface) <= 1e-6)};
  Goal speed{
      .name = "smoothing: bifurcation 128^3",
      .measured = text("%.1f ns a vertex and sweep at vertex rms %.2e h", per_move(ours), error(surface)),
      .target = ">= 4 x vtkWindowedSinc",
      .ratio = "-",
      .outcome = Outcome::unmatched};
  if (const auto peer = vtk_surface(image, "flying_edges windowed_sinc:20")) {
    volume.ratio = text("%s sinc: drift %.1e at %.2e h", peer->version.c_str(), drift(peer->surface),
                        error(peer->surface));
    speed.ratio = text("%.2f x (%s: %.1f ns at %.2e h)", peer->cpu / ours, peer->version.c_str(),
                       per_move(peer->cpu), error(peer->surface));
    speed.outcome = reached_if(peer->cpu / ours >= 4);
  }
  return {volume, speed};
}

}  // namespace tunica::bench
