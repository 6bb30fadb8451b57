// SPDX-License-Identifier: MIT
#include "tunica/mesh/quality.hpp"

#include "tunica/mesh/quality_report.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

using namespace tunica;

namespace {

mesh::TetCorners regular_tet() {
  return {Vec3{1, 1, 1}, Vec3{1, -1, -1}, Vec3{-1, -1, 1}, Vec3{-1, 1, -1}};
}

mesh::HexCorners brick(double x, double y, double z) {
  return {Vec3{0, 0, 0}, Vec3{x, 0, 0}, Vec3{x, y, 0}, Vec3{0, y, 0},
          Vec3{0, 0, z}, Vec3{x, 0, z}, Vec3{x, y, z}, Vec3{0, y, z}};
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("mesh: quality of a regular tetrahedron and of its mirror image") {
    const auto x = regular_tet();
    REQUIRE(mesh::tet_volume(x[0], x[1], x[2], x[3]) > 0);
    for (const double a : mesh::dihedral_angles(x))
      CHECK(a == doctest::Approx(std::acos(1.0 / 3)).epsilon(1e-12));
    CHECK(mesh::mean_ratio(x) == doctest::Approx(1).epsilon(1e-12));
    auto mirrored = x;
    std::swap(mirrored[0], mirrored[1]);
    CHECK(mesh::mean_ratio(mirrored) == doctest::Approx(-1).epsilon(1e-12));
  }

  TEST_CASE("mesh: dihedral angles of the corner tetrahedron stand at their edges") {
    const mesh::TetCorners x{Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
    const auto angle = mesh::dihedral_angles(x);
    const double right = std::numbers::pi / 2, slope = std::acos(1 / std::numbers::sqrt3);
    for (std::size_t e = 0; e < 3; ++e)
      CHECK(angle[e] == doctest::Approx(right).epsilon(1e-12));  // at node 0
    for (std::size_t e = 3; e < 6; ++e) CHECK(angle[e] == doctest::Approx(slope).epsilon(1e-12));
    CHECK(mesh::mean_ratio(x) == doctest::Approx(12 * std::cbrt(0.25) / 9).epsilon(1e-12));
  }

  TEST_CASE("mesh: a flat tetrahedron counts as inverted and is found by place") {
    mesh::TetMesh m;
    m.nodes.resize(3, 8);
    const auto good = regular_tet();
    for (int n = 0; n < 4; ++n) m.nodes.col(n) = good[static_cast<std::size_t>(n)];
    m.nodes.rightCols(4) << 10, 11, 10, 11, 0, 0, 1, 1, 0, 0, 0, 0;
    m.cells.resize(4, 2);
    m.cells << 0, 4, 1, 5, 2, 6, 3, 7;
    const auto q = mesh::quality(m);
    CHECK(q.inverted == 1);
    CHECK(q.dihedral.worst_cell == 1);
    CHECK(q.dihedral.least == doctest::Approx(0));
    CHECK(q.worst_place[0] == doctest::Approx(10.5));
    CHECK(q.dihedral.share_below(18) == doctest::Approx(0.5));
    CHECK(q.dihedral.greatest == doctest::Approx(mesh::degrees(std::acos(1.0 / 3))));
  }

  TEST_CASE("mesh: scaled Jacobian of bricks and sheared and inverted hexahedra") {
    CHECK(mesh::scaled_jacobian(brick(1, 2, 5)) == doctest::Approx(1).epsilon(1e-12));
    auto sheared = brick(1, 1, 1);
    for (std::size_t n = 4; n < 8; ++n) sheared[n][0] += 1;  // 45 degrees
    CHECK(mesh::scaled_jacobian(sheared) == doctest::Approx(std::numbers::sqrt2 / 2).epsilon(1e-12));
    auto inverted = brick(1, 1, 1);
    inverted[6] = {0.2, 0.2, 0.2};
    CHECK(mesh::scaled_jacobian(inverted) < 0);
    mesh::HexMesh m;
    m.nodes.resize(3, 8);
    for (int n = 0; n < 8; ++n) m.nodes.col(n) = sheared[static_cast<std::size_t>(n)];
    m.cells = Connectivity<8>(8, 1);
    for (Index n = 0; n < 8; ++n) m.cells(n, 0) = n;
    CHECK(mesh::quality(m).inverted == 0);
    CHECK(mesh::volume(m) == doctest::Approx(1).epsilon(1e-14));
  }

  TEST_CASE("mesh: quality of triangles") {
    mesh::Surface s;
    s.nodes.resize(3, 4);
    s.nodes << 0, 1, 0.5, 0.5, 0, 0, std::sqrt(0.75), -0.01, 0, 0, 0, 0;
    s.cells.resize(3, 2);
    s.cells << 0, 1, 1, 0, 2, 3;
    const auto q = mesh::quality(s);
    CHECK(q.angle.greatest == doctest::Approx(60));
    CHECK(q.angle.worst_cell == 1);
    CHECK(q.angle.least == doctest::Approx(mesh::degrees(std::atan(0.02))));
    CHECK(q.mean_ratio.greatest == doctest::Approx(1));
    CHECK(q.longest_edge == doctest::Approx(1));
    CHECK(q.angle.quantile(0) == q.angle.least);
  }

  TEST_CASE("mesh: scaled Jacobians are one for regular cells and follow their corners") {
    CHECK(mesh::scaled_jacobian(regular_tet()) == doctest::Approx(1).epsilon(1e-12));
    auto mirrored = regular_tet();
    std::swap(mirrored[0], mirrored[1]);
    CHECK(mesh::scaled_jacobian(mirrored) == doctest::Approx(-1).epsilon(1e-12));
    // the corner tetrahedron: det 1, longest product of edges 1 * sqrt2 * sqrt2 at nodes 1 to 3
    const mesh::TetCorners corner{Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
    CHECK(mesh::scaled_jacobian(corner) == doctest::Approx(std::numbers::sqrt2 / 2).epsilon(1e-12));
    const mesh::Triangle right{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}};  // its least sine is that of 45 degrees
    CHECK(mesh::scaled_jacobian(right) == doctest::Approx(std::sqrt(2.0 / 3)).epsilon(1e-12));
    CHECK(mesh::mean_ratio(brick(3, 3, 3)) == doctest::Approx(1).epsilon(1e-12));
    CHECK(mesh::mean_ratio(brick(1, 1, 8)) == doctest::Approx(3 * 4.0 / 66).epsilon(1e-12));
    auto inverted = brick(1, 1, 1);
    inverted[6] = {0.2, 0.2, 0.2};
    CHECK(mesh::mean_ratio(inverted) < 0);
  }

  TEST_CASE("mesh: histograms count every cell once and worst cells come with their places") {
    mesh::Surface s;  // right triangles of legs 1 and k + 1, one beside the other
    constexpr Index n = 40;
    s.nodes.resize(3, 3 * n);
    s.cells.resize(3, n);
    for (Index k = 0; k < n; ++k) {
      const Index i = (7 * k) % n;
      s.nodes.col(3 * k) << 10 * k, 0, 0;
      s.nodes.col(3 * k + 1) << 10 * k + 1, 0, 0;
      s.nodes.col(3 * k + 2) << 10 * k, i + 1, 0;
      s.cells.col(k) << 3 * k, 3 * k + 1, 3 * k + 2;
    }
    const auto figures = mesh::quality_report(s);
    REQUIRE(figures.size() == 3);
    for (const auto& f : figures) {
      Index all = f.histogram.below + f.histogram.above;
      for (const Index c : f.histogram.count) all += c;
      CHECK(all == n);
      CHECK(f.histogram.count.size() + 1 == f.histogram.edges.size());
      REQUIRE(f.worst.size() == mesh::Spread::most_worst);
      for (Index w = 0; w < 10; ++w) {  // the longest: legs 40, 39 ...
        const auto& cell = f.worst[static_cast<std::size_t>(w)];
        CHECK((7 * cell.cell) % n == n - 1 - w);
        CHECK(cell.place[0] == doctest::Approx(10 * cell.cell + 1.0 / 3));
        CHECK(cell.value == doctest::Approx(f.least).epsilon(w == 0 ? 1e-12 : 1));
      }
    }
    Index below_five = 0;  // degrees: a leg of 12 or more
    for (Index k = 1; k <= n; ++k) below_five += mesh::degrees(std::atan(1.0 / k)) < 5;
    CHECK(figures[0].histogram.count[0] + figures[0].histogram.count[1] == below_five);
    CHECK(figures[0].histogram.figure == "smallest angle");
    mesh::TetMesh m;  // one regular and one inverted: the last bin and below all
    const auto x = regular_tet();
    m.nodes.resize(3, 4);
    for (int k = 0; k < 4; ++k) m.nodes.col(k) = x[static_cast<std::size_t>(k)];
    m.cells.resize(4, 2);
    m.cells << 0, 1, 1, 0, 2, 2, 3, 3;
    for (const auto& f : mesh::quality_report(m)) {
      if (f.histogram.unit == "degrees") continue;
      CHECK(f.histogram.count.back() == 1);
      CHECK(f.histogram.below == 1);
      CHECK(f.histogram.above == 0);
      CHECK(f.worst.front().cell == 1);
    }
    mesh::HexMesh cube;
    cube.nodes.resize(3, 8);
    for (int k = 0; k < 8; ++k) cube.nodes.col(k) = brick(1, 1, 1)[static_cast<std::size_t>(k)];
    cube.cells.resize(8, 1);
    for (Index k = 0; k < 8; ++k) cube.cells(k, 0) = k;
    for (const auto& f : mesh::quality_report(cube)) CHECK(f.histogram.count.back() == 1);
    CHECK(mesh::quality_report(mesh::HexMesh{}).front().worst.empty());
  }
}
