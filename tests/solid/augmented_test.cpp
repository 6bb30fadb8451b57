// SPDX-License-Identifier: MIT
#include "tunica/solid/augmented.hpp"
#include "tunica/mesh/patch_nodes.hpp"
#include "tunica/meshing/tube.hpp"
#include "tunica/solid/laws.hpp"
#include "tunica/solid/stress.hpp"

#include <doctest/doctest.h>

#include "support/thick_tube.hpp"

#include <cmath>

using namespace tunica;
using namespace tunica::solid;

namespace {

using Wall = Statics<mesh::Hex8, Hyperelastic<Yeoh, Quadratic>>;

Wall tube(double kappa) {
  const test::ThickTube exact;
  const auto mesh = meshing::quarter_tube({.inner_radius = exact.inner,
                                           .thickness = exact.outer - exact.inner,
                                           .length = 1e-3,
                                           .cells = {2, 8, 1}});
  Wall wall(mesh, {Yeoh{.c10 = exact.c10, .c20 = exact.c20}, Quadratic{.kappa = kappa}});
  wall.fix(mesh.patch("ends"), Axis::z);
  wall.fix(mesh.patch("sym_x"), Axis::x);
  wall.fix(mesh.patch("sym_y"), Axis::y);
  wall.pressure(mesh.patch("inner"), exact.pressure(1.1));
  return wall;
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("solid: an augmented Lagrangian reaches the incompressible tube with a moderate bulk modulus") {
    const double c10 = test::ThickTube{}.c10;
    Wall soft = tube(2e3 * c10), stiff = tube(2e8 * c10);
    const auto report = solve_incompressible(soft, {.tolerance = 1e-11});
    REQUIRE(report);
    REQUIRE(stiff.solve());
    for (const double error : report.volume_errors) MESSAGE("largest |v/V - 1|: " << error);
    REQUIRE(report.volume_errors.size() > 2);
    CHECK(report.volume_errors[1] < 0.05 * report.volume_errors[0]);
    CHECK(report.volume_errors.back() < 1e-11);
    const Points<3> u = soft.displacement(), limit = stiff.displacement();
    CHECK((u - limit).cwiseAbs().maxCoeff() < 1e-7 * limit.cwiseAbs().maxCoeff());
    // and so are its stresses, pressure and all
    const StressField a = cell_stress(soft.body(), soft.unknowns()),
                      b = cell_stress(stiff.body(), stiff.unknowns());
    CHECK((a - b).cwiseAbs().maxCoeff() < 1e-5 * b.cwiseAbs().maxCoeff());
  }

  TEST_CASE("solid: an augmented Lagrangian says when its rounds are used up") {
    Wall wall = tube(2e2 * test::ThickTube{}.c10);
    const auto report = solve_incompressible(wall, {.tolerance = 1e-14, .most = 1});
    CHECK(report.solve.status == Status::max_iterations);
    CHECK(report.volume_errors.size() == 2);
  }
}
