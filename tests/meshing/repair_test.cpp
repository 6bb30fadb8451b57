// SPDX-License-Identifier: MIT
// Surfaces spoilt on purpose: what repair finds, counts and gives back.
#include "tunica/meshing/repair.hpp"

#include "support/surfaces.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <numbers>
#include <string>
#include <vector>

using namespace tunica;
using meshing::RepairExtent;

namespace {

/// Facets with corners of their own, as a file has them.
mesh::Surface soup(const mesh::Surface& s) {
  mesh::Surface r;
  r.nodes.resize(3, 3 * s.cell_count());
  r.cells.resize(3, s.cell_count());
  for (Index t = 0; t < s.cell_count(); ++t)
    for (Index k = 0; k < 3; ++k) {
      r.nodes.col(3 * t + k) = s.nodes.col(s.cells(k, t));
      r.cells(k, t) = 3 * t + k;
    }
  return r;
}

void add(mesh::Surface& s, const std::vector<std::array<Index, 3>>& facets) {
  Index t = s.cell_count();
  s.cells.conservativeResize(3, t + static_cast<Index>(facets.size()));
  for (const auto& f : facets) s.cells.col(t++) << f[0], f[1], f[2];
}

Index add_node(mesh::Surface& s, const Vec3& x) {
  const Index n = s.node_count();
  s.nodes.conservativeResize(3, n + 1);
  s.nodes.col(n) = x;
  return n;
}

/// Leaves out the facets that the predicate of the centroid tells.
template <class Out>
mesh::Surface without(mesh::Surface s, const Out& out) {
  std::vector<char> kept;
  for (Index t = 0; t < s.cell_count(); ++t) kept.push_back(!out(mesh::triangle(s, t).centroid()));
  meshing::keep_facets(s, kept);
  return s;
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("meshing: repair leaves a good surface as it is") {
    for (const auto& s : {test::icosphere(2), test::tube_surface(12, 6, 2), test::torus(16, 24)}) {
      const auto fixed = meshing::repair(s);
      CHECK(fixed.report.sentences().empty());
      CHECK(fixed.surface.cells == s.cells);
      CHECK(fixed.surface.nodes == s.nodes);
      CHECK(fixed.surface.region == s.region);
    }
  }

  TEST_CASE("meshing: safe repair welds and turns and leaves out what has no area") {
    const auto whole = test::icosphere(2);
    auto s = soup(whole);
    for (Index t = 0; t < s.cell_count(); t += 7) std::swap(s.cells(0, t), s.cells(1, t));
    const auto turned = (s.cell_count() + 6) / 7;
    add(s, {{0, 1, 2}, {4, 3, 5}, {0, 1, 1}});  // twice, twice and turned, without area
    const auto fixed = meshing::repair(s, {.extent = RepairExtent::safe});
    const auto& r = fixed.report;
    CHECK(r.welded.count == 3 * whole.cell_count() - whole.node_count());
    CHECK(r.degenerate.count == 1);
    CHECK(r.duplicates.count == 2);
    CHECK(r.turned.count == turned);
    CHECK(r.sentences().size() == 4);
    const auto topology = mesh::topology(fixed.surface);
    CHECK(topology.closed());
    CHECK(topology.triangles == whole.cell_count());
    CHECK(std::abs(mesh::enclosed_volume(fixed.surface)) ==
          doctest::Approx(mesh::enclosed_volume(whole)).epsilon(1e-14));
  }

  TEST_CASE("meshing: a facet on a line goes and its neighbour is split") {
    auto s = test::box_surface(0);
    // side x0 is 0 4 6, 0 6 2: a node on the diagonal with a facet on the line beside it
    const Index m = add_node(s, 0.5 * (s.nodes.col(0) + s.nodes.col(6)));
    for (Index t = 0; t < s.cell_count(); ++t)
      if (s.cells(0, t) == 0 && s.cells(1, t) == 6 && s.cells(2, t) == 2) s.cells.col(t) << 0, m, 2;
    s.region.clear();
    add(s, {{m, 6, 2}, {0, 6, m}});
    const auto fixed = meshing::repair(s, {.extent = RepairExtent::safe});
    CHECK(fixed.report.degenerate.count == 1);
    CHECK(mesh::topology(fixed.surface).closed());
    CHECK(fixed.surface.cell_count() == 14);
    CHECK(mesh::enclosed_volume(fixed.surface) == doctest::Approx(1).epsilon(1e-15));
    CHECK(mesh::area(fixed.surface) == doctest::Approx(6).epsilon(1e-15));
  }

  TEST_CASE("meshing: facets back to back are told from facets that are needed") {
    auto s = test::icosphere(1);
    const Index n = add_node(s, Vec3(3, 0, 0)), m = add_node(s, Vec3(3, 1, 0)),
                p = add_node(s, Vec3(4, 1, 0));
    add(s, {{n, m, p}, {m, n, p}});                           // two back to back that hold nothing
    add(s, {{s.cells(1, 5), s.cells(0, 5), s.cells(2, 5)}});  // and one behind a facet of the sphere
    const auto fixed = meshing::repair(s, {.extent = RepairExtent::safe});
    CHECK(fixed.report.folded_sheets.count == 1);
    CHECK(fixed.report.duplicates.count == 1);
    CHECK(mesh::topology(fixed.surface).closed());
    CHECK(fixed.surface.node_count() == test::icosphere(1).node_count());
    CHECK(mesh::enclosed_volume(fixed.surface) > 0);
  }

  TEST_CASE("meshing: safe repair fills no hole and cuts nothing off") {
    const auto open = without(test::icosphere(2), [](const Vec3& x) { return x[2] > 0.95; });
    const auto fixed = meshing::repair(open, {.extent = RepairExtent::safe});
    CHECK(fixed.report.sentences().empty());
    CHECK(mesh::topology(fixed.surface).loops.size() == 1);
  }

  TEST_CASE("meshing: holes are filled to the edges around them") {
    const auto whole = test::icosphere(3);
    const double edge = mesh::quality(whole).longest_edge;
    const auto open = without(
        whole, [](const Vec3& x) { return x[2] > 0.85 || (x[0] > 0.97 && x[1] > 0) || x[1] < -0.985; });
    const auto before = mesh::topology(open);
    REQUIRE(before.loops.size() == 3);
    const auto fixed = meshing::repair(open);
    const auto after = mesh::topology(fixed.surface);
    CHECK(after.closed());
    CHECK(after.genus() == 0);
    REQUIRE(fixed.report.filled.size() == 3);
    CHECK(fixed.report.left.empty());
    for (std::size_t i = 0; i < 3; ++i)
      CHECK(fixed.report.filled[i].edges == static_cast<Index>(before.loops[i].nodes.size()));
    const auto q = mesh::quality(fixed.surface);
    MESSAGE("volume ", mesh::enclosed_volume(fixed.surface) / mesh::enclosed_volume(whole),
            " of the whole, smallest angle ", q.angle.least, " degrees, longest edge ",
            q.longest_edge / edge);
    CHECK(q.angle.least > 15);
    CHECK(q.longest_edge < 1.6 * edge);
    CHECK(meshing::self_intersections(fixed.surface, 1).empty());
    const auto few = meshing::repair(open, {.hole_edges = 12});  // the largest stays and is told
    CHECK(few.report.left.size() == 1);
    CHECK(mesh::topology(few.surface).loops.size() == 1);
  }

  TEST_CASE("meshing: open ends of a tube are filled in their planes") {
    auto tube = test::tube_surface(40, 20, 6);
    const auto open = without(tube, [](const Vec3& x) { return x[2] < 1e-9 || x[2] > 4 - 1e-9; });
    const auto fixed = meshing::repair(open);
    CHECK(mesh::topology(fixed.surface).closed());
    CHECK(mesh::enclosed_volume(fixed.surface) ==
          doctest::Approx(mesh::enclosed_volume(tube)).epsilon(1e-12));
    CHECK(mesh::area(fixed.surface) == doctest::Approx(mesh::area(tube)).epsilon(1e-12));
    CHECK(fixed.report.filled.size() == 2);
    CHECK(fixed.report.filled[0].triangles > 60);
    CHECK(mesh::quality(fixed.surface).angle.least > 15);
  }

  TEST_CASE("meshing: seams are welded and nodes on open edges sewn") {
    const auto box = test::box_surface(2);
    auto s = soup(box);
    for (Index n = 0; n < s.node_count(); ++n)
      for (Index a = 0; a < 3; ++a)
        s.nodes(a, n) += 1e-7 * test::node_noise(static_cast<std::uint64_t>(3 * n + a));
    const auto welded = meshing::repair(s);
    CHECK(mesh::topology(welded.surface).closed());
    CHECK(welded.report.welded.count == 3 * box.cell_count() - box.node_count());
    CHECK(mesh::enclosed_volume(welded.surface) == doctest::Approx(1).epsilon(1e-6));
    // one half from a fine box and one from a coarse one: the rims have other nodes
    auto fine = test::box_surface(3), coarse = test::box_surface(1);
    fine = without(fine, [](const Vec3& x) { return x[2] > 1 - 1e-9; });
    coarse = without(coarse, [](const Vec3& x) { return x[2] < 1 - 1e-9; });
    auto both = test::joined(fine, coarse);
    both.region.clear(), both.region_names.clear();
    const auto sewn = meshing::repair(both);
    CHECK(mesh::topology(sewn.surface).closed());
    CHECK(sewn.report.sewn.count == 4 * (8 - 2));
    CHECK(sewn.report.filled.empty());
    CHECK(mesh::enclosed_volume(sewn.surface) == doctest::Approx(1).epsilon(1e-14));
  }

  TEST_CASE("meshing: flaps and stray sheets are cut off") {
    auto s = test::icosphere(2);
    const Index far = add_node(s, Vec3(2, 2, 2)), farther = add_node(s, Vec3(3, 2, 2));
    add(s, {{s.cells(0, 3), s.cells(1, 3), far}, {s.cells(0, 3), far, farther}});
    const Index a = add_node(s, Vec3(5, 0, 0)), b = add_node(s, Vec3(5, 0.1, 0)),
                c = add_node(s, Vec3(5, 0, 0.1));
    add(s, {{a, b, c}});
    const auto fixed = meshing::repair(s);
    CHECK(fixed.report.flaps.count == 2);
    CHECK(fixed.report.strays.count == 1);
    CHECK(fixed.report.strays.first[0] == doctest::Approx(5));
    CHECK(mesh::topology(fixed.surface).closed());
    CHECK(fixed.surface.cell_count() == test::icosphere(2).cell_count());
  }

  TEST_CASE("meshing: bodies that touch along edges and at nodes are parted") {
    const auto box = test::box_surface(1);
    const auto beside = [&](const Vec3& by) {
      auto other = box;
      other.nodes.colwise() += by;
      auto both = test::joined(box, other);
      both.region.clear(), both.region_names.clear();
      return meshing::repair(both);
    };
    const auto edge = beside(Vec3(1, 1, 0)), node = beside(Vec3(1, 1, 1));
    CHECK(edge.report.split_edges.count == 2);
    CHECK(edge.report.split_nodes.count == 3);
    CHECK(node.report.split_edges.count == 0);
    CHECK(node.report.split_nodes.count == 1);
    for (const auto* r : {&edge, &node}) {
      const auto t = mesh::topology(r->surface);
      CHECK(t.closed());
      CHECK(t.components.size() == 2);
      CHECK(mesh::enclosed_volume(r->surface) > 1.98);
      CHECK(meshing::self_intersections(r->surface, 1).empty());
    }
    // the same from inside: a block of voids is one body with two cavities that touch
    auto outer = test::box_surface(1, Vec3(4, 4, 4));
    outer.nodes.array() -= 1;
    auto second = box;
    second.nodes.colwise() += Vec3(1, 1, 0);
    auto all = test::joined(test::joined(box, second), outer);
    all.region.clear(), all.region_names.clear();
    const auto cavities = meshing::repair(all);
    CHECK(cavities.report.parts_turned.count == 1);
    CHECK(mesh::topology(cavities.surface).closed());
    CHECK(mesh::enclosed_volume(cavities.surface) == doctest::Approx(62).epsilon(0.01));
    CHECK(meshing::self_intersections(cavities.surface, 1).empty());
  }

  TEST_CASE("meshing: crossings are drawn apart and what has one side is refused") {
    auto s = test::icosphere(3);
    for (Index n = 0; n < s.node_count(); n += 97) s.nodes.col(n) *= -1.05;
    const auto fixed = meshing::repair(s);
    MESSAGE(fixed.report.crossings_before, " crossing pairs, ", fixed.report.crossings_after, " left");
    CHECK(fixed.report.crossings_before > 0);
    CHECK(fixed.report.crossings_after == 0);
    CHECK(meshing::self_intersections(fixed.surface, 1).empty());
    mesh::Surface strip;  // of Moebius
    constexpr int n = 12;
    strip.nodes.resize(3, 2 * n);
    strip.cells.resize(3, 2 * n);
    for (Index i = 0; i < n; ++i) {
      const double a = 2 * std::numbers::pi * i / n;
      for (Index k = 0; k < 2; ++k) {
        const double r = 0.3 * (k == 0 ? -1 : 1);
        strip.nodes.col(2 * i + k) << (1 + r * std::cos(a / 2)) * std::cos(a),
            (1 + r * std::cos(a / 2)) * std::sin(a), r * std::sin(a / 2);
      }
      const Index p = 2 * i, q = p + 1, u = i + 1 < n ? p + 2 : 1, v = i + 1 < n ? p + 3 : 0;
      strip.cells.col(2 * i) << p, q, v;
      strip.cells.col(2 * i + 1) << p, v, u;
    }
    std::string refusal;
    try {
      (void)meshing::repair(strip);
    } catch (const MeshError& e) {
      refusal = e.what();
    }
    CHECK(refusal.find("one side only: facets cannot agree across the edge from (") != std::string::npos);
  }

  TEST_CASE("meshing: spheres spoilt at random come back closed") {
    Index closed = 0, crossing = 0;
    constexpr Index cases = 60;
    for (Index c = 0; c < cases; ++c) {
      auto s = soup(test::noisy_sphere(2, 0.1, static_cast<std::uint64_t>(c)));
      const auto noise = [&](Index i) {
        return 0.5 + 0.5 * test::node_noise(static_cast<std::uint64_t>(1000 * c + i));
      };
      std::vector<char> kept;
      const Index cells = s.cell_count();
      for (Index t = 0; t < cells; ++t) {
        kept.push_back(noise(t) > 0.04);
        if (noise(3000 + t) < 0.2) std::swap(s.cells(0, t), s.cells(1, t));
      }
      meshing::keep_facets(s, kept);
      for (Index t = 0; t < 5; ++t) {
        const auto k = static_cast<Index>(noise(5000 + t) * s.cell_count());
        add(s, {{s.cells(1, k), s.cells(0, k), s.cells(2, k)}});
      }
      const auto fixed = meshing::repair(s);
      CAPTURE(c);
      const auto t = mesh::topology(fixed.surface);
      closed += t.closed() && t.genus() == 0;
      crossing += fixed.report.crossings_after > 0;
    }
    MESSAGE(closed, " of ", cases, " closed, ", crossing, " with crossings left");
    CHECK(closed == cases);
    CHECK(crossing == 0);
  }

  TEST_CASE("meshing: the faces of random voxels become closed manifolds") {
    // squares between inside and outside: many edges of four facets, many nodes of several fans
    Index edges = 0, nodes = 0, crossing = 0, parts = 0;
    std::size_t drawn_apart = 0;
    double least_volume = 1;
    constexpr int seeds = 20, n = 10;
    for (int seed = 0; seed < seeds; ++seed) {
      const auto inside = [&](int i, int j, int k) {
        return std::min({i, j, k}) >= 0 && std::max({i, j, k}) < n &&
               test::node_noise(static_cast<std::uint64_t>(((seed * n + i) * n + j) * n + k)) > 0;
      };
      test::SurfaceBuilder b;
      double volume = 0;
      const auto square = [&](const Vec3& o, const Vec3& u, const Vec3& v) {  // turns about u x v
        const Index p = b.node(o), q = b.node(o + u), r = b.node(o + u + v), w = b.node(o + v);
        b.triangles.push_back({p, q, r}), b.triangles.push_back({p, r, w});
      };
      for (int i = -1; i < n; ++i)
        for (int j = -1; j < n; ++j)
          for (int k = -1; k < n; ++k) {
            volume += inside(i, j, k);
            const Vec3 o(i + 1, j + 1, k + 1), x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
            const auto wall = [&](bool here, bool there, const Vec3& at, const Vec3& u, const Vec3& v) {
              if (here && !there) square(at, u, v);
              if (there && !here) square(at, v, u);
            };
            wall(inside(i, j, k), inside(i + 1, j, k), Vec3(o[0], o[1] - 1, o[2] - 1), y, z);
            wall(inside(i, j, k), inside(i, j + 1, k), Vec3(o[0] - 1, o[1], o[2] - 1), z, x);
            wall(inside(i, j, k), inside(i, j, k + 1), Vec3(o[0] - 1, o[1] - 1, o[2]), x, y);
          }
      const auto fixed = meshing::repair(b.surface());
      const auto t = mesh::topology(fixed.surface);
      CAPTURE(seed);
      CHECK(t.closed());
      CHECK(fixed.report.filled.empty());
      CHECK(mesh::enclosed_volume(fixed.surface) == doctest::Approx(volume).epsilon(0.2));
      edges += fixed.report.split_edges.count, nodes += fixed.report.split_nodes.count;
      crossing += fixed.report.crossings_after > 0;
      drawn_apart += fixed.report.crossings_before;
      least_volume = std::min(least_volume, mesh::enclosed_volume(fixed.surface) / volume);
      parts += static_cast<Index>(t.components.size());
    }
    MESSAGE(seeds, " sets of voxels: ", edges, " edges and ", nodes, " nodes parted, ", parts, " parts, ",
            crossing, " with crossings left of ", drawn_apart, " pairs; ", least_volume,
            " of the volume or more");
    CHECK(edges > 0);
    CHECK(crossing == 0);
  }
}
