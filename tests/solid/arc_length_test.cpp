// SPDX-License-Identifier: MIT
#include "tunica/solid/arc_length.hpp"
#include "tunica/meshing/box.hpp"
#include "tunica/solid/laws.hpp"
#include "tunica/solid/volume_control.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

using namespace tunica;
using namespace tunica::solid;

namespace {

constexpr double span = 0.05, rise = 0.006, thickness = 1.5e-3;  // half the span [m]
const Hyperelastic rubber{NeoHooke{.c10 = 0.5e6}, Quadratic{.kappa = 50e6}};

/// Half of a shallow arch, clamped at its foot x = 0; the crown at x = span only goes up and down.
struct Arch {
  mesh::HexMesh mesh = meshing::box_hexes(
      meshing::Block{.cells = {20, 1, 2}, .lo = Vec3::Zero(), .hi = Vec3(span, 1e-3, thickness)});
  std::vector<Index> crown;  // nodes of its top

  Arch() {
    for (Index n = 0; n < mesh.node_count(); ++n) {
      const double s = mesh.nodes(0, n) / span;
      if (s == 1 && mesh.nodes(2, n) == thickness) crown.push_back(n);
      mesh.nodes(2, n) += rise * (1 - (1 - s) * (1 - s));
    }
  }
  [[nodiscard]] auto clamped() const {
    Statics<mesh::Hex8, Hyperelastic<NeoHooke, Quadratic>> wall{mesh, rubber};
    wall.fix(mesh.patch("x0"));
    wall.fix(mesh.patch("x1"), Axis::x);
    wall.fix(mesh.patch("y0"), Axis::y);
    wall.fix(mesh.patch("y1"), Axis::y);
    return wall;
  }
};

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("solid: an arch snaps through along its arc and each point of it is an equilibrium") {
    const Arch arch;
    auto pushed = arch.clamped(), moved = arch.clamped();
    const double unit = 0.01;  // [N], at load factor 1
    for (const Index n : arch.crown) pushed.force(n, Vec3(0, 0, -unit / 2));
    ArcLength path{pushed, {.first_step = 2e-4, .largest_step = 1e-3, .smallest_step = 1e-7}};
    std::vector<double> load{0}, sunk{0};
    int iterations = 0, cuts = 0;
    while (sunk.back() < 3 * rise && load.size() < 100) {
      const auto at = path.step();
      REQUIRE(at);
      iterations += at.solve.iterations, cuts += at.cuts;
      load.push_back(at.load);
      sunk.push_back(-pushed.displacement()(2, arch.crown[0]));
      // The load that holds the crown there, found without any continuation.
      if (load.size() % 4 == 0) {
        for (const Index n : arch.crown) moved.prescribe(n, Axis::z, pushed.displacement()(2, n));
        REQUIRE(moved.solve());
        auto body = moved.body();
        Eigen::VectorXd f, predicted;
        REQUIRE(body.internal_forces(moved.unknowns(), la::no_step, f, predicted));
        double held = 0;
        for (const Index n : arch.crown) held -= f[3 * n + 2] / unit;
        CHECK(held == doctest::Approx(at.load).epsilon(1e-6).scale(0));
      }
    }
    const auto high = std::max_element(load.begin(), load.end() - 1);
    std::size_t top = 1;  // the first limit point, then the lowest load after it
    while (top + 1 < load.size() && load[top + 1] > load[top]) ++top;
    const auto low = std::min_element(load.begin() + static_cast<std::ptrdiff_t>(top), load.end());
    MESSAGE("limit load " << load[top] * unit << " N with the crown " << sunk[top] / rise
                          << " of the rise down, then " << *low * unit << " N at "
                          << sunk[static_cast<std::size_t>(low - load.begin())] / rise << ", at the end "
                          << load.back() * unit << " N; " << load.size() - 1 << " steps, " << iterations
                          << " iterations, " << cuts << " cuts");
    CHECK(high != load.begin());
    CHECK(*low < 0.8 * load[top]);
    CHECK(load.back() > load[top]);  // it hangs and is stiff again
    // Under the load alone the wall leaps from the limit to the far branch.
    auto leaping = arch.clamped();
    for (const Index n : arch.crown) leaping.force(n, Vec3(0, 0, -1.02 * load[top] * unit / 2));
    const auto report = leaping.solve();
    MESSAGE("load alone, 2 % above the limit: " << name(report.solve.status) << " with "
                                                << -leaping.displacement()(2, arch.crown[0]) / rise);
    if (report) CHECK(-leaping.displacement()(2, arch.crown[0]) > sunk[top] * 1.5);
  }

  TEST_CASE("solid: volume control closes its volume and gives the derivative of it") {
    const auto mesh = meshing::box_hexes(meshing::Block{.cells = {2, 2, 2}});
    Body body(mesh, rubber, 1.0, Mass::lumped);
    for (const char* side : {"x0", "x1", "y0", "y1", "z0", "z1"}) body.add_pressure(mesh.patch(side));
    Eigen::VectorXd u(body.unknowns()), du(body.unknowns());
    for (Eigen::Index k = 0; k < u.size(); ++k) {
      u[k] = 0.1 * std::sin(0.7 * static_cast<double>(k));
      du[k] = std::cos(1.3 * static_cast<double>(k));
    }
    // All six sides close the block itself: its volume from outside, whatever the apex, and its derivative,
    // which is then the forces of a pressure.
    double volume = 0;
    Eigen::VectorXd slope = Eigen::VectorXd::Zero(u.size()), force = slope, pressures(6);
    const Vec3 apex(0.3, -2, 5);
    for (std::size_t side = 0; side < 6; ++side) {
      const auto cavity = body.cavity(side, u, apex);
      volume -= cavity.volume;
      slope -= cavity.slope;
      const auto ahead = body.cavity(side, u + 1e-4 * du, apex),
                 behind = body.cavity(side, u - 1e-4 * du, apex);
      CHECK(cavity.slope.dot(du) == doctest::Approx((ahead.volume - behind.volume) / 2e-4).epsilon(1e-6));
    }
    double meshed = 0;  // the exact volume of the trilinear cells
    using Tables = fem::Tables<fem::Lagrange<mesh::Hex8>, fem::Gauss<mesh::Hex8, 3>>;
    for (Index e = 0; e < mesh.cell_count(); ++e)
      for (const auto& gradients : Tables::gradients)
        meshed += fem::map_point<double, 3>((body.reference(e) + body.gather(e, u)).eval(), gradients).det;
    CHECK(volume == doctest::Approx(meshed).epsilon(1e-12));
    pressures.setConstant(-1);
    body.add_pressure_forces(u, pressures, force);
    CHECK((force - slope).norm() < 1e-12 * slope.norm());
  }
}
