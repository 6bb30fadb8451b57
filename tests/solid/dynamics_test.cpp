// SPDX-License-Identifier: MIT
#include "tunica/solid/dynamics.hpp"
#include "tunica/core/parallel.hpp"
#include "tunica/meshing/box.hpp"
#include "tunica/meshing/tube.hpp"
#include "tunica/solid/laws.hpp"
#include "tunica/solid/statics.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <map>
#include <string>

using namespace tunica;
using namespace tunica::solid;

namespace {

const Hyperelastic wall_law{Yeoh{.c10 = 174e3, .c20 = 1880e3}, Quadratic{.kappa = 348e6}};

mesh::HexMesh small_tube() {
  return meshing::tube({.inner_radius = 5e-3, .thickness = 1.5e-3, .length = 15e-3, .cells = {1, 16, 8}});
}

Dynamics<mesh::Hex8, Hyperelastic<Yeoh, Quadratic>> held(const mesh::HexMesh& mesh,
                                                         DynamicsOptions options = {}) {
  Dynamics<mesh::Hex8, Hyperelastic<Yeoh, Quadratic>> wall{mesh, wall_law, 1100, options};
  wall.fix(mesh.patch("ends"));
  wall.interface(mesh.patch("inner"));
  return wall;
}

/// Radial forces at the interface, some of them larger than others [N].
template <class Wall>
Points<3> push(const Wall& wall, const mesh::HexMesh& mesh, double size) {
  Points<3> f(3, static_cast<Eigen::Index>(wall.interface_nodes().size()));
  for (Eigen::Index k = 0; k < f.cols(); ++k) {
    const Vec3 x = mesh.nodes.col(wall.interface_nodes()[static_cast<std::size_t>(k)]);
    f.col(k) = size * (1 + 50 * x[0]) * Vec3(x[0], x[1], 0).normalized();
  }
  return f;
}

/// Keeps the vectors that are handed to it, or gives them back.
struct Store {
  std::map<std::string, Eigen::VectorXd> kept;
  bool reading = false;
  void operator()(const std::string& name, Eigen::VectorXd& v) {
    reading ? v = kept.at(name) : kept[name] = v;
  }
};

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("solid: dynamics with nodal pressures starts at rest from an equilibrium") {
    const auto mesh = meshing::box_tets(meshing::Block{.cells = {4, 4, 4}, .hi = Vec3::Constant(0.01)});
    const Hyperelastic law{NeoHooke{.c10 = 100e3}, Quadratic{.kappa = 1e9}};
    const auto held_and_pressed = [&](auto& wall) {
      wall.fix(mesh.patch("z0"));
      wall.pressure(mesh.patch("z1"), 20e3);
    };
    Statics loaded{mesh, with<NodalPressure>(law)};
    held_and_pressed(loaded);
    REQUIRE(loaded.solve());
    Dynamics wall{mesh, with<NodalPressure>(law), 1000.0, DynamicsOptions{.newton = {.tolerance = 1e-11}}};
    held_and_pressed(wall);
    const Points<3> still = Points<3>::Zero(3, mesh.node_count());
    REQUIRE(wall.start(loaded.displacement(), still));
    // 20 kPa on 1 cm of 1000 kg/m3 that nothing holds back would be 2000 m/s2.
    const double left = wall.nodal_acceleration().cwiseAbs().maxCoeff();
    MESSAGE("acceleration of the equilibrium " << left << " m/s2");
    CHECK(left < 1e-4);
    // The pressures are those of the static state, and it stays where it is.
    const Points<3> u = loaded.displacement();
    for (int step = 0; step < 3; ++step) REQUIRE(wall.step(1e-3));
    CHECK((wall.nodal_displacement() - u).norm() < 1e-7 * u.norm());
    CHECK(wall.nodal_velocity().cwiseAbs().maxCoeff() < 1e-6);
    // Let go, it moves.
    wall.pressure(0, 0);
    REQUIRE(wall.start(loaded.displacement(), still));
    CHECK(wall.nodal_acceleration().cwiseAbs().maxCoeff() > 100);
  }

  TEST_CASE("solid: dynamics from a restored state reaches the same end however it got there") {
    const auto mesh = small_tube();
    auto once = held(mesh), twice = held(mesh);
    const Points<3> f = push(once, mesh, 0.02);
    for (int n = 1; n <= 3; ++n) {
      once.save();
      once.load(f * n);
      REQUIRE(once.step(1e-3));
      twice.save();
      for (const double factor : {1.7, 0.9, 1.0, 1.0}) {
        twice.restore();
        twice.load(f * n * factor);
        REQUIRE(twice.step(1e-3));
      }
      CHECK(twice.last().solve.iterations == 0);  // nothing changed since the iterate
    }
    const double size = once.displacement().norm();
    CHECK(size > 0);
    CHECK((once.displacement() - twice.displacement()).norm() < 1e-8 * size);
    CHECK((once.velocity() - twice.velocity()).norm() < 1e-6 * once.velocity().norm());
    for (const Index n : mesh::patch_nodes(mesh.patch("ends")))
      CHECK(once.nodal_displacement().col(n).norm() == 0);
    const Points<3> nodal = once.nodal_displacement();
    for (std::size_t k = 0; k < once.interface_nodes().size(); ++k)
      CHECK(nodal.col(once.interface_nodes()[k]) == once.displacement().col(static_cast<Eigen::Index>(k)));
    CHECK(once.interface_nodes() == mesh::patch_nodes(mesh.patch("inner")));
  }

  TEST_CASE("solid: dynamics has the same bits on two threads and after a checkpoint") {
    const auto mesh = small_tube();
    const auto run = [&](int threads, bool broken) {
      thread_count() = threads;
      auto wall = held(mesh);
      const Points<3> f = push(wall, mesh, 0.02);
      for (int n = 1; n <= 4; ++n) {
        if (broken && n == 3) {
          Store store;
          wall.archive(store);
          store.reading = true;
          wall = held(mesh);
          wall.archive(store);
        }
        wall.save();
        for (const double factor : {1.2, 1.0}) {
          wall.restore();
          wall.load(f * n * factor);
          REQUIRE(wall.step(n < 3 ? 1e-3 : 5e-4));
        }
      }
      thread_count() = 1;
      return wall.nodal_velocity();
    };
    const Points<3> v = run(1, false);
    CHECK(v.norm() > 0);
    CHECK(run(2, false) == v);
    CHECK(run(1, true) == v);
    CHECK(run(2, true) == v);
    Store store;
    held(mesh).archive(store);
    store.reading = true;
    auto other =
        held(meshing::tube({.inner_radius = 5e-3, .thickness = 1e-3, .length = 5e-3, .cells = {1, 8, 1}}));
    CHECK_THROWS_WITH_AS(other.archive(store), doctest::Contains("checkpoint: displacement: "), InputError);
  }

  TEST_CASE("solid: modified and full Newton agree and the tangent is kept between sub-iterations") {
    const auto mesh = small_tube();
    auto full = held(mesh, {.newton = {.refresh_above = 0}}), modified = held(mesh);
    const Points<3> f = push(full, mesh, 0.01);
    int made = 0, made_by_full = 0;
    for (int n = 1; n <= 3; ++n) {
      for (auto* wall : {&full, &modified}) {
        wall->save();
        for (const double factor : {1.1, 1.001, 1.0}) {
          wall->restore();
          wall->load(f * n * factor);
          REQUIRE(wall->step(1e-3));
          (wall == &full ? made_by_full : made) += wall->last().factorisations;
          if (wall == &modified && factor == 1.0) CHECK(wall->last().factorisations == 0);
        }
      }
    }
    CHECK((full.displacement() - modified.displacement()).norm() < 1e-8 * full.displacement().norm());
    MESSAGE("factorisations " << made << " against " << made_by_full);
    CHECK(made < made_by_full);
  }

  TEST_CASE("solid: lumped and consistent masses weigh the same") {
    const auto mesh = small_tube();
    double volume = 0;
    for (const Mass kind : {Mass::consistent, Mass::lumped}) {
      auto wall = held(mesh, {.mass = kind});
      Points<3> v = Points<3>::Zero(3, mesh.node_count());
      v.row(2).setConstant(2.0);
      const double energy = wall.body().kinetic_energy(v.reshaped());  // rho V v^2/2
      if (volume == 0) volume = energy / (0.5 * 1100 * 4);
      CHECK(energy == doctest::Approx(0.5 * 1100 * 4 * volume).epsilon(1e-12).scale(0));
    }
    const double octagon = 16 * std::sin(2 * std::acos(-1.0) / 16) / 2;  // area of the 16-gon of radius 1
    CHECK(volume == doctest::Approx(octagon * (6.5e-3 * 6.5e-3 - 25e-6) * 15e-3).epsilon(1e-12).scale(0));
  }

  TEST_CASE("solid: dynamics creeps to the static solution when its load stays") {
    const auto mesh = small_tube();
    auto wall = held(mesh, {.scheme = {.rho_inf = 0}});
    wall.pressure(mesh.patch("inner"), 8e3);
    // Steps far longer than the period of any mode: the scheme kills them one by one.
    for (int n = 0; n < 60; ++n) REQUIRE(wall.step(0.1));
    Statics statics{mesh, wall_law};
    statics.fix(mesh.patch("ends"));
    statics.pressure(mesh.patch("inner"), 8e3);
    REQUIRE(statics.solve());
    const Points<3> exact = statics.displacement();
    CHECK((wall.nodal_displacement() - exact).norm() < 1e-6 * exact.norm());
    CHECK(
        wall.cell_von_mises().maxCoeff() ==
        doctest::Approx(von_mises(cell_stress(statics.body(), statics.unknowns())).maxCoeff()).epsilon(1e-6));
    CHECK(wall.nodal_von_mises().size() == mesh.node_count());
  }

  TEST_CASE("solid: a NaN load ends as diverged and leaves the state where it was") {
    const auto mesh = small_tube();
    auto wall = held(mesh);
    const Points<3> f = push(wall, mesh, 0.02);
    wall.load(f);
    REQUIRE(wall.step(1e-3));
    const Points<3> u = wall.nodal_displacement();
    wall.save();
    Points<3> bad = f;
    bad(1, 3) = std::numeric_limits<double>::quiet_NaN();
    wall.load(bad);
    CHECK(wall.step(1e-3).status == Status::diverged);
    CHECK(wall.nodal_displacement() == u);
    wall.restore();
    wall.load(f);
    CHECK(wall.step(1e-3));
  }
}
