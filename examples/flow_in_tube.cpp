// SPDX-License-Identifier: MIT
// Flow in a rigid tube, fed by a velocity, against the exact solution of Poiseuille.
#include "tunica/core/units.hpp"
#include "tunica/fluid/inlet.hpp"
#include "tunica/fluid/projection.hpp"
#include "tunica/meshing/tube.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

using namespace tunica;
using namespace tunica::literals;

int main() {
  const meshing::Lumen tube{.radius = 5_mm, .length = 20_mm, .cells = {6, 36, 24}};
  const double U = 0.002_m_s, R = tube.radius, mu = 3.5_mPas;  // mean velocity; Re = 6
  const auto mesh = meshing::lumen(tube);

  const fluid::Newtonian newtonian{.density = 1050_kg_m3, .viscosity = mu};
  fluid::Projection blood{mesh, newtonian, fluid::Fic{}, fluid::FixedMesh{}};  // no grid velocity is compiled
  blood.velocity("inlet", fluid::inlet_profile(mesh, "inlet"),
                 [U](double t) { return U * std::min(1.0, t / 1_s); });
  blood.pressure("outlet", 0.0);  // the third patch, "wall", has no condition: no slip

  for (int n = 0; n < 60; ++n)
    if (const auto report = blood.step(0.2_s); !report) {
      std::fprintf(stderr, "error: the flow ended as %s\n", name(report.status).data());
      return 1;
    }

  // u = 2 U (1 - r^2/R^2), p = 8 mu U (L - z) / R^2
  double error = 0, size = 0, drop = 0, inside = 0;
  for (Index i = 0; i < mesh.node_count(); ++i) {
    const Vec3 x = mesh.nodes.col(i);
    const double exact = 2 * U * (1 - x.head<2>().squaredNorm() / (R * R));
    error += (blood.velocity().col(i) - Vec3(0, 0, exact)).squaredNorm(), size += exact * exact;
    if (x[2] < 1e-9) drop += blood.pressure()[i], ++inside;
  }
  const double velocity = std::sqrt(error / size);
  const double pressure = std::abs(drop / inside / (8 * mu * U * tube.length / (R * R)) - 1);
  const auto& mass = blood.mass_balance();
  std::printf("%d tetrahedra: error of the velocity %.2f %%, of the pressure drop %.2f %%\n",
              mesh.cell_count(), 100 * velocity, 100 * pressure);
  std::printf("mass residual %.1e, mass defect %.1e of the inflow\n", mass.residual(), mass.defect());
  return velocity < 0.03 && pressure < 0.03 && mass.residual() < 1e-8 ? 0 : 1;
}
