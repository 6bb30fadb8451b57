// SPDX-License-Identifier: MIT
// Sheets of quadrilaterals that are made finer, settled and grown: closed up to their rims, near the surface.
#include "support/contours.hpp"
#include "support/stubs.hpp"
#include "support/vessels.hpp"
#include "tunica/mesh/adjacency.hpp"
#include "tunica/meshing/dual_contouring.hpp"
#include "tunica/meshing/hermite_field.hpp"
#include "tunica/meshing/hermite_surface.hpp"
#include "tunica/meshing/interface_distance.hpp"
#include "tunica/meshing/quad_columns.hpp"
#include "tunica/meshing/quad_contour.hpp"
#include "tunica/meshing/quad_face.hpp"
#include "tunica/meshing/quad_grow.hpp"
#include "tunica/meshing/quad_inset.hpp"
#include "tunica/meshing/quad_misfit.hpp"
#include "tunica/meshing/quad_settle.hpp"
#include "tunica/meshing/quad_smooth.hpp"
#include "tunica/meshing/wall_quads.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

using namespace tunica;

namespace {

mesh::QuadSurface surface_of(const meshing::WallQuads& wall) {
  mesh::QuadSurface s;
  s.nodes = wall.nodes;
  s.cells = wall.cells;
  return s;
}

/// Open along the rims and nowhere else, manifold, oriented.
void check_sheet(const meshing::WallQuads& wall, long euler) {
  const auto topology = test::contours::topology(surface_of(wall));
  int rim = 0;
  for (const auto& loop : wall.loops) rim += static_cast<int>(loop.size());
  CHECK(topology.open_edges == rim);
  CHECK(topology.wrong_edges == 0);
  CHECK(topology.wrong_vertices == 0);
  CHECK(topology.loose_vertices == 0);
  CHECK(topology.euler == euler);
}

/// The smoothed sheet of a tube of radius 4 and length 12.
struct Tube {
  mesh::Surface lumen = test::vessels::cylinder(4, 12, 48);
  meshing::Rims rims = meshing::rims_of(lumen);
  meshing::FootFinder finder{lumen};
  std::vector<Vec3> points = meshing::wall_points(lumen);
  meshing::WallQuads wall = meshing::wall_quads(
      meshing::dual_contour(meshing::hermite_of_surface(lumen, {.spacing = 2}), {.hold = -0.5}), rims);
  Tube() { (void)meshing::smooth_quads(wall, finder, rims, {}, points); }
};

/// A closed sheet of the noise in a cube.
meshing::WallQuads noise(std::uint64_t seed) {
  const auto image = test::contours::noise(12, false, seed);
  const auto quads =
      meshing::dual_contour(meshing::hermite_of_image(image, test::contours::at_least(image, 0), 0));
  return {quads.nodes, quads.cells, {}, {}, 0};
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("meshing: the distance from a bilinear face is that of its nearest point") {
    std::mt19937 engine(5);
    const auto random = [&] { return double(engine()) / 2147483648.0 - 1; };
    for (int trial = 0; trial < 50; ++trial) {
      meshing::QuadFace face{{Vec3(-1, -1, 0), Vec3(1, -1, 0), Vec3(1, 1, 0), Vec3(-1, 1, 0)}};
      for (Vec3& x : face.x) x += 0.3 * Vec3(random(), random(), random());
      const Vec3 p(1.5 * random(), 1.5 * random(), random());
      double least = std::numeric_limits<double>::infinity();
      constexpr int parts = 400;
      for (int j = 0; j <= parts; ++j)
        for (int i = 0; i <= parts; ++i)
          least = std::min(least, (face.at(double(i) / parts, double(j) / parts) - p).norm());
      CHECK(std::sqrt(face.squared_distance(p)) == doctest::Approx(least).epsilon(0.01));
      CHECK(face.squared_distance_of_box(p) <= face.squared_distance(p));
    }
  }

  TEST_CASE("meshing: an inset keeps a sheet closed up to its rims") {
    const Tube tube;
    check_sheet(tube.wall, 0);
    const auto around = mesh::cells_of_nodes(tube.wall.cells, static_cast<Index>(tube.wall.nodes.cols()));
    for (Index n = 0; n < around.size(); n += 7) {
      for (const bool whole : {false, true}) {  // one quadrilateral, or all around a node; some on a rim
        meshing::WallQuads wall = tube.wall;
        const std::vector<Index> block(around[n].begin(), whole ? around[n].end() : around[n].begin() + 1);
        const auto inset = meshing::inset_quads(wall, block);
        REQUIRE(inset.border.size() == inset.inner.size());
        CHECK(wall.cells.cols() == tube.wall.cells.cols() + static_cast<Eigen::Index>(inset.border.size()));
        CHECK(wall.loops == tube.wall.loops);
        check_sheet(wall, 0);
        for (std::size_t i = 0; i < inset.inner.size(); ++i)  // drawn in by half
          CHECK((wall.nodes.col(inset.inner[i]) - wall.nodes.col(inset.border[i])).norm() < 4);
        const auto again = meshing::inset_quads(wall, block);
        CHECK(again.border == inset.inner);
        check_sheet(wall, 0);
      }
    }
    meshing::WallQuads wall = tube.wall;
    const Index apart = around[0][0], other = around[around.size() / 2][0];
    CHECK_THROWS_AS((void)meshing::inset_quads(wall, {apart, other}), ContractError);
    CHECK_THROWS_AS((void)meshing::inset_quads(wall, {}), ContractError);
  }

  TEST_CASE("meshing: insets keep sheets of noise closed") {
    for (std::uint64_t seed = 0; seed < 3; ++seed) {
      meshing::WallQuads wall = noise(seed);
      const long euler = test::contours::topology(surface_of(wall)).euler;
      for (std::uint64_t i = 0; i < 60; ++i) {
        const auto q =
            test::contours::splitmix64(100 * seed + i) % static_cast<std::uint64_t>(wall.cells.cols());
        (void)meshing::inset_quads(wall, {static_cast<Index>(q)}, 0.3);
      }
      check_sheet(wall, euler);
    }
  }

  TEST_CASE("meshing: columns are as sound as the cells that can stand on them") {
    // The corner of a cube seen from outside: the diagonal makes an angle of acos(1/sqrt 3) with its faces.
    meshing::WallQuads wall;
    wall.nodes.resize(3, 7);
    wall.nodes.transpose() << 0, 0, 0, -1, 0, 0, 0, -1, 0, 0, 0, -1, -1, -1, 0, 0, -1, -1, -1, 0, -1;
    wall.cells.resize(4, 3);
    wall.cells.transpose() << 0, 1, 4, 2, 0, 2, 5, 3, 0, 3, 6, 1;
    const meshing::QuadColumns columns(wall, {});
    CHECK(columns.quality(0, 0.9) == doctest::Approx(1 / std::sqrt(3)));
    wall.nodes.col(0) = Vec3(-1, -1, 0);  // a face without area
    CHECK(columns.quality(0, 0.9) <= 0);
    meshing::WallQuads rhombus;
    rhombus.nodes.resize(3, 4);
    rhombus.nodes.transpose() << 0, 0, 0, 1, 0, 0, 1.5, std::sqrt(0.75), 0, 0.5, std::sqrt(0.75), 0;
    rhombus.cells.resize(4, 1);
    rhombus.cells << 0, 1, 2, 3;
    CHECK(meshing::QuadColumns(rhombus, {}).quality(0, 0.5) == doctest::Approx(std::sqrt(0.75)));
    const Tube tube;
    const meshing::QuadColumns round(tube.wall, tube.rims);
    for (Index n = 0; n < static_cast<Index>(tube.wall.nodes.cols()); ++n) CHECK(round.quality(n, 0.5) > 0.5);
  }

  TEST_CASE("meshing: the misfit of a sheet is kept up to date while nodes move") {
    Tube tube;
    const std::vector<char> all(static_cast<std::size_t>(tube.wall.nodes.cols()), 1);
    constexpr double tolerance = 0.1;
    meshing::QuadMisfit misfit(tube.wall, tube.finder, tube.points, tolerance, all);
    std::mt19937 engine(9);
    const auto random = [&] { return double(engine()) / 2147483648.0 - 1; };
    for (int move = 0; move < 60; ++move) {
      const auto n = static_cast<Index>(engine() % static_cast<unsigned>(tube.wall.nodes.cols()));
      const auto around = misfit.around(n);
      const double infinity = std::numeric_limits<double>::infinity(),
                   before = misfit.sum(around, 0, infinity), total = misfit.sum();
      const Vec3 step = 0.2 * Vec3(random(), random(), random());
      tube.wall.nodes.col(n) += step;
      const double after = misfit.sum(around, step.norm(), infinity);
      CHECK(misfit.sum(around, step.norm(), 0.5 * after) >= 0.5 * after);
      misfit.update(around);
      const meshing::QuadMisfit anew(tube.wall, tube.finder, tube.points, tolerance, all);
      // anew the face of a target is the nearest by its triangles, which may not be quite the nearest
      CHECK(misfit.sum() <= anew.sum() * (1 + 1e-9));
      CHECK(misfit.sum() >= anew.sum() * (1 - 1e-3));
      CHECK(std::abs(misfit.sum() - total - (after - before)) < 1e-3 * total + 1e-9);
    }
  }

  TEST_CASE("meshing: settling brings a sheet within the tolerance and leaves alone what is within") {
    Tube tube;
    constexpr double tolerance = 0.2;
    const auto distance = [&] {
      const auto d = meshing::interface_distance(surface_of(tube.wall), tube.points, tube.finder, tolerance);
      return std::max(d.quads_max, d.wall_max);
    };
    std::mt19937 engine(2);
    std::vector<char> rim(static_cast<std::size_t>(tube.wall.nodes.cols()), 0);
    for (const auto& loop : tube.wall.loops)
      for (const Index n : loop) rim[static_cast<std::size_t>(n)] = 1;
    for (Index n = 0; n < static_cast<Index>(tube.wall.nodes.cols()); ++n)
      if (rim[static_cast<std::size_t>(n)] == 0)
        for (int a = 0; a < 3; ++a) tube.wall.nodes(a, n) += 0.4 * (double(engine()) / 2147483648.0 - 1);
    const double before = distance();
    (void)meshing::settle_quads(tube.wall, tube.finder, tube.rims, tube.points,
                                {.tolerance = 0.9 * tolerance});
    MESSAGE("noise of 0.4 on the nodes: sheet and surface " << before << " apart, settled " << distance()
                                                            << " with a tolerance of " << tolerance);
    CHECK(before > 2 * tolerance);
    CHECK(distance() <= tolerance);
    for (std::size_t r = 0; r < tube.rims.curves.size(); ++r)
      for (std::size_t i = 0; i < tube.wall.loops[r].size(); ++i)
        CHECK((tube.rims.curves[r].at(tube.wall.along[r][i]) - tube.wall.nodes.col(tube.wall.loops[r][i]))
                  .norm() < 1e-12);
    const Points<3> settled = tube.wall.nodes;
    (void)meshing::settle_quads(tube.wall, tube.finder, tube.rims, tube.points, {.tolerance = tolerance});
    CHECK(tube.wall.nodes == settled);
  }

  TEST_CASE("meshing: a sheet grows into a blind branch that it misses") {
    const auto lumen = test::stubs::tube({.radius = 0.7, .length = 3}, 0.6);
    const auto rims = meshing::rims_of(lumen);
    const meshing::FootFinder finder(lumen);
    const auto points = meshing::wall_points(lumen);
    constexpr double edge = 2, tolerance = 0.2;
    auto wall = meshing::detail::quads_through({}, lumen, edge * std::sqrt(1.5), rims);
    (void)meshing::smooth_quads(wall, finder, rims, {}, points);
    check_sheet(wall, 0);
    const auto judge = [&](const meshing::WallQuads& sheet) {
      std::vector<meshing::FarPlace> far;
      (void)meshing::interface_distance(surface_of(sheet), points, finder, tolerance, &far);
      double sum = 0;
      for (const auto& place : far) sum += place.distance / tolerance - 1;
      return sum;
    };
    const double before = judge(wall);
    const auto quads = wall.cells.cols();
    const int rings =
        meshing::grow_quads(wall, finder, rims, points, {.edge = edge, .tolerance = tolerance}, judge);
    MESSAGE("a branch of 0.7 by 3 with edges of 2: " << rings << " rings; beyond the tolerance in all "
                                                     << before << " times, grown " << judge(wall));
    CHECK(rings > 0);
    CHECK(wall.cells.cols() == quads + 4 * rings);
    CHECK(judge(wall) < 0.1 * before);
    check_sheet(wall, 0);
  }
}
