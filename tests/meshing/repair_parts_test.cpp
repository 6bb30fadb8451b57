// SPDX-License-Identifier: MIT
// The parts of repair, each by the property that the others rely on.
#include "support/surfaces.hpp"
#include "tunica/mesh/topology.hpp"
#include "tunica/meshing/repair_edges.hpp"
#include "tunica/meshing/repair_facets.hpp"
#include "tunica/meshing/repair_holes.hpp"
#include "tunica/meshing/repair_loops.hpp"
#include "tunica/meshing/repair_orient.hpp"
#include "tunica/meshing/repair_report.hpp"
#include "tunica/meshing/repair_seams.hpp"
#include "tunica/meshing/repair_split.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <numbers>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

using namespace tunica;
using namespace tunica::meshing;
namespace parts = meshing::detail;

namespace {

std::size_t at(Index i) {
  return static_cast<std::size_t>(i);
}

/// Facets over random nodes: edges of one, two and many facets, however turned.
Connectivity<3> random_facets(Index nodes, Index facets, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<Index> any(0, nodes - 1);
  Connectivity<3> cells(3, facets);
  for (Index t = 0; t < facets; ++t) do
      for (int k = 0; k < 3; ++k) cells(k, t) = any(random);
    while (cells(0, t) == cells(1, t) || cells(1, t) == cells(2, t) || cells(2, t) == cells(0, t));
  return cells;
}

/// Without the facets for which out(centroid) holds.
template <class Out>
mesh::Surface without(mesh::Surface s, const Out& out) {
  std::vector<char> kept;
  for (Index t = 0; t < s.cell_count(); ++t) kept.push_back(!out(mesh::triangle(s, t).centroid()));
  keep_facets(s, kept);
  return s;
}

/// A corrugated loop of n corners around the z axis.
std::vector<Vec3> loop_of(int n, double waves, double height) {
  std::vector<Vec3> x;
  for (int i = 0; i < n; ++i) {
    const double a = 2 * std::numbers::pi * i / n;
    x.emplace_back(std::cos(a), std::sin(a), height * std::cos(waves * a));
  }
  return x;
}

/// Twice the sum of area vectors: what a loop spans, however it is filled.
Vec3 spanned(const std::vector<Vec3>& x, const std::vector<std::array<Index, 3>>& triangles) {
  Vec3 sum(0, 0, 0);
  for (const auto& t : triangles) sum += (x[at(t[1])] - x[at(t[0])]).cross(x[at(t[2])] - x[at(t[0])]);
  return sum;
}

/// The directed edges that have no opposite one.
std::set<std::pair<Index, Index>> rim_of(const std::vector<std::array<Index, 3>>& triangles) {
  std::set<std::pair<Index, Index>> rim;
  for (const auto& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = t[k], b = t[(k + 1) % 3];
      if (rim.erase({b, a}) == 0) CHECK(rim.insert({a, b}).second);
    }
  return rim;
}

bool is_rim(const std::set<std::pair<Index, Index>>& rim, Index n) {
  bool all = rim.size() == at(n);
  for (Index i = 0; i < n; ++i) all = all && rim.count({i, (i + 1) % n}) == 1;
  return all;
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("meshing: shared edges hold every half-edge once") {
    for (const unsigned seed : {1U, 2U, 3U}) {
      const auto cells = random_facets(30, 200, seed);
      const SharedEdges edges(cells);
      std::map<std::array<Index, 2>, Index> count;
      for (Index h = 0; h < 600; ++h) {
        const auto [a, b] = mesh::half_edge(cells, h);
        ++count[{std::min(a, b), std::max(a, b)}];
      }
      REQUIRE(at(edges.size()) == count.size());
      std::vector<int> met(600, 0);
      for (Index e = 0; e < edges.size(); ++e) {
        CHECK(edges.facets(e) == count[edges.nodes[at(e)]]);
        if (e > 0) CHECK(edges.nodes[at(e - 1)] < edges.nodes[at(e)]);
        for (const Index h : edges.half_edges[e]) {
          CHECK(edges.edge(h) == e);
          ++met[at(h)];
          const Index g = edges.across(h);
          CHECK((g >= 0) == (edges.facets(e) == 2));
          if (g >= 0) CHECK(edges.across(g) == h);
        }
      }
      CHECK(std::count(met.begin(), met.end(), 1) == 600);
      for (Index a = 0; a < 30; ++a)
        for (Index b = 0; b < 30; ++b)
          if (a != b) CHECK(edges.has(a, b) == (count.count({std::min(a, b), std::max(a, b)}) == 1));
    }
  }

  TEST_CASE("meshing: sheets of facets are joined over the edges asked for and no others") {
    // two spheres, and a third one that shares an edge of four facets with the second
    auto s = test::joined(test::icosphere(2), test::icosphere(1, 1, {5, 0, 0}));
    std::vector<Index> label;
    CHECK(sheets(SharedEdges(s.cells), 2, label) == 2);
    CHECK(std::is_sorted(label.begin(), label.end()));
    CHECK(label.front() == 0);
    CHECK(label.back() == 1);
    CHECK(std::count(label.begin(), label.end(), 0) == 320);
    CHECK(sheets(SharedEdges(s.cells), 1, label) == s.cell_count());  // none of its edges has one facet
    const Index a = s.cells(0, 350), b = s.cells(1, 350);
    const Index c = s.node_count();
    append_nodes(s, {Vec3(9, 0, 0), Vec3(9, 1, 0)});
    add_facets(s, {{a, b, c}, {b, a, c + 1}, {a, c, c + 1}, {b, c + 1, c}}, {0, 0, 0, 0});
    CHECK(sheets(SharedEdges(s.cells), 2, label) == 3);
    CHECK(sheets(SharedEdges(s.cells), 4, label) == 2);
  }

  TEST_CASE("meshing: facets that are kept keep their regions and nodes their order") {
    auto s = test::box_surface(2);
    const auto all = s;
    std::vector<char> kept;
    for (Index t = 0; t < s.cell_count(); ++t) kept.push_back(s.region_of(t) % 2 == 1);
    keep_facets(s, kept);
    CHECK(s.cell_count() == all.cell_count() / 2);
    Index to = 0;
    for (Index t = 0; t < all.cell_count(); ++t) {
      if (kept[at(t)] == 0) continue;
      CHECK(s.cells.col(to) == all.cells.col(t));
      CHECK(s.region_of(to++) == all.region_of(t));
    }
    const double area = mesh::area(s);
    const Index before = s.node_count();
    drop_unused_nodes(s);
    CHECK(s.node_count() < before);
    CHECK(mesh::topology(s).unused_nodes == 0);
    CHECK(mesh::area(s) == area);
    Index last = -1;  // those left are a subsequence of those that were
    for (Index n = 0; n < s.node_count(); ++n) {
      Index m = last + 1;
      while (m < before && all.nodes.col(m) != s.nodes.col(n)) ++m;
      REQUIRE(m < before);
      last = m;
    }
  }

  TEST_CASE("meshing: the loops of holes run each open edge once against its facet") {
    // two caps that meet in one node make a walk that comes back to it
    const auto sphere = test::icosphere(3);
    const Vec3 up(0, 0, 1), side = Vec3(1, 0.2, 0).normalized();
    for (const double cosine : {0.6, 0.8, 0.95}) {
      const auto s =
          without(sphere, [&](const Vec3& x) { return x.dot(up) > cosine || x.dot(side) > cosine; });
      const SharedEdges edges(s.cells);
      std::set<std::pair<Index, Index>> open;
      for (Index h = 0; h < 3 * s.cell_count(); ++h)
        if (edges.facets(edges.edge(h)) == 1) {
          const auto [a, b] = mesh::half_edge(s.cells, h);
          open.insert({a, b});
        }
      const auto loops = parts::hole_loops(s, edges);
      CHECK(loops.size() >= 1);
      for (const auto& loop : loops) {
        CHECK(std::set<Index>(loop.begin(), loop.end()).size() == loop.size());
        for (std::size_t i = 0; i < loop.size(); ++i)
          CHECK(open.erase({loop[(i + 1) % loop.size()], loop[i]}) == 1);
      }
      CHECK(open.empty());
    }
  }

  TEST_CASE("meshing: a loop is filled from its own corners and spans the same area vector") {
    const auto any = [](Index, Index) { return true; };
    for (const int n : {3, 4, 7, 20, 60})
      for (const double height : {0.0, 0.05, 0.6}) {
        const auto x = loop_of(n, 2, height);
        const auto made = parts::loop_triangles(x, any);
        CHECK(made.size() == static_cast<std::size_t>(n - 2));
        CHECK(is_rim(rim_of(made), n));
        CHECK((spanned(x, made) - parts::loop_normal(x)).norm() < 1e-12);
      }
    // chords that exist elsewhere are not used again
    const auto x = loop_of(12, 3, 0.4);
    const auto some = [](Index i, Index j) { return (i + j) % 3 != 0; };
    const auto made = parts::loop_triangles(x, some);
    REQUIRE(made.size() == 10);
    for (const auto& t : made)
      for (std::size_t k = 0; k < 3; ++k) {
        const Index a = t[k], b = t[(k + 1) % 3], step = (b - a + 12) % 12;
        CHECK((step == 1 || step == 11 || some(a, b)));
      }
    CHECK(parts::loop_triangles(loop_of(5, 2, 0.6), [](Index, Index) { return false; }).empty());
  }

  TEST_CASE("meshing: the filling of a hole is a disc over its rim with edges like those around") {
    const auto any = [](Index, Index) { return true; };
    for (const int n : {6, 24, 60})
      for (const double height : {0.0, 0.3}) {
        const auto x = loop_of(n, 2, height);
        const double edge = (x[1] - x[0]).norm();
        const parts::HolePatch patch(x, std::vector<double>(at(n), edge), any);
        REQUIRE(patch.x.size() >= x.size());
        for (std::size_t i = 0; i < x.size(); ++i) CHECK(patch.x[i] == x[i]);
        CHECK(is_rim(rim_of(patch.triangles), n));
        // Euler's number of a disc is 1: F = 2 V - 2 - rim
        CHECK(static_cast<int>(patch.triangles.size()) == 2 * static_cast<int>(patch.x.size()) - 2 - n);
        double longest = 0;
        for (const auto& t : patch.triangles)
          for (std::size_t k = 0; k < 3; ++k)
            longest = std::max(longest, (patch.x[at(t[(k + 1) % 3])] - patch.x[at(t[k])]).norm());
        CHECK(longest < 2.5 * edge);
        CHECK((spanned(patch.x, patch.triangles) - parts::loop_normal(x)).norm() < 1e-12 * n);
        for (const Vec3& p : patch.x) {  // a membrane stays within the hull of its rim
          CHECK(std::abs(p[2]) <= height + 1e-12);
          CHECK(std::hypot(p[0], p[1]) <= 1 + 1e-12);
        }
      }
  }

  TEST_CASE("meshing: filled spheres are closed and what is too long is left with its place") {
    for (const double cosine : {0.5, 0.8}) {
      auto s = without(test::icosphere(3), [&](const Vec3& x) { return std::abs(x[2]) > cosine; });
      const double cut = std::numbers::pi * (2.0 / 3 - cosine + std::pow(cosine, 3) / 3);  // of one cap
      auto whole = s;
      RepairReport report;
      parts::fill_holes(whole, 100, report);
      CHECK(report.filled.size() == 2);
      CHECK(report.left.empty());
      const auto t = mesh::topology(whole);
      CHECK(t.closed());
      CHECK(t.euler() == 2);
      // flat lids: the sphere without its two caps
      CHECK(std::abs(mesh::enclosed_volume(whole) / (4 * std::numbers::pi / 3 - 2 * cut) - 1) < 0.06);
      RepairReport too_long;
      parts::fill_holes(s, 5, too_long);
      REQUIRE(too_long.left.size() == 2);
      CHECK(too_long.filled.empty());
      for (const auto& hole : too_long.left) CHECK(std::abs(hole.centre[2]) > 0.8 * cosine);
    }
  }

  TEST_CASE("meshing: nested parts face outward and inward in turns") {
    std::mt19937 random(5);
    const std::array<double, 4> radius{4, 3, 2, 1};
    mesh::Surface s = test::icosphere(2, radius[0]);
    for (std::size_t i = 1; i < 4; ++i) s = test::joined(s, test::icosphere(2, radius[i]));
    s = test::joined(s, test::icosphere(2, 1, {0, 0, 6}));
    const auto good = s;
    std::vector<Index> part;
    (void)sheets(SharedEdges(s.cells), 2, part);
    const parts::Nesting nesting(s, part);
    for (const auto& [x, depth] : {std::pair{Vec3(0.1, 0.2, 0.3), 4},
                                   {Vec3(1.5, 0.1, 0.2), 3},
                                   {Vec3(0.1, 2.5, -0.2), 2},
                                   {Vec3(0.3, 0.2, -3.5), 1},
                                   {Vec3(0.2, 0.1, 5.5), 1},
                                   {Vec3(0.2, 0.1, 4.5), 0}})
      CHECK(nesting.depth(x, -1) == depth);
    for (Index t = 0; t < s.cell_count(); ++t)
      if (random() % 3 == 0) parts::turn_facet(s, t);
    RepairReport report;
    parts::agree(s, report);
    CHECK(mesh::topology(s).oriented());
    CHECK(report.turned.count > 0);
    parts::face_outward(s, report);
    const auto t = mesh::topology(s);
    REQUIRE(t.components.size() == 5);
    for (std::size_t i = 0; i < 5; ++i) CHECK((t.components[i].volume > 0) == (i % 2 == 0));
    double wanted = 0;
    const auto ball = mesh::enclosed_volume(test::icosphere(2));
    for (std::size_t i = 0; i < 4; ++i) wanted += (i % 2 == 0 ? 1 : -1) * std::pow(radius[i], 3) * ball;
    CHECK(mesh::enclosed_volume(s) == doctest::Approx(wanted + ball).epsilon(1e-12));
    RepairReport again;  // nothing is left to do
    parts::agree(s, again), parts::face_outward(s, again);
    CHECK(again.turned.count == 0);
    CHECK(again.parts_turned.count == 0);
  }

  TEST_CASE("meshing: seams in reach are welded and those beyond it are not") {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> jitter(-1, 1);
    const double gap = 1e-4;
    for (const double off : {0.2 * gap, 10 * gap}) {
      const auto sphere = test::icosphere(3);
      auto lower = without(sphere, [](const Vec3& x) { return x[2] > 0.1; });
      auto upper = without(sphere, [](const Vec3& x) { return x[2] <= 0.1; });
      for (Index n = 0; n < upper.node_count(); ++n)
        upper.nodes.col(n) += off / 2 * Vec3(jitter(random), jitter(random), jitter(random));
      auto s = test::joined(lower, upper);
      drop_unused_nodes(s);
      const Index open = mesh::topology(s).open_edges;
      RepairReport report;
      parts::weld_seams(s, gap, report);
      CHECK(s.cell_count() == sphere.cell_count());
      const bool reach = off < gap;
      CHECK(mesh::topology(s).open_edges == (reach ? 0 : open));
      CHECK(report.welded.count == (reach ? open / 2 : 0));  // as many nodes as edges on a simple rim
    }
  }

  TEST_CASE("meshing: sheets around an edge are paired across their inside") {
    // wedges of a pie that touch along the z axis
    for (const int wedges : {2, 3, 5}) {
      test::SurfaceBuilder b;
      const Index low = b.node({0, 0, 0}), high = b.node({0, 0, 1});
      for (int w = 0; w < wedges; ++w) {
        const double from = 2 * std::numbers::pi * w / wedges, to = from + std::numbers::pi / wedges;
        const Index p = b.node({std::cos(from), std::sin(from), 0.5}),
                    q = b.node({std::cos(to), std::sin(to), 0.5});
        for (const std::array<Index, 3>& f :
             {std::array<Index, 3>{low, p, high}, {low, high, q}, {low, q, p}, {p, q, high}})
          b.triangles.push_back(f);
      }
      auto s = b.surface();
      s.region.clear();
      const SharedEdges edges(s.cells);
      std::vector<Index> twin(at(3 * s.cell_count()), -1);
      Index axis = -1;
      for (Index e = 0; e < edges.size(); ++e)
        if (edges.facets(e) > 2) axis = e;
      REQUIRE(edges.facets(axis) == 2 * wedges);
      CHECK(parts::pair_around(s, edges, axis, twin));
      for (const Index h : edges.half_edges[axis]) {
        REQUIRE(twin[at(h)] >= 0);
        CHECK(twin[at(twin[at(h)])] == h);
        CHECK(twin[at(h)] / 12 == h / 12);  // the facet across the same wedge
      }
      const double volume = mesh::enclosed_volume(s);
      RepairReport report;
      parts::part_sheets(s, report);
      const auto t = mesh::topology(s);
      CHECK(t.closed());
      CHECK(t.components.size() == at(wedges));
      CHECK(report.split_edges.count == 1);
      CHECK(report.split_nodes.count == 2);
      CHECK(mesh::enclosed_volume(s) < volume);
      CHECK(mesh::enclosed_volume(s) > 0.8 * volume);
    }
  }

  TEST_CASE("meshing: the report on repair has a sentence for each kind with its count and first place") {
    RepairReport r;
    CHECK(r.sentences().empty());
    r.welded.add({1, 2, 3});
    for (int i = 0; i < 5; ++i) r.turned.add({7, 8, 9.5 + i});
    r.filled.push_back({.edges = 12, .triangles = 10, .centre = {4, 5, 6}});
    r.crossings_before = 9, r.crossings_after = 2;
    const auto text = r.sentences();
    REQUIRE(text.size() == 4);
    CHECK(text[0].substr(0, 6) == "1 node");
    CHECK(text[0].find(place(Vec3(1, 2, 3))) != std::string::npos);
    CHECK(text[1].substr(0, 8) == "5 facets");
    CHECK(text[1].find(place(Vec3(7, 8, 9.5))) != std::string::npos);
    CHECK(text[2].find("12 edges") != std::string::npos);
    CHECK(text[2].find("10 triangles") != std::string::npos);
    CHECK(text[3].substr(0, 7) == "7 pairs");
  }
}
