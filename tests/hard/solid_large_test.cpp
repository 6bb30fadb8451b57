// SPDX-License-Identifier: MIT
#include "support/newton_order.hpp"
#include "tunica/meshing/box.hpp"
#include "tunica/solid/laws.hpp"
#include "tunica/solid/statics.hpp"
#include "tunica/solid/stress.hpp"

#include <doctest/doctest.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

using namespace tunica;
using namespace tunica::solid;

namespace {

/// The displacement of F x + what bends it a little, turned by R.
Eigen::VectorXd moved(const mesh::HexMesh& mesh, const Eigen::Matrix3d& R, double shear, double waves) {
  Points<3> x = mesh.nodes;
  x.row(0) += shear * mesh.nodes.row(1);
  for (Eigen::Index n = 0; n < x.cols(); ++n) x(2, n) += waves * std::sin(3 * mesh.nodes(0, n));
  const Points<3> u = R * x - mesh.nodes;
  return u.reshaped();
}

}  // namespace

TEST_SUITE("hard") {
  TEST_CASE("solid: turns through 360 degrees leave no stress and no energy behind") {
    const double mu = 348e3;
    for (const int n : {1, 3})
      for (const double ratio : {10.0, 1e3}) {
        const auto mesh = meshing::box_hexes(
            meshing::Block{.cells = {n, n, n}, .lo = Vec3::Constant(-0.5), .hi = Vec3::Constant(0.5)});
        const Hyperelastic law{Yeoh{.c10 = mu / 2, .c20 = 1880e3}, Quadratic{.kappa = ratio * mu}};
        Body body(mesh, law, 1.0, Mass::lumped);
        const Vec3 axis = Vec3(1, 2, -0.5).normalized();
        double stress = 0, energy = 0, force = 0;
        Eigen::VectorXd f0, f, predicted;
        const auto sheared = moved(mesh, Eigen::Matrix3d::Identity(), 0.5, 0.1);
        const double E0 = body.strain_energy(sheared);
        REQUIRE(body.internal_forces(sheared, la::no_step, f0, predicted));
        for (int degrees = 0; degrees <= 360; degrees += 15) {
          const Eigen::Matrix3d R =
              Eigen::AngleAxisd(degrees * std::numbers::pi / 180, axis).toRotationMatrix();
          stress = std::max(stress, cell_stress(body, moved(mesh, R, 0, 0)).cwiseAbs().maxCoeff() / mu);
          const auto u = moved(mesh, R, 0.5, 0.1);
          energy = std::max(energy, std::abs(body.strain_energy(u) / E0 - 1));
          REQUIRE(body.internal_forces(u, la::no_step, f, predicted));
          const Points<3> turned = R * f0.reshaped(3, mesh.node_count());
          force = std::max(force, (f.reshaped(3, mesh.node_count()) - turned).norm() / f0.norm());
        }
        MESSAGE(n << " cells along a side, kappa/mu " << ratio << ": stress of the rigid turn " << stress
                  << " mu; sheared, energy drifts by " << energy << " and forces by " << force);
        // u itself is rounded to eps |u|/2 at both ends of the three edges h of a cell, which kappa sees as a
        // volume: one cell leaves less than the 1e-12 mu asked for, three a side at kappa/mu = 1e3 need not.
        constexpr double eps = std::numeric_limits<double>::epsilon();
        const double largest_u = std::sqrt(3.0), rounded = 3 * eps * largest_u * n * ratio;
        CHECK(stress < (n == 1 ? 1e-12 : std::max(1e-12, rounded)));
        CHECK(energy < 1e-12);
        CHECK(force < 1e-12);
      }
  }

  TEST_CASE("solid: a column twisted by 300 degrees keeps its symmetry and positive J") {
    const double width = 1, height = 6, mu = 1e5;
    const auto mesh = meshing::box_hexes(meshing::Block{.cells = {4, 4, 24},
                                                        .lo = Vec3(-width / 2, -width / 2, 0),
                                                        .hi = Vec3(width / 2, width / 2, height)});
    const double nu = 0.499, kappa = 2 * mu * (1 + nu) / (3 * (1 - 2 * nu));
    Statics column{mesh, Hyperelastic{NeoHooke{.c10 = mu / 2}, SimoTaylor{.kappa = kappa}}};
    column.fix(mesh.patch("z0"));
    const auto top = mesh::patch_nodes(mesh.patch("z1"));
    int steps = 0, cuts = 0, iterations = 0;
    for (int degrees = 15; degrees <= 300; degrees += 15) {
      const double angle = degrees * std::numbers::pi / 180;
      for (const Index n : top) {
        const double x = mesh.nodes(0, n), y = mesh.nodes(1, n);
        column.prescribe(n, Axis::x, std::cos(angle) * x - std::sin(angle) * y - x);
        column.prescribe(n, Axis::y, std::sin(angle) * x + std::cos(angle) * y - y);
        column.prescribe(n, Axis::z, 0);
      }
      const auto report = column.solve();
      REQUIRE(report);
      steps += report.steps, cuts += report.cuts, iterations += report.solve.iterations;
    }
    using Element = Body<mesh::Hex8, Hyperelastic<NeoHooke, SimoTaylor>>::Element;
    const auto& body = column.body();
    double smallest_J = 1, low = 1e300, high = -1e300, jump = 0, turned = 0, size = 0;
    std::vector<double> p(static_cast<std::size_t>(mesh.cell_count()));
    for (Index e = 0; e < mesh.cell_count(); ++e) {
      const auto at = Element::forces(body.material(e), body.reference(e), body.gather(e, column.unknowns()));
      smallest_J = std::min(smallest_J, at.smallest_J);
      p[static_cast<std::size_t>(e)] = at.p;
    }
    // The cells of the middle half of the height: along the axis their pressures hardly change.
    const auto cell = [](Index i, Index j, Index k) { return static_cast<std::size_t>(i + 4 * (j + 4 * k)); };
    for (Index k = 8; k < 16; ++k)
      for (Index j = 0; j < 4; ++j)
        for (Index i = 0; i < 4; ++i) {
          low = std::min(low, p[cell(i, j, k)]), high = std::max(high, p[cell(i, j, k)]);
          jump = std::max(jump,
                          std::abs(p[cell(i, j, k)] - 0.5 * (p[cell(i, j, k - 1)] + p[cell(i, j, k + 1)])));
          turned = std::max(turned, std::abs(p[cell(i, j, k)] - p[cell(3 - j, i, k)]));  // by 90 degrees
          size = std::max(size, std::abs(p[cell(i, j, k)]));
        }
    MESSAGE("twisted by 300 degrees in " << steps << " steps, " << cuts << " cuts, " << iterations
                                         << " iterations; smallest J " << smallest_J
                                         << ", pressures in the middle " << low / mu << " to " << high / mu
                                         << " mu, cell to cell along the axis " << jump / (high - low)
                                         << " of their range, off their symmetry by " << turned / size);
    CHECK(smallest_J > 0.9);
    CHECK(jump < 0.05 * (high - low));
    CHECK(turned < 1e-6 * size);
  }

  TEST_CASE("solid: a stiff and a soft inclusion of contrast 1e4 converge quadratically") {
    auto mesh = meshing::box_hexes(meshing::Block{.cells = {6, 6, 6}});
    for (Index e = 0; e < mesh.cell_count(); ++e) {
      Vec3 middle = Vec3::Zero();
      for (const Index n : mesh.cells.col(e)) middle += mesh.nodes.col(n) / 8;
      mesh.region.push_back((middle - Vec3::Constant(0.5)).cwiseAbs().maxCoeff() < 1. / 6 ? 1 : 0);
    }
    mesh.region_names = {"matrix", "inclusion"};
    for (const double contrast : {1e4, 1e-4})
      for (const double pulled : {0.1, 0.2, 0.3, 0.4, 0.5}) {
        const auto law = [](double c10) {
          return Hyperelastic{Yeoh{.c10 = c10, .c20 = c10}, SimoTaylor{.kappa = 1000 * c10}};
        };
        Statics block{mesh, law(100e3)};
        block.laws().material(1, law(contrast * 100e3));
        block.fix(mesh.patch("x0"), Axis::x);
        block.fix(mesh.patch("y0"), Axis::y);
        block.fix(mesh.patch("z0"), Axis::z);
        for (const Index n : mesh::patch_nodes(mesh.patch("z1"))) block.prescribe(n, Axis::z, pulled);
        const auto report = block.solve();
        REQUIRE(report);
        const auto sigma = cell_stress(block.body(), block.unknowns());
        const double inside = sigma(2, 2 + 6 * (2 + 6 * 2)), beside = sigma(2, 0 + 6 * (2 + 6 * 2));
        const auto order = test::newton_order(block);
        MESSAGE("contrast " << contrast << ", pulled by " << pulled << ": " << report.steps << " steps, "
                            << report.cuts << " cuts, " << report.solve.iterations << " iterations, rounding "
                            << report.rounding << "; Newton's slope at least " << order.slope << " in "
                            << order.ratios << " ratios; stress inside " << inside << ", beside it " << beside
                            << " Pa");
        CHECK(report.cuts <= 3);
        CHECK(order.slope >= 1.9);
        CHECK(order.ratios >= 2);
        CHECK((contrast > 1) == (inside > beside));
      }
  }

  TEST_CASE("solid: a step into inversion is cut back and a start from one is named") {
    const auto mesh = meshing::box_hexes(meshing::Block{.cells = {3, 3, 3}});
    const Hyperelastic law{NeoHooke{.c10 = 1}, Quadratic{.kappa = 100}};
    // Between walls the top is pushed through the bottom: J = 0 everywhere at two thirds of the way.
    Statics block{mesh, law, {.newton = {.max_iterations = 12}}};
    block.fix(mesh.patch("z0"), Axis::z);
    for (const char* side : {"x0", "x1"}) block.fix(mesh.patch(side), Axis::x);
    for (const char* side : {"y0", "y1"}) block.fix(mesh.patch(side), Axis::y);
    for (const Index n : mesh::patch_nodes(mesh.patch("z1"))) block.prescribe(n, Axis::z, -1.5);
    const auto pushed = block.solve();
    MESSAGE("pushed through the bottom: " << name(pushed.solve.status) << " at " << pushed.load << " after "
                                          << pushed.cuts << " cuts, cell " << pushed.inverted_cell);
    CHECK_FALSE(pushed);
    CHECK(pushed.cuts > 0);
    CHECK(pushed.inverted_cell >= 0);
    CHECK(pushed.load > 0.5);
    CHECK(pushed.load < 2. / 3);
    CHECK(block.displacement().allFinite());
    double J = 1;  // where it stopped is an equilibrium
    for (Index e = 0; e < mesh.cell_count(); ++e)
      J = std::min(J, Body<mesh::Hex8, Hyperelastic<NeoHooke, Quadratic>>::Element::forces(
                          law, block.body().reference(e), block.body().gather(e, block.unknowns()))
                          .smallest_J);
    CHECK(J > 0);
    // An inverted start.
    Points<3> u = Points<3>::Zero(3, mesh.node_count());
    const Index cell = 13;
    u.col(mesh.cells(6, cell)) =
        1.5 * (mesh.nodes.col(mesh.cells(0, cell)) - mesh.nodes.col(mesh.cells(6, cell)));
    Statics inverted{mesh, law};
    inverted.fix(mesh.patch("z0"));
    inverted.start(u);
    const auto step = inverted.step();
    CHECK(step.solve.status == Status::diverged);
    CHECK(step.inverted_cell == cell);
    CHECK(step.cuts > 0);
    CHECK(step.load == 0);
  }
}
