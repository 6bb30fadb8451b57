// SPDX-License-Identifier: MIT
// The parts that smoothing, cutting and remeshing share: flat regions, sections, caps, edits, volumes.
#include "tunica/meshing/cap.hpp"
#include "tunica/meshing/cut_snap.hpp"
#include "tunica/meshing/cut_split.hpp"
#include "tunica/meshing/edit_flips.hpp"
#include "tunica/meshing/edit_kinds.hpp"
#include "tunica/meshing/editable_surface.hpp"
#include "tunica/meshing/facets.hpp"
#include "tunica/meshing/flat_regions.hpp"
#include "tunica/meshing/folds.hpp"
#include "tunica/meshing/keep_volume.hpp"
#include "tunica/meshing/orient.hpp"
#include "tunica/meshing/restore_volume.hpp"
#include "tunica/meshing/section.hpp"
#include "tunica/meshing/surface_target.hpp"
#include "tunica/meshing/triangle_grid.hpp"
#include "tunica/meshing/wear.hpp"

#include "tunica/mesh/solid_angle.hpp"
#include "tunica/mesh/topology.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

using namespace tunica;

namespace {

/// The surface of n x n x n unit cells cut in triangles, outward; the top is region 1, "lid".
mesh::Surface cube(Index n) {
  mesh::Surface s;
  s.region_names = {"wall", "lid"};
  std::vector<Vec3> nodes;
  const auto number = [&](const Vec3& x) {
    for (std::size_t i = 0; i < nodes.size(); ++i)
      if (nodes[i] == x) return static_cast<Index>(i);
    nodes.push_back(x);
    return static_cast<Index>(nodes.size()) - 1;
  };
  std::vector<std::array<Index, 3>> cells;
  for (int axis = 0; axis < 3; ++axis)
    for (const bool high : {false, true})
      for (Index j = 0; j < n; ++j)
        for (Index i = 0; i < n; ++i) {
          const auto at = [&](Index u, Index v) {
            Vec3 x(0, 0, 0);
            x[axis] = high ? n : 0, x[(axis + 1) % 3] = u, x[(axis + 2) % 3] = v;
            return number(x);
          };
          std::array<Index, 4> c{at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)};
          if (!high) std::swap(c[1], c[3]);
          for (const auto& t : {std::array{c[0], c[1], c[2]}, std::array{c[0], c[2], c[3]}}) {
            cells.push_back(t);
            s.region.push_back(axis == 2 && high ? 1 : 0);
          }
        }
  s.nodes = vec::columns(nodes);
  s.cells.resize(3, static_cast<Index>(cells.size()));
  for (std::size_t t = 0; t < cells.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) s.cells(static_cast<Index>(k), static_cast<Index>(t)) = cells[t][k];
  return s;
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("meshing: flat regions bind their nodes to the plane and the rim") {
    const auto s = cube(3);
    REQUIRE(mesh::topology(s).closed());
    CHECK(mesh::enclosed_volume(s) == doctest::Approx(27).epsilon(1e-14));
    const auto planes = meshing::flat_regions(s);
    REQUIRE(planes.size() == 2);
    CHECK_FALSE(planes[0]);
    REQUIRE(planes[1]);
    CHECK(planes[1]->normal == Vec3(0, 0, 1));
    CHECK(planes[1]->distance({9, 9, 4}) == doctest::Approx(1));
    CHECK(planes[1]->projected({1, 2, 5}) == Vec3(1, 2, 3));
    const auto b = meshing::bonds(s, planes);
    for (Index n = 0; n < s.node_count(); ++n) {
      const Vec3 x = mesh::node(s, n);
      const bool top = x[2] == 3, edge = x[0] == 0 || x[0] == 3 || x[1] == 0 || x[1] == 3;
      CHECK(b.of(n) == (!top ? meshing::Bond::none : edge ? meshing::Bond::rim : meshing::Bond::plane));
      if (b.of(n) == meshing::Bond::rim)
        for (const Index m : b.along[static_cast<std::size_t>(n)])
          CHECK(vec::distance(mesh::node(s, m), x) == doctest::Approx(1));
    }
  }

  TEST_CASE("meshing: facets part a cube at its sharp edges and a target answers on each") {
    const auto s = cube(3);
    CHECK(meshing::facets(s, 180).region.size() == 2);
    const auto f = meshing::facets(s, 60);
    CHECK(f.region.size() == 6);
    for (const auto& plane : f.planes) CHECK(plane.has_value());
    const meshing::SurfaceTarget target(s, f);
    for (Index t = 0; t < s.cell_count(); ++t) {
      const auto triangle = mesh::triangle(s, t);
      const Vec3 n = vec::unit(triangle.area_vector()), c = triangle.centroid();
      const auto hit = target.nearest(vec::along(c, 0.4, n), f.of[static_cast<std::size_t>(t)]);
      CHECK(vec::distance(hit.point, c) < 1e-14);
      CHECK(vec::dot(hit.normal, n) == doctest::Approx(1));
    }
    const Index lid = f.of[static_cast<std::size_t>(s.cell_count()) - 1];
    Index side = -1;  // the facet x = 0
    for (Index t = 0; t < s.cell_count(); ++t)
      if (mesh::triangle(s, t).centroid()[0] == 0) side = f.of[static_cast<std::size_t>(t)];
    REQUIRE(side >= 0);
    CHECK(vec::distance(target.nearest_on_rim({-0.3, 1.3, 3.4}, std::min(side, lid), std::max(side, lid)),
                        {0, 1.3, 3}) < 1e-14);
  }

  TEST_CASE("meshing: a section of a cube is one square whose cap has its area") {
    const auto s = cube(4);
    const Vec3 point(1, 1.5, 1.25), normal(0, 0, 1);
    const meshing::PlaneFrame frame(point, normal);
    CHECK(vec::cross(frame.u, frame.v) == normal);
    CHECK(frame.place(frame({2, 3, 1.25})) == Vec3(2, 3, 1.25));
    std::vector<double> distance;
    for (Index n = 0; n < s.node_count(); ++n) distance.push_back(mesh::node(s, n)[2] - point[2]);
    const auto twin = mesh::twins(s.cells, s.node_count());
    const auto parts = meshing::sections(s, twin, distance, frame);
    REQUIRE(parts.size() == 1);
    CHECK(parts[0].triangles.size() == 32);
    CHECK(parts[0].nearest == 0);
    CHECK(parts[0].farthest == doctest::Approx(std::hypot(3, 2.5)));
    CHECK(parts[0].centre[2] == doctest::Approx(1.25));

    std::vector<mesh::HalfEdge> open;  // the cube without its top: the rim as its triangles run it
    for (Index h = 0; h < static_cast<Index>(twin.size()); ++h)
      if (s.region_of(h / 3) == 0 && s.region_of(twin[static_cast<std::size_t>(h)] / 3) == 1)
        open.push_back(mesh::half_edge(s.cells, h));
    REQUIRE(open.size() == 16);
    double area = 0;
    for (const auto& t : meshing::caps(s.nodes, open, {0, 0, 4}, normal)) {
      const mesh::Triangle f{mesh::node(s, t[0]), mesh::node(s, t[1]), mesh::node(s, t[2])};
      CHECK(vec::dot(f.area_vector(), normal) > 0);
      area += f.area();
    }
    CHECK(area == doctest::Approx(16).epsilon(1e-14));
    open.pop_back();
    CHECK_THROWS_AS((void)meshing::caps(s.nodes, open, {0, 0, 4}, normal), MeshError);
  }

  TEST_CASE("meshing: a cap lies in its plane as far as single precision tells") {
    auto s = cube(3);
    s.nodes *= 1.1;
    const auto planes = meshing::flat_regions(s);
    REQUIRE(planes.size() == 2);
    CHECK_FALSE(planes[0]);  // the wall
    REQUIRE(planes[1]);
    CHECK(vec::distance(planes[1]->normal, {0, 0, 1}) < 1e-14);
    CHECK(vec::distance(planes[1]->point, {1.65, 1.65, 3.3}) < 1e-13);
    s.nodes = s.nodes.cast<float>().cast<double>().eval();
    CHECK(meshing::flat_regions(s)[1]);
    for (Index n = 0; n < s.node_count(); ++n)
      if (s.nodes(2, n) > 3) s.nodes(2, n) += 1e-3 * s.nodes(0, n) * s.nodes(0, n);
    CHECK_FALSE(meshing::flat_regions(s)[1]);
  }

  TEST_CASE("meshing: nodes beside a cut are moved onto it and what is kept is closed") {
    const auto s = cube(4);
    for (const double height : {2.95, 2.5}) {  // a twentieth above the nodes; between them
      const meshing::Plane plane{{0, 0, height}, {0, 0, 1}};
      meshing::detail::Splitter split(s, plane);
      split.split(std::vector<char>(static_cast<std::size_t>(s.cell_count()), 1), {});
      CHECK((split.snapped() > 0) == (height == 2.95));
      mesh::Surface none;
      CHECK_THROWS_AS((void)split.pinched(), ContractError);  // no side is chosen yet
      CHECK_THROWS_AS((void)split.close(none), ContractError);
      split.keep_behind();
      CHECK(split.pinched().empty());
      mesh::Surface kept;
      const Index first_of_cap = split.close(kept);
      CHECK(mesh::topology(kept).closed());
      CHECK(mesh::enclosed_volume(kept) == doctest::Approx(16 * height).epsilon(1e-12));
      double cap = 0;
      for (Index t = first_of_cap; t < kept.cell_count(); ++t) cap += mesh::triangle(kept, t).area();
      CHECK(cap == doctest::Approx(16));
    }
  }

  TEST_CASE("meshing: a fold is the angle at which triangles meet and no edit sharpens it beyond a limit") {
    using Patch = std::vector<std::array<Index, 3>>;
    const Patch hinge{{0, 1, 2}, {1, 0, 3}};
    for (const double degrees : {180.0, 90.0, 30.0, 0.5}) {
      const double angle = degrees * std::numbers::pi / 180;
      const std::array<Vec3, 4> x{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0.4, 1, 0),
                                  Vec3(0.7, 2 * std::cos(angle), 2 * std::sin(angle))};
      const auto position = [&](Index n) { return x[static_cast<std::size_t>(n)]; };
      // the other sides of the patch are level with it
      const auto level = [&](Index a, Index b) { return a + b == 3 ? Patch::value_type{a, b, 2} : hinge[0]; };
      const Patch one{hinge[0]};
      const auto other = [&](Index, Index) { return hinge[1]; };
      CHECK(meshing::sharpest_fold(one, position, other) == doctest::Approx(std::cos(angle)).epsilon(1e-12));
      CHECK(meshing::sharpest_fold(hinge, position, level) >= std::cos(angle) - 1e-12);
    }
    const auto nowhere = [](Index) { return Vec3(1, 2, 3); };
    CHECK(meshing::sharpest_fold(hinge, nowhere, [&](Index, Index) { return hinge[0]; }) == 1);

    // the top of a low pyramid may be lowered to 5 degrees, not to less
    mesh::Surface s;
    s.nodes.resize(3, 5), s.cells.resize(3, 6);
    s.nodes << 0, 2, 2, 0, 1, 0, 0, 2, 2, 1, 0, 0, 0, 0, 1;
    s.cells << 0, 1, 2, 3, 0, 0, 1, 2, 3, 0, 2, 3, 4, 4, 4, 4, 1, 2;
    s.region = {0, 0, 0, 0, 1, 1}, s.region_names = {"wall", "ground"};
    REQUIRE(mesh::topology(s).closed());
    meshing::EditableSurface edit(s, meshing::facets(s, 180), 1.0);
    CHECK(edit.move(4, {1, 1, 0.5}));
    CHECK(edit.move(4, {1, 1, 0.1}));  // atan(0.1) = 5.7 degrees
    CHECK_FALSE(edit.move(4, {1, 1, 0.08}));
    CHECK_FALSE(edit.move(4, {1, 1, 1e-9}));
    CHECK(edit.x(4) == Vec3(1, 1, 0.1));
    CHECK(edit.left_out().folds == 2);
    s.nodes(2, 4) = 0.05;  // what is sharper at first may not get sharper still
    meshing::EditableSurface low(s, meshing::facets(s, 180), 1.0);
    CHECK(low.move(4, {1, 1, 0.06}));
    CHECK_FALSE(low.move(4, {1, 1, 0.05}));
  }

  TEST_CASE("meshing: wear is the way of the worn places and what they had lost before") {
    const auto s = cube(3);
    const auto f = meshing::facets(s, 60);
    const meshing::EditableSurface edit(s, f, 1.0);
    const auto node = [&](const Vec3& x) {
      for (Index n = 0; n < s.node_count(); ++n)
        if (vec::distance(edit.x(n), x) < 1e-12) return n;
      return Index{-1};
    };
    const Index a = node({1, 1, 3}), b = node({2, 1, 3});
    meshing::Wear wear;
    CHECK(wear.at(a) == 0);
    CHECK(wear.after(edit, a, b, edit.x(a)) < 1e-12);  // within the lid nothing is lost
    const double raised = wear.after(edit, a, b, {1.5, 1, 3.1});
    CHECK(raised > 0.01);
    CHECK(raised <= 0.1);
    wear.set(b, 0.2);
    CHECK(wear.after(edit, a, b, edit.x(a)) == doctest::Approx(0.2));
  }

  TEST_CASE("meshing: edits keep a surface closed and what would fold or cross it is left out and counted") {
    const auto s = cube(3);
    const auto f = meshing::facets(s, 60);
    meshing::EditableSurface edit(s, f, 1.0);
    const auto closed = [&] {
      const auto made = edit.surface();
      const auto t = mesh::topology(made);
      return t.closed() && t.genus() == 0 && std::abs(mesh::enclosed_volume(made) - 27) < 1e-12;
    };
    CHECK(closed());
    const auto edges = meshing::edges_of(edit, [](double l) { return l > 1.2; });  // the diagonals
    CHECK(edges.size() == 54);
    CHECK(std::is_sorted(edges.begin(), edges.end()));
    const auto e = edges.front();
    CHECK(edit.split(e.a, e.b, vec::between(edit.x(e.a), edit.x(e.b), 0.5)) == s.node_count());
    CHECK(closed());
    CHECK(meshing::has_edge(edit, e.a, s.node_count()));
    CHECK_FALSE(meshing::has_edge(edit, e.a, e.b));
    CHECK(edit.collapse(e.a, s.node_count(), edit.x(e.a)));
    CHECK(closed());
    const auto d = meshing::edges_of(edit, [](double l) { return l > 1.2; }).back();
    CHECK(edit.flip(d.a, d.b));
    CHECK(closed());
    Index inner = -1;  // in the middle of the lid
    for (Index n = 0; n < s.node_count(); ++n)
      if (vec::distance(edit.x(n), {1, 1, 3}) < 1e-12) inner = n;
    REQUIRE(inner >= 0);
    CHECK(meshing::kind_of(edit, inner) == meshing::NodeKind::facet);
    CHECK(edit.move(inner, {1.2, 0.9, 3}));
    CHECK_FALSE(edit.move(inner, {5, 1, 3}));
    CHECK(edit.left_out().folds == 1);
    CHECK_FALSE(edit.move(inner, {1, 1, -1}));  // through the bottom
    CHECK(edit.left_out().folds + edit.left_out().crosses == 2);
    CHECK(edit.x(inner) == Vec3(1.2, 0.9, 3));
    meshing::flip_to_angle(edit);
    meshing::flip_to_valence(edit);
    CHECK(closed());
  }

  TEST_CASE("meshing: a grid of triangles finds what overlaps until it is removed") {
    Box all;
    all.extend(Vec3(0, 0, 0)), all.extend(Vec3(10, 10, 10));
    meshing::TriangleGrid grid(all, 1.0);
    for (Index i = 0; i < 10; ++i) {
      Box b;
      b.extend(Vec3(i, i, i)), b.extend(Vec3(i + 0.5, i + 2.5, i + 0.5));
      grid.add(i, b);
    }
    Box query;
    query.extend(Vec3(3, 3, 3)), query.extend(Vec3(4.2, 4.2, 4.2));
    const auto found = [&] {
      std::vector<Index> items;
      (void)grid.any(query, [&](Index i) {
        items.push_back(i);
        return false;
      });
      std::sort(items.begin(), items.end());
      return items;
    };
    CHECK(found() == std::vector<Index>{3, 4});
    CHECK(grid.any(query, [](Index i) { return i == 4; }));
    grid.remove(3);
    CHECK(found() == std::vector<Index>{4});
  }

  TEST_CASE("meshing: the cubic of an offset is the volume and restores it with flat parts in place") {
    auto s = cube(3);
    Points<3> outward = Points<3>::Zero(3, s.node_count());
    for (Index n = 0; n < s.node_count(); ++n)
      vec::set_column(outward, n, vec::minus(mesh::node(s, n), {1.5, 1.5, 1.5}));
    const std::vector<Index> one(static_cast<std::size_t>(s.cell_count()), 0);
    const auto cubic = meshing::volume_cubics(s.cells, s.nodes, outward, one, 1, Vec3(1.5, 1.5, 1.5)).front();
    for (const double d : {-0.1, 0.0, 0.2})  // scaled about the centre by 1 + d
      CHECK(cubic.at(d) / 6 == doctest::Approx(27 * std::pow(1 + d, 3)).epsilon(1e-13));
    CHECK(cubic.offset(6 * 27 * 1.331, 1) == doctest::Approx(0.1).epsilon(1e-13));
    CHECK(cubic.offset(6 * 27 * 8, 0.5) == 0);  // out of reach
    CHECK(meshing::restore_volume(s, 27.5, 0.2));
    CHECK(mesh::enclosed_volume(s) == doctest::Approx(27.5).epsilon(1e-13));
    for (Index t = 0; t < s.cell_count(); ++t)
      if (s.region_of(t) == 1)
        for (int k = 0; k < 3; ++k) CHECK(std::abs(s.nodes(2, s.cells(k, t)) - 3) < 1e-14);
    const auto before = s.nodes;
    CHECK_FALSE(meshing::restore_volume(s, 100, 0.2));
    CHECK(s.nodes == before);
  }

  TEST_CASE("meshing: a surface is turned outward and sees its inside under the whole sphere") {
    auto s = cube(2);
    CHECK_FALSE(meshing::orient_outward(s));
    CHECK(mesh::solid_angle(s, {0.7, 1.1, 1.9}) == doctest::Approx(4 * std::numbers::pi).epsilon(1e-13));
    CHECK(std::abs(mesh::solid_angle(s, {2.5, 1, 1})) < 1e-13);
    for (Index t = 0; t < s.cell_count(); ++t) std::swap(s.cells(0, t), s.cells(1, t));
    CHECK(mesh::solid_angle(s, {0.7, 1.1, 1.9}) == doctest::Approx(-4 * std::numbers::pi).epsilon(1e-13));
    CHECK(meshing::orient_outward(s));
    CHECK(mesh::enclosed_volume(s) == doctest::Approx(8).epsilon(1e-14));
  }
}
