// SPDX-License-Identifier: MIT
#include "tunica/meshing/intersections.hpp"

#include "support/work_cases.hpp"
#include "tunica/meshing/marching_cubes.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <utility>
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

  TEST_CASE("meshing: an open star is one that an axis sees whole") {
    // fans about node 0 in the plane z = 0, or along a spiral that goes round `turns` times
    const auto fan = [](int count, double turns, double lift, double depth) {
      mesh::Surface s;
      s.nodes.resize(3, count + 1), s.cells.resize(3, count);
      s.nodes.col(0) = Vec3(0, 0, depth);
      for (int i = 0; i < count; ++i) {
        const double angle = 2 * std::numbers::pi * (turns * i / count + 0.01);
        s.nodes.col(i + 1) = Vec3(std::cos(angle), std::sin(angle), lift * std::sin(3 * angle));
        s.cells.col(i) << 0, i + 1, (i + 1) % count + 1;
      }
      return s;
    };
    const auto open = [](const mesh::Surface& s) { return meshing::detail::open_stars(s).open[0] != 0; };
    CHECK(open(fan(3, 1, 0, 0)));
    CHECK(open(fan(7, 1, 0, 2)));
    CHECK(open(fan(12, 1, 0.2, 0)));
    CHECK_FALSE(open(fan(14, 2, 0.1, 0)));  // twice round
    CHECK_FALSE(open(fan(7, 2, 0, 0)));
    mesh::Surface backwards = fan(7, 1, 0, 0);
    backwards.cells.row(1).swap(backwards.cells.row(2));
    CHECK(open(backwards));
    mesh::Surface gap = fan(7, 1, 0, 0);
    gap.cells.conservativeResize(3, 6);
    CHECK_FALSE(open(gap));  // not closed: nothing is known
    mesh::Surface folded = fan(7, 1, 0, 0);
    folded.nodes.col(3) = Vec3(0.1, -0.7, 0);  // a triangle turns over
    CHECK_FALSE(open(folded));
    mesh::Surface flat = fan(7, 1, 0, 0);
    flat.nodes.col(3) = flat.nodes.col(0);
    CHECK_FALSE(open(flat));
    CHECK(meshing::detail::open_stars(flat).unknown[2] == 1);
    CHECK(meshing::detail::open_stars(flat).unknown[4] == 0);
  }

  TEST_CASE("meshing: self-intersections are those of a search through all pairs") {
    std::mt19937 random(3);
    const auto uniform = [&] { return static_cast<double>(random()) / 4294967296.0 - 0.5; };
    std::size_t total = 0;
    for (const double shake : {0.0, 0.2, 0.6, 1.0, 2.0, 4.0}) {  // of a grid spacing
      mesh::Surface s =
          meshing::marching_cubes(test::sampled<float>(9, [](const Vec3& x) { return -test::sphere(x); }), 0)
              .surface;
      for (Index n = 0; n < s.node_count(); ++n)
        s.nodes.col(n) += shake / 8 * Vec3(uniform(), uniform(), uniform());
      if (shake == 4) s.nodes.col(s.cells(0, 5)) = s.nodes.col(s.cells(1, 5)).eval();
      const auto nodes = [&](Index t) {
        return std::array<Index, 3>{s.cells(0, t), s.cells(1, t), s.cells(2, t)};
      };
      std::vector<std::pair<Index, Index>> all;
      std::vector<char> flat(static_cast<std::size_t>(s.cell_count()));
      for (Index t = 0; t < s.cell_count(); ++t) {
        flat[static_cast<std::size_t>(t)] = meshing::detail::projection_axis(mesh::triangle(s, t)) < 0;
        if (flat[static_cast<std::size_t>(t)]) all.emplace_back(t, t);
      }
      for (Index t = 0; t < s.cell_count(); ++t)
        for (Index u = t + 1; u < s.cell_count(); ++u)
          if (!flat[static_cast<std::size_t>(t)] && !flat[static_cast<std::size_t>(u)] &&
              meshing::cross(nodes(t), nodes(u), [&](Index n) -> Vec3 { return s.nodes.col(n); }))
            all.emplace_back(t, u);
      std::sort(all.begin(), all.end());
      CHECK(meshing::self_intersections(s) == all);
      total += all.size();
    }
    CHECK(total > 1000);
  }
}
