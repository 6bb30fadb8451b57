// SPDX-License-Identifier: MIT
// Volume-preserving smoothing against VTK's filters on the same surface, 50 sweeps.
#include "goals/goal.hpp"
#include "support/stopwatch.hpp"
#include "support/vtk_peer.hpp"
#include "support/work_cases.hpp"
#include "tunica/mesh/measures.hpp"
#include "tunica/meshing/flat_regions.hpp"
#include "tunica/meshing/marching_cubes.hpp"
#include "tunica/meshing/smooth.hpp"
#include "tunica/meshing/smooth_sweeps.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace tunica::bench {

std::vector<Goal> smoothing_goals() {
  constexpr Index n = 128;
  constexpr int sweeps = 50, repeats = 5;
  constexpr double h = 1.0 / (n - 1);
  const auto image = test::sampled<float>(n, [](const Vec3& x) { return -test::bifurcation(x); });
  const auto raw = meshing::marching_cubes(image, 0).surface;
  mesh::Surface surface;
  const double ours = best_cpu_seconds(repeats, [&] {
    surface = raw;
    static_cast<void>(meshing::smooth(surface, {.sweeps = sweeps}));
  });
  // the sweeps alone: without their preparation and the exact test for crossings at the end
  double alone = ours;
  const auto planes = meshing::flat_regions(raw);
  const meshing::Bonds bonds;
  const std::vector<char> held(static_cast<std::size_t>(raw.node_count()), 0);
  for (int i = 0; i < repeats; ++i) {
    meshing::detail::Sweeps work(raw, planes, bonds, held);
    alone = std::min(alone, best_cpu_seconds(1, [&] {
                       for (int k = 0; k < sweeps; ++k) static_cast<void>(work.sweep(0.5));
                     }));
  }
  const auto drift = [&](const mesh::Surface& s) {
    return std::abs(mesh::enclosed_volume(s) / mesh::enclosed_volume(raw) - 1);
  };
  const auto error = [&](const mesh::Surface& s) {
    return test::distance_to_zero(s.nodes, test::bifurcation).first / h;
  };
  const auto per_move = [&](double seconds) { return 1e9 * seconds / (sweeps * raw.node_count()); };

  Goal volume{.name = "smoothing: volume of the bifurcation",
              .measured = text("drift %.1e at vertex rms %.2e h", drift(surface), error(surface)),
              .target = "drift <= 1e-12 over 50 sweeps and rms <= 1.6e-2 h",
              .ratio = "-",
              .outcome = reached_if(drift(surface) <= 1e-12 && error(surface) <= 1.6e-2)};
  Goal speed{.name = "smoothing: bifurcation 128^3",
             .measured = text("%.1f ns a vertex and sweep (%.1f with preparation and test for crossings)",
                              per_move(alone), per_move(ours)),
             .target = "<= 9 ns a vertex and sweep",
             .ratio = "-",
             .outcome = reached_if(per_move(alone) <= 9)};
  if (const auto peer = vtk_surface(image, "flying_edges windowed_sinc:50")) {
    volume.ratio = text("%s sinc: drift %.1e at %.2e h", peer->version.c_str(), drift(peer->surface),
                        error(peer->surface));
    speed.ratio = text("%.2f x and in all %.2f x (%s sinc: %.1f ns at %.2e h)", peer->cpu / alone,
                       peer->cpu / ours, peer->version.c_str(), per_move(peer->cpu), error(peer->surface));
  }
  return {volume, speed};
}

}  // namespace tunica::bench
