// SPDX-License-Identifier: MIT
#include "support/thick_tube.hpp"
#include "tunica/meshing/box.hpp"
#include "tunica/meshing/tube.hpp"
#include "tunica/solid/dynamics.hpp"
#include "tunica/solid/laws.hpp"
#include "tunica/solid/statics.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <type_traits>

using namespace tunica;
using namespace tunica::solid;

namespace {

const Hyperelastic rubber{NeoHooke{.c10 = 50e3}, SimoTaylor{.kappa = 1e6}};

Eigen::VectorXd waves(Eigen::Index n, double size, double frequency) {
  Eigen::VectorXd u(n);
  for (Eigen::Index k = 0; k < n; ++k) u[k] = size * std::sin(frequency * static_cast<double>(k));
  return u;
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("solid: supports have their exact tangent and it is symmetric") {
    const auto mesh =
        meshing::tube({.inner_radius = 5e-3, .thickness = 1.5e-3, .length = 4e-3, .cells = {1, 8, 3}});
    for (const Motion against : {Motion::any, Motion::normal}) {
      Body bare(mesh, rubber, 1.0, Mass::lumped), body(mesh, rubber, 1.0, Mass::lumped);
      body.add_support(mesh.patch("outer"), {.spring = 3e8, .dashpot = 2e5, .against = against});
      const Eigen::VectorXd u = waves(body.unknowns(), 1e-4, 0.7), v = waves(body.unknowns(), 1e-2, 1.3);
      const Eigen::VectorXd none = Eigen::VectorXd::Zero(u.size()), no_pressure(0);
      Eigen::VectorXd f, predicted;
      la::SparseMatrix with = body.pattern(), without = body.pattern();
      for (auto* b : {&bare, &body}) {
        REQUIRE(b->internal_forces(u, la::no_step, f, predicted));
        b->tangent(u, no_pressure, {.stiffness = 0.5, .damping = 7}, b == &body ? with : without);
      }
      const la::SparseMatrix S = with - without;
      CHECK(la::SparseMatrix(S - la::SparseMatrix(S.transpose())).norm() < 1e-12 * S.norm());
      Eigen::VectorXd springs = none, dashpots = none, both = none;
      body.add_support_forces(u, none, springs);
      body.add_support_forces(none, u, dashpots);
      body.add_support_forces(u, v, both);
      CHECK((S * u - 0.5 * springs - 7 * dashpots).norm() < 1e-9 * (S * u).norm());
      CHECK(dashpots.dot(u) > 0);
      CHECK(body.spring_energy(u) == doctest::Approx(0.5 * springs.dot(u)).epsilon(1e-12).scale(0));
      Eigen::VectorXd rest = none;
      body.add_support_forces(none, v, rest);
      CHECK((both - springs - rest).norm() < 1e-12 * both.norm());
      // A shift of 1 along z meets the area of the surface, or nothing if only its normal counts.
      Eigen::VectorXd shift = none, held = none;
      for (Index n = 0; n < mesh.node_count(); ++n) shift[3 * n + 2] = 1;
      body.add_support_forces(shift, none, held);
      const double area = 8 * 2 * 6.5e-3 * std::sin(std::acos(-1.0) / 8) * 4e-3;
      if (against == Motion::any)
        CHECK(held.dot(shift) == doctest::Approx(3e8 * area).epsilon(1e-12));
      else
        CHECK(std::abs(held.dot(shift)) < 1e-12 * 3e8 * area);
    }
  }

  TEST_CASE("solid: a springy support carries the load that is pressed on it") {
    const auto mesh = meshing::box_hexes(meshing::Block{.cells = {3, 2, 2}, .hi = Vec3(0.02, 0.01, 0.01)});
    // The end under pressure is free: all of the load stiffness is needed.
    Statics<mesh::Hex8, std::remove_const_t<decltype(rubber)>, la::Lu> block{mesh, rubber};
    block.support(mesh.patch("x0"), {.spring = 2e6, .against = Motion::normal});
    block.fix(mesh.patch("y0"), Axis::y);
    block.fix(mesh.patch("z0"), Axis::z);
    const auto pressed = block.pressure(mesh.patch("x1"), 2e3);
    const auto report = block.solve();
    REQUIRE(report);
    CHECK(la::observed_order(report.history, 1e-11) >= 1.9);
    // Uniform compression: a pressure on the deformed end, springs on the reference area of the other.
    const double u = block.displacement()(0, 0);
    const Points<3> x = mesh.nodes + block.displacement();
    const double area = x.row(1).maxCoeff() * x.row(2).maxCoeff();
    CHECK(2e6 * -u * 1e-4 == doctest::Approx(2e3 * area).epsilon(1e-10));
    block.pressure(pressed, 0);
    REQUIRE(block.solve());
    CHECK(block.displacement().cwiseAbs().maxCoeff() < 1e-12);
  }

  TEST_CASE("solid: tissue round a thick tube takes its share of the pressure") {
    const test::ThickTube tube;
    const auto mesh = meshing::quarter_tube({.inner_radius = tube.inner,
                                             .thickness = tube.outer - tube.inner,
                                             .length = 1e-3,
                                             .cells = {4, 16, 1}});
    const double spring = 2e7, l = 1.05;  // [N/m3], [-]
    const double u = tube.outer * (tube.outer_stretch(l) - 1);
    // spring u on the reference area is spring u R_o/r_o on the current one.
    const double p = tube.pressure(l) + spring * u / tube.outer_stretch(l);
    Statics wall{
        mesh, Hyperelastic{Yeoh{.c10 = tube.c10, .c20 = tube.c20}, Quadratic{.kappa = 1e4 * 2 * tube.c10}}};
    wall.fix(mesh.patch("ends"), Axis::z);
    wall.fix(mesh.patch("sym_x"), Axis::x);
    wall.fix(mesh.patch("sym_y"), Axis::y);
    wall.support(mesh.patch("outer"), {.spring = spring, .against = Motion::normal});
    wall.pressure(mesh.patch("inner"), p);
    REQUIRE(wall.solve());
    const Points<3> x = mesh.nodes + wall.displacement();
    const double reached = x.col(mesh.patch("inner").faces(0, 0)).head<2>().norm() / tube.inner;
    MESSAGE("inner stretch " << reached << " of " << l << ", the springs bear "
                             << 100 * (1 - tube.pressure(l) / p) << " % of the pressure");
    CHECK(tube.pressure(l) < 0.8 * p);
    CHECK(std::abs(reached - l) < 2e-3 * (l - 1));
  }

  TEST_CASE("solid: a stiff block on dashpots slows down as it must and the energy balance closes") {
    const double side = 0.01, density = 1000, dashpot = 4e3;  // [m], [kg/m3], [N s/m3]
    const auto mesh = meshing::box_hexes(meshing::Block{.cells = {2, 2, 2}, .hi = Vec3::Constant(side)});
    const Hyperelastic stiff{NeoHooke{.c10 = 5e7}, SimoTaylor{.kappa = 1e8}};
    Dynamics block{mesh, stiff, density, {.scheme = {.rho_inf = 1}}};
    block.support(mesh.patch("x0"), {.dashpot = dashpot});
    block.support(mesh.patch("x1"), {.dashpot = dashpot});
    Points<3> v = Points<3>::Zero(3, mesh.node_count());
    v.row(1).setConstant(0.1);
    REQUIRE(block.start(Points<3>::Zero(3, mesh.node_count()), v));
    const double before = block.kinetic_energy(), rate = 2 * dashpot / (density * side);  // [1/s]
    double taken = 0, scheme = 0;
    for (int k = 0; k < 50; ++k) {
      REQUIRE(block.step(2e-5));
      const auto energy = block.energy_balance();
      taken += energy.dashpots;
      scheme += std::abs(energy.scheme);
      CHECK(energy.external == 0);
      CHECK(energy.dashpots > 0);
      CHECK(energy.kinetic + energy.strain + energy.dashpots + energy.scheme ==
            doctest::Approx(0).epsilon(1e-12 * before));
    }
    const double left = block.kinetic_energy() / before;
    MESSAGE("kinetic energy left " << left << ", rigid " << std::exp(-2 * rate * 1e-3) << "; dashpots took "
                                   << taken / before << ", the scheme " << scheme / before);
    CHECK(left == doctest::Approx(std::exp(-2 * rate * 1e-3)).epsilon(0.01).scale(0));
    CHECK(taken == doctest::Approx((1 - left) * before).epsilon(0.01).scale(0));
    CHECK(scheme < 1e-3 * before);
  }
}
