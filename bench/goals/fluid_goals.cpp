// SPDX-License-Identifier: MIT
// Flow in a rigid tube against Poiseuille's solution: error, observed order and time to the steady state.
#include "goals/goal.hpp"
#include "support/stopwatch.hpp"
#include "tunica/fluid/inlet.hpp"
#include "tunica/fluid/projection.hpp"
#include "tunica/meshing/tube.hpp"

#include <cmath>

namespace tunica::bench {
namespace {

struct Run {
  double error = 0;    // of the velocity, relative, root mean square over the nodes [-]
  double seconds = 0;  // [s]
  Index tetrahedra = 0;
  bool converged = true;
};

/// Mean velocity 2 mm/s in a tube of radius 5 mm: Reynolds number 6.
Run poiseuille(int radial) {
  constexpr double R = 5e-3, U = 2e-3;
  const auto mesh =
      meshing::lumen(meshing::Lumen{.radius = R, .length = 20e-3, .cells = {radial, 6 * radial, 4 * radial}});
  Run run{.tetrahedra = mesh.cell_count()};
  const double start = cpu_seconds();
  fluid::Projection blood{mesh, fluid::Newtonian{.density = 1050, .viscosity = 3.5e-3}, fluid::Fic{},
                          fluid::FixedMesh{}};
  blood.velocity("inlet", fluid::inlet_profile(mesh, "inlet"),
                 [](double t) { return U * std::min(1.0, t / 1.0); });
  blood.pressure("outlet", 0.0);
  for (int n = 0; n < 60 && run.converged; ++n) run.converged = static_cast<bool>(blood.step(0.2));
  run.seconds = cpu_seconds() - start;
  double error = 0, size = 0;
  for (Index i = 0; i < mesh.node_count(); ++i) {
    // u = 2 U (1 - r^2/R^2)
    const double exact = 2 * U * (1 - mesh.nodes.col(i).head<2>().squaredNorm() / (R * R));
    error += (blood.velocity().col(i) - Vec3(0, 0, exact)).squaredNorm(), size += exact * exact;
  }
  run.error = std::sqrt(error / size);
  return run;
}

}  // namespace

std::vector<Goal> fluid_goals() {
  const Run coarse = poiseuille(3), fine = poiseuille(6);
  const double order = std::log2(coarse.error / fine.error);
  return {{.name = "fluid: Poiseuille in a tube",
           .measured = text("error %.2f %% of %d tetrahedra at order %.2f in %.1f s", 100 * fine.error,
                            fine.tetrahedra, order, fine.seconds),
           .target = "error <= 3 % at order >= 1.8",
           .ratio = "-",
           .outcome = reached_if(coarse.converged && fine.converged && fine.error <= 0.03 && order >= 1.8)}};
}

}  // namespace tunica::bench
