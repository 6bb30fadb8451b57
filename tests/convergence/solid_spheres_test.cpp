// SPDX-License-Identifier: MIT
// Thick and thin spheres of rubber under pressure: the closed form at second order, and the limit of a thin
// one.
#include "support/octant.hpp"
#include "tunica/solid/laws.hpp"
#include "tunica/solid/volume_control.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

using namespace tunica;
using namespace tunica::solid;

namespace {

constexpr double inner = 10e-3, mu = 100e3;  // [m], [Pa]
using Rubber = Hyperelastic<NeoHooke, Quadratic>;

/// An octant of a sphere with outer radius ratio * inner; its bulk modulus is that many mu.
struct Sphere {
  mesh::HexMesh mesh;
  Statics<mesh::Hex8, Rubber> wall;
  std::size_t lumen;

  Sphere(double ratio, int across, int radial, double bulk = 1e5)
      : mesh(test::octant(inner, ratio * inner, across, radial)),
        wall(mesh, Rubber{NeoHooke{.c10 = mu / 2}, Quadratic{.kappa = bulk * mu}}) {
    wall.fix(mesh.patch("sym_x"), Axis::x);
    wall.fix(mesh.patch("sym_y"), Axis::y);
    wall.fix(mesh.patch("sym_z"), Axis::z);
    lumen = wall.pressure(mesh.patch("inner"), 0);
  }
  /// Mean over the inner nodes.
  [[nodiscard]] double stretch() const {
    const Points<3> x = mesh.nodes + wall.displacement();
    const auto nodes = mesh::patch_nodes(mesh.patch("inner"));
    double sum = 0;
    for (const Index k : nodes) sum += x.col(k).norm();
    return sum / static_cast<double>(nodes.size()) / inner;
  }
};

}  // namespace

TEST_SUITE("convergence") {
  TEST_CASE("solid: closed form of spheres has its tabled limits") {
    constexpr struct {
      double ratio, stretch, pressure;
    } table[] = {{1.01, 1.38739222, 0.0123329282},
                 {1.1, 1.42638458, 0.1180125366},
                 {1.7, 1.69317646, 0.6378582619},
                 {2.0, 1.82814733, 0.8164236480}};
    for (const auto& [ratio, stretch, pressure] : table) {
      const test::Balloon exact{ratio};
      CHECK(std::abs(exact.pressure(stretch) - pressure) < 1e-10);
      CHECK(exact.pressure(stretch - 1e-3) < exact.pressure(stretch));
      CHECK(exact.pressure(stretch + 1e-3) < exact.pressure(stretch));
    }
    // Of a thin one p R/(mu t) = 2 (1/l - l^-7), 1.2394629024 at most.
    CHECK(std::abs(test::Balloon{1 + 1e-6}.pressure(1.3830875543) * 1e6 - 1.2394629024) < 1e-5);
  }

  TEST_CASE("solid: spheres of every thickness bear the pressures of the closed form at second order") {
    for (const double ratio : {1.1, 1.7, 2.0}) {
      const double l = 1.3, p = test::Balloon{ratio}.pressure(l);
      std::vector<double> errors;
      for (const int n : {2, 4, 8}) {
        Sphere sphere(ratio, n, ratio < 1.5 ? n / 2 : n);
        sphere.wall.pressure(sphere.lumen, p * mu);
        const auto report = sphere.wall.solve();
        REQUIRE(report);
        const double reached = sphere.stretch();
        errors.push_back(std::abs(reached - l));
        MESSAGE("R_o/R_i " << ratio << ", " << n << " cells: stretch " << reached << " of " << l
                           << ", pressure off by " << 100 * (test::Balloon{ratio}.pressure(reached) / p - 1)
                           << " %, " << report.solve.iterations << " iterations");
        if (n == 8) CHECK(std::abs(test::Balloon{ratio}.pressure(reached) / p - 1) < 5e-3);
      }
      const double order = std::log2(errors[1] / errors[2]);
      MESSAGE("orders " << std::log2(errors[0] / errors[1]) << " " << order);
      CHECK(std::abs(order - 2) < 0.15);
    }
  }

  TEST_CASE("solid: a sphere of a hundredth of its radius passes its limit pressure within 1 percent") {
    const double ratio = 1.01, stretch = 1.38739222, pressure = 0.0123329282;
    Sphere sphere(ratio, 8, 1, 1e4);
    VolumeControl filling{sphere.wall, sphere.lumen};
    const double octant = filling.volume();
    double most = 0, at_stretch = 0, last = 0;
    int iterations = 0, cuts = 0;
    for (double l = 1.05; l < stretch + 0.3; l += 0.05) {
      const auto at = filling.step(octant * l * l * l);
      REQUIRE(at);
      iterations += at.solve.iterations, cuts += at.cuts;
      last = at.pressure / mu;
      if (last > most) most = last, at_stretch = sphere.stretch();
    }
    MESSAGE("limit pressure " << most << " mu of " << pressure << ", off by " << 100 * (most / pressure - 1)
                              << " %, at stretch " << at_stretch << "; " << iterations << " iterations, "
                              << cuts << " cuts; at the end " << last << " mu");
    CHECK(std::abs(most / pressure - 1) < 0.01);
    CHECK(std::abs(at_stretch - stretch) < 0.05);
    CHECK(last < 0.995 * most);
  }
}
