// SPDX-License-Identifier: MIT
// Dual contouring of an image: time with vertex error, error at 64^3, sharp rims, and noise on the iso-value.
#include "goals/goal.hpp"
#include "support/stopwatch.hpp"
#include "support/vtk_peer.hpp"
#include "support/work_cases.hpp"
#include "tunica/mesh/quality.hpp"
#include "tunica/mesh/topology.hpp"
#include "tunica/meshing/dual_cuts.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace tunica::bench {
namespace {

image::Image<float> bifurcation(Index n) {
  return test::sampled<float>(n, [](const Vec3& x) { return -test::bifurcation(x); });
}

Goal speed() {
  constexpr Index n = 128;
  constexpr double h = 1.0 / (n - 1), most = 5.7e-3;
  const auto image = bifurcation(n);
  meshing::Contour contour;
  const double seconds = best_cpu_seconds(9, [&] { contour = meshing::dual_contour_image(image, {}, 0); });
  const double error = test::distance_to_zero(contour.surface.nodes, test::bifurcation).first / h;
  Goal goal{.name = "dual contouring: bifurcation 128^3",
            .measured = text("%.2f ms at vertex rms %.2e h, %d triangles", 1e3 * seconds, error,
                             contour.surface.cell_count()),
            .target = "<= 5.7 ms",
            .ratio = "-",
            .outcome = reached_if(seconds <= most)};
  if (const auto peer = vtk_surface(image, "flying_edges"))
    goal.ratio =
        text("%.2f x (%s Flying Edges: %.2f ms at %.2e h)", peer->cpu / seconds, peer->version.c_str(),
             1e3 * peer->cpu, test::distance_to_zero(peer->surface.nodes, test::bifurcation).first / h);
  return goal;
}

Goal accuracy() {
  constexpr Index n = 64;
  const auto surface = meshing::dual_contour_image(bifurcation(n), {}, 0).surface;
  const auto [rms, largest] = test::distance_to_zero(surface.nodes, test::bifurcation);
  return {.name = "dual contouring: bifurcation 64^3",
          .measured = text("vertex rms %.2e h, max %.2e h", rms * (n - 1), largest * (n - 1)),
          .target = "rms <= 2.0e-2 h",
          .ratio = "-",
          .outcome = reached_if(rms * (n - 1) <= 2.0e-2)};
}

/// A cylinder with an end square to it and an oblique one: distance of their rims from the cylinder.
Goal sharp_edges() {
  constexpr Index n = 64;
  constexpr double h = 1.0 / (n - 1), radius = 0.23;
  const Vec3 centre(0.51, 0.49, 0.5), axis = Vec3(1, 2, 6).normalized();
  const auto off = [&](const Vec3& x) {
    const Vec3 d = x - centre;
    return (d - d.dot(axis) * axis).norm() - radius;
  };
  const std::vector<meshing::Cut> cuts{{.point = centre + 0.24 * axis, .normal = axis},
                                       {.point = centre - 0.2 * axis, .normal = -axis + Vec3(0.3, -0.2, 0)}};
  const auto s = meshing::dual_contour_image(test::sampled<float>(n, [&](const Vec3& x) { return -off(x); }),
                                             {}, 0, cuts)
                     .contour.surface;
  std::vector<char> wall(static_cast<std::size_t>(s.node_count()), 0);
  for (Index t = 0; t < s.cell_count(); ++t)
    if (s.region_of(t) == 0)
      for (int k = 0; k < 3; ++k) wall[static_cast<std::size_t>(s.cells(k, t))] = 1;
  double rim = 0, plane = 0;
  for (Index t = 0; t < s.cell_count(); ++t) {
    if (s.region_of(t) == 0) continue;
    const auto& cut = cuts[static_cast<std::size_t>(s.region_of(t)) - 1];
    for (int k = 0; k < 3; ++k) {
      const Vec3 x = mesh::node(s, s.cells(k, t));
      plane = std::max(plane, std::abs(cut.normal.normalized().dot(x - cut.point)));
      if (wall[static_cast<std::size_t>(s.cells(k, t))] != 0) rim = std::max(rim, std::abs(off(x)));
    }
  }
  return {.name = "dual contouring: cut cylinder",
          .measured = text("sharp edges within %.1e h, ends plane within %.0e h", rim / h, plane / h),
          .target = "edges <= 0.05 h",
          .ratio = "-",
          .outcome = reached_if(rim <= 0.05 * h && plane <= 1e-12 * h)};
}

Goal noise(const char* name, const image::Image<float>& image) {
  const auto s = meshing::dual_contour_image(image, {}, 0).surface;
  const auto t = mesh::topology(s);
  Index degenerate = 0;
  for (Index c = 0; c < s.cell_count(); ++c) degenerate += !(mesh::triangle(s, c).area() > 0);
  const Index edges = t.nonmanifold_edges + t.misoriented_edges;
  return {.name = name,
          .measured = text("%d open, %d bad edges, %d bad vertices, %d degenerate of %d", t.open_edges, edges,
                           t.nonmanifold_nodes, degenerate, s.cell_count()),
          .target = "0, 0, 0, 0",
          .ratio = "-",
          .outcome = reached_if(t.open_edges + edges + t.nonmanifold_nodes + degenerate == 0)};
}

}  // namespace

std::vector<Goal> dual_goals() {
  return {speed(), accuracy(), sharp_edges(), noise("dual contouring: noise 64^3", test::noise_volume(64)),
          noise("dual contouring: integer noise 64^3", test::integer_noise_volume(64))};
}

}  // namespace tunica::bench
