// SPDX-License-Identifier: MIT
#include "tunica/meshing/polygon.hpp"

#include "support/work_cases.hpp"

#include <doctest/doctest.h>

#include <numeric>

using namespace tunica;

namespace {

struct Polygon {
  Points<2> x;
  std::vector<meshing::Corners> loops;

  void add(const std::vector<Point<2>>& loop) {
    meshing::Corners c;
    for (const auto& p : loop) {
      x.conservativeResize(2, x.cols() + 1);
      x.rightCols(1) = p;
      c.push_back(static_cast<Index>(x.cols() - 1));
    }
    loops.push_back(c);
  }
};

std::vector<Point<2>> circle(double cx, double cy, double r, int n, bool clockwise = false) {
  std::vector<Point<2>> p;
  for (int i = 0; i < n; ++i) {
    const double u = (clockwise ? -2 : 2) * std::numbers::pi * i / n;
    p.emplace_back(cx + r * std::cos(u), cy + r * std::sin(u));
  }
  return p;
}

/// Every triangle is counter-clockwise, and the areas add up; the number of triangles follows Euler.
void check(const Polygon& p, double area) {
  const auto t = meshing::triangulate(p.x, p.loops);
  double sum = 0;
  for (const auto& f : t) {
    const double a = 0.5 * meshing::orient2d(p.x.col(f[0]), p.x.col(f[1]), p.x.col(f[2]));
    CHECK(a > 0);
    sum += a;
  }
  CHECK(sum == doctest::Approx(area).epsilon(1e-12));
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("meshing: polygons with holes and flat corners are triangulated by their corners") {
    Polygon square;  // flat corners on every side
    square.add({{0, 0}, {1, 0}, {2, 0}, {3, 0}, {3, 1}, {3, 3}, {2, 3}, {0, 3}, {0, 2}, {0, 1}});
    check(square, 9);
    CHECK(meshing::triangulate(square.x, square.loops).size() == 8);

    Polygon comb;
    comb.add(
        {{0, 0}, {7, 0}, {7, 3}, {6, 3}, {6, 1}, {5, 1}, {5, 3}, {4, 3}, {4, 1}, {3, 1}, {3, 3}, {0, 3}});
    check(comb, 21 - 4);

    Polygon holes;
    holes.add({{0, 0}, {10, 0}, {10, 10}, {0, 10}});
    holes.add(circle(3, 3, 1, 24, true));
    holes.add(circle(7, 3, 1, 24, true));
    holes.add({{2, 6}, {2, 8}, {8, 8}, {8, 6}});
    const double disc = 12 * std::sin(2 * std::numbers::pi / 24);
    check(holes, 100 - 2 * disc - 12);

    Polygon nested;  // two separate parts, one of them inside the hole of the other
    nested.add(circle(0, 0, 4, 60));
    nested.add(circle(0, 0, 3, 40, true));
    nested.add(circle(0.2, 0, 1, 20));
    check(nested, 480 * std::sin(2 * std::numbers::pi / 60) - 180 * std::sin(2 * std::numbers::pi / 40) +
                      10 * std::sin(2 * std::numbers::pi / 20));
  }

  TEST_CASE("meshing: random star polygons are triangulated") {
    for (std::uint64_t seed = 1; seed <= 50; ++seed) {
      std::vector<Point<2>> p;
      const int n = 5 + static_cast<int>(seed * 4);
      std::uint64_t at = seed << 32;
      double area = 0;
      for (int i = 0; i < n; ++i) {
        const double u = 2 * std::numbers::pi * i / n, r = 1 + 0.9 * test::noise(++at);
        p.emplace_back(r * std::cos(u), r * std::sin(u));
      }
      for (std::size_t i = 0; i < p.size(); ++i) {
        const auto &a = p[i], &b = p[(i + 1) % p.size()];
        area += 0.5 * (a[0] * b[1] - a[1] * b[0]);
      }
      Polygon star;
      star.add(p);
      check(star, area);
    }
  }

  TEST_CASE("meshing: a polygon that crosses itself is refused") {
    Polygon bow;
    bow.add({{0, 0}, {2, 2}, {2, 0}, {0, 3}});
    CHECK_THROWS_AS((void)meshing::triangulate(bow.x, bow.loops), MeshError);
  }
}
