// SPDX-License-Identifier: MIT
// The parts of a smoothing: the order of its nodes, one visit, the watch on triangles that turn over.
#include "support/work_cases.hpp"
#include "tunica/mesh/adjacency.hpp"
#include "tunica/mesh/measures.hpp"
#include "tunica/meshing/marching_cubes.hpp"
#include "tunica/meshing/ring_sweep.hpp"
#include "tunica/meshing/smooth_graph.hpp"
#include "tunica/meshing/turn_watch.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

using namespace tunica;
namespace parts = meshing::detail;

namespace {

parts::SmoothGraph graph_of(const mesh::Surface& s) {
  return parts::smooth_graph(
      s.cells, std::vector<parts::Visit>(static_cast<std::size_t>(s.node_count()), parts::Visit::ring));
}

std::vector<parts::Place> placed(const parts::SmoothGraph& g, const Points<3>& nodes) {
  std::vector<parts::Place> places;
  for (const Index n : g.node) places.push_back({nodes(0, n), nodes(1, n), nodes(2, n), 0});
  return places;
}

Points<3> nodes_of(const parts::SmoothGraph& g, const std::vector<parts::Place>& places) {
  Points<3> nodes(3, static_cast<Eigen::Index>(places.size()));
  for (std::size_t i = 0; i < places.size(); ++i)
    nodes.col(g.node[i]) = Vec3(places[i].x, places[i].y, places[i].z);
  return nodes;
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("meshing: no two nodes that a smoothing moves at once are neighbours") {
    const auto s = meshing::marching_cubes(test::noise_volume(12, 3), 0).surface;
    const auto g = graph_of(s);
    const auto near = mesh::neighbours_of_nodes(s.cells, s.node_count());
    std::vector<char> visited(g.node.size(), 0);
    for (const auto& group : g.groups) {
      const auto within = [&](std::uint32_t slot) {
        return slot >= group.first && slot < group.first + group.count;
      };
      std::size_t at = group.ring;
      for (std::uint32_t slot = group.first; slot < group.first + group.count; ++slot) {
        CHECK(visited[slot]++ == 0);
        for (const Index m : near[g.node[slot]]) CHECK_FALSE(within(g.slot[static_cast<std::size_t>(m)]));
      }
      // the rings lie in packs; what is left over, one by one
      for (std::uint32_t slot = group.first; slot < group.first + group.count && group.valence > 0;) {
        const std::uint32_t left = group.first + group.count - slot;
        const std::uint32_t width = left >= parts::widest ? parts::widest : 1;
        for (std::uint32_t lane = 0; lane < width; ++lane) {
          std::set<Index> ring;
          for (std::uint32_t i = 0; i < group.valence; ++i) {
            const Index a = g.node[g.ring_slots[at + i * width + lane] / parts::lane_stride];
            const Index b =
                g.node[g.ring_slots[at + (i + 1) % group.valence * width + lane] / parts::lane_stride];
            ring.insert(a);
            CHECK(std::count(near[a].begin(), near[a].end(), b) == 1);
          }
          const auto expected = near[g.node[slot + lane]];
          CHECK(ring == std::set<Index>(expected.begin(), expected.end()));
        }
        at += width * group.valence, slot += width;
      }
    }
    CHECK(std::count(visited.begin(), visited.end(), char{1}) == s.node_count());
  }

  TEST_CASE("meshing: a visit knows the volume that its moves take in") {
    const auto s =
        meshing::marching_cubes(test::sampled<float>(20, [](const Vec3& x) { return -test::sphere(x); }), 0)
            .surface;
    const auto g = graph_of(s);
    auto places = placed(g, s.nodes);
    auto before = places, normal = places;
    mesh::Surface now = s;
    double volume = mesh::enclosed_volume(s);
    for (const auto& group : g.groups) {
      parts::Tally tally;
      const auto was = places;
      parts::visit_group<parts::Pass::note>(places.data(), before.data(), normal.data(), g, group,
                                            {.factor = 0.5, .offset = 1e-3}, tally);
      now.nodes = nodes_of(g, places);
      const double next = mesh::enclosed_volume(now);
      CHECK(next - volume == doctest::Approx(tally.volume / 6).epsilon(1e-9).scale(1e-3));
      const double offset = parts::offset_group(places.data(), normal.data(), group, 0.01);
      CHECK(offset == doctest::Approx(0.01 * tally.slope));
      now.nodes = nodes_of(g, places);
      volume = mesh::enclosed_volume(now);
      CHECK(volume - next == doctest::Approx(offset / 6).epsilon(1e-9).scale(1e-3));
      for (std::uint32_t i = group.first; i < group.first + group.count; ++i) {
        CHECK(before[i].x == was[i].x);
        CHECK(before[i].z == was[i].z);
      }
      CHECK(tally.longest > 0);
    }
  }

  TEST_CASE("meshing: every triangle that turns over is told of in the step that turns it") {
    const auto s =
        meshing::marching_cubes(test::sampled<float>(24, [](const Vec3& x) { return -test::sphere(x); }), 0)
            .surface;
    const auto g = graph_of(s);
    parts::TurnWatch watch(s.cells, g.slot);
    auto places = placed(g, s.nodes);
    std::uint64_t seed = 1;
    Index turned = 0;
    const auto area = [&](const Points<3>& nodes, Index t) {
      const Vec3 a = nodes.col(s.cells(0, t)), b = nodes.col(s.cells(1, t)), c = nodes.col(s.cells(2, t));
      return mesh::Triangle{a, b, c}.area_vector();
    };
    for (int step = 0; step < 300; ++step) {
      const auto before = places;
      const double size = step % 30 == 0 ? 1e-2 : 2e-4;  // the grid's spacing is 4e-2
      double travel = 0;
      for (auto& p : places) {
        const Vec3 d = size * Vec3(test::noise(seed), test::noise(seed + 1), test::noise(seed + 2));
        seed += 3;
        p.x += d[0], p.y += d[1], p.z += d[2];
        travel = std::max(travel, d.norm() * (1 + 1e-12));
      }
      std::vector<Index> told, expected;
      watch.look(places.data(), before.data(), travel, [&](Index t) { told.push_back(t); });
      const auto was = nodes_of(g, before), is = nodes_of(g, places);
      for (Index t = 0; t < s.cell_count(); ++t)
        if (!(area(was, t).dot(area(is, t)) > 0)) expected.push_back(t);
      turned += static_cast<Index>(expected.size());
      REQUIRE(told == expected);
    }
    MESSAGE("triangles turned over in 300 steps: ", turned);
    CHECK(turned > 100);
  }
}
