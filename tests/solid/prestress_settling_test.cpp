// SPDX-License-Identifier: MIT
#include "tunica/core/units.hpp"
#include "tunica/meshing/box.hpp"
#include "tunica/solid/laws.hpp"
#include "tunica/solid/prestress.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

using namespace tunica;
using namespace tunica::literals;
using namespace tunica::solid;

namespace {

const Hyperelastic rubber{NeoHooke{.c10 = 15e3}, Quadratic{.kappa = 3e6}};

/// A thin soft half tube that bends: an arch of hexes between two fixed ends, pressed from inside.
[[nodiscard]] mesh::HexMesh arch(int along, int across, int wide) {
  constexpr double inner = 9e-3, thick = 1.5e-3, width = 12e-3;
  auto mesh = meshing::box_hexes(meshing::Block{.cells = {across, along, wide}, .hi = Vec3::Ones()});
  for (Index n = 0; n < mesh.node_count(); ++n) {
    const Vec3 at = mesh.nodes.col(n);
    const double angle = std::numbers::pi * at[1], r = inner + thick * at[0];
    // Not round: flat on top, so that its wall turns and bends as well as stretches.
    mesh.nodes.col(n) = Vec3(1.3 * r * std::cos(angle), 0.7 * r * std::sin(angle), width * at[2]);
  }
  return mesh;
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("solid: a wall without load is its own prestressed image") {
    auto mesh = meshing::box_hexes(meshing::Block{.cells = {3, 2, 2}, .hi = Vec3(3e-3, 2e-3, 2e-3)});
    for (Index n = 0; n < mesh.node_count(); ++n)
      mesh.nodes.col(n) += Vec3::Constant(2e-4 * std::sin(5.3 * static_cast<double>(n)));
    Statics wall{mesh, rubber};
    wall.fix(mesh.patch("x0"));
    const auto report = prestress(wall);
    CHECK(report);
    CHECK(report.residual == 0);
    CHECK(report.drift == 0);
    CHECK(report.load == 1);
    CHECK(report.settlings == 0);
    // A pressure of nothing is no load either, and the stresses that are handed on are none.
    Statics pressed{mesh, rubber};
    pressed.fix(mesh.patch("x0"));
    pressed.pressure(mesh.patch("x1"), 0);
    CHECK(prestress(pressed));
    for (const auto& F : pressed.body().laws().prestress())
      CHECK((F - Eigen::Matrix3d::Identity()).norm() < 1e-14);
  }

  TEST_CASE("solid: prescribed displacements of an image are refused") {
    const auto mesh = meshing::box_hexes(meshing::Block{.cells = {2, 1, 1}, .hi = Vec3(2e-3, 1e-3, 1e-3)});
    Statics wall{mesh, rubber};
    wall.fix(mesh.patch("x0"));
    const auto ends = mesh::patch_nodes(mesh.patch("x1"));
    for (const Index n : ends) wall.prescribe(n, Axis::x, 0);  // as fixed
    CHECK(wall.prescribed(3 * ends.front()) == 0);
    CHECK(prestress(wall));
    for (const Index n : ends) wall.prescribe(n, Axis::x, 1e-4);
    CHECK(wall.prescribed(3 * ends.front()) == 1e-4);
    CHECK_THROWS_AS((void)prestress(wall), ContractError);
  }

  TEST_CASE("solid: the drift that is stored is the root of a linear map within a window of changes") {
    // drift(x) = b - A x with A = 1 - K_geo K^-1 whose parts are from 0.1 to 1.5: storing the drift alone
    // takes log(1e-10) / log(0.9) = 218 times.
    constexpr int size = 8;
    Eigen::VectorXd a(size), x = Eigen::VectorXd::Zero(size), b(size);
    for (int k = 0; k < size; ++k) {
      a[k] = 0.1 + 0.2 * k;
      b[k] = std::cos(1.7 * k);
    }
    detail::Settling settling;
    int times = 0;
    Eigen::VectorXd drift = b;
    for (; times < 100 && !(drift.norm() < 1e-10 * b.norm()); ++times) {
      x += settling.next(drift);
      drift = b - a.cwiseProduct(x);
    }
    MESSAGE("root found after " << times << " times");
    CHECK(times <= 2 * size);
    CHECK((a.cwiseProduct(x) - b).norm() < 1e-10 * b.norm());
  }

  TEST_CASE("solid: the image of a soft wall that bends settles under its pressure") {
    const auto mesh = arch(16, 2, 4);
    const double p = 6_mmHg;
    const auto wall_of = [&](double soft) {
      Statics wall{mesh, Hyperelastic{NeoHooke{.c10 = soft}, Quadratic{.kappa = 100 * soft}}};
      wall.fix(mesh.patch("y0"));
      wall.fix(mesh.patch("y1"));
      wall.pressure(mesh.patch("x0"), p);
      return wall;
    };
    for (const double soft : {10e3, 30e3}) {
      auto wall = wall_of(soft);
      const auto report = prestress(wall);
      MESSAGE(soft << " Pa: settled " << report.settlings << " times, " << report.solve.iterations
                   << " iterations: residual " << report.residual << ", drift " << report.drift << " m");
      REQUIRE(report);
      CHECK(report.residual <= 1e-6);
      CHECK(report.drift < 1e-8);
      // Another wall with what was stored stays on the image, under its pressure from nothing.
      auto again = wall_of(soft);
      again.laws().prestress(wall.body().laws().prestress());
      REQUIRE(again.solve());
      CHECK(again.displacement().cwiseAbs().maxCoeff() < 1e-7);
    }
  }
}
