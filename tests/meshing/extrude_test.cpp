// SPDX-License-Identifier: MIT
// Extruded walls: uniform thickness, flat ends, positive cells, patches that close the boundary.
#include "tunica/meshing/extrude.hpp"

#include "support/contours.hpp"
#include "support/vessels.hpp"
#include "tunica/mesh/patch_nodes.hpp"
#include "tunica/mesh/quality.hpp"
#include "tunica/meshing/most_normal.hpp"
#include "tunica/meshing/quad_diagonals.hpp"
#include "tunica/meshing/surface_foot.hpp"
#include "tunica/meshing/vessel_wall.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <string>
#include <vector>

using namespace tunica;

namespace {

// The patches but "ends" (a union) as one closed surface.
mesh::QuadSurface boundary(const mesh::HexMesh& m) {
  mesh::QuadSurface s;
  s.nodes = m.nodes;
  for (const auto& p : m.patches) {
    if (p.name == "ends") continue;
    const Eigen::Index before = s.cells.cols();
    s.cells.conservativeResize(4, before + p.faces.cols());
    s.cells.rightCols(p.faces.cols()) = p.faces;
  }
  return s;
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("meshing: the most normal direction is the axis of the narrowest cone") {
    std::mt19937 engine(3);
    const auto random = [&] { return double(engine()) / 2147483648.0 - 1; };
    for (int trial = 0; trial < 200; ++trial) {
      std::vector<Vec3> normals;
      const auto count = 1 + trial % 7;
      for (int i = 0; i < count; ++i)
        normals.push_back((Vec3(random(), random(), random()) + Vec3(0, 0, 1.2)).normalized());
      const auto best = meshing::most_normal(normals);
      const auto cosine = [&](const Vec3& d) {
        double least = 1;
        for (const Vec3& n : normals) least = std::min(least, n.dot(d));
        return least;
      };
      CHECK(cosine(best.direction) == doctest::Approx(best.cosine).epsilon(1e-12));
      for (int k = 0; k < 100; ++k)  // no direction near it is better
        CHECK(cosine((best.direction + 0.05 * Vec3(random(), random(), random())).normalized()) <=
              best.cosine + 1e-12);
    }
  }

  TEST_CASE("meshing: wall of a straight tube is uniform with flat ends") {
    const double radius = 4, thickness = 1, length = 20;
    const auto lumen = test::vessels::cylinder(radius, length, 96);
    const Vec3 axis = test::vessels::tilt().col(2);
    for (const int layers : {1, 2}) {
      const auto result =
          meshing::vessel_wall(lumen, {.thickness = thickness, .edge = 0.5, .layers = layers});
      const auto& wall = result.wall;
      CHECK(wall.cell_count() == layers * result.inner.cell_count());
      const auto& report = result.report.extrusion;
      CHECK(report.quality.inverted == 0);
      CHECK(report.quality.scaled_jacobian.least >= 0.2);
      CHECK(report.thinned == 0);
      MESSAGE("tube, " << layers << " layers: " << wall.cell_count()
                       << " hexahedra, thickness of faces off by rms " << report.deviation_rms << " max "
                       << report.deviation_max << " of it, scaled Jacobian least "
                       << report.quality.scaled_jacobian.least << " mean "
                       << report.quality.scaled_jacobian.mean);
      CHECK(report.deviation_max < 1e-3);
      for (const auto& [name, z] : {std::pair<std::string, double>{"inlet", 0}, {"outlet", length}})
        for (const Index n : mesh::patch_nodes(wall.patch(name)))
          CHECK(std::abs(axis.dot(wall.nodes.col(n)) - z) < 1e-12);
      for (Index n = 0; n < result.inner.node_count(); ++n)
        CHECK(Vec3(wall.nodes.col(n)) == Vec3(result.inner.nodes.col(n)));
      const auto closed = boundary(wall);
      const auto t = test::contours::topology(closed);
      CHECK(t.open_edges + t.wrong_edges + t.wrong_vertices == 0);
      CHECK(t.euler == 0);  // a torus
      CHECK(test::contours::enclosed_volume(closed) > 0);
      CHECK(wall.patch("ends").faces.cols() ==
            wall.patch("inlet").faces.cols() + wall.patch("outlet").faces.cols());
      // inner faces look towards the axis, outer ones away from it
      for (const auto& [name, sign] : {std::pair<std::string, double>{"inner", -1}, {"outer", 1}}) {
        const auto& faces = wall.patch(name).faces;
        for (Eigen::Index f = 0; f < faces.cols(); ++f) {
          const auto x = [&](int k) { return Vec3(wall.nodes.col(faces(k, f))); };
          const Vec3 out = x(0) - axis * axis.dot(x(0));
          CHECK(sign * (x(2) - x(0)).cross(x(3) - x(1)).dot(out) > 0);
        }
      }
      const auto& d = result.report.distance;
      MESSAGE("interfaces apart by at most " << d.quads_max / 0.5 << " and " << d.wall_max / 0.5 << " edges");
      CHECK(std::max(d.quads_max, d.wall_max) < 0.1 * 0.5);
    }
  }

  TEST_CASE("meshing: a wall may vary in thickness from place to place") {
    const auto lumen = test::vessels::cylinder(4, 20, 96);
    const Vec3 axis = test::vessels::tilt().col(2);
    const auto thinning = [&](const Vec3& x) { return 1.2 - 0.02 * axis.dot(x); };
    const auto result = meshing::vessel_wall(
        lumen, meshing::WallOptions<decltype(thinning)>{.thickness = thinning, .edge = 0.5});
    CHECK(result.report.extrusion.quality.inverted == 0);
    CHECK(result.report.extrusion.thinned == 0);
    MESSAGE("varying thickness: faces off by at most " << result.report.extrusion.deviation_max << " of it");
    CHECK(result.report.extrusion.deviation_max < 2e-3);
    for (Index n = 0; n < result.inner.node_count(); ++n) {
      const Vec3 x = result.inner.nodes.col(n), out = result.wall.nodes.col(n + result.inner.node_count());
      CHECK((out - x).norm() == doctest::Approx(thinning(x)).epsilon(0.02));
    }
  }

  TEST_CASE("meshing: extrusion in a sharp groove keeps its thickness and stays positive") {
    // A V of two planes, 40 degrees between them, folded along a line and extruded into the groove.
    const int n = 12;
    mesh::QuadSurface sheet;
    sheet.nodes.resize(3, (2 * n + 1) * (n + 1));
    for (int j = 0; j <= n; ++j)
      for (int i = -n; i <= n; ++i)
        sheet.nodes.col((i + n) + (2 * n + 1) * j) << i * std::sin(0.35), j, std::abs(i) * std::cos(0.35);
    sheet.cells.resize(4, 2 * n * n);
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < 2 * n; ++i) {
        const Index a = i + (2 * n + 1) * j;
        sheet.cells.col(i + 2 * n * j) << a, a + 1, a + 2 * n + 2, a + 2 * n + 1;
      }
    const auto result = meshing::extrude(sheet, {}, {.thickness = 1.5, .layers = 2});
    CHECK(result.report.quality.inverted == 0);
    CHECK(result.report.quality.scaled_jacobian.least >= 0.2);
    CHECK(result.report.least_share >= 0.75);
    CHECK(result.report.mean_share >= 0.99);
    if (result.report.thinned > 0) CHECK(std::abs(result.report.thinnest[0]) < 3);  // in the groove
    const auto flanks = meshing::triangles_of(sheet);
    const meshing::FootFinder finder(flanks);
    const auto top = [&](Index k) { return Vec3(result.mesh.nodes.col(k + 2 * sheet.node_count())); };
    for (Index k = 0; k < sheet.node_count(); ++k) {
      if (k % (2 * n + 1) < 2 * n) CHECK(top(k)[0] < top(k + 1)[0]);  // no two columns cross
      const double share = finder.distance(top(k)) / 1.5;             // measured anew, from both flanks
      CHECK(share >= 0.75);
      if (std::abs(sheet.nodes(0, k)) > 3) CHECK(result.share[static_cast<std::size_t>(k)] == 1);
      CHECK(std::min(share, 1.0) == doctest::Approx(result.share[static_cast<std::size_t>(k)]).epsilon(0.01));
    }
    MESSAGE("groove of 40 degrees: mean share " << result.report.mean_share << ", " << result.report.thinned
                                                << " nodes thinned, least share " << result.report.least_share
                                                << ", scaled Jacobian "
                                                << result.report.quality.scaled_jacobian.least);
  }

  TEST_CASE("meshing: a folded sheet is refused by its place") {
    mesh::QuadSurface sheet;  // two faces back to back along one edge
    sheet.nodes.resize(3, 6);
    sheet.nodes << 0, 1, 1, 0, 1, 0, 0, 0, 1, 1, 1e-9, 1e-9, 0, 0, 0, 0, 1e-9, 1e-9;
    sheet.cells.resize(4, 2);
    sheet.cells << 0, 3, 1, 2, 2, 4, 3, 5;
    CHECK_THROWS_AS((void)meshing::extrude(sheet, {}, {.thickness = 1}), MeshError);
  }
}
