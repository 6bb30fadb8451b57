// SPDX-License-Identifier: MIT
#include "support/layered_tube.hpp"
#include "tunica/meshing/tube.hpp"
#include "tunica/solid/fibre_laws.hpp"
#include "tunica/solid/statics.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

using namespace tunica;
using namespace tunica::solid;

namespace {

/// A quarter of a slice, its cells fitted to the two layers: region 0 is the inner one.
mesh::HexMesh layered_ring(const test::LayeredTube& tube, int media, int adventitia, int around) {
  const int radial = media + adventitia;
  const auto& [in, out] = tube.layers;
  auto mesh = meshing::quarter_tube({.inner_radius = in.inner,
                                     .thickness = out.outer - in.inner,
                                     .length = 0.1e-3,
                                     .cells = {radial, around, 1}});
  for (Index n = 0; n < mesh.node_count(); ++n) {
    const int i = n % (radial + 1);  // nodes run through the wall first
    const double r = i <= media ? in.inner + (in.outer - in.inner) * i / media
                                : out.inner + (out.outer - out.inner) * (i - media) / adventitia;
    mesh.nodes.col(n).head<2>() *= r / mesh.nodes.col(n).head<2>().norm();
  }
  mesh.region_names = {"media", "adventitia"};
  for (Index e = 0; e < mesh.cell_count(); ++e) mesh.region.push_back(e % radial < media ? 0 : 1);
  return mesh;
}

struct Reached {
  double radius;
  StaticsReport report;
};

Reached inflate(const test::LayeredTube& tube, const mesh::HexMesh& mesh, double z, double p) {
  const auto law = [](const test::FibreLayer& layer) {
    return Hyperelastic{HolzapfelGasserOgden{.c = layer.c, .k1 = layer.k1, .k2 = layer.k2},
                        Quadratic{.kappa = 1e10}};
  };
  Statics wall{mesh, law(tube.layers[0]), {.first_step = 0.1}};
  wall.laws().material(1, law(tube.layers[1]));
  wall.point_field([&](Index cell, const Vec3& x) {
    const Vec3 hoop = Vec3(-x[1], x[0], 0).normalized();
    const double angle =
        tube.layers[static_cast<std::size_t>(mesh.region_of(cell))].degrees * std::numbers::pi / 180;
    const double c = std::cos(angle), s = std::sin(angle);
    Fibres<double, 2> fibres;
    fibres.set(0, {c * hoop[0], c * hoop[1], s});
    fibres.set(1, {c * hoop[0], c * hoop[1], -s});
    return fibres;
  });
  wall.fix(mesh.patch("end0"), Axis::z);
  wall.fix(mesh.patch("sym_x"), Axis::x);
  wall.fix(mesh.patch("sym_y"), Axis::y);
  for (const Index n : mesh::patch_nodes(mesh.patch("end1"))) wall.prescribe(n, Axis::z, (z - 1) * 0.1e-3);
  Reached reached{.radius = 0, .report = wall.solve()};
  if (!reached.report) return reached;
  wall.pressure(mesh.patch("inner"), p);
  reached.report = wall.solve();
  const auto nodes = mesh::patch_nodes(mesh.patch("inner"));
  const Points<3> x = mesh.nodes + wall.displacement();
  for (const Index n : nodes) reached.radius += x.col(n).head<2>().norm() / static_cast<double>(nodes.size());
  return reached;
}

/// The pressure of the closed form at an inner radius r [m], put on the mesh, leads to a radius of nearly
/// that pressure.
void holds(const test::LayeredTube& tube, const mesh::HexMesh& mesh, double z, double r) {
  const double p = tube.pressure(r, z);
  const Reached at = inflate(tube, mesh, z, p);
  REQUIRE(at.report);
  const double error = tube.pressure(at.radius, z) / p - 1;
  MESSAGE("axial stretch " << z << ", " << p << " Pa: inner radius " << at.radius * 1e3 << " of " << r * 1e3
                           << " mm, off by " << 100 * (at.radius / r - 1) << " %, its pressure by "
                           << 100 * error << " %; " << at.report.steps << " steps, " << at.report.cuts
                           << " cuts, " << at.report.solve.iterations << " iterations");
  CHECK(std::abs(at.radius / r - 1) < 5e-4);
  CHECK(std::abs(error) < 5e-3);
}

constexpr std::array axial{1.5, 1.7, 1.9};

}  // namespace

TEST_SUITE("convergence") {
  TEST_CASE("solid: the quadrature of two fibrous layers has the tabled pressures") {
    // Of two other quadratures; radii in mm, pressures in kPa at each of the axial stretches.
    constexpr struct {
      double radius;
      std::array<double, 3> pressure;
    } table[] = {{0.7, {0.687842, 1.040573, 2.105628}},    {0.9, {1.742537, 2.208631, 3.750682}},
                 {1.0, {2.757800, 3.498447, 5.708129}},    {1.1, {4.919317, 6.433431, 10.328069}},
                 {1.2, {10.671239, 14.757691, 24.120446}}, {1.3, {30.414137, 45.497713, 78.984322}}};
    const test::LayeredTube tube;
    for (const auto& row : table)
      for (std::size_t k = 0; k < 3; ++k)
        CHECK(std::abs(1e-3 * tube.pressure(1e-3 * row.radius, axial[k]) - row.pressure[k]) < 1e-6);
    constexpr std::array radii{1.22389029, 1.18928845, 1.13396476};  // where 13.33 kPa lead to
    for (std::size_t k = 0; k < 3; ++k)
      CHECK(std::abs(tube.pressure(1e-3 * radii[k], axial[k]) / 13.33e3 - 1) < 3e-4);
  }

  TEST_CASE("solid: two fibrous layers of a tube bear the pressures of the closed form within 0.5 percent") {
    const test::LayeredTube tube;
    const auto mesh = layered_ring(tube, 12, 6, 24);
    for (const double z : axial)
      for (const double r : {0.7e-3, 0.9e-3, 1.0e-3, 1.1e-3, 1.2e-3}) holds(tube, mesh, z, r);
  }
}

TEST_SUITE("slow") {
  TEST_CASE("solid: two layers of taut fibres bear the pressures of the closed form within 0.5 percent") {
    // Where a tenth of a percent of the radius is two of the pressure.
    const test::LayeredTube tube;
    const auto mesh = layered_ring(tube, 18, 9, 48);
    for (const double z : axial) holds(tube, mesh, z, 1.3e-3);
  }
}
