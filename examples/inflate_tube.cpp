// SPDX-License-Identifier: MIT
// Inflates a thick tube of the paper's wall and holds its stretch against the exact one. [PEREZ08, (17)]
#include "tunica/core/units.hpp"
#include "tunica/meshing/tube.hpp"
#include "tunica/solid/laws.hpp"
#include "tunica/solid/statics.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

using namespace tunica;
using namespace tunica::literals;

int main() {
  const meshing::Tube shape{.inner_radius = 5_mm, .thickness = 1.5_mm, .length = 1_mm, .cells = {4, 16, 1}};
  const auto ring = meshing::quarter_tube(shape);  // a quarter of a slice, in plane strain
  const solid::Yeoh law{.c10 = 174_kPa, .c20 = 1880_kPa};

  solid::Statics wall{ring, solid::Hyperelastic{law, solid::Quadratic{.kappa = 348_MPa}}};
  wall.fix(ring.patch("ends"), solid::Axis::z);
  wall.fix(ring.patch("sym_x"), solid::Axis::x);
  wall.fix(ring.patch("sym_y"), solid::Axis::y);
  const auto lumen = wall.pressure(ring.patch("inner"), 0);  // follows the deformed surface

  // The exact pressure of an incompressible wall: int 2 Phi' (l^2 - l^-2)/(l (l^2 - 1)) dl over the wall.
  const double Ri = shape.inner_radius, Ro = Ri + shape.thickness;
  const auto primitive = [&](double l) {
    const double s = l * l;
    return 2 * law.c10 * (std::log(l) - 0.5 / s) +
           4 * law.c20 * (0.5 * s - std::log(l) + 0.5 / s - 0.25 / (s * s));
  };
  const auto pressure = [&](double l) {
    return primitive(l) - primitive(std::sqrt(l * l * Ri * Ri + Ro * Ro - Ri * Ri) / Ro);
  };

  const Index node = mesh::patch_nodes(ring.patch("inner")).front();
  double worst = 0;
  std::printf("%12s %14s %14s %10s %10s\n", "p [kPa]", "exact stretch", "inner stretch", "p off [%]",
              "iterations");
  for (const double exact : {1.02, 1.05, 1.10, 1.20}) {
    wall.pressure(lumen, pressure(exact));
    const auto report = wall.solve();
    if (!report) return std::printf("no equilibrium: %s\n", name(report.solve.status).data()), 1;
    const Vec3 x = ring.nodes.col(node) + wall.displacement().col(node);
    const double stretch = x.head<2>().norm() / Ri;
    const double error = 100 * (pressure(stretch) / pressure(exact) - 1);
    worst = std::max(worst, std::abs(error));
    std::printf("%12.4f %14.6f %14.6f %10.4f %10d\n", 1e-3 * pressure(exact), exact, stretch, error,
                report.solve.iterations);
  }
  return worst < 1 ? 0 : 1;
}
