// SPDX-License-Identifier: MIT
#include "support/newton_order.hpp"
#include "tunica/meshing/box.hpp"
#include "tunica/meshing/tube.hpp"
#include "tunica/solid/fibre_laws.hpp"
#include "tunica/solid/laws.hpp"
#include "tunica/solid/statics.hpp"
#include "tunica/solid/stress.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <type_traits>
#include <utility>

using namespace tunica;
using namespace tunica::solid;

namespace {

/// A strip along x whose fibres run at +-30 degrees to it; its ends are held sideways.
template <class Law>
auto strip(const mesh::HexMesh& mesh, const Law& law, double pulled) {
  Statics<mesh::Hex8, Law> wall{mesh, law, {.first_step = 0.25}};
  if constexpr (needs_point<Law>) {
    const double c = std::cos(std::numbers::pi / 6), s = std::sin(std::numbers::pi / 6);
    wall.point_field([=](Index, const Vec3&) {
      Fibres<double, 2> f;
      f.set(0, {c, s, 0});
      f.set(1, {c, -s, 0});
      return f;
    });
  }
  wall.fix(mesh.patch("x0"));
  for (const Index n : mesh::patch_nodes(mesh.patch("x1")))
    for (const Axis axis : {Axis::x, Axis::y, Axis::z}) wall.prescribe(n, axis, axis == Axis::x ? pulled : 0);
  return wall;
}

/// The force at its end along x [N].
template <class Wall>
double held(const Wall& wall, const mesh::HexMesh& mesh) {
  auto body = wall.body();
  Eigen::VectorXd f, predicted;
  REQUIRE(body.internal_forces(wall.unknowns(), la::no_step, f, predicted));
  double sum = 0;
  for (const Index n : mesh::patch_nodes(mesh.patch("x1"))) sum += f[3 * n];
  return sum;
}

}  // namespace

TEST_SUITE("hard") {
  TEST_CASE("solid: fibres up to a hundred thousand times as stiff as their ground converge with cut-back") {
    // A ring starts slack, where the stiffness of its fibres jumps from nothing, and is blown up.
    const auto ring = meshing::quarter_tube(
        {.inner_radius = 0.71e-3, .thickness = 0.26e-3, .length = 0.1e-3, .cells = {3, 12, 1}});
    const double c = 1e3, angle = 29 * std::numbers::pi / 180;
    for (const double ratio : {1e3, 1e4, 1e5})
      for (const double k2 : {1.0, 50.0, 500.0}) {
        const double k1 = ratio * c;
        Statics wall{
            ring,
            Hyperelastic{HolzapfelGasserOgden{.c = c, .k1 = k1, .k2 = k2}, Quadratic{.kappa = 10 * k1}},
            {.first_step = 0.25}};
        wall.point_field([&](Index, const Vec3& x) {
          const Vec3 hoop = Vec3(-x[1], x[0], 0).normalized();
          Fibres<double, 2> f;
          f.set(0, {std::cos(angle) * hoop[0], std::cos(angle) * hoop[1], std::sin(angle)});
          f.set(1, {std::cos(angle) * hoop[0], std::cos(angle) * hoop[1], -std::sin(angle)});
          return f;
        });
        wall.fix(ring.patch("ends"), Axis::z);
        wall.fix(ring.patch("sym_x"), Axis::x);
        wall.fix(ring.patch("sym_y"), Axis::y);
        wall.pressure(ring.patch("inner"), 0.02 * k1);
        const auto report = wall.solve();
        const double grown = wall.displacement().cwiseAbs().maxCoeff() / 0.71e-3;
        MESSAGE("k1/c " << ratio << ", k2 " << k2 << ": " << report.steps << " steps, " << report.cuts
                        << " cuts, " << report.solve.iterations << " iterations, grown by " << 100 * grown
                        << " %");
        REQUIRE(report);
        CHECK(grown > 5e-3);
        CHECK(grown < 0.05);
      }
    // A strip that is pulled at an angle to its fibres closes like scissors.
    const auto mesh = meshing::box_hexes(meshing::Block{.cells = {8, 4, 2}, .hi = Vec3(0.02, 0.01, 0.002)});
    for (const double ratio : {1e3, 1e4, 1e5})
      for (const double k2 : {1.0, 50.0, 500.0}) {
        const Hyperelastic law{HolzapfelGasserOgden{.c = c, .k1 = ratio * c, .k2 = k2},
                               Quadratic{.kappa = 1e4 * c}};
        auto wall = strip(mesh, law, 0.03 * 0.02);
        const auto report = wall.solve();
        MESSAGE("strip, k1/c " << ratio << ", k2 " << k2 << ": " << report.steps << " steps, " << report.cuts
                               << " cuts, " << report.solve.iterations << " iterations, force "
                               << (report ? held(wall, mesh) : 0) << " N");
        REQUIRE(report);
        CHECK(held(wall, mesh) > 0);
      }
  }

  TEST_CASE("solid: fibres that are pressed leave the ground alone and a wall goes through their switch") {
    const auto mesh = meshing::box_hexes(meshing::Block{.cells = {8, 4, 2}, .hi = Vec3(0.02, 0.01, 0.002)});
    const double c = 10e3;
    const Hyperelastic bare{NeoHooke{.c10 = 0.5 * c}, Quadratic{.kappa = 1e3 * c}};
    const Hyperelastic fibrous{HolzapfelGasserOgden{.c = c, .k1 = 100 * c, .k2 = 10},
                               Quadratic{.kappa = 1e3 * c}};
    auto pulled = strip(mesh, fibrous, 0.05 * 0.02);
    REQUIRE(pulled.solve());
    const double pull = held(pulled, mesh);
    for (const Index n : mesh::patch_nodes(mesh.patch("x1"))) pulled.prescribe(n, Axis::x, -0.03 * 0.02);
    const auto back = pulled.solve();  // from taut to slack
    REQUIRE(back);
    auto pressed = strip(mesh, bare, -0.03 * 0.02);
    REQUIRE(pressed.solve());
    MESSAGE("pulled by 5 %: " << pull << " N; pressed by 3 %: " << held(pulled, mesh)
                              << " N, the ground alone " << held(pressed, mesh) << " N; "
                              << back.solve.iterations << " iterations, " << back.cuts << " cuts");
    CHECK(pull > 0);
    CHECK(held(pulled, mesh) < 0);
    CHECK(held(pulled, mesh) == doctest::Approx(held(pressed, mesh)).epsilon(1e-8));
  }

  TEST_CASE(
      "solid: follower pressure on a free border converges with half of its stiffness and quadratically with "
      "all") {
    // A tube that is held at one end only: the free border of its inner patch makes the load stiffness
    // unsymmetric.
    const auto mesh =
        meshing::tube({.inner_radius = 5e-3, .thickness = 1e-3, .length = 15e-3, .cells = {1, 16, 8}});
    const Hyperelastic law{Yeoh{.c10 = 174e3, .c20 = 1880e3}, Quadratic{.kappa = 348e6}};
    const auto press = [&](auto wall) {
      wall.fix(mesh.patch("end0"));
      wall.pressure(mesh.patch("inner"), 15e3);
      const auto report = wall.solve();
      REQUIRE(report);
      MESSAGE((std::decay_t<decltype(wall)>::linear_solver::symmetric ? std::string("symmetric part: ")
                                                                      : std::string("all of it: "))
              << report.solve.iterations << " iterations in " << report.steps << " steps");
      const Points<3> u = wall.displacement();
      if constexpr (!std::decay_t<decltype(wall)>::linear_solver::symmetric) {
        const auto order = test::newton_order(wall);
        MESSAGE("with all of its stiffness of slope " << order.slope << " in " << order.ratios << " ratios");
        CHECK(order.slope >= 1.9);
        CHECK(order.ratios >= 2);
      }
      return std::pair{report, u};
    };
    using Law = Hyperelastic<Yeoh, Quadratic>;
    const auto [half, a] = press(Statics<mesh::Hex8, Law, la::Ldlt>{mesh, law});
    const auto [whole, b] = press(Statics<mesh::Hex8, Law, la::Lu>{mesh, law});
    CHECK((a - b).norm() < 1e-6 * b.norm());
    CHECK(whole.solve.iterations <= half.solve.iterations);
  }

  TEST_CASE("solid: flat and skewed cells of a wall carry their load") {
    // Cells a hundred times as long as thick, every other layer of nodes pushed half a cell along.
    auto mesh = meshing::box_hexes(meshing::Block{.cells = {12, 4, 3}, .hi = Vec3(0.06, 0.02, 0.00015)});
    const double dx = 0.06 / 12, dz = 0.00015 / 3;
    for (Index n = 0; n < mesh.node_count(); ++n) {
      const auto layer = std::lround(mesh.nodes(2, n) / dz);
      const double s = mesh.nodes(0, n) / 0.06;
      if (layer % 2 == 1 && s > 0 && s < 1) mesh.nodes(0, n) += 0.4 * dx;
    }
    const Hyperelastic law{Yeoh{.c10 = 174e3, .c20 = 1880e3}, Quadratic{.kappa = 348e8}};
    Statics skewed{mesh, law};
    skewed.fix(mesh.patch("x0"), Axis::x);
    skewed.fix(mesh.patch("y0"), Axis::y);
    skewed.fix(mesh.patch("z0"), Axis::z);
    for (const Index n : mesh::patch_nodes(mesh.patch("x1"))) skewed.prescribe(n, Axis::x, 0.2 * 0.06);
    const auto report = skewed.solve();
    REQUIRE(report);
    // Uniform tension at stretch 1.2: one stress everywhere, whatever the cells look like.
    const auto sigma = cell_stress(skewed.body(), skewed.unknowns());
    const double mean = sigma.row(0).mean(), spread = (sigma.row(0).array() - mean).abs().maxCoeff();
    MESSAGE(report.steps << " steps, " << report.solve.iterations << " iterations; stress " << mean
                         << " Pa, uneven by " << spread / mean << ", across it "
                         << sigma.bottomRows(5).cwiseAbs().maxCoeff() / mean);
    const double l = 1.2, I1 = l * l + 2 / l;
    CHECK(mean == doctest::Approx(2 * (174e3 + 2 * 1880e3 * (I1 - 3)) * (l * l - 1 / l)).epsilon(1e-4));
    CHECK(spread < 1e-6 * mean);
  }
}
