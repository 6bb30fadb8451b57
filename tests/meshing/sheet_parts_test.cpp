// SPDX-License-Identifier: MIT
// The parts of contours and of walls, each by what is known of it in closed form.
#include "support/contours.hpp"
#include "support/surfaces.hpp"
#include "support/vessels.hpp"
#include "tunica/mesh/measures.hpp"
#include "tunica/meshing/cut_numbers.hpp"
#include "tunica/meshing/extrude_ends.hpp"
#include "tunica/meshing/extrude_field.hpp"
#include "tunica/meshing/extrude_options.hpp"
#include "tunica/meshing/faces_on.hpp"
#include "tunica/meshing/hermite.hpp"
#include "tunica/meshing/marching_caps.hpp"
#include "tunica/meshing/quad_adjacency.hpp"
#include "tunica/meshing/quad_fans.hpp"
#include "tunica/meshing/quad_fit.hpp"
#include "tunica/meshing/quad_pin.hpp"
#include "tunica/meshing/quad_smoother.hpp"
#include "tunica/meshing/rim_curve.hpp"
#include "tunica/meshing/sign_bits.hpp"
#include "tunica/meshing/thickness.hpp"
#include "tunica/meshing/vertex_normals.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

using namespace tunica;
using namespace tunica::meshing;

namespace {

/// n x m squares of side 1 in the plane z = 0, normals along z; node i + (n + 1) j at (i, j).
WallQuads squares(Index n, Index m) {
  WallQuads wall;
  wall.nodes.resize(3, (n + 1) * (m + 1));
  wall.cells.resize(4, n * m);
  for (Index j = 0; j <= m; ++j)
    for (Index i = 0; i <= n; ++i) wall.nodes.col(i + (n + 1) * j) << i, j, 0;
  for (Index j = 0; j < m; ++j)
    for (Index i = 0; i < n; ++i) {
      const Index a = i + (n + 1) * j;
      wall.cells.col(i + n * j) << a, a + 1, a + n + 2, a + n + 1;
    }
  return wall;
}

/// The plane z = 0, known in closed form.
struct Ground {
  [[nodiscard]] Foot nearest(const Vec3& x) const { return {{x[0], x[1], 0}, {0, 0, 1}, std::abs(x[2])}; }
  [[nodiscard]] Foot nearest_facing(const Vec3& x, const Vec3&) const { return nearest(x); }
  [[nodiscard]] double distance(const Vec3& x) const { return std::abs(x[2]); }
};

/// A sheet folded along x = 0 so that its halves rise by that slope to either side.
mesh::QuadSurface roof(Index n, double slope) {
  WallQuads flat = squares(2 * n, n);
  for (Index k = 0; k < flat.nodes.cols(); ++k) {
    flat.nodes(0, k) -= n;
    flat.nodes(2, k) = slope * std::abs(flat.nodes(0, k));
  }
  mesh::QuadSurface sheet;
  sheet.nodes = flat.nodes;
  sheet.cells = flat.cells;
  return sheet;
}

Vec3 normal_of_face(const mesh::HexMesh& mesh, const Connectivity<4>& faces, Eigen::Index f) {
  const auto x = [&](int k) { return Vec3(mesh.nodes.col(faces(k, f))); };
  return 0.5 * (x(2) - x(0)).cross(x(3) - x(1));
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("meshing: half-edges of quadrilaterals know their twins and nodes their neighbours") {
    const WallQuads wall = squares(3, 2);
    const auto twin = quad_twins(wall.cells, 12);
    int open = 0;
    for (std::size_t h = 0; h < twin.size(); ++h) {
      if (twin[h] < 0) {
        ++open;
        continue;
      }
      CHECK(twin[static_cast<std::size_t>(twin[h])] == static_cast<Index>(h));
      const auto mine = static_cast<Index>(h);
      const auto end = [&](Index half, Index k) { return wall.cells((half + k) % 4, half / 4); };
      CHECK(end(mine, 0) == end(twin[h], 1));
      CHECK(end(mine, 1) == end(twin[h], 0));
    }
    CHECK(open == 10);  // the border of 3 x 2 squares
    const auto around = quad_neighbours(wall.cells, 12);
    std::array<int, 5> of_degree{};
    for (Index n = 0; n < 12; ++n) {
      ++of_degree[around[n].size()];
      for (const Index m : around[n])
        CHECK((wall.nodes.col(m) - wall.nodes.col(n)).norm() == 1);  // an edge, not a diagonal
    }
    CHECK(of_degree == std::array<int, 5>{0, 0, 4, 6, 2});
  }

  TEST_CASE("meshing: fans of quadrilaterals have their area and give back every point by its weights") {
    WallQuads wall = squares(3, 2);
    const auto fans = fans_of_quads(wall.nodes, wall.cells);
    CHECK(fans.cell_count() == 4 * 6);
    CHECK(mesh::area(fans) == doctest::Approx(6).epsilon(1e-14));
    const FootFinder sheet(fans);
    std::mt19937 random(2);
    std::uniform_real_distribution<double> uniform(0, 1);
    for (int i = 0; i < 50; ++i) {
      const Vec3 x(3 * uniform(random), 2 * uniform(random), uniform(random) - 0.5);
      const QuadFoot foot = quad_foot(sheet, x);
      CHECK((foot.point - Vec3(x[0], x[1], 0)).norm() < 1e-14);
      Vec3 sum = Vec3::Zero();
      double weights = 0;
      for (int k = 0; k < 4; ++k) {
        const double w = foot.weights[static_cast<std::size_t>(k)];
        CHECK(w >= 0);
        weights += w;
        sum += w * wall.nodes.col(wall.cells(k, foot.quad));
      }
      CHECK(weights == doctest::Approx(1).epsilon(1e-14));
      CHECK((sum - foot.point).norm() < 1e-14);
    }
  }

  TEST_CASE("meshing: nodes are pinned to the tips that a sheet misses and to nothing else") {
    const WallQuads wall = squares(4, 4);
    std::vector<char> held(25, 0);
    const std::vector<Vec3> targets{{1.2, 1.1, 0.5}, {1.3, 1.2, 0.4}, {3.2, 3.1, 0.3}, {2, 2, 0.1}};
    const auto pins = quad_pins(wall, held, targets, 0.2, 1);
    REQUIRE(pins.size() == 2);  // the second lies beside the first, the last is near enough
    CHECK(pins[0].node == 1 + 5 * 1);
    CHECK(pins[0].place == targets[0]);
    CHECK(pins[1].node == 3 + 5 * 3);
    held[1 + 5 * 1] = 1;
    const auto others = quad_pins(wall, held, targets, 0.2, 1);
    REQUIRE(others.size() == 2);
    CHECK(others[0].node == 2 + 5 * 1);  // the next in weight: x is nearer to the other side than y
    std::fill(held.begin(), held.end(), char{1});
    CHECK(quad_pins(wall, held, targets, 0.2, 1).empty());
  }

  TEST_CASE("meshing: a sheet is levelled with a plane and its rims stay") {
    constexpr double tolerance = 0.05;
    WallQuads wall = squares(8, 8);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> uniform(-0.3, 0.3);
    for (Index n = 0; n < 81; ++n) wall.nodes(2, n) = 0.2 + uniform(random);
    wall.loops.push_back({0, 1, 2, 3, 4, 5, 6, 7, 8});  // one side stands for a rim
    for (Index n = 0; n < 9; ++n) wall.nodes(2, n) = 0;
    const Points<3> before = wall.nodes;
    fit_quads(wall, Ground{}, {}, {.tolerance = tolerance, .rounds = 6});
    CHECK(wall.nodes.leftCols(9) == before.leftCols(9));
    CHECK(before.row(2).cwiseAbs().maxCoeff() > 0.4);
    CHECK(wall.nodes.row(2).cwiseAbs().maxCoeff() < tolerance);
    // a point of the surface that the sheet misses draws it up, to within the tolerance
    wall = squares(8, 8);
    const std::vector<Vec3> targets{{4.3, 4.2, 0.2}};
    fit_quads(wall, Ground{}, targets, {.tolerance = 0.12, .rounds = 6});
    const auto fans = fans_of_quads(wall.nodes, wall.cells);
    const FootFinder sheet(fans);
    CHECK(sheet.distance(targets[0]) < 0.15);
    CHECK(wall.nodes.row(2).maxCoeff() < 0.125);
    CHECK(std::abs(wall.nodes(2, 0)) < 1e-6);  // far away next to nothing moves
  }

  TEST_CASE("meshing: sweeps even a sheet out on its surface and leave pinned nodes") {
    WallQuads wall = squares(6, 6);
    std::vector<Index> border;
    for (Index n = 0; n < 49; ++n)
      if (n % 7 == 0 || n % 7 == 6 || n < 7 || n >= 42) border.push_back(n);
    const Points<3> even = wall.nodes;
    std::mt19937 random(9);
    std::uniform_real_distribution<double> uniform(-0.3, 0.3);
    for (Index n = 0; n < 49; ++n)
      if (std::find(border.begin(), border.end(), n) == border.end())
        for (int a = 0; a < 3; ++a) wall.nodes(a, n) += uniform(random);
    const Ground ground;
    const Rims none;
    meshing::detail::QuadSmoother<Ground> smoother(wall, ground, none, 1.0);
    CHECK(wall.nodes.row(2).cwiseAbs().maxCoeff() == 0);
    for (const Index n : border) smoother.pin(n, even.col(n));
    const Index middle = 3 + 7 * 3;
    const double worst = smoother.worst_corner(middle);
    for (int sweep = 0; sweep < 200; ++sweep) smoother.sweep();
    // the mean of the neighbours is the discrete harmonic map: squares again
    CHECK((wall.nodes - even).cwiseAbs().maxCoeff() < 1e-6);
    CHECK(worst < 0.99);
    CHECK(smoother.worst_corner(middle) == doctest::Approx(1).epsilon(1e-6));
    for (const Index n : border) CHECK(smoother.held()[static_cast<std::size_t>(n)] != 0);
  }

  TEST_CASE("meshing: a rim is a closed curve measured by its length with the wall on its left") {
    const RimCurve square("end", {{0, 0, 3}, {0, 0, 1}}, {{0, 0, 3.1}, {2, 0, 3}, {2, 2, 2.9}, {0, 2, 3}});
    CHECK(square.length() == doctest::Approx(8).epsilon(1e-15));
    CHECK((square.at(3) - Vec3(2, 1, 3)).norm() < 1e-15);
    CHECK((square.at(-1) - Vec3(0, 1, 3)).norm() < 1e-15);
    CHECK((square.at(8 * 5 + 0.5) - Vec3(0.5, 0, 3)).norm() < 1e-14);
    CHECK(square.nearest({1.2, -4, 7}) == doctest::Approx(1.2));
    CHECK(square.nearest({-1, -1, 3}) == 0);
    CHECK(square.way(7.5, 0.5) == doctest::Approx(1));
    CHECK(square.way(0.5, 7.5) == doctest::Approx(-1));
    for (double s = 0.1; s < 8; s += 0.37) CHECK(square.nearest(square.at(s)) == doctest::Approx(s));

    const int around = 24;
    const auto lumen = test::vessels::cylinder(2, 9, around);
    const Rims rims = rims_of(lumen);
    REQUIRE(rims.curves.size() == 2);
    for (std::size_t r = 0; r < 2; ++r) {
      const RimCurve& rim = rims.curves[r];
      CHECK(rim.name() == lumen.region_names[static_cast<std::size_t>(rims.regions[r])]);
      CHECK(rim.length() ==
            doctest::Approx(2 * around * 2 * std::sin(std::numbers::pi / around)).epsilon(1e-9));
      Vec3 area = Vec3::Zero();  // of the curve as it runs
      for (int i = 0; i < 480; ++i) {
        const Vec3 a = rim.at(rim.length() * i / 480), b = rim.at(rim.length() * (i + 1) / 480);
        area += 0.5 * (a - rim.plane().point).cross(b - rim.plane().point);
      }
      // seen from outside the cap lies on its right
      CHECK(area.dot(rim.plane().normal) ==
            doctest::Approx(-mesh::area_of_region(lumen, rims.regions[r])).epsilon(1e-3));
    }
    mesh::Surface both = lumen;
    for (Index& r : both.region) r = std::min(r, Index{1});
    CHECK_THROWS_WITH_AS((void)rims_of(both), doctest::Contains("not flat"), MeshError);
  }

  TEST_CASE("meshing: normals at the nodes of a box do not depend on how its sides are cut") {
    auto box = test::box_surface(0);
    box.region.assign(box.region.size(), 0);
    const auto normals = vertex_normals(box, 0);
    for (Index n = 0; n < box.node_count(); ++n) {
      const Vec3 corner = Vec3(box.nodes.col(n)) - Vec3(0.5, 0.5, 0.5);
      CHECK((normals[static_cast<std::size_t>(n)] - corner.normalized()).norm() < 1e-15);
    }
    for (const Vec3& n : vertex_normals(box, 1)) CHECK(n == Vec3::Zero());
    CHECK(corner_angle({0, 0, 0}, {2, 0, 0}, {0, 3, 0}) == doctest::Approx(std::numbers::pi / 2));
    CHECK(corner_angle({0, 0, 0}, {1, 0, 0}, {-1, 1e-9, 0}) == doctest::Approx(std::numbers::pi));
  }

  TEST_CASE("meshing: the edges of a grid that a surface crosses come in ascending order") {
    HermiteGrid grid;
    for (std::size_t a = 0; a < 3; ++a) grid.axes[a] = {0, 1, 3 + static_cast<double>(a), 9};
    grid.inside.assign(64, 0);
    const std::size_t inner = 1 + 4 * (2 + 4 * 1);
    grid.inside[inner] = 1;
    CHECK(grid.position(inner) == std::array<std::size_t, 3>{1, 2, 1});
    CHECK(grid.point(inner) == Vec3(1, 4, 1));
    CHECK(grid.strides() == std::array<std::size_t, 3>{1, 4, 16});
    std::vector<std::size_t> edges;
    meshing::detail::for_crossed_edges(
        grid, [&](std::size_t edge, std::size_t node, std::size_t other, std::size_t a) {
          CHECK(edge == 3 * node + a);
          CHECK(other == node + grid.strides()[a]);
          CHECK((node == inner || other == inner));
          edges.push_back(edge);
        });
    CHECK(edges == std::vector<std::size_t>{3 * (inner - 16) + 2, 3 * (inner - 4) + 1, 3 * (inner - 1),
                                            3 * inner, 3 * inner + 1, 3 * inner + 2});
  }

  TEST_CASE("meshing: caps of an image that is inside all over are its closed box") {
    image::Image<float> im;
    const std::array<std::size_t, 3> size{4, 3, 5};
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t i = 0; i < size[a]; ++i) im.axes[a].push_back(static_cast<double>(i));
    im.values.assign(60, 1);
    const SignBits bits(im, {}, 0.5);
    const CutNumbers cuts(bits, size[1], size[2]);
    CHECK(cuts.count() == 0);
    const meshing::detail::MarchingCaps caps(bits, cuts, size);
    CHECK(caps.nodes().size() == 60 - 2 * 1 * 3);
    mesh::Surface box;
    box.nodes.resize(3, static_cast<Index>(caps.nodes().size()));
    for (std::size_t n = 0; n < caps.nodes().size(); ++n)
      for (std::size_t a = 0; a < 3; ++a)
        box.nodes(static_cast<Index>(a), static_cast<Index>(n)) = static_cast<double>(caps.nodes()[n][a]);
    std::vector<Index> all;
    const std::array<std::size_t, 6> squares_of{2 * 4, 2 * 4, 3 * 4, 3 * 4, 3 * 2, 3 * 2};
    for (std::size_t f = 0; f < 6; ++f) {
      CHECK(caps.triangles()[f].size() == 6 * squares_of[f]);
      all.insert(all.end(), caps.triangles()[f].begin(), caps.triangles()[f].end());
    }
    box.cells = Eigen::Map<const Connectivity<3>>(all.data(), 3, static_cast<Index>(all.size()) / 3);
    const auto topology = test::contours::topology(box);
    CHECK(topology.open_edges + topology.wrong_edges + topology.wrong_vertices + topology.loose_vertices ==
          0);
    CHECK(topology.euler == 2);
    CHECK(test::contours::enclosed_volume(box) == doctest::Approx(3 * 2 * 4));
  }

  TEST_CASE("meshing: faces of a side are outward and close the mesh together") {
    mesh::HexMesh mesh;  // two cubes in a row along x
    mesh.nodes.resize(3, 12);
    for (Index k = 0; k < 12; ++k) mesh.nodes.col(k) << k % 3, k / 3 % 2, k / 6;
    mesh.cells.resize(8, 2);
    for (Index c = 0; c < 2; ++c) mesh.cells.col(c) << c, c + 1, c + 4, c + 3, c + 6, c + 7, c + 10, c + 9;
    Vec3 sum = Vec3::Zero();
    for (int axis = 0; axis < 3; ++axis)
      for (const double at : {0.0, axis == 0 ? 2.0 : 1.0}) {
        const auto side = faces_on(mesh, "side", [&](Index n) { return mesh.nodes(axis, n) == at; });
        CHECK(side.name == "side");
        REQUIRE(side.faces.cols() == (axis == 0 ? 1 : 2));
        for (Eigen::Index f = 0; f < side.faces.cols(); ++f) {
          const Vec3 n = normal_of_face(mesh, side.faces, f);
          CHECK(n[axis] == (at == 0 ? -1 : 1));
          CHECK(n.norm() == 1);
          sum += n;
        }
      }
    CHECK(sum == Vec3::Zero());
    CHECK(faces_on(mesh, "none", [](Index n) { return n == 0; }).faces.cols() == 0);
  }

  TEST_CASE("meshing: columns of a folded sheet stand on the bisector and give the faces their thickness") {
    const auto varying = [](const Vec3& x) { return 1 + 0.1 * x[1]; };
    static_assert(Thickness<double> && Thickness<decltype(varying)> && !Thickness<std::string>);
    CHECK(thickness_at(1.5, {1, 2, 3}) == 1.5);
    CHECK(thickness_at(varying, {1, 2, 3}) == doctest::Approx(1.2));

    constexpr double thickness = 0.5;
    const ExtrudeOptions<double> options{.thickness = thickness};  // outlives the fields
    for (const double slope : {0.0, -1.0, -0.5}) {                 // flat, and ridges
      const auto sheet = roof(4, slope);
      meshing::detail::ExtrudeField field(sheet, {}, options);
      field.solve();
      const double along = std::sqrt(1 + slope * slope);
      for (Index n = 0; n < sheet.node_count(); ++n) {
        const double side = sheet.nodes(0, n);
        const Vec3 flank = Vec3(side > 0 ? -slope : slope, 0, 1) / along;
        // the bisector of the flanks at the ridge: both are then `thickness` away
        const Vec3 expected = side == 0 ? Vec3(0, 0, thickness * along) : Vec3(thickness * flank);
        if (std::abs(side) != 1 || slope == 0) CHECK((field.offset(n) - expected).norm() < 0.02 * thickness);
        CHECK(field.share(n) == 1);
      }
      for (Index q = 0; q < sheet.cell_count(); ++q) {
        CHECK(field.wanted(q) == doctest::Approx(thickness));
        const auto deviation = field.deviation(q);
        REQUIRE(deviation.has_value());
        CHECK(std::abs(*deviation) < 0.02);
      }
    }
    // ends stay in their planes, also where these lean
    const auto sheet = roof(4, 0);
    SheetRim rim{"end", Vec3(0, -1, 0.3).normalized(), {}};
    for (Index i = 0; i < 9; ++i) rim.loop.push_back(i);
    const std::vector<SheetRim> rims{rim};
    meshing::detail::ExtrudeField field(sheet, rims, options);
    field.solve();
    for (const Index n : rim.loop) {
      CHECK(std::abs(field.offset(n).dot(rim.normal)) < 1e-14);
      CHECK(field.offset(n)[2] == doctest::Approx(thickness));
    }
  }

  TEST_CASE("meshing: the end of a column knows its distance from both flanks of a groove") {
    const auto sheet = roof(4, 2.0);  // a groove of 53 degrees
    const auto around = mesh::cells_of_nodes(sheet.cells, sheet.node_count());
    const auto neighbours = quad_neighbours(sheet.cells, sheet.node_count());
    const auto count = static_cast<std::size_t>(sheet.node_count());
    const std::vector<double> thickness(count, 1.0);
    const std::vector<Vec3> planes(count, Vec3::Zero());
    std::vector<Vec3> offset(count, Vec3(0, 0, 1));
    for (std::size_t n = 0; n < count; ++n)
      if (const double side = sheet.nodes(0, static_cast<Index>(n)); side != 0)
        offset[n] = Vec3(side > 0 ? -2 : 2, 0, 1).normalized();
    const meshing::detail::Columns columns{sheet, around, neighbours, thickness, planes, 1, 0.3, 80};
    meshing::detail::ColumnEnds ends(columns, offset);
    const Index bottom = 4 + 9 * 2;
    CHECK(ends.share(bottom) == doctest::Approx(1 / std::sqrt(5.0)));  // height 1 above two flanks of slope 2
    CHECK(ends.share(bottom + 1) == 1);                                // 1.19 from the other flank
    CHECK(ends.share(bottom + 4) == 1);
    ends.settle();
    double least = 1;
    for (Index n = 0; n < sheet.node_count(); ++n) least = std::min(least, ends.share(n));
    MESSAGE("groove of 53 degrees: least share " << least);
    CHECK(least > 0.8);
  }
}
