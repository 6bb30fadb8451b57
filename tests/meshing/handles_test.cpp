// SPDX-License-Identifier: MIT
#include "tunica/meshing/handles.hpp"

#include "support/work_cases.hpp"
#include "tunica/meshing/marching_cubes.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

using namespace tunica;

TEST_SUITE("unit") {
  TEST_CASE("meshing: a sphere has no handle") {
    const auto s =
        meshing::marching_cubes(test::sampled<float>(20, [](const Vec3& x) { return -test::sphere(x); }), 0)
            .surface;
    CHECK(meshing::handles(s, mesh::topology(s)).empty());
  }

  TEST_CASE("meshing: the handle of a ring is found where it is thinnest") {
    // a ring about the z axis whose tube has its least radius at +x
    const auto s = meshing::marching_cubes(test::sampled<float>(48,
                                                                [](const Vec3& x) {
                                                                  const Vec3 p = x - Vec3(0.5, 0.5, 0.5);
                                                                  const double r = std::hypot(p[0], p[1]);
                                                                  return 0.11 -
                                                                         0.05 * (r > 0 ? p[0] / r : 0) -
                                                                         std::hypot(r - 0.3, p[2]);
                                                                }),
                                           0)
                       .surface;
    const auto t = mesh::topology(s);
    REQUIRE(t.genus() == 1);
    const auto found = meshing::handles(s, t);
    REQUIRE(found.size() == 1);
    CHECK((found[0].place - Vec3(0.8, 0.5, 0.5)).norm() < 0.05);
    CHECK(found[0].length == doctest::Approx(2 * std::numbers::pi * 0.06).epsilon(0.15));
  }

  TEST_CASE("meshing: three holes of a plate are three handles") {
    const std::array<Vec3, 3> hole{Vec3(0.2, 0.5, 0.5), Vec3(0.5, 0.5, 0.5), Vec3(0.8, 0.5, 0.5)};
    const auto s =
        meshing::marching_cubes(
            test::sampled<float>(61,
                                 [&](const Vec3& x) {
                                   double f = 0.08 - std::abs(x[2] - 0.5);
                                   f = std::min({f, x[0] - 0.03, 0.97 - x[0], x[1] - 0.3, 0.7 - x[1]});
                                   for (const Vec3& h : hole)
                                     f = std::min(f, std::hypot(x[0] - h[0], x[1] - h[1]) - 0.08);
                                   return f;
                                 }),
            0)
            .surface;
    const auto t = mesh::topology(s);
    REQUIRE(t.genus() == 3);
    const auto found = meshing::handles(s, t);
    REQUIRE(found.size() == 3);
    for (const auto& h : found) CHECK(h.length < 1.0);
    CHECK(meshing::handles(s, t, 2).size() == 2);
    for (const double unit : {0x1p-20, 0x1p20}) {  // the same to the last bit, whatever the unit
      auto scaled = s;
      scaled.nodes *= unit;
      const auto again = meshing::handles(scaled, mesh::topology(scaled));
      REQUIRE(again.size() == 3);
      for (std::size_t i = 0; i < 3; ++i) {
        CHECK(again[i].length == unit * found[i].length);
        CHECK(again[i].place == Vec3(unit * found[i].place));
      }
    }
  }
}
