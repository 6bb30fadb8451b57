// SPDX-License-Identifier: MIT
#include "tunica/mesh/quality.hpp"

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
}
