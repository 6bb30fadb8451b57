// SPDX-License-Identifier: MIT
// Boundary layers: prisms split alike from both sides, heights as asked for, flat ends kept, the whole mesh
// as promised.
#include "tunica/meshing/boundary_layers.hpp"
#include "tunica/meshing/layered_prisms.hpp"

#include "support/layers.hpp"
#include "support/surfaces.hpp"
#include "support/vessels.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <set>
#include <string>
#include <vector>

namespace {

using namespace tunica;
using mesh::Surface;
namespace layers = test::layers;

const meshing::PrismCorners right_prism{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0),
                                        Vec3(0, 0, 2), Vec3(1, 0, 2), Vec3(0, 1, 2)};

/// Adds the faces of the cells, each from its smallest node on as it turns, to those still open: a face meets
/// its reverse once.
template <class C>
void meet(std::set<std::vector<Index>>& open, const mesh::Mesh<C, 3>& m, bool outward, int& wrong) {
  const auto turned = [](std::vector<Index> f) {
    std::rotate(f.begin(), std::min_element(f.begin(), f.end()), f.end());
    return f;
  };
  const auto meet_one = [&](std::vector<Index> f) {
    if (!outward) std::reverse(f.begin(), f.end());
    const auto here = turned(f);
    std::reverse(f.begin(), f.end());
    if (open.erase(turned(f)) == 0) wrong += !open.insert(here).second;
  };
  for (Index c = 0; c < m.cell_count(); ++c) {
    if constexpr (C::dim == 2) {
      std::vector<Index> f;
      for (int k = 0; k < C::nodes; ++k) f.push_back(m.cells(k, c));
      meet_one(f);
    } else {
      for (const auto& face : C::faces) {
        std::vector<Index> f;
        for (const int k : face)
          if (f.empty() || f.back() != m.cells(k, c)) f.push_back(m.cells(k, c));
        meet_one(f);
      }
    }
  }
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("meshing: a prism is split into three positive tetrahedra in every order of its columns") {
    std::array<Index, 3> rank{0, 1, 2};
    do {
      std::set<std::array<Index, 2>> diagonals;
      double volume = 0;
      int count = 0;
      meshing::split_prism({0, 1, 2, 3, 4, 5}, rank, [&](const std::array<Index, 4>& t) {
        const auto x = [&](std::size_t i) { return right_prism[static_cast<std::size_t>(t[i])]; };
        const double six = meshing::orient3d(x(0), x(1), x(2), x(3));
        CHECK(six > 0);
        volume += six / 6, ++count;
        for (const auto& e : mesh::Tet4::edges) {
          const Index a = t[static_cast<std::size_t>(e[0])], b = t[static_cast<std::size_t>(e[1])];
          if ((a < 3) != (b < 3) && a % 3 != b % 3) diagonals.insert({std::min(a, b), std::max(a, b)});
        }
      });
      CHECK(count == 3);
      CHECK(volume == doctest::Approx(1.0));
      REQUIRE(diagonals.size() == 3);
      for (const auto& [low, high] : diagonals)  // from the base of the lower column
        CHECK(rank[static_cast<std::size_t>(low)] < rank[static_cast<std::size_t>(high % 3)]);
    } while (std::next_permutation(rank.begin(), rank.end()));
  }

  TEST_CASE("meshing: columns without height leave a pyramid or one tetrahedron or nothing of a prism") {
    const auto count = [](const meshing::Prism& p) {
      int n = 0;
      meshing::split_prism(p, {0, 1, 2}, [&](const std::array<Index, 4>&) { ++n; });
      return n;
    };
    CHECK(count({0, 1, 2, 0, 4, 5}) == 2);
    CHECK(count({0, 1, 2, 3, 1, 5}) == 2);
    CHECK(count({0, 1, 2, 3, 4, 2}) == 2);
    CHECK(count({0, 1, 2, 0, 1, 5}) == 1);
    CHECK(count({0, 1, 2, 0, 1, 2}) == 0);
  }

  TEST_CASE("meshing: the quality of a prism is 1 when right and not positive when a corner turns over") {
    CHECK(meshing::prism_quality(right_prism, 1) == doctest::Approx(1));
    auto x = right_prism;
    for (std::size_t k = 3; k < 6; ++k) x[k][2] *= 0.01;  // thin is as good
    CHECK(meshing::prism_quality(x, 1) == doctest::Approx(1));
    x = right_prism;
    x[4] = Vec3(0.25, 0, 2), x[5] = Vec3(0, 0.25, 2);  // a top of a sixteenth of the area
    CHECK(meshing::prism_quality(x, 1) == doctest::Approx(0.0625).epsilon(0.1));
    x[4] = Vec3(-0.1, 0, 2);
    CHECK(meshing::prism_quality(x, 1) < 0);
    x = right_prism;
    x[3][2] = 0;  // a column without height
    CHECK(meshing::prism_quality(x, 1) > 0.9);
  }

  TEST_CASE("meshing: layers on a tube have the heights asked for and its ends stay flat") {
    const Surface s = test::tube_surface(48, 32, 8);
    const meshing::LayerOptions options{.layers = 4, .first = 0.02, .growth = 1.3};
    const auto fill = meshing::layered_tetrahedra(s, options);
    layers::check("tube", s, fill);
    layers::tell("tube", s, fill);
    CHECK(fill.report.full_share == 1);
    CHECK(fill.report.vanished == 0);
    CHECK(fill.report.layer.tetrahedra == 3 * 4 * 48 * 32 * 2);
    // From a node of the wall inward: radii 1, 1 - t, 1 - t (1 + g), ...
    constexpr Index n = 48 * 16 + 7;  // half-way along
    double radius = 1, height = options.first;
    for (int level = 0; level < options.layers; ++level, height *= options.growth) {
      radius -= height;
      const Vec3 x = fill.mesh.nodes.col(fill.end[static_cast<std::size_t>(n)] - options.layers + 1 + level);
      CHECK(std::hypot(x[0], x[1]) == doctest::Approx(radius).epsilon(1e-6));
      CHECK(x[2] == doctest::Approx(s.nodes(2, n)).epsilon(1e-6));
    }
  }

  TEST_CASE("meshing: without a height asked for the last layer is 0.8 of the edge that it meets") {
    const Surface s = test::icosphere(4);
    const auto fill = meshing::layered_tetrahedra(s, {.layers = 4});
    layers::check("sphere", s, fill);
    layers::tell("sphere", s, fill);
    CHECK(fill.report.full_share == 1);
    double height = 0, edge = 0, count = 0;
    for (Index n = 0; n < s.node_count(); ++n) {
      const Index end = fill.end[static_cast<std::size_t>(n)];
      height += (fill.mesh.nodes.col(end) - fill.mesh.nodes.col(end - 1)).norm() / s.node_count();
    }
    for (Index t = 0; t < s.cell_count(); ++t)
      for (int k = 0; k < 3; ++k, ++count)
        edge += (fill.inner.nodes.col(s.cells(k, t)) - fill.inner.nodes.col(s.cells((k + 1) % 3, t))).norm();
    CHECK(std::abs(height / (edge / count) - 0.8) < 0.03);
  }

  TEST_CASE("meshing: layers on some sides of a box end in the planes of the others") {
    const Surface s = test::box_surface(3);
    for (const std::vector<std::string>& sides : std::vector<std::vector<std::string>>{
             {"x0"}, {"x0", "x1"}, {"x0", "y0"}, {"x0", "y0", "z0"}, {"x0", "x1", "y0", "y1", "z0", "z1"}}) {
      const auto fill = meshing::layered_tetrahedra(s, {.layers = 3, .first = 0.02, .regions = sides});
      const std::string name = "box with layers on " + std::to_string(sides.size()) + " sides";
      layers::check(name, s, fill);
      layers::tell(name, s, fill);
      CHECK(fill.report.vanished == 0);
      CHECK(fill.report.least_share > 0.9);
    }
    CHECK_THROWS_AS((void)meshing::layered_tetrahedra(s), MeshError);  // all regions are flat
    CHECK_THROWS_AS((void)meshing::layered_tetrahedra(s, {.regions = {"lid"}}), MeshError);
  }

  TEST_CASE("meshing: layers give way between walls that are near and the report tells where") {
    // Two spheres with a gap of a tenth of their edges, within a third: the gap is narrow outside of both.
    Surface s = test::icosphere(4, 4.0);
    const Surface a = test::icosphere(3, 1.0, Vec3(-1.007, 0, 0)),
                  b = test::icosphere(3, 1.0, Vec3(1.007, 0, 0));
    for (Surface hole : {a, b}) {
      hole.cells.row(1).swap(hole.cells.row(2));
      s = test::joined(s, hole);
    }
    const auto fill = meshing::layered_tetrahedra(s, {.layers = 3});
    layers::check("holes", s, fill);
    layers::tell("holes", s, fill);
    CHECK(fill.report.full_share > 0.5);
    CHECK(fill.report.least_share < 0.1);
    CHECK(fill.report.thinnest.norm() < 0.3);
  }

  TEST_CASE("meshing: layers taper off where the neighbour without layers is curved") {
    Surface s = test::icosphere(4);
    s.region_names = {"upper", "lower"};
    s.region.clear();
    for (Index t = 0; t < s.cell_count(); ++t)
      s.region.push_back(mesh::triangle(s, t).centroid()[2] > 0 ? 0 : 1);
    const auto fill = meshing::layered_tetrahedra(s, {.layers = 3, .regions = {"upper"}});
    layers::check("half a sphere", s, fill);
    layers::tell("half a sphere", s, fill);
    CHECK(fill.report.vanished > 0);
    CHECK(fill.report.full_share > 0.5);
  }

  TEST_CASE("meshing: layers are the same bits on any run and refuse what the filler refuses") {
    const Surface s = test::tube_surface(24, 8, 4);
    const auto one = meshing::layered_tetrahedra(s), two = meshing::layered_tetrahedra(s);
    CHECK(one.mesh.nodes == two.mesh.nodes);
    CHECK(one.mesh.cells == two.mesh.cells);
    Surface open = s;
    open.cells.conservativeResize(3, s.cells.cols() - 1);
    open.region.pop_back();
    CHECK_THROWS_AS((void)meshing::layered_tetrahedra(open), MeshError);
    Surface inward = s;
    inward.cells.row(1).swap(inward.cells.row(2));
    CHECK_THROWS_AS((void)meshing::layered_tetrahedra(inward), MeshError);
  }

  TEST_CASE("meshing: layers kept as prisms conform with the core and with the flat ends") {
    std::vector<Surface> surfaces{test::tube_surface(24, 12, 4), test::tube_surface(24, 12, 4)};
    Surface& dented = surfaces.back();  // a node of the rim and one of the wall pulled out to sharp tips
    dented.nodes.col(3) *= 3, dented.nodes.col(24 * 6 + 5).head<2>() *= 4;
    for (const Surface& s : surfaces) {
      const meshing::LayerOptions options{.layers = 3};
      const auto split = meshing::layered_tetrahedra(s, options);
      const auto fill = meshing::layered_prisms(s, split, options);
      MESSAGE(fill.prisms.cell_count()
              << " prisms, " << fill.pyramids.cell_count() << " pyramids, " << fill.tets.cell_count()
              << " tetrahedra, " << split.report.vanished << " columns vanished");
      CHECK((fill.pyramids.cell_count() > 0) == (split.report.vanished > 0));
      std::set<std::vector<Index>> open;
      int wrong = 0;
      meet(open, fill.prisms, true, wrong), meet(open, fill.pyramids, true, wrong);
      meet(open, fill.tets, true, wrong);
      meet(open, fill.triangles, false, wrong), meet(open, fill.quads, false, wrong);
      CHECK(wrong == 0);
      CHECK(open.empty());
      double volume = mesh::volume(fill.tets);
      int inverted = 0;
      for (Index c = 0; c < fill.prisms.cell_count(); ++c) {
        meshing::Prism p{};
        meshing::PrismCorners x;
        for (std::size_t k = 0; k < 6; ++k) {
          p[k] = fill.prisms.cells(static_cast<Eigen::Index>(k), c);
          x[k] = fill.prisms.nodes.col(p[k]);
        }
        inverted += !(meshing::prism_quality(x, 1) > 0);
        meshing::split_prism({0, 1, 2, 3, 4, 5}, {p[0], p[1], p[2]}, [&](const std::array<Index, 4>& t) {
          const auto y = [&](std::size_t i) { return x[static_cast<std::size_t>(t[i])]; };
          volume += meshing::orient3d(y(0), y(1), y(2), y(3)) / 6;
        });
      }
      for (Index c = 0; c < fill.pyramids.cell_count(); ++c) {
        const auto x = [&](int k) { return Vec3(fill.pyramids.nodes.col(fill.pyramids.cells(k, c))); };
        const bool first = fill.pyramids.cells(0, c) < fill.pyramids.cells(3, c);  // as the prism beside it
        for (const auto& [i, j, k] :
             std::array<std::array<int, 3>, 4>{{{0, 1, 2}, {0, 2, 3}, {0, 1, 3}, {1, 2, 3}}}) {
          const double six = meshing::orient3d(x(i), x(j), x(k), x(4));
          inverted += !(six > 0);
          if ((k == 3 && (j == 1 || i == 1)) != first) volume += six / 6;
        }
      }
      CHECK(inverted == 0);
      CHECK(volume == doctest::Approx(split.report.volume).epsilon(1e-12));
    }
  }
}
