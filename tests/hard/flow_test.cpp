// SPDX-License-Identifier: MIT
// Numerical stability of the flow solver: moving meshes, outlets, backflow, coarse cells, violent starts.
#include "support/flow.hpp"
#include "tunica/fluid/inlet.hpp"
#include "tunica/fluid/projection.hpp"
#include "tunica/meshing/box.hpp"
#include "tunica/meshing/tube.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

using namespace tunica;
using std::numbers::pi;

namespace {

double kinetic_energy(const mesh::TetMesh& mesh, const Points<3>& u, double density) {
  double sum = 0;
  for (Index e = 0; e < mesh.cell_count(); ++e) {
    const auto ue = fluid::nodal(u, mesh.cells, e);
    const Vec3 total = ue.rowwise().sum();
    sum += density / 2 * fem::p1_tet(mesh.nodes, mesh.cells, e).volume / 20 *
           (total.squaredNorm() + ue.squaredNorm());
  }
  return sum;
}

mesh::TetMesh pipe(double length, int cells_along) {
  return meshing::lumen(meshing::Lumen{.radius = 5e-3, .length = length, .cells = {4, 24, cells_along}});
}

}  // namespace

TEST_SUITE("hard") {
  TEST_CASE("fluid: a uniform stream does not see a hundred random motions of the mesh") {
    auto mesh = meshing::box_tets(5);
    test::shake(mesh, 0.03);
    const Vec3 stream(0.3, -0.7, 0.5);
    fluid::Projection flow{mesh, fluid::Newtonian{.density = 1, .viscosity = 0.01}, fluid::Fic{}};
    for (const auto* side : test::box_sides) flow.velocity(side, stream);
    flow.pressure("x1", 0.0);
    flow.set(stream.replicate(1, mesh.node_count()));
    test::Noise noise(7);
    const double h = 0.2, dt = 0.01;
    for (int k = 0; k < 100; ++k) {
      Points<3> d(3, mesh.node_count());
      for (Eigen::Index i = 0; i < d.size(); ++i) d.data()[i] = 0.1 * h * noise();  // the boundary moves too
      const double step = dt * (1 + 0.5 * noise());
      flow.move(d, step);
      REQUIRE(flow.step(step));
      REQUIRE((flow.velocity().colwise() - stream).cwiseAbs().maxCoeff() < 1e-12);
    }
    MESSAGE("after 100 motions: velocity " << (flow.velocity().colwise() - stream).cwiseAbs().maxCoeff()
                                           << " pressure " << flow.pressure().cwiseAbs().maxCoeff());
    CHECK(flow.pressure().cwiseAbs().maxCoeff() < 1e-10);
  }

  TEST_CASE("fluid: a piston feels the mass of its column") {
    const auto mesh =
        meshing::box_tets(meshing::Block{.cells = {8, 4, 4}, .lo = Vec3::Zero(), .hi = Vec3(2, 1, 1)});
    const double w = 5, amplitude = 0.1;  // x_piston = A (w t - sin w t)
    const auto speed = [&](double t) { return Vec3(amplitude * w * (1 - std::cos(w * t)), 0, 0); };
    for (const int passes : {1, 3}) {
      std::vector<double> errors;
      for (const int steps : {40, 80, 160}) {
        fluid::Projection column{mesh, fluid::Newtonian{.density = 3, .viscosity = 0.01}, fluid::Fic{},
                                 fluid::MovingMesh{}, fluid::ProjectionOptions{.passes = passes}};
        for (const auto* side : {"y0", "y1", "z0", "z1"})
          column.velocity(side, speed);  // slides along: plug flow
        column.pressure("x1", 0.0);
        column.interface("x0");
        double worst = 0, sideways = 0;
        for (int k = 1; k <= steps; ++k) {
          const double dt = 1.0 / steps, t = k * dt, x = amplitude * (w * t - std::sin(w * t));
          Points<3> d = Points<3>::Zero(3, mesh.node_count());
          d.row(0) = x * (1 - mesh.nodes.row(0).array() / 2).matrix();
          column.move(d, dt);
          REQUIRE(column.step(dt));
          const Vec3 force = column.interface_force().rowwise().sum();
          const double exact = -3 * (2 - x) * amplitude * w * w * std::sin(w * t);
          if (k > steps / 4)
            worst = std::max(worst, std::abs(force[0] - exact) / (3 * 2 * amplitude * w * w));
          sideways = std::max(sideways, force.tail<2>().norm());
        }
        errors.push_back(worst);
        MESSAGE("passes " << passes << " steps " << steps << " worst error of the force " << worst
                          << " sideways " << sideways);
      }
      CHECK(errors[2] < 0.01);
      CHECK(errors[2] < 0.3 * errors[1]);  // of second order already with one pass
    }
  }

  TEST_CASE("fluid: rotational outlets are stable at any viscous step") {
    const double h = 1.25e-3, dt = 1e-3;
    for (const double length : {20e-3, 4e-3}) {  // elements as long as wide, and a fifth of it
      const auto mesh = pipe(length, 16);
      for (const double number : {1e-3, 1e-1, 1e1, 1e3}) {  // nu dt / h^2
        const double nu = number * h * h / dt;
        for (const int passes : {1, 3}) {
          CAPTURE(length);
          CAPTURE(number);
          CAPTURE(passes);
          fluid::Projection flow{mesh, fluid::Newtonian{.density = 1000, .viscosity = 1000 * nu},
                                 fluid::Fic{}, fluid::FixedMesh{},
                                 fluid::ProjectionOptions{.passes = passes}};
          flow.velocity("inlet", fluid::inlet_profile(mesh, "inlet"),
                        [](double t) { return 0.1 * (1 - std::exp(-t / 5e-3)); });
          flow.pressure("outlet", 0.0, {.backflow = 0.5});
          double peak = 0;
          for (int k = 0; k < 100; ++k) {
            const auto report = flow.step(dt);
            REQUIRE_MESSAGE(bool(report), "step " << k << " " << name(report.status));
            peak = std::max(peak, flow.velocity().colwise().norm().maxCoeff());
          }
          MESSAGE("length " << length << " nu dt/h2 " << number << " passes " << passes << ": peak velocity "
                            << peak << " last pressure " << flow.pressure().cwiseAbs().maxCoeff()
                            << " defect " << flow.mass_balance().defect());
          CHECK(peak < 0.26);
        }
      }
    }
  }

  TEST_CASE("fluid: reversing flow at an open end needs the stress against backflow") {
    const auto mesh = pipe(30e-3, 24);
    const auto run = [&](double beta, auto waveform, int steps) {
      fluid::Projection flow{mesh, fluid::Newtonian{.density = 1050, .viscosity = 0.0035}, fluid::Fic{},
                             fluid::FixedMesh{}};
      flow.velocity("inlet", fluid::inlet_profile(mesh, "inlet"), waveform);
      flow.pressure("outlet", 0.0, {.backflow = beta});
      double energy = 0;
      for (int k = 0; k < steps; ++k) {
        if (!flow.step(2e-3)) {
          energy = std::numeric_limits<double>::infinity();
          break;
        }
        energy = std::max(energy, kinetic_energy(mesh, flow.velocity(), 1050));
      }
      return std::pair(energy, Points<3>(flow.velocity()));
    };
    const double Re_5000 = 5000 * 0.0035 / (1050 * 10e-3);  // mean velocity [m/s]
    const auto reversing = [&](double t) { return Re_5000 * std::sin(2 * pi * t / 0.4); };
    const double plug = 0.5 * 1050 * pi * 25e-6 * 30e-3 * Re_5000 * Re_5000;
    for (const double beta : {0.0, 0.5, 1.0}) {
      const double energy = run(beta, reversing, 200).first;
      MESSAGE("beta " << beta << " largest kinetic energy over that of a plug " << energy / plug);
      CHECK((beta >= 0.5) == (energy < 3 * plug));  // without it the run is lost: a documented failure
    }
    const auto forward = [](double t) { return 0.05 * (1 - std::exp(-t / 0.02)); };
    const Points<3> u0 = run(0, forward, 40).second, u1 = run(1, forward, 40).second;
    CHECK((u0 - u1).cwiseAbs().maxCoeff() < 1e-12);
  }

  TEST_CASE("fluid: a cavity at any cell Reynolds number stays bounded") {
    const int n = 16;
    auto mesh =
        meshing::box_tets(meshing::Block{.cells = {n, n, 2}, .lo = Vec3::Zero(), .hi = Vec3(1, 1, 2.0 / n)});
    for (const double Re : {1e1, 1e3, 1e5}) {
      fluid::Projection cavity{mesh, fluid::Newtonian{.density = 1, .viscosity = 1 / Re}, fluid::Fic{},
                               fluid::FixedMesh{}};
      const auto lid = [](const Vec3& x, double) {
        return x[1] > 1 - 1e-9 ? Vec3(16 * std::pow(x[0] * (1 - x[0]), 2), 0, 0) : Vec3(0, 0, 0);
      };
      for (const auto* side : {"y1", "z0", "z1"}) cavity.velocity(side, lid);
      double peak = 0;
      for (int k = 0; k < 200; ++k) {  // CFL 0.8, an impulsive start
        REQUIRE(cavity.step(0.05));
        peak = std::max(peak, cavity.velocity().colwise().norm().maxCoeff());
      }
      MESSAGE("Re " << Re << " peak velocity " << peak);
      CHECK(peak < 1.05);
    }
  }

  TEST_CASE("fluid: no mass is lost from the first step on where pressures alone drive the flow") {
    for (const double scale : {1e-6, 1e-3, 1.0}) {  // tubes of 5 nm, 5 um and 5 mm
      const auto mesh = meshing::lumen(
          meshing::Lumen{.radius = 5e-3 * scale, .length = 30e-3 * scale, .cells = {4, 24, 16}});
      fluid::Projection flow{mesh, fluid::Newtonian{.density = 1050, .viscosity = 0.0035}, fluid::Fic{},
                             fluid::FixedMesh{}};
      flow.pressure("inlet", [](double t) { return 5e3 * t; });
      flow.pressure("outlet", [](double t) { return 1e4 * t; }, {.backflow = 0.5});
      double worst = 0;
      for (int k = 0; k < 5; ++k) {
        REQUIRE(flow.step(1e-3));
        worst = std::max(worst, flow.mass_balance().residual());
      }
      MESSAGE("scale " << scale << ": largest mass residual " << worst);
      CHECK(flow.mass_balance().inflow > 0);
      CHECK(worst < 2e-9);
    }
  }

  TEST_CASE("fluid: a jet from an impulsive start at large steps") {
    const auto mesh = pipe(30e-3, 24);
    for (const double courant : {0.5, 5.0, 20.0}) {
      fluid::Projection flow{mesh, fluid::Newtonian{.density = 1056, .viscosity = 0.0035}, fluid::Fic{},
                             fluid::FixedMesh{}};
      flow.velocity("inlet", [](const Vec3& x, double) {  // half the radius blows at 0.5 m/s: an expansion
        const double r = x.head<2>().norm() / 2.5e-3;
        return Vec3(0, 0, r < 1 ? 0.5 * (1 - r * r) : 0.0);
      });
      flow.pressure("outlet", 0.0, {.backflow = 0.5});
      for (int k = 0; k < 60; ++k) {
        REQUIRE(flow.step(courant * 1.25e-3 / 0.5));
        CHECK(flow.mass_balance().residual() < 1e-8);
      }
      const double peak = flow.velocity().colwise().norm().maxCoeff();
      MESSAGE("Courant " << courant << " peak velocity " << peak << " mass defect "
                         << flow.mass_balance().defect());
      CHECK(peak < 0.6);
    }
  }
}
