// SPDX-License-Identifier: MIT
// Observed orders of the flow solver in space and time, on fixed and moving meshes, at small steps.
#include "support/flow.hpp"
#include "tunica/fluid/projection.hpp"
#include "tunica/meshing/box.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

using namespace tunica;
using std::numbers::pi;

namespace {

/// A slab of n x n x layers boxes of the square [lo, hi]^2, shaken inside.
mesh::TetMesh slab(int n, int layers, double lo, double hi) {
  const double h = (hi - lo) / n;
  auto mesh = meshing::box_tets(
      meshing::Block{.cells = {n, n, layers}, .lo = Vec3(lo, lo, 0), .hi = Vec3(hi, hi, layers * h)});
  test::shake(mesh, 0.1 * h);
  return mesh;
}

template <class Grid, class Solution, class S = fluid::Fic>
auto with_exact_boundary(const mesh::TetMesh& mesh, const Solution& exact,
                         fluid::ProjectionOptions options = {}, const S& stabilization = {}) {
  fluid::Projection flow{mesh, fluid::Newtonian{.density = 1, .viscosity = exact.nu}, stabilization, Grid{},
                         options};
  for (const auto* side : test::box_sides)
    flow.velocity(side, [exact](const Vec3& x, double t) { return exact.u(x, t); });
  flow.set(test::nodal_values(mesh.nodes, [&](const Vec3& x) { return exact.u(x, 0); }));
  return flow;
}

template <class Flow, class Solution>
test::FlowError error(const Flow& flow, const mesh::TetMesh& mesh, const Solution& exact) {
  return test::flow_error(
      flow.position(), mesh.cells, flow.velocity(), flow.pressure(),
      [&](const Vec3& x) { return exact.u(x, flow.time()); },
      [&](const Vec3& x) { return exact.p(x, flow.time()); }, 1);
}

double order(double coarse, double fine, double ratio = 2) {
  return std::log(coarse / fine) / std::log(ratio);
}

/// |grad p - P grad p| h / |p|: what is left of the gradient after smoothing, large for a checkerboard.
double oscillation(const mesh::TetMesh& mesh, const Eigen::VectorXd& p, double h) {
  fem::P1Tets tets;
  REQUIRE(tets.update(mesh.nodes, mesh.cells));
  Points<3> smooth = Points<3>::Zero(3, p.size());
  Eigen::VectorXd mass = Eigen::VectorXd::Zero(p.size());
  const auto gradient = [&](Index e) { return Vec3(tets[e].grad * fluid::nodal(p, mesh.cells, e)); };
  for (Index e = 0; e < mesh.cell_count(); ++e)
    for (int a = 0; a < 4; ++a) {
      smooth.col(mesh.cells(a, e)) += tets[e].volume / 4 * gradient(e);
      mass[mesh.cells(a, e)] += tets[e].volume / 4;
    }
  double rough = 0;
  for (Index e = 0; e < mesh.cell_count(); ++e)
    for (int a = 0; a < 4; ++a) {
      const Index n = mesh.cells(a, e);
      rough += tets[e].volume / 4 * (gradient(e) - smooth.col(n) / mass[n]).squaredNorm();
    }
  return std::sqrt(rough / p.cwiseAbs2().dot(mass)) * h;
}

/// The vortex of the moving mesh, rho = 1, on [-1/2, 1/2]^2.
struct Vortex {
  double nu;
  [[nodiscard]] Vec3 u(const Vec3& x, double t) const {
    const double s = std::exp(-4 * nu * pi * pi * t);
    return {-s * std::sin(2 * pi * x[1]), s * std::sin(2 * pi * x[0]), 0};
  }
  [[nodiscard]] double p(const Vec3& x, double t) const {
    return -std::cos(2 * pi * x[0]) * std::cos(2 * pi * x[1]) * std::exp(-8 * nu * pi * pi * t);
  }
};

Points<3> vortex_motion(const mesh::TetMesh& mesh, double t, double amplitude = 0.08, double period = 4) {
  return test::nodal_values(mesh.nodes, [&](const Vec3& X) {
    const double s = amplitude * std::sin(2 * pi * t / period);
    return Vec3(s * std::sin(2 * pi * (X[1] + 0.5)), s * std::sin(2 * pi * (X[0] + 0.5)), 0);
  });
}

/// A manufactured flow with a pressure outlet at x = pi, where du_y/dx = 0. rho = 1.
struct Outflow {
  double nu;
  [[nodiscard]] Vec3 u(const Vec3& x, double t) const {
    return {std::sin(x[0]) * std::sin(x[1] + t), std::cos(x[0]) * std::cos(x[1] + t), 0};
  }
  [[nodiscard]] double p(const Vec3& x, double t) const { return std::cos(x[0]) * std::sin(x[1] + t); }
  [[nodiscard]] Vec3 force(const Vec3& x, double t) const {
    const double sx = std::sin(x[0]), cx = std::cos(x[0]), sy = std::sin(x[1] + t), cy = std::cos(x[1] + t);
    const Vec3 rate(sx * cy, -cx * sy, 0), convection(sx * cx, -sy * cy, 0), gradient(-sx * sy, cx * cy, 0);
    return rate + convection + gradient + 2 * nu * u(x, t);
  }
  [[nodiscard]] double outlet(const Vec3& x, double t) const {  // p - nu du_x/dx
    return std::cos(x[0]) * std::sin(x[1] + t) * (1 - nu);
  }
};

}  // namespace

TEST_SUITE("convergence") {
  TEST_CASE("fluid: second order in space on vortices that decay in three dimensions") {
    std::vector<test::FlowError> e;
    for (const int n : {4, 8, 16}) {
      auto mesh =
          meshing::box_tets(meshing::Block{.cells = {n, n, n}, .lo = -Vec3::Ones(), .hi = Vec3::Ones()});
      test::shake(mesh, 0.2 / n);
      const test::EthierSteinman exact{.nu = 0.1};
      auto flow = with_exact_boundary<fluid::FixedMesh>(mesh, exact);
      for (int k = 0; k < 10; ++k) REQUIRE(flow.step(0.02));
      e.push_back(error(flow, mesh, exact));
      MESSAGE("n " << n << " velocity " << e.back().velocity << " pressure " << e.back().pressure);
    }
    const double u = order(e[1].velocity, e[2].velocity), p = order(e[1].pressure, e[2].pressure);
    MESSAGE("orders: velocity " << u << " pressure " << p);
    CHECK(u > 1.9);
    CHECK(p > 1.9);
    CHECK(e[2].velocity < 0.01);
  }

  TEST_CASE("fluid: the pressure stays accurate and smooth at any small step") {
    const int n = 16;
    const auto mesh = slab(n, 2, 0, pi);
    const test::TaylorGreen exact{.nu = 0.02};
    const auto sweep = [&](const auto& stabilization) {
      auto settled = with_exact_boundary<fluid::FixedMesh>(mesh, exact, {}, stabilization);
      for (int k = 0; k < 50; ++k) REQUIRE(settled.step(0.01));
      std::vector<double> errors, rough;
      for (const double dt : {1e-2, 1e-3, 1e-4, 1e-5}) {
        auto flow = settled;  // goes on from the scheme's own state
        double iterations = 0;
        for (int k = 0; k < 40; ++k) {
          const auto report = flow.step(dt);
          REQUIRE(report);
          iterations += report.iterations / 40.0;
        }
        errors.push_back(error(flow, mesh, exact).pressure);
        rough.push_back(oscillation(mesh, flow.pressure(), pi / n));
        MESSAGE("dt " << dt << " pressure error " << errors.back() << " roughness " << rough.back()
                      << " iterations " << iterations);
      }
      return std::pair(errors, rough);
    };
    const double smooth = oscillation(
        mesh, test::nodal_scalars(mesh.nodes, [&](const Vec3& x) { return exact.p(x, 0.5); }), pi / n);
    const auto [errors, rough] = sweep(fluid::Fic{});
    const auto [low, high] = std::minmax_element(errors.begin(), errors.end());
    MESSAGE("roughness of the exact pressure " << smooth << " ratio of the errors " << *high / *low);
    CHECK(*high < 1.5 * *low);
    for (const double r : rough) CHECK(r < 1.2 * smooth);

    const auto [bad_errors, bad_rough] = sweep(fluid::Unstabilized{});  // a documented failure
    CHECK(bad_errors.back() > 100 * bad_errors.front());
    CHECK(bad_rough.back() > 10 * smooth);
  }

  TEST_CASE("fluid: second order in time with prescribed velocities") {
    const auto mesh = slab(16, 2, 0, pi);
    for (const double nu : {0.02, 0.1}) {
      const test::TaylorGreen exact{.nu = nu};
      auto early = with_exact_boundary<fluid::FixedMesh>(mesh, exact);
      for (int k = 0; k < 50; ++k) REQUIRE(early.step(0.01));
      const double start = early.time();  // the interpolated start and its transient lie behind
      const auto run = [&](int steps, int passes) {
        fluid::Projection flow{mesh, fluid::Newtonian{.density = 1, .viscosity = nu}, fluid::Fic{},
                               fluid::FixedMesh{}, fluid::ProjectionOptions{.passes = passes}};
        for (const auto* side : test::box_sides)
          flow.velocity(side, [=](const Vec3& x, double t) { return exact.u(x, start + t); });
        flow.set(early.velocity(), early.pressure());
        for (int k = 0; k < steps; ++k) REQUIRE(flow.step(1.0 / steps));
        return flow;
      };
      const auto reference = run(320, 3);
      std::vector<double> u, p;
      for (const int steps : {10, 20, 40}) {
        const auto flow = run(steps, 1);
        u.push_back((flow.velocity() - reference.velocity()).norm() / reference.velocity().norm());
        p.push_back((flow.pressure() - reference.pressure()).norm() / reference.pressure().norm());
      }
      MESSAGE("nu " << nu << ": velocity " << u[0] << " " << u[1] << " " << u[2] << " order "
                    << order(u[1], u[2]) << "; pressure " << p[0] << " " << p[1] << " " << p[2] << " order "
                    << order(p[1], p[2]));
      CHECK(order(u[1], u[2]) > 1.8);
      CHECK(order(p[1], p[2]) > 1.4);
    }
  }

  TEST_CASE("fluid: order in time with a pressure outlet and the smaller error of the rotational form") {
    // The outlet's pressure is corrected through a layer of the width sqrt(nu dt): theory's orders 3/2 and
    // 1 of the velocity and the pressure with one pass are seen where the mesh resolves it [GUERMOND06].
    auto mesh = meshing::box_tets(
        meshing::Block{.cells = {16, 10, 6}, .lo = Vec3(pi / 2, 0, 0), .hi = Vec3(pi, 1, 0.6)});
    test::shake(mesh, 0.01);
    const Outflow exact{.nu = 1};
    const auto run = [&](int steps, fluid::ProjectionOptions options) {
      auto flow = with_exact_boundary<fluid::FixedMesh>(mesh, exact, options);
      flow.pressure("x1", [exact](const Vec3& x, double t) { return exact.outlet(x, t); });
      flow.body_force([exact](const Vec3& x, double t) { return exact.force(x, t); });
      flow.set(test::nodal_values(mesh.nodes, [&](const Vec3& x) { return exact.u(x, 0); }),
               test::nodal_scalars(mesh.nodes, [&](const Vec3& x) { return exact.p(x, 0); }));
      for (int k = 0; k < steps; ++k) REQUIRE(flow.step(1.0 / steps));
      return flow;
    };
    const auto reference = run(240, {.passes = 3});
    MESSAGE("error of the mesh: velocity " << error(reference, mesh, exact).velocity);
    const auto orders = [&](fluid::ProjectionOptions options) {
      std::vector<double> u, p;
      for (const int steps : {20, 40, 80}) {
        const auto flow = run(steps, options);
        u.push_back((flow.velocity() - reference.velocity()).norm() / reference.velocity().norm());
        p.push_back((flow.pressure() - reference.pressure()).norm() / reference.pressure().norm());
      }
      MESSAGE("chi " << options.rotational << " passes " << options.passes << ": velocity " << u[0] << " "
                     << u[1] << " " << u[2] << " order " << order(u[1], u[2]) << "; pressure " << p[0] << " "
                     << p[1] << " " << p[2] << " order " << order(p[1], p[2]));
      return std::pair(u, p);
    };
    const auto [u1, p1] = orders({.passes = 1});
    const auto [u3, p3] = orders({.passes = 3});
    const auto [us, ps] = orders({.passes = 1, .rotational = 0});
    CHECK(order(u1[1], u1[2]) > 1.5);
    CHECK(order(p1[1], p1[2]) > 1.4);
    // Passes take away most of the splitting error, so the order lies above 3/2; what is left of it keeps
    // the order below 2 (docs/fluid.md, Limits).
    CHECK(order(u3[1], u3[2]) > 1.8);
    CHECK(order(p3[1], p3[2]) > 1.4);
    CHECK(u3[2] < 0.2 * u1[2]);
    // The standard form would stop at an outlet where dp is held at the nodes; weakly prescribed, it goes on,
    // with a larger error.
    CHECK(order(us[1], us[2]) > 1);
    CHECK(us[2] > 2 * u1[2]);
    CHECK(ps[2] > 2 * p1[2]);
  }

  TEST_CASE("fluid: second order in time and space on a moving mesh") {
    const Vortex exact{.nu = 0.025};
    const auto run = [&](const mesh::TetMesh& mesh, int steps, double amplitude) {
      auto flow = with_exact_boundary<fluid::MovingMesh>(mesh, exact);
      for (int k = 1; k <= steps; ++k) {
        flow.move(vortex_motion(mesh, double(k) / steps, amplitude), 1.0 / steps);
        REQUIRE(flow.step(1.0 / steps));
      }
      return flow;
    };
    const auto mesh = slab(12, 3, -0.5, 0.5);
    for (const double amplitude : {0.08, 0.0}) {
      const auto reference = run(mesh, 320, amplitude);
      std::vector<double> u, p;
      for (const int steps : {20, 40, 80}) {
        const auto flow = run(mesh, steps, amplitude);
        u.push_back((flow.velocity() - reference.velocity()).norm() / reference.velocity().norm());
        p.push_back((flow.pressure() - reference.pressure()).norm() / reference.pressure().norm());
      }
      MESSAGE("amplitude " << amplitude << ": velocity " << u[0] << " " << u[1] << " " << u[2] << " order "
                           << order(u[1], u[2]) << "; pressure " << p[0] << " " << p[1] << " " << p[2]
                           << " order " << order(p[1], p[2]));
      CHECK(order(u[1], u[2]) > 1.8);
      CHECK(order(p[1], p[2]) > 1.4);
    }
    std::vector<test::FlowError> e;
    for (const int n : {8, 12, 24}) {
      const auto m = slab(n, n / 4, -0.5, 0.5);
      e.push_back(error(run(m, 80, 0.08), m, exact));
      MESSAGE("n " << n << " velocity " << e.back().velocity << " pressure " << e.back().pressure);
    }
    MESSAGE("orders in space: velocity " << order(e[1].velocity, e[2].velocity) << " pressure "
                                         << order(e[1].pressure, e[2].pressure));
    CHECK(order(e[1].velocity, e[2].velocity) > 1.9);
    CHECK(order(e[1].pressure, e[2].pressure) > 1.4);
  }

  TEST_CASE("fluid: steps of changing size keep the order") {
    const auto mesh = slab(12, 2, -0.5, 0.5);
    const Vortex exact{.nu = 0.025};
    const auto run = [&](int steps, bool uneven) {
      auto flow = with_exact_boundary<fluid::MovingMesh>(mesh, exact);
      double t = 0;
      for (int k = 0; k < steps; ++k) {
        const double dt = (uneven ? (k % 2 == 0 ? 1.5 : 0.5) : 1.0) / steps;
        t += dt;
        flow.move(vortex_motion(mesh, t), dt);
        REQUIRE(flow.step(dt));
      }
      return flow;
    };
    const auto reference = run(320, false);
    std::vector<double> u;
    for (const int steps : {20, 40, 80})
      u.push_back((run(steps, true).velocity() - reference.velocity()).norm() / reference.velocity().norm());
    MESSAGE("velocity " << u[0] << " " << u[1] << " " << u[2] << " order " << order(u[1], u[2]));
    CHECK(order(u[1], u[2]) > 1.8);
  }
}
