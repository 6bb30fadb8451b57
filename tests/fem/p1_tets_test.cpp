// SPDX-License-Identifier: MIT
// Linear tetrahedra: exact gradients and volumes, and the first inverted cell.
#include "tunica/fem/p1_tets.hpp"

#include "support/flow.hpp"
#include "tunica/meshing/box.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

using namespace tunica;

TEST_SUITE("unit") {
  TEST_CASE("fem: linear tetrahedra have exact gradients and fill their box") {
    auto mesh = meshing::box_tets(4);
    test::shake(mesh, 0.05);
    fem::P1Tets tets;
    REQUIRE(tets.update(mesh.nodes, mesh.cells));
    CHECK(tets.inverted() == -1);
    const Vec3 g(0.3, -2, 1.1);
    double volume = 0;
    for (Index e = 0; e < mesh.cell_count(); ++e) {
      Vec3 gradient = Vec3::Zero();
      for (int a = 0; a < 4; ++a) gradient += tets[e].grad.col(a) * g.dot(mesh.nodes.col(mesh.cells(a, e)));
      CHECK((gradient - g).norm() < 1e-12);
      CHECK(tets[e].grad.rowwise().sum().norm() < 1e-12);
      volume += tets[e].volume;
    }
    CHECK(volume == doctest::Approx(1.0).epsilon(1e-13));
  }

  TEST_CASE("fem: the size of a regular tetrahedron is its edge") {
    Points<3> x(3, 4);
    x << 1, 1, -1, -1, 1, -1, 1, -1, 1, -1, -1, 1;  // alternate corners of a cube of edge 2
    Connectivity<4> cell(4, 1);
    cell << 0, 1, 3, 2;
    if (fem::p1_tet(x, cell, 0).volume < 0) cell << 0, 1, 2, 3;
    CHECK(fem::p1_tet(x, cell, 0).size() == doctest::Approx(2 * std::sqrt(2.0)));
  }

  TEST_CASE("fem: an inverted cell and one that is not finite are found") {
    const auto mesh = meshing::box_tets(2);
    fem::P1Tets tets;
    Points<3> x = mesh.nodes;
    x.col(mesh.cells(3, 11)) = 2 * mesh.nodes.col(mesh.cells(0, 11)) - mesh.nodes.col(mesh.cells(3, 11));
    CHECK_FALSE(tets.update(x, mesh.cells));
    REQUIRE(tets.inverted() >= 0);
    CHECK(tets[tets.inverted()].volume <= 0);
    x = mesh.nodes;
    x(1, mesh.cells(0, 5)) = std::numeric_limits<double>::quiet_NaN();
    CHECK_FALSE(tets.update(x, mesh.cells));
  }
}
