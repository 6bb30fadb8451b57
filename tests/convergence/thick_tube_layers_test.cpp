// SPDX-License-Identifier: MIT
#include "support/layered_tube.hpp"
#include "tunica/meshing/tube.hpp"
#include "tunica/solid/fibre_laws.hpp"
#include "tunica/solid/statics.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <vector>

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

/// Two meshes whose cells are 3:2, and the limit of their radii, of second order.
void holds(const test::LayeredTube& tube, const mesh::HexMesh& coarse, const mesh::HexMesh& fine, double z,
           double r) {
  const double p = tube.pressure(r, z);
  const Reached a = inflate(tube, coarse, z, p), b = inflate(tube, fine, z, p);
  REQUIRE(a.report);
  REQUIRE(b.report);
  const double limit = b.radius + (b.radius - a.radius) / (1.5 * 1.5 - 1);
  const auto error = [&](double radius) { return 100 * (tube.pressure(radius, z) / p - 1); };
  MESSAGE("axial stretch " << z << ", " << p << " Pa: inner radius " << a.radius * 1e3 << ", "
                           << b.radius * 1e3 << ", extrapolated " << limit * 1e3 << " of " << r * 1e3
                           << " mm; pressure off by " << error(a.radius) << ", " << error(b.radius) << ", "
                           << error(limit) << " %; " << b.report.steps << " steps, " << b.report.cuts
                           << " cuts, " << b.report.solve.iterations << " iterations");
  CHECK(std::abs(b.radius - r) < 5e-3 * r);
  CHECK(std::abs(limit - r) < 5e-4 * r);
  CHECK(std::abs(error(limit)) < 0.5);
}

}  // namespace

TEST_SUITE("convergence") {
  TEST_CASE("solid: two fibrous layers of a tube bear the pressures of the closed form") {
    const test::LayeredTube tube;
    // The quadrature against the table of radii that two other quadratures agree on.
    CHECK(tube.pressure(0.7e-3, 1.5) == doctest::Approx(687.842).epsilon(1e-6));
    CHECK(tube.pressure(1.0e-3, 1.7) == doctest::Approx(3498.447).epsilon(1e-6));
    CHECK(tube.pressure(1.3e-3, 1.9) == doctest::Approx(78984.322).epsilon(1e-6));
    CHECK(tube.pressure(1.22389029e-3, 1.5) == doctest::Approx(13330).epsilon(1e-4));
    const auto coarse = layered_ring(tube, 4, 2, 16), fine = layered_ring(tube, 6, 3, 24);
    for (const double z : {1.5, 1.7, 1.9})
      for (const double r : {0.7e-3, 0.9e-3, 1.0e-3, 1.1e-3, 1.2e-3}) holds(tube, coarse, fine, z, r);
  }
}

TEST_SUITE("slow") {
  TEST_CASE("solid: two layers of taut fibres bear the pressures of the closed form") {
    // Where a tenth of a percent of the radius is two of the pressure.
    const test::LayeredTube tube;
    const auto coarse = layered_ring(tube, 8, 4, 32), fine = layered_ring(tube, 12, 6, 48);
    for (const double z : {1.5, 1.7, 1.9}) holds(tube, coarse, fine, z, 1.3e-3);
  }
}
