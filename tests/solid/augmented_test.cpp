// SPDX-License-Identifier: MIT
#include "tunica/solid/augmented.hpp"
#include "tunica/fem/shape_quadratic.hpp"
#include "tunica/mesh/patch_nodes.hpp"
#include "tunica/mesh/quadratic.hpp"
#include "tunica/meshing/tube.hpp"
#include "tunica/solid/laws.hpp"
#include "tunica/solid/stress.hpp"

#include <doctest/doctest.h>

#include "support/thick_tube.hpp"

#include <cmath>

using namespace tunica;
using namespace tunica::solid;

namespace {

template <mesh::Cell C>
Statics<C, Hyperelastic<Yeoh, Quadratic>> tube(double kappa) {
  const test::ThickTube exact;
  const auto mesh = [&] {
    const auto hexes = meshing::quarter_tube({.inner_radius = exact.inner,
                                              .thickness = exact.outer - exact.inner,
                                              .length = 1e-3,
                                              .cells = {2, 8, 1}});
    if constexpr (mesh::Quadratic<C>)
      return mesh::quadratic<C>(hexes);
    else
      return hexes;
  }();
  Statics<C, Hyperelastic<Yeoh, Quadratic>> wall(
      mesh, {Yeoh{.c10 = exact.c10, .c20 = exact.c20}, Quadratic{.kappa = kappa}});
  wall.fix(mesh.patch("ends"), Axis::z);
  wall.fix(mesh.patch("sym_x"), Axis::x);
  wall.fix(mesh.patch("sym_y"), Axis::y);
  wall.pressure(mesh.patch("inner"), exact.pressure(1.1));
  return wall;
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE_TEMPLATE(
      "solid: an augmented Lagrangian reaches the incompressible tube with a moderate bulk modulus", C,
      mesh::Hex8, mesh::Hex27) {
    const double c10 = test::ThickTube{}.c10;
    auto soft = tube<C>(2e3 * c10), stiff = tube<C>(2e8 * c10);
    const auto report = solve_incompressible(soft, {.tolerance = 1e-11});
    REQUIRE(report);
    REQUIRE(stiff.solve());
    for (const double error : report.volume_errors) MESSAGE("largest of theta - 1: " << error);
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
    auto wall = tube<mesh::Hex8>(2e2 * test::ThickTube{}.c10);
    const auto report = solve_incompressible(wall, {.tolerance = 1e-14, .most = 1});
    CHECK(report.solve.status == Status::max_iterations);
    CHECK(report.volume_errors.size() == 2);
  }
}
