// SPDX-License-Identifier: MIT
#include "tunica/meshing/intersections.hpp"

#include "support/work_cases.hpp"
#include "tunica/meshing/marching_cubes.hpp"

#include <doctest/doctest.h>

#include <vector>

using namespace tunica;

namespace {

bool crossing(const std::vector<Vec3>& x, std::array<Index, 3> s, std::array<Index, 3> t) {
  const auto at = [&](Index n) { return x[static_cast<std::size_t>(n)]; };
  const bool forward = meshing::cross(s, t, at);
  for (int turn = 0; turn < 3; ++turn) {  // the answer depends on neither order nor orientation
    std::rotate(s.begin(), s.begin() + 1, s.end());
    CHECK(meshing::cross(s, t, at) == forward);
    CHECK(meshing::cross(t, s, at) == forward);
    std::swap(t[0], t[1]);
    CHECK(meshing::cross(s, t, at) == forward);
  }
  return forward;
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("meshing: two triangles cross or touch or lie apart") {
    const std::vector<Vec3> base{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}};
    const auto against = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
      auto x = base;
      x.insert(x.end(), {a, b, c});
      return crossing(x, {0, 1, 2}, {3, 4, 5});
    };
    CHECK(against({1, 1, -1}, {1, 1, 1}, {1, 2, 1}));        // pierces
    CHECK_FALSE(against({3, 3, -1}, {3, 3, 1}, {3, 4, 1}));  // passes beside
    CHECK(against({1, 1, 0}, {1, 1, 1}, {1, 2, 1}));         // a corner touches
    CHECK_FALSE(against({1, 1, 1e-300}, {1, 1, 1}, {1, 2, 1}));
    CHECK(against({1, 1, 0}, {1.5, 1, 0}, {1, 1.5, 0}));    // within, in plane
    CHECK(against({-1, -1, 0}, {9, -1, 0}, {-1, 9, 0}));    // around, in plane
    CHECK(against({4, 0, 0}, {8, 0, 0}, {4, 4, 0}));        // in plane, a corner touches
    CHECK_FALSE(against({3, 3, 0}, {8, 3, 0}, {3, 8, 0}));  // in plane, apart
    CHECK(against({-1, 1, 0}, {9, 1, 0}, {3, 9, 0}));       // in plane, edges cross
    CHECK(against({2, -1, 0}, {2, 9, 0}, {2, 1, 5}));       // an edge in the plane
  }

  TEST_CASE("meshing: two triangles with a common node or edge") {
    const std::vector<Vec3> x{{0, 0, 0},  {4, 0, 0}, {0, 4, 0}, {-4, 0, 0}, {0, -4, 0}, {1, 1, 1},
                              {1, 1, -1}, {3, 3, 0}, {4, 4, 1}, {8, 0, 0},  {1, 1, 0}};
    CHECK_FALSE(crossing(x, {0, 1, 2}, {0, 3, 4}));  // opposite, in plane
    CHECK(crossing(x, {0, 1, 2}, {0, 5, 6}));        // cuts through from the common node
    CHECK_FALSE(crossing(x, {0, 1, 2}, {0, 3, 5}));
    CHECK(crossing(x, {0, 1, 2}, {0, 7, 5}));        // an edge runs along the inside
    CHECK(crossing(x, {0, 1, 2}, {0, 9, 5}));        // an edge on an edge
    CHECK_FALSE(crossing(x, {0, 1, 2}, {1, 2, 7}));  // common edge, flat
    CHECK(crossing(x, {0, 1, 2}, {1, 2, 10}));       // common edge, folded flat
    CHECK_FALSE(crossing(x, {0, 1, 2}, {1, 2, 8}));
    CHECK(crossing(x, {0, 1, 2}, {2, 1, 0}));  // the same
  }

  TEST_CASE("meshing: marching cubes surfaces of noise do not intersect themselves") {
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      CHECK(meshing::self_intersections(meshing::marching_cubes(test::noise_volume(20, seed), 0).surface)
                .empty());
      CHECK(meshing::self_intersections(
                meshing::marching_cubes(test::integer_noise_volume(20, seed), 0).surface)
                .empty());
    }
  }

  TEST_CASE("meshing: overlapping spheres intersect and flat triangles are named") {
    const auto one =
        meshing::marching_cubes(test::sampled<float>(16, [](const Vec3& x) { return -test::sphere(x); }), 0)
            .surface;
    CHECK(meshing::self_intersections(one).empty());
    mesh::Surface two;
    const auto n = one.nodes.cols(), c = one.cells.cols();
    two.nodes.resize(3, 2 * n), two.cells.resize(3, 2 * c);
    two.nodes << one.nodes, one.nodes.colwise() + Vec3(0.3, 0.01, 0.02);
    two.cells << one.cells, one.cells.array() + static_cast<Index>(n);
    const auto pairs = meshing::self_intersections(two);
    CHECK(pairs.size() > 20);
    for (const auto& [i, j] : pairs) CHECK((i < c && j >= c));
    CHECK(meshing::self_intersections(two, 3).size() == 3);
    two.nodes.col(two.cells(0, 0)) = two.nodes.col(two.cells(1, 0)).eval();
    CHECK(meshing::self_intersections(two).front() == std::pair<Index, Index>(0, 0));
  }
}
