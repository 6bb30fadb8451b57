// SPDX-License-Identifier: MIT
// A pressure pulse in a compliant tube: the staggered algorithm of section 6.1 of [PEREZ08] on the
// benchmark of [FORMAGGIA01].
#include "tunica/core/units.hpp"
#include "tunica/coupling/iqn_ils.hpp"
#include "tunica/coupling/matching.hpp"
#include "tunica/coupling/staggered.hpp"
#include "tunica/fluid/projection.hpp"
#include "tunica/meshing/tube.hpp"
#include "tunica/motion/laplace.hpp"
#include "tunica/solid/dynamics.hpp"
#include "tunica/solid/laws.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

int main() {
  using namespace tunica;
  using namespace tunica::literals;

  const meshing::Tube shape{.inner_radius = 5_mm, .thickness = 1_mm, .length = 50_mm, .cells = {2, 18, 30}};
  const auto lumen = meshing::lumen(shape);  // tetrahedra
  const auto tube = meshing::tube(shape);    // hexahedra, their inner nodes those of the lumen's wall

  fluid::Projection blood{lumen, fluid::Newtonian{.density = 1000_kg_m3, .viscosity = 3_mPas},
                          fluid::Fic{.wave_speed = 5.5_m_s}};  // of Moens and Korteweg
  blood.pressure("inlet", [](double t) { return t < 3.05_ms ? 1333.2_Pa : 0.0; });
  blood.pressure("outlet", 0.0);
  blood.interface("wall");

  solid::Hyperelastic law{solid::Yeoh{.c10 = 57.69_kPa}, solid::Quadratic{.kappa = 250_kPa}};  // (17)
  solid::Dynamics wall{tube, law, 1200_kg_m3};
  wall.fix(tube.patch("ends"));
  wall.interface(tube.patch("inner"));

  // (13)-(16) motion of the grid, (11) and (12) on the interface, iterated to convergence
  auto fsi =
      coupling::staggered(blood, wall, motion::Laplace{lumen}, coupling::Matching{}, coupling::IqnIls{});

  const auto radial = [&] {  // mean displacement of the ring at mid-length [m]
    const Points<3> u = wall.nodal_displacement();
    double sum = 0;
    int nodes = 0;
    for (const Index n : wall.interface_nodes())
      if (const Vec3 x = tube.nodes.col(n); std::abs(x[2] - shape.length / 2) < 1_um)
        sum += u.col(n).dot(Vec3(x[0], x[1], 0).normalized()), ++nodes;
    return sum / nodes;
  };
  double peak = 0;
  int iterations = 0;
  for (int n = 1; n <= 50; ++n) {
    const auto step = fsi.step(0.2_ms);
    if (!step) return std::printf("step %d: %s failed\n", n, step.failed.data()), 1;
    iterations += step.iterations;
    peak = std::max(peak, radial());
    if (n % 5 == 0)
      std::printf("t %4.1f ms  radial displacement %7.2f um\n", blood.time() * 1e3, radial() * 1e6);
  }
  std::printf("peak %.1f um, %.1f iterations a step\n", peak * 1e6, iterations / 50.0);
  return peak > 120_um && peak < 160_um ? 0 : 1;  // 158 um on a fine mesh
}
