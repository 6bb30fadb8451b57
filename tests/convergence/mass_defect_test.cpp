// SPDX-License-Identifier: MIT
// How the flow through the boundary falls short of the balance of the discrete equations, over the mesh.
#include "tunica/fluid/inlet.hpp"
#include "tunica/fluid/projection.hpp"
#include "tunica/meshing/tube.hpp"
#include "tunica/motion/laplace.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

using namespace tunica;
using std::numbers::pi;

namespace {

constexpr double radius = 5e-3, length = 10e-3;  // [m]

struct Defects {
  double largest = 0, mean = 0, residual = 0;
};

/// A pulse into a tube of n cells across the radius that swells and shrinks by a tenth of its radius.
Defects pulse(int n, bool moving) {
  const auto mesh =
      meshing::lumen(meshing::Lumen{.radius = radius, .length = length, .cells = {n, 6 * n, 2 * n}});
  const motion::Laplace laplace(mesh);
  fluid::Projection blood{mesh, fluid::Newtonian{.density = 1050, .viscosity = 0.0035}, fluid::Fic{}};
  blood.velocity("inlet", fluid::inlet_profile(mesh, "inlet"),
                 [](double t) { return 0.1 + 0.3 * std::pow(std::sin(pi * t / 0.3), 2); });
  blood.pressure("outlet", [](double t) { return 5300 * std::pow(std::sin(pi * t / 0.4), 2); });
  constexpr double dt = 1e-3;
  constexpr int steps = 30, skipped = 10;  // the start, from a flow without a boundary layer, has its own
  Defects defects;
  int counted = 0;
  for (int k = 1; k <= steps; ++k) {
    const double s = 0.1 * std::pow(std::sin(pi * k * dt / 0.4), 2);
    Points<3> wall(3, static_cast<Eigen::Index>(laplace.wall_nodes().size()));
    for (std::size_t i = 0; i < laplace.wall_nodes().size(); ++i) {
      const Vec3 x = mesh.nodes.col(laplace.wall_nodes()[i]);
      const double bulge = moving ? s * std::sin(pi * x[2] / length) : 0;
      wall.col(static_cast<Eigen::Index>(i)) = Vec3(bulge * x[0], bulge * x[1], 0);
    }
    blood.move(laplace.extend(wall), dt);
    REQUIRE(blood.step(dt));
    defects.residual = std::max(defects.residual, blood.mass_balance().residual());
    if (k <= skipped) continue;
    ++counted;
    defects.mean += blood.mass_balance().defect();
    defects.largest = std::max(defects.largest, blood.mass_balance().defect());
  }
  defects.mean /= counted;
  return defects;
}

}  // namespace

TEST_SUITE("convergence") {
  TEST_CASE("fluid: a pulse loses no mass on any mesh") {
    // The velocity itself, not the balance of the equations: what is left is that of the linear solvers.
    for (const bool moving : {false, true}) {
      std::vector<Defects> d;
      for (const int n : {2, 3, 4, 6, 8}) {
        d.push_back(pulse(n, moving));
        MESSAGE(std::string(moving ? "moving" : "rigid")
                << " across " << 2 * n << ": defect " << d.back().largest << " at most and " << d.back().mean
                << " in the mean; residual " << d.back().residual);
        CHECK(d.back().residual < 1e-8);
        CHECK(d.back().largest < 1e-8);
      }
    }
  }
}
