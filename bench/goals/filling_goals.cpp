// SPDX-License-Identifier: MIT
// Tetrahedra in a smoothed bifurcation, the triangles of the surface kept: quality and speed in one run.
#include "goals/goal.hpp"
#include "support/stopwatch.hpp"
#include "support/work_cases.hpp"
#include "tunica/meshing/marching_cubes.hpp"
#include "tunica/meshing/smooth.hpp"
#include "tunica/meshing/tetrahedra.hpp"

namespace tunica::bench {

std::vector<Goal> filling_goals() {
  const auto image = test::sampled<float>(136, [](const Vec3& x) { return -test::bifurcation(x); });
  auto surface = meshing::marching_cubes(image, 0).surface;
  static_cast<void>(meshing::smooth(surface, {.sweeps = 30}));
  meshing::FillReport r;
  const double seconds = best_cpu_seconds(1, [&] { r = meshing::tetrahedra(surface).report; });
  const double speed = 1e-3 * r.tetrahedra / seconds;
  return {{.name = "filling: bifurcation 136^3, quality",
           .measured = text("dihedral %.1f to %.1f deg and mean ratio %.3f of %d", r.min_dihedral,
                            r.max_dihedral, r.mean_ratio, r.tetrahedra),
           .target = "smallest >= 12 and largest <= 160 deg and ratio >= 0.82",
           .ratio = "-",
           .outcome = reached_if(r.min_dihedral >= 12 && r.max_dihedral <= 160 && r.mean_ratio >= 0.82)},
          {.name = "filling: bifurcation 136^3, speed",
           .measured = text("%.1f k tetrahedra/s at volume error %.1e", speed, r.volume_error),
           .target = ">= 30 k/s with improvement",
           .ratio = "-",
           .outcome = reached_if(speed >= 30)}};
}

}  // namespace tunica::bench
