// SPDX-License-Identifier: MIT
// Hexahedra in the bifurcation: the dual mesh of a grid with layers on the surface, and round the voxels.
#include "goals/goal.hpp"
#include "support/stopwatch.hpp"
#include "support/work_cases.hpp"
#include "tunica/meshing/dual_hexahedra.hpp"
#include "tunica/meshing/marching_cubes.hpp"
#include "tunica/meshing/voxel_hexahedra.hpp"

#include <cmath>
#include <cstdint>
#include <vector>

namespace tunica::bench {

std::vector<Goal> hex_goals() {
  constexpr Index n = 128;
  constexpr double h = 1.0 / (n - 1);
  const auto image = test::sampled<float>(n, [](const Vec3& x) { return -test::bifurcation(x); });
  const auto surface = meshing::marching_cubes(image, 0).surface;
  meshing::HexFill fill;
  const double seconds = best_cpu_seconds(3, [&] { fill = meshing::dual_hexahedra(surface, {.edge = h}); });
  const auto& r = fill.report;
  const double speed = 1e-3 * r.cells / seconds, drift = 100 * std::abs(r.volume / r.surface_volume - 1);

  std::vector<std::uint8_t> kept;
  for (const float v : image.values) kept.push_back(v >= 0 ? 1 : 0);
  Index voxels = 0;
  const double boxes =
      best_cpu_seconds(5, [&] { voxels = meshing::voxel_hexahedra(image, kept).mesh.cell_count(); });
  return {{.name = "hexahedra: bifurcation 128^3, quality",
           .measured = text("%d inverted; scaled Jacobian least %.2f 1st percentile %.2f mean %.3f",
                            r.inverted, r.least_jacobian, r.first_percentile, r.mean_jacobian),
           .target = "0 inverted; least >= 0.2; 1st percentile >= 0.3; mean >= 0.85",
           .ratio = "-",
           .outcome = reached_if(r.inverted == 0 && r.least_jacobian >= 0.2 && r.first_percentile >= 0.3 &&
                                 r.mean_jacobian >= 0.85)},
          {.name = "hexahedra: bifurcation 128^3, surface",
           .measured = text("rms %.1e h and volume %.1e %% off", r.distance_rms / h, drift),
           .target = "rms <= 3e-2 h and volume within 0.5 %",
           .ratio = "-",
           .outcome = reached_if(r.distance_rms <= 0.03 * h && drift <= 0.5)},
          {.name = "hexahedra: bifurcation 128^3, speed",
           .measured = text("%.0f k hexahedra/s at least scaled Jacobian %.2f", speed, r.least_jacobian),
           .target = ">= 100 k/s with improvement",
           .ratio = "-",
           .outcome = reached_if(speed >= 100)},
          {.name = "voxel hexahedra: bifurcation 128^3",
           .measured = text("%.1f M hexahedra/s (%d)", 1e-6 * voxels / boxes, voxels),
           .target = ">= 2 M/s",
           .ratio = "-",
           .outcome = reached_if(1e-6 * voxels / boxes >= 2)}};
}

}  // namespace tunica::bench
