// SPDX-License-Identifier: MIT
#include "tunica/core/vec.hpp"

#include <Eigen/Geometry>

#include <doctest/doctest.h>

#include <cmath>
#include <random>
#include <vector>

using namespace tunica;

TEST_SUITE("unit") {
  TEST_CASE("core: plain products of vectors have the bits of those of Eigen") {
    std::mt19937 generator(7);
    std::uniform_real_distribution<double> uniform(-3, 3);
    const auto random = [&] { return Vec3(uniform(generator), uniform(generator), uniform(generator)); };
    for (int n = 0; n < 1000; ++n) {
      const Vec3 a = random(), b = random();
      const double s = uniform(generator);
      CHECK(vec::plus(a, b) == (a + b).eval());
      CHECK(vec::minus(a, b) == (a - b).eval());
      CHECK(vec::along(a, s, b) == (a + s * b).eval());
      CHECK(vec::scaled(s, a) == (s * a).eval());
      CHECK(vec::divided(a, s) == (a / s).eval());
      CHECK(vec::cross(a, b) == a.cross(b).eval());
      CHECK(vec::unit(a) == a.normalized().eval());
      CHECK(vec::dot(a, b) == a.dot(b));
      CHECK(vec::squared(a) == a.squaredNorm());
      CHECK(vec::length(a) == a.norm());
      CHECK(vec::distance(a, b) == (a - b).norm());
    }
    CHECK(vec::unit(Vec3(0, 0, 0)) == Vec3(0, 0, 0));
  }

  TEST_CASE("core: an orthogonal vector is one for every direction") {
    for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(0, 0, -1), Vec3(1e-14, 0, 1),
                             Vec3(0, -1e-14, 1), Vec3(0.6, 0, 0.8), Vec3(-0.48, 0.6, 0.64)}) {
      const Vec3 a = vec::unit(axis), u = vec::orthogonal(a);
      CHECK(vec::length(u) == doctest::Approx(1).epsilon(1e-15));
      CHECK(std::abs(vec::dot(a, u)) < 1e-13);
    }
  }

  TEST_CASE("core: lists of points become columns and come back") {
    const std::vector<Vec3> list{{1, 2, 3}, {4, 5, 6}};
    Points<3> points = vec::columns(list);
    CHECK(points.cols() == 2);
    CHECK(vec::column(points, 1) == list[1]);
    vec::set_column(points, 0, {7, 8, 9});
    CHECK(points(2, 0) == 9);
    const auto quads = vec::quads({0, 1, 2, 3, 4, 5, 6, 7});
    CHECK(quads.cols() == 2);
    CHECK(quads(1, 1) == 5);
  }
}
