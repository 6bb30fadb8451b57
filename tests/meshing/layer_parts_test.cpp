// SPDX-License-Identifier: MIT
// The parts of boundary layers, each by the property that the others rely on.
#include "support/layers.hpp"
#include "support/surfaces.hpp"
#include "tunica/mesh/topology.hpp"
#include "tunica/meshing/flat_regions.hpp"
#include "tunica/meshing/layer_caps.hpp"
#include "tunica/meshing/layer_directions.hpp"
#include "tunica/meshing/layer_heights.hpp"
#include "tunica/meshing/layer_options.hpp"
#include "tunica/meshing/layer_sheet.hpp"
#include "tunica/meshing/size_field.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <random>
#include <utility>
#include <vector>

using namespace tunica;
using namespace tunica::meshing;
namespace parts = meshing::detail;

namespace {

std::size_t at(Index i) {
  return static_cast<std::size_t>(i);
}

/// A tube of radius 1 along z from 0 to 4, slightly crumpled within its wall.
mesh::Surface tube() {
  auto s = test::tube_surface(24, 16, 6);
  for (Index n = 0; n < s.node_count(); ++n) {
    const double z = s.nodes(2, n);
    if (z == 0 || z == 4) continue;
    const double noise = test::node_noise(static_cast<std::uint64_t>(n));
    s.nodes(0, n) *= 1 + 0.02 * noise, s.nodes(1, n) *= 1 + 0.02 * noise;
  }
  return s;
}

/// A prism over a hexagon of `rings` rings of equilateral triangles, its sides one region.
mesh::Surface hexagonal_prism(Index rings, double height) {
  test::SurfaceBuilder b;
  std::map<std::array<Index, 3>, Index> number;
  const auto inside = [&](Index i, Index j) {
    return std::abs(i) <= rings && std::abs(j) <= rings && std::abs(i + j) <= rings;
  };
  std::vector<Index> region;
  const auto add = [&](const std::array<Index, 3>& f, Index r) {
    b.triangles.push_back(f), region.push_back(r);
  };
  for (const Index top : {0, 1}) {
    for (Index i = -rings; i <= rings; ++i)
      for (Index j = -rings; j <= rings; ++j)
        if (inside(i, j))
          number[{i, j, top}] = b.node(Vec3(i + 0.5 * j, std::sqrt(0.75) * j, top * height * rings) /
                                       static_cast<double>(rings));
    for (Index i = -rings; i <= rings; ++i)
      for (Index j = -rings; j <= rings; ++j) {
        const auto n = [&](Index di, Index dj) { return number.at({i + di, j + dj, top}); };
        for (const bool up : {true, false}) {
          const Index di = up ? 1 : -1;
          if (!inside(i, j) || !inside(i + di, j) || !inside(i, j + di)) continue;
          std::array<Index, 3> f{n(0, 0), n(di, 0), n(0, di)};
          if (top == 0) std::swap(f[1], f[2]);
          add(f, 1 + top);
        }
      }
  }
  // along the rim against the clock
  constexpr std::array<std::array<Index, 2>, 6> steps{{{-1, 1}, {-1, 0}, {0, -1}, {1, -1}, {1, 0}, {0, 1}}};
  Index i = rings, j = 0;
  for (const auto& [di, dj] : steps)
    for (Index k = 0; k < rings; ++k, i += di, j += dj) {
      const Index p = number.at({i, j, 0}), q = number.at({i + di, j + dj, 0});
      const Index u = number.at({i, j, 1}), v = number.at({i + di, j + dj, 1});
      add({p, q, v}, 0), add({p, v, u}, 0);
    }
  auto s = b.surface();
  s.region = region;
  s.region_names = {"wall", "bottom", "top"};
  return s;
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("meshing: the sheet of a tube stands freely on its wall and in the planes of its ends") {
    const auto s = tube();
    const auto sheet = layer_sheet(s, {});
    CHECK(sheet.triangles.size() == at(2 * 24 * 16));
    for (Index t = 0; t < s.cell_count(); ++t) {
      CHECK((sheet.carries[at(t)] != 0) == (s.region_of(t) == 0));
      const Vec3 outward = mesh::triangle(s, t).area_vector();
      CHECK(sheet.inward[at(t)].dot(outward) == doctest::Approx(-outward.norm()).epsilon(1e-14));
    }
    for (Index n = 0; n < s.node_count(); ++n) {
      const Vec3 x = sheet.node(n);
      const bool end = x[2] == 0 || x[2] == 4, wall = std::hypot(x[0], x[1]) > 0.95;
      CHECK(sheet.foot[at(n)] == (!wall ? ColumnFoot::none : end ? ColumnFoot::plane : ColumnFoot::free));
      if (wall && end) CHECK(std::abs(sheet.axis[at(n)][2]) == 1);
      CHECK(sheet.neighbours[n].size() == (!wall ? 0U : end ? 4U : 6U));
      for (const Index m : sheet.neighbours[n]) {
        const auto back = sheet.neighbours[m];
        CHECK(std::count(back.begin(), back.end(), n) == 1);
      }
    }
    // where the neighbour without layers is curved they end; in the corner of three sides they run along a
    // line
    const auto one_end = layer_sheet(s, {"inlet"});
    for (Index n = 0; n < s.node_count(); ++n)
      if (s.nodes(2, n) == 0 && std::hypot(s.nodes(0, n), s.nodes(1, n)) > 0.95)
        CHECK(one_end.foot[at(n)] == ColumnFoot::fixed);
    const auto box = test::box_surface(1);
    const auto side = layer_sheet(box, {"z0"});
    for (Index n = 0; n < box.node_count(); ++n) {
      const Vec3 x = side.node(n);
      if (x[2] > 0) continue;
      const int edges = (x[0] == 0 || x[0] == 1) + (x[1] == 0 || x[1] == 1);
      CHECK(side.foot[at(n)] == (edges == 0   ? ColumnFoot::free
                                 : edges == 1 ? ColumnFoot::plane
                                              : ColumnFoot::line));
      if (edges == 2) CHECK(std::abs(side.axis[at(n)][2]) == doctest::Approx(1).epsilon(1e-14));
    }
    CHECK_THROWS_WITH_AS((void)layer_sheet(s, {"roof"}), doctest::Contains("roof"), MeshError);
  }

  TEST_CASE("meshing: directions of columns see their triangles and stay within the planes of ends") {
    for (const int sweeps : {0, 20}) {
      const auto s = tube();
      auto sheet = layer_sheet(s, {});
      const auto d = layer_directions(sheet, sweeps);
      CHECK(d.blind == 0);
      for (Index n = 0; n < s.node_count(); ++n) {
        if (!sheet.grows(n)) {
          CHECK(d.way[at(n)].norm() == 0);
          continue;
        }
        CHECK(d.way[at(n)].norm() == doctest::Approx(1).epsilon(1e-14));
        CHECK(d.cosine[at(n)] == parts::least_cosine(sheet, n, d.way[at(n)]));
        CHECK(d.cosine[at(n)] > 0.7);
        if (sheet.foot[at(n)] == ColumnFoot::plane) CHECK(std::abs(d.way[at(n)][2]) < 1e-15);
      }
    }
    // on a sphere they meet in the middle, and no sweep moves them far from there
    const auto ball = test::icosphere(3);
    auto sheet = layer_sheet(ball, {});
    const auto d = layer_directions(sheet, 20);
    for (Index n = 0; n < ball.node_count(); ++n) CHECK(d.way[at(n)].dot(ball.nodes.col(n)) < -0.999);
  }

  TEST_CASE("meshing: weights of neighbours give linear fields their value at the node") {
    const auto s = tube();
    const auto sheet = layer_sheet(s, {});
    int linear = 0, nodes = 0;
    for (Index n = 0; n < s.node_count(); ++n) {
      if (sheet.foot[at(n)] == ColumnFoot::none) continue;
      const Vec3 up = parts::first_direction(sheet, n).way;
      const auto w = parts::linear_weights(sheet, n, up);
      REQUIRE(w.size() == sheet.neighbours[n].size());
      double sum = 0;
      Vec3 off(0, 0, 0);
      for (std::size_t i = 0; i < w.size(); ++i) {
        sum += w[i];
        off += w[i] * (sheet.node(sheet.neighbours[n][i]) - sheet.node(n));
      }
      CHECK(sum == doctest::Approx(1).epsilon(1e-12));
      off -= off.dot(up) * up;
      ++nodes, linear += off.norm() < 1e-12;
      if (sheet.foot[at(n)] == ColumnFoot::free) CHECK(off.norm() < 1e-12);
    }
    MESSAGE(linear, " of ", nodes, " nodes");
  }

  TEST_CASE("meshing: heights of layers grow by their rate and fall off no faster than their slope") {
    const auto s = tube();
    const LayerOptions options{.layers = 4, .first = 0.02, .growth = 1.5};
    auto sheet = layer_sheet(s, {});
    const auto d = layer_directions(sheet, options.smoothing);
    LayerHeights heights(sheet, d, options);
    const double all = 0.02 * (std::pow(1.5, 4) - 1) / 0.5;
    std::vector<Index> grown;
    for (Index n = 0; n < s.node_count(); ++n) {
      if (!sheet.grows(n)) continue;
      grown.push_back(n);
      CHECK(heights.height(n) == doctest::Approx(all).epsilon(1e-12));
      double step = 0.02;
      for (int level = 1; level <= 4; ++level, step *= 1.5) {
        const Vec3 way = heights.place(n, level) - heights.place(n, level - 1);
        CHECK(way.norm() == doctest::Approx(step).epsilon(1e-9));
        CHECK(way.normalized().dot(d.way[at(n)]) == doctest::Approx(1).epsilon(1e-9));
      }
      CHECK(heights.place(n, 0) == sheet.node(n));
    }
    const auto slope_holds = [&] {
      for (const Index n : grown)
        for (const Index m : sheet.neighbours[n])
          CHECK(heights.height(n) <=
                heights.height(m) + options.slope * (sheet.node(n) - sheet.node(m)).norm() + 1e-12);
    };
    slope_holds();
    CHECK(heights.lower({grown[40]}, 0.4));
    CHECK(heights.height(grown[40]) == doctest::Approx(0.4 * all).epsilon(1e-12));
    slope_holds();
    std::mt19937 random(2);
    for (int i = 0; i < 60; ++i) {  // ever lower; what is below the least height is none
      std::vector<Index> some;
      for (int k = 0; k < 5; ++k) some.push_back(grown[random() % grown.size()]);
      (void)heights.lower(some, 0.5);
      slope_holds();
    }
    int vanished = 0;
    for (const Index n : grown) {
      CHECK(heights.height(n) <= heights.wanted(n));
      const Vec3 top = heights.place(n, options.layers);
      CHECK((top - sheet.node(n)).norm() == doctest::Approx(heights.height(n)).epsilon(1e-9));
      vanished += heights.height(n) == 0;
    }
    CHECK(vanished > 0);
  }

  TEST_CASE("meshing: columns keep their room on both sides of a narrow slab") {
    for (const double thick : {0.3, 0.1}) {
      const auto s = test::box_surface(3, {2, 2, thick});
      const LayerOptions options{.layers = 3, .first = 0.1, .growth = 1, .regions = {"z0", "z1"}};
      auto sheet = layer_sheet(s, options.regions);
      const auto d = layer_directions(sheet, options.smoothing);
      const LayerHeights heights(sheet, d, options);
      for (Index n = 0; n < s.node_count(); ++n)
        if (sheet.grows(n)) {
          CHECK(heights.height(n) <= options.room * thick * 1.15);
          CHECK(heights.height(n) > 0.5 * options.room * thick);
        }
    }
  }

  TEST_CASE("meshing: the inside of an end follows its rim and keeps linear displacements") {
    Eigen::Matrix3d A;
    A << 0.9, 0.1, 0, -0.05, 0.85, 0, 0, 0, 1;
    const auto drawn = [&](const LayerSheet& sheet) {
      std::vector<Vec3> move(at(sheet.surface.node_count()), Vec3(0, 0, 0));
      for (Index n = 0; n < sheet.surface.node_count(); ++n)
        if (sheet.grows(n)) move[at(n)] = A * sheet.node(n) - sheet.node(n);
      return move;
    };
    const auto off = [&](const LayerSheet& sheet, const std::vector<Vec3>& move) {
      double worst = 0;
      for (Index n = 0; n < sheet.surface.node_count(); ++n)
        if (sheet.foot[at(n)] == ColumnFoot::none)
          worst = std::max(worst, (move[at(n)] - (A * sheet.node(n) - sheet.node(n))).norm());
      return worst;
    };
    const auto prism = hexagonal_prism(6, 2);
    REQUIRE(mesh::topology(prism).closed());
    const auto even = layer_sheet(prism, {});
    const LayerCaps even_caps(even);
    auto even_move = drawn(even);
    CHECK(off(even, even_move) > 0.05);
    even_caps.follow(even_move);
    CHECK(off(even, even_move) < 1e-9);
    CHECK(even_caps.folded(even_move).empty());
    // right-angled triangles, whose weights are held above zero
    const auto s = tube();
    const auto sheet = layer_sheet(s, {});
    const LayerCaps caps(sheet);
    auto move = drawn(sheet);
    caps.follow(move);
    MESSAGE("off by ", off(even, even_move), " on even triangles, by ", off(sheet, move),
            " on right-angled ones");
    CHECK(off(sheet, move) < 0.01);
    CHECK(caps.folded(move).empty());
    // a rim that is drawn through its middle folds its end
    for (Index n = 0; n < s.node_count(); ++n)
      if (sheet.grows(n) && sheet.node(n)[2] == 0) move[at(n)] = Vec3(-1.5 * sheet.node(n)[0], 0, 0);
    caps.follow(move);
    const auto folded = caps.folded(move);
    CHECK(!folded.empty());
    CHECK(std::is_sorted(folded.begin(), folded.end()));
    for (const Index n : folded) {
      CHECK(sheet.grows(n));
      CHECK(sheet.node(n)[2] == 0);
    }
  }

  TEST_CASE("meshing: layers with a size field have a core of that size") {
    const auto s = test::icosphere(3);
    const LayerOptions options{.layers = 3, .first = 0.02};
    const auto fine = layered_tetrahedra(s, ConstantSize{0.08}, options);
    const auto coarse = layered_tetrahedra(s, ConstantSize{0.3}, options);
    test::layers::check("fine", s, fine);
    test::layers::check("coarse", s, coarse);
    CHECK(fine.report.layer.tetrahedra == coarse.report.layer.tetrahedra);
    MESSAGE("core of ", fine.report.core.tetrahedra, " and of ", coarse.report.core.tetrahedra);
    CHECK(fine.report.core.tetrahedra > 4 * coarse.report.core.tetrahedra);
  }
}
