// SPDX-License-Identifier: MIT
#include "tunica/meshing/flat_regions.hpp"

#include "support/surfaces.hpp"
#include "tunica/meshing/remesh.hpp"

#include <Eigen/Geometry>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

using namespace tunica;

namespace {

/// A tube with its axis askew, its coordinates rounded to single precision: what an STL file holds.
mesh::Surface tube_of_a_file() {
  auto s = test::tube_surface(24, 12, 4);
  const Eigen::AngleAxisd turn(0.7, Vec3(1, 2, 3).normalized());
  s.nodes = ((turn.toRotationMatrix() * s.nodes).colwise() + Vec3(217, 131, 22)).eval();
  s.nodes = s.nodes.cast<float>().cast<double>().eval();
  return s;
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("meshing: ends in single precision are flat and a bent one is not") {
    auto s = tube_of_a_file();
    const auto planes = meshing::flat_regions(s);
    REQUIRE(planes.size() == 3);
    CHECK_FALSE(planes[0]);
    const Vec3 axis = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()) * Vec3(0, 0, 1);
    for (const std::size_t r : {1, 2}) {
      REQUIRE(planes[r]);
      CHECK(std::abs(std::abs(planes[r]->normal.dot(axis)) - 1) < 1e-9);
    }
    CHECK((planes[2]->point - planes[1]->point).norm() == doctest::Approx(4).epsilon(1e-6));
    CHECK(planes[1]->normal.dot(planes[1]->point - planes[2]->point) > 0);  // outward

    Index centre = 0;  // of the second end: pushed in by a hundredth of the radius
    for (Index n = 0; n < s.node_count(); ++n)
      if ((s.nodes.col(n) - planes[2]->point).norm() < (s.nodes.col(centre) - planes[2]->point).norm())
        centre = n;
    s.nodes.col(centre) -= 0.01 * planes[2]->normal;
    CHECK(meshing::flat_regions(s)[1]);
    CHECK_FALSE(meshing::flat_regions(s)[2]);
  }

  TEST_CASE("meshing: neither a closed region nor an empty one is flat") {
    auto box = test::box_surface(2);  // its area vectors cancel to the last bit
    box.region.clear();
    box.region_names = {"wall", "nothing"};
    CHECK_FALSE(meshing::flat_regions(box)[0]);
    CHECK_FALSE(meshing::flat_regions(box)[1]);
    box.region.assign(static_cast<std::size_t>(box.cell_count()), 4);  // a label without a name
    CHECK(meshing::flat_regions(box).size() == 5);
  }

  TEST_CASE("meshing: flat ends of a file stay flat when they are remeshed") {
    const auto given = tube_of_a_file();
    const auto s = meshing::remesh(given, {.edge = 0.35}).surface;
    const double size = mesh::bounding_box(s.nodes).diagonal();
    for (const Index r : {1, 2}) {
      const auto plane = meshing::flat_regions(s)[static_cast<std::size_t>(r)];
      REQUIRE(plane);
      double off = 0;
      for (Index t = 0; t < s.cell_count(); ++t)
        for (int k = 0; s.region_of(t) == r && k < 3; ++k)
          off = std::max(off, std::abs(plane->distance(s.nodes.col(s.cells(k, t)))));
      MESSAGE("end ", r, ": ", off / size, " of the size off its plane");
      CHECK(off < 1e-9 * size);
      CHECK(mesh::area_of_region(s, r) == doctest::Approx(std::numbers::pi).epsilon(0.03));
    }
  }
}
