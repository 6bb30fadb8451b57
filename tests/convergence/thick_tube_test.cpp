// SPDX-License-Identifier: MIT
#include "support/thick_tube.hpp"
#include "tunica/meshing/tube.hpp"
#include "tunica/solid/laws.hpp"
#include "tunica/solid/output.hpp"
#include "tunica/solid/statics.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

using namespace tunica;

namespace {

struct Inflated {
  double inner_stretch, outer_stretch;
  solid::StaticsReport report;
};

/// A quarter ring, one cell long, in plane strain.
Inflated inflate(const test::ThickTube& tube, double p, double kappa, int radial, int around) {
  const auto mesh = meshing::quarter_tube({.inner_radius = tube.inner,
                                           .thickness = tube.outer - tube.inner,
                                           .length = 1e-3,
                                           .cells = {radial, around, 1}});
  solid::Statics wall{mesh, solid::Hyperelastic{solid::Yeoh{.c10 = tube.c10, .c20 = tube.c20},
                                                solid::Quadratic{.kappa = kappa}}};
  wall.fix(mesh.patch("ends"), solid::Axis::z);
  wall.fix(mesh.patch("sym_x"), solid::Axis::x);
  wall.fix(mesh.patch("sym_y"), solid::Axis::y);
  wall.pressure(mesh.patch("inner"), p);
  Inflated out;
  out.report = wall.solve();
  const Points<3> x = mesh.nodes + wall.displacement();
  const auto mean_radius = [&](const char* patch) {
    double sum = 0;
    const auto nodes = mesh::patch_nodes(mesh.patch(patch));
    for (const Index n : nodes) sum += x.col(n).head<2>().norm();
    return sum / static_cast<double>(nodes.size());
  };
  out.inner_stretch = mean_radius("inner") / tube.inner;
  out.outer_stretch = mean_radius("outer") / tube.outer;
  return out;
}

}  // namespace

TEST_SUITE("convergence") {
  TEST_CASE("solid: thick tube closed form against its quadrature and the tabled values") {
    const test::ThickTube tube;
    for (const double l : {1.01, 1.05, 1.1, 1.2, 1.5})
      CHECK(tube.pressure_by_quadrature(l) == doctest::Approx(tube.pressure(l)).epsilon(1e-11));
    constexpr struct {
      double stretch, pressure;  // [-], [Pa]
    } fibrous[] = {{1.01, 2804.2867862},   {1.02, 5595.6446477},   {1.03, 8459.8522530},
                   {1.05, 14707.8055923},  {1.08, 26316.7080742},  {1.10, 36133.6801743},
                   {1.15, 70034.0338000},  {1.20, 119554.0527456}, {1.30, 270545.6486196},
                   {1.40, 491558.3366009}, {1.50, 778726.3941859}},
      rubber[] = {{1.01, 2788.8014053},  {1.02, 5474.9454392},  {1.05, 12960.4560514}, {1.10, 23754.8985727},
                  {1.20, 40408.4460223}, {1.30, 52326.0851795}, {1.50, 67448.4293313}, {2.0, 82812.0738630},
                  {3.0, 89462.8262768},  {5.0, 91051.9196551}};
    for (const auto& [l, p] : fibrous) CHECK(std::abs(tube.pressure(l) - p) < 1e-6);
    for (const auto& [l, p] : rubber) CHECK(std::abs(test::ThickTube{.c20 = 0}.pressure(l) - p) < 1e-6);
    CHECK(std::abs(tube.stretch(16e3) - 1.053778941042) < 1e-11);
    // s_rr, s_tt and s_zz through the wall at an inner stretch of 1.10 [kPa]
    constexpr struct {
      double R, rr, tt, zz;  // [mm], [kPa]
    } profile[] = {{5.0, -36.133680, 202.465896, 71.829929},
                   {5.375, -23.336949, 163.916450, 62.491393},
                   {5.75, -13.627823, 137.722862, 56.481207},
                   {6.125, -6.052043, 119.307645, 52.528847},
                   {6.5, 0, 105.954523, 49.878313}};
    for (const auto& at : profile) {
      const double R = 1e-3 * at.R, r = std::sqrt(R * R + (1.1 * 1.1 - 1) * tube.inner * tube.inner);
      const auto s = tube.stress_at(r, 1.1);
      CHECK(std::abs(1e-3 * s.rr - at.rr) < 1e-6);
      CHECK(std::abs(1e-3 * s.tt - at.tt) < 1e-6);
      CHECK(std::abs(1e-3 * s.zz - at.zz) < 1e-6);
    }
  }

  TEST_CASE(
      "solid: thick tube within a tenth of a percent in the limit of kappa with four Hex8 through the wall") {
    const test::ThickTube tube;
    const double kappa = 1000 * 2 * tube.c10;
    for (const double l : {1.05, 1.10}) {
      const double p = tube.pressure(l);
      const auto at = [&](double k) {
        const auto ring = inflate(tube, p, k, 4, 16);
        REQUIRE(ring.report);
        if (k == kappa) CHECK(la::observed_order(ring.report.history, 5e-12) >= 1.9);  // above rounding
        return ring.inner_stretch;
      };
      const double s1 = at(kappa), s2 = at(10 * kappa);
      const double limit = s2 + (s2 - s1) / 9;  // the error of a finite kappa is linear in 1/kappa
      const auto errors = [&](double s) { return (p - tube.pressure(s)) / p * 100; };
      MESSAGE("inner stretch " << l << " at " << p << " Pa: kappa/mu 1e3 " << s1 << " (pressure off by "
                               << errors(s1) << " %), 1e4 " << s2 << " (" << errors(s2)
                               << " %), extrapolated " << limit << " (" << errors(limit) << " %)");
      CHECK(std::abs(errors(s1)) < 0.3);  // of which kappa alone costs 0.16 %
      CHECK(std::abs(errors(s2)) < 0.1);
      CHECK(std::abs(errors(limit)) < 0.1);
    }
  }

  TEST_CASE("solid: thick tube converges at second order") {
    const test::ThickTube tube;
    const double l = 1.10, p = tube.pressure(l);
    std::vector<double> errors;
    for (const int n : {1, 2, 4, 8, 16}) {
      // At kappa/mu = 1e6 kappa alone costs 1e-7 of the stretch, a tenth of the last error.
      const auto ring = inflate(tube, p, 1e8 * 2 * tube.c10, n, 4 * n);
      REQUIRE(ring.report);
      errors.push_back(std::abs(ring.inner_stretch - l));
    }
    for (std::size_t k = 1; k < errors.size(); ++k) {
      const double order = std::log2(errors[k - 1] / errors[k]);
      MESSAGE("radial cells " << (1 << k) << ": error of the inner stretch " << errors[k] << ", order "
                              << order);
      if (k > 2) CHECK(std::abs(order - 2) < 0.1);
    }
  }

  TEST_CASE("solid: thick tube within a tenth of a percent and its stresses are recovered at the surfaces") {
    const test::ThickTube tube;
    const double l = 1.10, p = tube.pressure(l);
    std::vector<double> recovered, averaged;
    for (const int n : {2, 4, 8, 16}) {
      const auto mesh = meshing::quarter_tube({.inner_radius = tube.inner,
                                               .thickness = tube.outer - tube.inner,
                                               .length = 1e-3,
                                               .cells = {n, 4 * n, 1}});
      solid::Statics wall{mesh, solid::Hyperelastic{solid::Yeoh{.c10 = tube.c10, .c20 = tube.c20},
                                                    solid::Quadratic{.kappa = 1e5 * 2 * tube.c10}}};
      wall.fix(mesh.patch("ends"), solid::Axis::z);
      wall.fix(mesh.patch("sym_x"), solid::Axis::x);
      wall.fix(mesh.patch("sym_y"), solid::Axis::y);
      wall.pressure(mesh.patch("inner"), p);
      REQUIRE(wall.solve());
      const auto reached = wall.displacement();
      if (n == 4) {
        const Index node = mesh.patch("inner").faces(0, 0);
        const double stretch = (mesh.nodes + reached).col(node).head<2>().norm() / tube.inner;
        MESSAGE("4 cells: pressure at the reached stretch off by " << 100 * (tube.pressure(stretch) / p - 1)
                                                                   << " %");
        CHECK(std::abs(tube.pressure(stretch) / p - 1) < 1e-3);
      }
      // The largest error of s_rr, s_tt and s_zz at the nodes of both surfaces.
      const auto error = [&](const solid::StressField& sigma) {
        double worst = 0;
        for (const char* patch : {"inner", "outer"})
          for (const Index k : mesh::patch_nodes(mesh.patch(patch))) {
            const Vec3 X = mesh.nodes.col(k);
            const double R = X.head<2>().norm(), c = X[0] / R, s = X[1] / R;
            const double r = std::sqrt(R * R + (l * l - 1) * tube.inner * tube.inner);
            const auto exact = tube.stress_at(r, l);
            const auto at = sigma.col(k);
            worst = std::max({worst, std::abs(c * c * at[0] + s * s * at[1] + 2 * c * s * at[3] - exact.rr),
                              std::abs(s * s * at[0] + c * c * at[1] - 2 * c * s * at[3] - exact.tt),
                              std::abs(at[2] - exact.zz)});
          }
        return worst / tube.stress_at(l * tube.inner, l).tt;
      };
      recovered.push_back(error(solid::nodal_fields(wall.body(), wall.unknowns()).cauchy));
      averaged.push_back(error(solid::nodal_stress(wall.body(), wall.unknowns())));
      MESSAGE(n << " cells: nodal stresses off by " << 100 * recovered.back()
                << " % of the largest, averaged ones by " << 100 * averaged.back() << " %");
    }
    for (std::size_t k = 1; k < recovered.size(); ++k)
      MESSAGE("order " << std::log2(recovered[k - 1] / recovered[k]) << ", averaged "
                       << std::log2(averaged[k - 1] / averaged[k]));
    CHECK(std::log2(recovered[2] / recovered[3]) > 1.7);
    CHECK(recovered[2] < 0.02);
    CHECK(recovered[2] < 0.3 * averaged[2]);
  }
}
