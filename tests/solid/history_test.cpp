// SPDX-License-Identifier: MIT
#include "tunica/solid/history.hpp"
#include "tunica/meshing/box.hpp"
#include "tunica/solid/dynamics.hpp"
#include "tunica/solid/hyperelastic.hpp"
#include "tunica/solid/laws.hpp"
#include "tunica/solid/statics.hpp"
#include "tunica/solid/viscoelastic.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <map>
#include <string>

using namespace tunica;
using namespace tunica::solid;

namespace {

constexpr Prony branch{.ratio = 0.8, .time = 0.2};
const NeoHooke rubber{.c10 = 50e3};

auto remembering(const Prony& prony = branch) {
  return Hyperelastic{Viscoelastic{rubber, std::array{prony}}, Quadratic{.kappa = 5e6}};
}

/// A block pulled or let go at its far end, held at the near one.
template <class Law>
Dynamics<mesh::Hex8, Law> block(const Law& law) {
  const auto mesh =
      meshing::box_hexes({.cells = {3, 1, 1}, .lo = Vec3::Zero(), .hi = Vec3(0.03, 0.01, 0.01)});
  Dynamics<mesh::Hex8, Law> block(mesh, law, 1100, {.scheme = {.rho_inf = 1}});
  block.fix(mesh.patch("x0"));
  block.interface(mesh.patch("x1"));
  return block;
}

/// Keeps the vectors of an archive and gives them back.
struct Store {
  std::map<std::string, Eigen::VectorXd> kept;
  bool reading = false;
  void operator()(const std::string& name, Eigen::VectorXd& v) {
    if (reading)
      v = kept.at(name);
    else
      kept[name] = v;
  }
};

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("solid: a stretched block relaxes as its Prony series says") {
    const auto mesh = meshing::box_hexes(2);
    Statics wall{mesh, remembering()};
    for (Index n = 0; n < mesh.node_count(); ++n) {  // a homogeneous stretch, nothing is free
      wall.prescribe(n, Axis::x, 0.2 * mesh.nodes(0, n));
      wall.prescribe(n, Axis::y, -0.08 * mesh.nodes(1, n));
      wall.prescribe(n, Axis::z, -0.08 * mesh.nodes(2, n));
    }
    const auto shear = [&] {
      const StressField s = cell_stress(wall.body(), wall.unknowns());
      return s(0, 3) - s(1, 3);
    };
    REQUIRE(hold(wall, 0));  // a jump
    const double at_once = shear();
    double t = 0;
    for (const double dt : {0.01, 0.05, 0.2, 0.3}) {
      REQUIRE(hold(wall, dt));
      t += dt;
      const double exact = (1 + branch.ratio * std::exp(-t / branch.time)) / (1 + branch.ratio);
      CHECK(shear() / at_once == doctest::Approx(exact).epsilon(1e-10));
    }
  }

  TEST_CASE("solid: a viscoelastic block comes to rest where an elastic one swings on") {
    auto viscous = block(remembering({.ratio = 0.8, .time = 1e-3}));  // its first period is some 8 ms
    auto elastic = block(Hyperelastic{rubber, Quadratic{.kappa = 5e6}});
    const auto kinetic = [](auto& body) {
      body.load(Points<3>::Zero(3, 4).colwise() + Vec3(0.05, 0, 0));
      double first = 0, last = 0;
      for (int k = 0; k < 300; ++k) {
        REQUIRE(body.step(5e-4));
        if (k < 20) first = std::max(first, body.kinetic_energy());
        if (k >= 250) last = std::max(last, body.kinetic_energy());
      }
      return last / first;
    };
    const double slow = kinetic(viscous), fast = kinetic(elastic);
    MESSAGE("kinetic energy after 0.15 s over that at first: " << slow << ", elastic " << fast);
    CHECK(slow < 0.01);
    CHECK(fast > 0.5);
  }

  TEST_CASE("solid: a step with a history can be repeated and a checkpoint carries it") {
    auto first = block(remembering());
    first.load(Points<3>::Zero(3, 4).colwise() + Vec3(0.05, 0, 0));
    for (int k = 0; k < 5; ++k) REQUIRE(first.step(0.01));
    first.save();
    REQUIRE(first.step(0.01));
    const Points<3> once = first.nodal_displacement();
    first.restore();
    REQUIRE(first.step(0.01));
    CHECK((first.nodal_displacement() - once).cwiseAbs().maxCoeff() < 1e-9 * once.cwiseAbs().maxCoeff());
    Store store;
    first.restore();
    first.archive(store);
    auto second = block(remembering());
    store.reading = true;
    second.archive(store);
    REQUIRE(first.step(0.01));
    REQUIRE(second.step(0.01));
    CHECK(first.nodal_displacement() == second.nodal_displacement());
  }
}
