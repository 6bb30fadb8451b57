// SPDX-License-Identifier: MIT
// Volume-preserving smoothing against VTK's filters on the same surface, 50 sweeps.
#include "goals/goal.hpp"
#include "support/provenance.hpp"
#include "support/smoothing_time.hpp"
#include "support/vtk_peer.hpp"
#include "tunica/mesh/measures.hpp"
#include "tunica/meshing/intersections.hpp"

#include <cmath>
#include <cstdint>
#include <optional>
#include <sstream>
#include <string>

#ifndef TUNICA_SMOOTHING_NATIVE
#define TUNICA_SMOOTHING_NATIVE ""
#endif

namespace tunica::bench {
namespace {

constexpr double wanted_ns = 9;
constexpr double h = 1.0 / (SmoothingTime::n - 1);

/// Sweeps alone and the whole call, a vertex and sweep [ns].
struct PerMove {
  double alone = 0, call = 0;
};

/// Of the program built for the machine at hand; nothing where it is not there.
std::optional<PerMove> native() {
  const std::string program = TUNICA_SMOOTHING_NATIVE;
  if (program.empty()) return std::nullopt;
  std::istringstream reply(output_of("'" + program + "'"));
  PerMove t;
  if (!(reply >> t.alone >> t.call)) return std::nullopt;
  return t;
}

Goal speed(const std::string& name, const PerMove& ours, double error, const std::optional<PeerSurface>& peer,
           double peer_ns) {
  Goal goal{.name = name,
            .measured = text("%.1f ns a vertex and sweep at vertex rms %.2e h (%.1f with all of a call)",
                             ours.alone, error, ours.call),
            .target = text("<= %.0f ns a vertex and sweep", wanted_ns),
            .ratio = "-",
            .outcome = reached_if(ours.alone <= wanted_ns)};
  if (peer)
    goal.ratio = text("%.2f x and in all %.2f x (%s sinc: %.1f ns)", peer_ns / ours.alone,
                      peer_ns / ours.call, peer->version.c_str(), peer_ns);
  return goal;
}

/// Random waves on 40^3, each smoothed by 30 sweeps.
Goal safety() {
  constexpr int surfaces = 200, sweeps = 30;
  int crossing = 0;
  for (int seed = 1; seed <= surfaces; ++seed) {
    const test::RandomWaves waves(static_cast<std::uint64_t>(seed));
    auto s = meshing::marching_cubes(test::sampled<float>(40, [&](const Vec3& x) { return -waves(x); }), 0)
                 .surface;
    static_cast<void>(meshing::smooth(s, {.sweeps = sweeps}));
    crossing += !meshing::self_intersections(s, 1).empty();
  }
  return {.name = "smoothing: random surfaces",
          .measured = text("%d of %d cross themselves after %d sweeps", crossing, surfaces, sweeps),
          .target = "none",
          .ratio = "-",
          .outcome = reached_if(crossing == 0)};
}

}  // namespace

std::vector<Goal> smoothing_goals() {
  const auto image = smoothing_volume();
  const SmoothingTime ours(image);
  const auto drift = [&](const mesh::Surface& s) {
    return std::abs(mesh::enclosed_volume(s) / mesh::enclosed_volume(ours.raw) - 1);
  };
  const auto error = [](const mesh::Surface& s) {
    return test::distance_to_zero(s.nodes, test::bifurcation).first / h;
  };
  const double rms = error(ours.smoothed);
  Goal volume{.name = "smoothing: volume of the bifurcation",
              .measured = text("drift %.1e at vertex rms %.2e h", drift(ours.smoothed), rms),
              .target = "drift <= 1e-12 over 50 sweeps and rms <= 1.6e-2 h",
              .ratio = "-",
              .outcome = reached_if(drift(ours.smoothed) <= 1e-12 && rms <= 1.6e-2)};
  const auto peer = vtk_surface(image, "flying_edges windowed_sinc:50");
  if (peer)
    volume.ratio = text("%s sinc: drift %.1e at %.2e h", peer->version.c_str(), drift(peer->surface),
                        error(peer->surface));
  const double peer_ns = peer ? ours.per_move(peer->cpu) : 0;
  std::vector<Goal> goals{
      volume, speed("smoothing: bifurcation 128^3", {ours.per_move(ours.alone), ours.per_move(ours.call)},
                    rms, peer, peer_ns)};
  if (const auto t = native())
    goals.push_back(speed("smoothing: bifurcation 128^3, -march=native", *t, rms, peer, peer_ns));
  goals.push_back(safety());
  return goals;
}

}  // namespace tunica::bench
