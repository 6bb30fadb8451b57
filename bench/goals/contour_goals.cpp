// SPDX-License-Identifier: MIT
// Marching cubes against Flying Edges on the same volumes: time with vertex error, order, degeneracy.
#include "goals/goal.hpp"
#include "support/stopwatch.hpp"
#include "support/vtk_peer.hpp"
#include "support/work_cases.hpp"
#include "tunica/mesh/quality.hpp"
#include "tunica/meshing/marching_cubes.hpp"

#include <cmath>
#include <cstdint>

namespace tunica::bench {
namespace {

Index degenerate(const mesh::Surface& s) {
  Index count = 0;
  for (Index t = 0; t < s.cell_count(); ++t) count += !(mesh::triangle(s, t).area() > 0);
  return count;
}

/// Sample of a field that is negative inside, with ours: inside where the value is large.
template <class Field>
image::Image<float> volume(Index n, const Field& field) {
  return test::sampled<float>(n, [&](const Vec3& x) { return -field(x); });
}

Goal speed() {
  constexpr Index n = 128;
  constexpr double h = 1.0 / (n - 1), wanted = 2.5;
  const auto image = volume(n, test::bifurcation);
  meshing::Contour contour;
  const double ours = best_cpu_seconds(7, [&] { contour = meshing::marching_cubes(image, 0); });
  const double error = test::distance_to_zero(contour.surface.nodes, test::bifurcation).first / h;
  Goal goal{.name = "isosurface: bifurcation 128^3",
            .measured = text("%.2f ms at vertex rms %.2e h", 1e3 * ours, error),
            .target = text(">= %.1f x vtkFlyingEdges3D at an error equal within 1 %%", wanted),
            .ratio = "-",
            .outcome = Outcome::unmatched};
  if (const auto peer = vtk_surface(image, "flying_edges")) {
    const double peer_error = test::distance_to_zero(peer->surface.nodes, test::bifurcation).first / h;
    goal.ratio = text("%.2f x (%s: %.2f ms at %.2e h)", peer->cpu / ours, peer->version.c_str(),
                      1e3 * peer->cpu, peer_error);
    goal.outcome = reached_if(peer->cpu / ours >= wanted && error <= 1.01 * peer_error);
  }
  return goal;
}

Goal order() {
  const auto off_grid = [](const Vec3& x) { return (x - Vec3(0.513, 0.487, 0.506)).norm() - 0.4; };
  const auto error = [&](Index n) {
    return test::distance_to_zero(meshing::marching_cubes(volume(n, off_grid), 0).surface.nodes, off_grid)
        .first;
  };
  const double coarse = error(33), fine = error(129);
  const double observed = std::log2(coarse / fine) / 2;
  Goal goal{.name = "isosurface: vertices on a sphere",
            .measured = text("order %.2f and rms %.2e at 129^3", observed, fine),
            .target = "order >= 1.9",
            .ratio = "-",
            .outcome = reached_if(observed >= 1.9)};
  if (const auto peer = vtk_surface(volume(129, off_grid), "flying_edges")) {
    const double theirs = test::distance_to_zero(peer->surface.nodes, off_grid).first;
    goal.ratio = text("error %.3f x (%s: %.2e)", fine / theirs, peer->version.c_str(), theirs);
  }
  return goal;
}

Goal degeneracy() {
  const auto image = test::integer_noise_volume(64);
  const auto ours = meshing::marching_cubes(image, 0);
  Goal goal{.name = "isosurface: integer noise 64^3",
            .measured = text("%d degenerate of %d", degenerate(ours.surface), ours.surface.cell_count()),
            .target = "0 degenerate",
            .ratio = "-",
            .outcome = reached_if(degenerate(ours.surface) == 0)};
  if (const auto peer = vtk_surface(image, "flying_edges"))
    goal.ratio =
        text("%s: %d of %d", peer->version.c_str(), degenerate(peer->surface), peer->surface.cell_count());
  return goal;
}

}  // namespace

std::vector<Goal> contour_goals() {
  return {speed(), order(), degeneracy()};
}

}  // namespace tunica::bench
