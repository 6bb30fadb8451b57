// SPDX-License-Identifier: MIT
// Flow in a rigid tube against the exact solutions of Poiseuille and Womersley. [WOMERSLEY55]
#include "support/flow.hpp"
#include "tunica/fluid/inlet.hpp"
#include "tunica/fluid/projection.hpp"
#include "tunica/meshing/tube.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

using namespace tunica;
using std::numbers::pi;

namespace {

using Complex = std::complex<double>;

/// Power series of the Bessel functions J_0 and J_1, enough for |z| < 10.
Complex bessel(int order, Complex z) {
  Complex term = order == 0 ? 1.0 : z / 2.0, sum = term;
  for (int k = 1; k < 60; ++k) {
    term *= -z * z / (4.0 * k * (k + order));
    sum += term;
  }
  return sum;
}

/// Pressure gradient dp/dz = -Re(G e^{i w t}) in a tube of radius R.
struct Womersley {
  double alpha, radius, density, viscosity, G;  // [-], [m], [kg/m3], [Pa s], [Pa/m]

  [[nodiscard]] double omega() const { return alpha * alpha * viscosity / (density * radius * radius); }
  [[nodiscard]] Complex lambda() const { return std::pow(Complex(0, 1), 1.5) * alpha; }
  [[nodiscard]] Complex profile(double y) const {  // u / (G R^2 / 4 mu)
    return 4.0 / (Complex(0, 1) * alpha * alpha) * (1.0 - bessel(0, lambda() * y) / bessel(0, lambda()));
  }
  [[nodiscard]] Complex flow() const {  // Q / (pi R^4 G / 8 mu)
    const Complex F = 2.0 * bessel(1, lambda()) / (lambda() * bessel(0, lambda()));
    return 8.0 / (Complex(0, 1) * alpha * alpha) * (1.0 - F);
  }
  [[nodiscard]] Vec3 u(const Vec3& x, double t) const {
    const double y = x.head<2>().norm() / radius;
    return {0, 0, G * radius * radius / (4 * viscosity) * (profile(y) * std::polar(1.0, omega() * t)).real()};
  }
};

double order(double coarse, double fine, double ratio) {
  return std::log(coarse / fine) / std::log(ratio);
}

}  // namespace

TEST_SUITE("convergence") {
  TEST_CASE("fluid: poiseuille flow in a tube") {
    constexpr double R = 5e-3, L = 10e-3, U = 2e-3;
    constexpr fluid::Newtonian blood{.density = 1050, .viscosity = 0.0035};
    const double G = 8 * blood.viscosity * U / (R * R);  // -dp/dz = 8 mu U / R^2
    const auto exact = [&](const Vec3& x) {
      return Vec3(0, 0, 2 * U * (1 - x.head<2>().squaredNorm() / (R * R)));
    };
    const auto drop = [&](const Vec3& x) { return G * (L - x[2]); };
    std::vector<double> u, p, Q, F;
    for (const int n : {3, 4, 6, 8}) {
      const auto mesh = meshing::lumen(meshing::Lumen{.radius = R, .length = L, .cells = {n, 6 * n, 2 * n}});
      fluid::Projection flow{mesh, blood, fluid::Fic{}, fluid::FixedMesh{}};
      flow.pressure("inlet", G * L);
      flow.pressure("outlet", 0.0);
      flow.interface("wall");
      flow.set(test::nodal_values(mesh.nodes, exact), test::nodal_scalars(mesh.nodes, drop));
      for (int k = 0; k < 60; ++k) REQUIRE(flow.step(0.2));
      const auto e = test::flow_error(mesh.nodes, mesh.cells, flow.velocity(), flow.pressure(), exact, drop);
      double area = 0;
      for (Eigen::Index f = 0; f < mesh.patch("inlet").faces.cols(); ++f)
        area += fluid::Conditions::area_vector(mesh.nodes, mesh.patch("inlet").faces, f).norm();
      u.push_back(e.velocity), p.push_back(e.pressure);
      Q.push_back(std::abs(flow.mass_balance().inflow / (pi * R * R * U) - 1));
      F.push_back(std::abs(flow.interface_force().row(2).sum() / (G * L * area) - 1));
      MESSAGE("across " << n << " tetrahedra " << mesh.cell_count() << ": velocity " << u.back()
                        << " pressure " << p.back() << " flow " << Q.back() << " force balance " << F.back()
                        << " mass residual " << flow.mass_balance().residual() << " defect "
                        << flow.mass_balance().defect());
      CHECK(flow.mass_balance().residual() < 1e-8);
    }
    MESSAGE("orders from 4 to 8: velocity " << order(u[1], u[3], 2) << " pressure " << order(p[1], p[3], 2)
                                            << " flow " << order(Q[1], Q[3], 2));
    CHECK(order(u[1], u[3], 2) > 1.9);
    CHECK(order(p[1], p[3], 2) > 1.5);
    CHECK(order(Q[1], Q[3], 2) > 1.8);
    CHECK(u[3] < 0.01);
    CHECK(F[3] < 1e-3);  // the wall takes what the pressures put in
  }

  TEST_CASE("fluid: poiseuille flow fed by a velocity has the pressure drop of the tube") {
    constexpr double R = 5e-3, L = 20e-3, U = 2e-3;
    constexpr fluid::Newtonian blood{.density = 1050, .viscosity = 0.0035};
    std::vector<double> error;
    for (const int n : {4, 8}) {
      const auto mesh = meshing::lumen(meshing::Lumen{.radius = R, .length = L, .cells = {n, 6 * n, 4 * n}});
      fluid::Projection flow{mesh, blood, fluid::Fic{}, fluid::FixedMesh{}};
      // in a round tube the profile of the inlets, 1 - (1 - d/d_max)^2, is the parabola
      flow.velocity("inlet", fluid::inlet_profile(mesh, "inlet"), U);
      flow.pressure("outlet", 0.0);
      for (int k = 0; k < 60; ++k) REQUIRE(flow.step(0.2));
      // the gradient of the pressure over the middle of the tube
      std::array<double, 2> mean{}, count{};
      for (Index i = 0; i < mesh.node_count(); ++i)
        for (std::size_t k = 0; k < 2; ++k)
          if (std::abs(mesh.nodes(2, i) - (k == 0 ? 0.25 : 0.75) * L) < 1e-9)
            mean[k] += flow.pressure()[i], ++count[k];
      const double gradient = (mean[0] / count[0] - mean[1] / count[1]) / (L / 2);
      error.push_back(std::abs(gradient / (8 * blood.viscosity * U / (R * R)) - 1));
      MESSAGE("across " << n << ": error of the pressure gradient " << error.back() << " mass defect "
                        << flow.mass_balance().defect());
      CHECK(flow.mass_balance().residual() < 1e-8);
    }
    MESSAGE("order " << order(error[0], error[1], 2));
    CHECK(order(error[0], error[1], 2) > 1.7);
    CHECK(error[1] < 0.02);
  }

  TEST_CASE("fluid: womersley flow in a tube") {
    // references to ten digits: the profile at y and the flow
    struct Row {
      double alpha, y;
      Complex u, Q;
    };
    const std::array<Row, 2> table{{{3, 0.5, {.2229776219, -.3420275452}, {.319966968109, -.445324179923}},
                                    {5, 0.8, {.0576343854, -.0930933064}, {.077311365420, -.229102204616}}}};
    for (const Row& row : table) {
      const Womersley exact{.alpha = row.alpha, .radius = 5e-3, .density = 1050, .viscosity = 0.0035, .G = 2};
      REQUIRE(std::abs(exact.profile(row.y) - row.u) < 1e-9);
      REQUIRE(std::abs(exact.flow() - row.Q) < 1e-9);
      const double L = 5e-3, period = 2 * pi / exact.omega();
      std::vector<double> l2, phase, amplitude;
      for (const int n : {4, 8}) {
        const auto mesh = meshing::lumen(meshing::Lumen{.radius = 5e-3, .length = L, .cells = {n, 6 * n, n}});
        fluid::Projection flow{mesh, fluid::Newtonian{.density = 1050, .viscosity = 0.0035}, fluid::Fic{},
                               fluid::FixedMesh{}};
        const auto pressure = [&](const Vec3& x, double t) {
          return exact.G * std::cos(exact.omega() * t) * (L - x[2]);
        };
        flow.pressure("inlet", pressure);
        flow.pressure("outlet", 0.0);
        flow.set(test::nodal_values(mesh.nodes, [&](const Vec3& x) { return exact.u(x, 0); }),
                 test::nodal_scalars(mesh.nodes, [&](const Vec3& x) { return pressure(x, 0); }));
        const int steps = 20 * n;  // a period; the second one is measured
        double worst = 0, scale = 0;
        Complex Q = 0;
        for (int k = 1; k <= 2 * steps; ++k) {
          REQUIRE(flow.step(period / steps));
          if (k <= steps) continue;
          Q += 2.0 / steps *
               fluid::Conditions::flux(mesh.nodes, mesh.patch("outlet").faces, flow.velocity()) *
               std::polar(1.0, -exact.omega() * flow.time());
          if (k % (steps / 4) != 0) continue;
          double e = 0, s = 0;
          for (Index i = 0; i < mesh.node_count(); ++i) {
            const Vec3 u = exact.u(mesh.nodes.col(i), flow.time());
            e += (flow.velocity().col(i) - u).squaredNorm(), s += u.squaredNorm();
          }
          worst = std::max(worst, e), scale = std::max(scale, s);
        }
        const Complex ratio = Q / (exact.flow() * pi * std::pow(5e-3, 4) * exact.G / (8 * 0.0035));
        l2.push_back(std::sqrt(worst / scale));
        amplitude.push_back(std::abs(std::abs(ratio) - 1));
        phase.push_back(std::abs(std::arg(ratio)) * 180 / pi);
        MESSAGE("alpha " << row.alpha << " across " << n << ": velocity L2 " << l2.back()
                         << " flow amplitude " << amplitude.back() << " phase " << phase.back()
                         << " degrees, mass residual " << flow.mass_balance().residual());
      }
      MESSAGE("alpha " << row.alpha << " orders: velocity " << order(l2[0], l2[1], 2) << " flow "
                       << order(amplitude[0], amplitude[1], 2));
      CHECK(order(l2[0], l2[1], 2) > 1.7);
      CHECK(l2[1] < 0.02);
      CHECK(amplitude[1] < 0.02);
      CHECK(phase[1] < 1);
    }
  }
}
