// SPDX-License-Identifier: MIT
// The parts of the filler, each by the property that the others rely on.
#include "support/surfaces.hpp"
#include "tunica/core/vec.hpp"
#include "tunica/meshing/cavity_flips.hpp"
#include "tunica/meshing/cavity_insert.hpp"
#include "tunica/meshing/cavity_polygon.hpp"
#include "tunica/meshing/delaunay.hpp"
#include "tunica/meshing/expansion.hpp"
#include "tunica/meshing/front_conform.hpp"
#include "tunica/meshing/front_edges.hpp"
#include "tunica/meshing/front_faces.hpp"
#include "tunica/meshing/front_inside.hpp"
#include "tunica/meshing/front_recovery.hpp"
#include "tunica/meshing/front_release.hpp"
#include "tunica/meshing/front_surface.hpp"
#include "tunica/meshing/hilbert.hpp"
#include "tunica/meshing/improve.hpp"
#include "tunica/meshing/improve_insert.hpp"
#include "tunica/meshing/improve_mesh.hpp"
#include "tunica/meshing/improve_smooth.hpp"
#include "tunica/meshing/size_field.hpp"
#include "tunica/meshing/tet_complex.hpp"
#include "tunica/meshing/tet_quality.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

using namespace tunica;
using namespace tunica::meshing;

namespace {

std::vector<Vec3> random_points(int count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<Vec3> points;
  for (int i = 0; i < count; ++i) {
    const double x = uniform(random), y = uniform(random), z = uniform(random);
    points.emplace_back(x, y, z);
  }
  return points;
}

/// Six times the volume; every tetrahedron is positive and neighbours know each other.
double checked_volume(const TetComplex& c) {
  double volume = 0;
  for (Index t = 0; t < c.size(); ++t) {
    if (!c.alive(t)) continue;
    const double v = c.orient(c.nodes(t));
    CHECK(v > 0);
    volume += v;
    for (int f = 0; f < 4; ++f) {
      const Side s = c.across(t, f);
      if (s < 0) continue;
      CHECK(c.across(s) == 4 * t + f);
      Triple mine = c.face(t, f), theirs = c.face(s / 4, s % 4);
      std::sort(mine.begin(), mine.end()), std::sort(theirs.begin(), theirs.end());
      CHECK(mine == theirs);
    }
  }
  return volume;
}

/// Tetrahedra whose circumsphere has another point inside.
int not_delaunay(const TetComplex& c) {
  int count = 0;
  for (Index t = 0; t < c.size(); ++t) {
    if (!c.alive(t)) continue;
    const Quad& n = c.nodes(t);
    for (std::size_t p = 0; p < c.points.size(); ++p)
      if (!c.has(t, static_cast<Index>(p)) &&
          insphere(c.point(n[0]), c.point(n[1]), c.point(n[2]), c.point(n[3]), c.points[p]) > 0)
        ++count;
  }
  return count;
}

double worst_quality(const TetComplex& c) {
  double least = 2;
  for (Index t = 0; t < c.size(); ++t)
    if (c.alive(t)) {
      const Quad& n = c.nodes(t);
      least = std::min(least, sine_quality(c.point(n[0]), c.point(n[1]), c.point(n[2]), c.point(n[3])));
    }
  return least;
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("meshing: expansions are exact sums and products") {
    __extension__ typedef __int128 Whole;
    const auto value = [](const auto& e) {
      Whole sum = 0;
      for (std::size_t i = 0; i < e.size; ++i) {
        CHECK(e.part[i] != 0);
        if (i > 0) CHECK(std::abs(e.part[i]) > std::abs(e.part[i - 1]));
        sum += static_cast<Whole>(e.part[i]);
      }
      return sum;
    };
    std::mt19937_64 random(7);
    for (int round = 0; round < 200; ++round) {
      const auto number = [&] {  // of all magnitudes up to 2^52
        const auto bits = static_cast<std::int64_t>(random() >> (12 + random() % 50));
        return static_cast<double>(random() % 2 == 0 ? bits : -bits);
      };
      const double a = number(), b = number(), c = number(), d = number();
      const auto whole = [](double x) { return static_cast<Whole>(x); };
      const auto ab = difference(a, b), cd = difference(c, d);
      CHECK((value(ab) == whole(a) - whole(b)));
      CHECK((value(ab + cd) == whole(a) - whole(b) + whole(c) - whole(d)));
      CHECK((value(ab - cd) == whole(a) - whole(b) - whole(c) + whole(d)));
      CHECK((value(ab * c) == (whole(a) - whole(b)) * whole(c)));
      CHECK((value(ab * cd) == (whole(a) - whole(b)) * (whole(c) - whole(d))));
      const auto product = two_product(a, b);
      CHECK((whole(product.hi) + whole(product.lo) == whole(a) * whole(b)));
      const double estimate = (ab * cd).estimate();
      const Whole exact = (whole(a) - whole(b)) * (whole(c) - whole(d));
      CHECK((estimate > 0) - (estimate < 0) == (exact > 0) - (exact < 0));
    }
  }

  TEST_CASE("meshing: a curve of Hilbert goes from neighbour to neighbour") {
    constexpr std::uint32_t side = 8;
    std::vector<std::pair<std::uint64_t, std::array<std::uint32_t, 3>>> along;
    for (std::uint32_t i = 0; i < side; ++i)
      for (std::uint32_t j = 0; j < side; ++j)
        for (std::uint32_t k = 0; k < side; ++k) along.push_back({hilbert_index({i, j, k}), {i, j, k}});
    std::sort(along.begin(), along.end());
    for (std::size_t n = 1; n < along.size(); ++n) {
      CHECK(along[n].first == along[n - 1].first + 1);
      int steps = 0;
      for (std::size_t a = 0; a < 3; ++a)
        steps += std::abs(static_cast<int>(along[n].second[a]) - static_cast<int>(along[n - 1].second[a]));
      CHECK(steps == 1);
    }
    const auto points = random_points(500, 3);
    Box box;
    for (const Vec3& x : points) box.extend(x);
    auto order = insertion_order(points, points.size(), box);
    std::sort(order.begin(), order.end());
    for (std::size_t n = 0; n < order.size(); ++n) CHECK(order[n] == static_cast<Index>(n));
  }

  TEST_CASE("meshing: a triangulation of Delaunay has empty spheres also where points are cospherical") {
    std::vector<Vec3> grid;
    for (int n = 0; n < 125; ++n) grid.emplace_back(n % 5, n / 5 % 5, n / 25);
    for (const auto& points : {random_points(150, 1), grid}) {
      TetComplex c;
      c.points = points;
      Delaunay delaunay(c);
      REQUIRE(c.points.size() == points.size() + 4);
      const auto at = [&](std::size_t i) { return static_cast<Index>(points.size() + i); };
      const double whole = c.orient(at(0), at(1), at(2), at(3));
      CHECK(checked_volume(c) == doctest::Approx(whole).epsilon(1e-12));
      CHECK(not_delaunay(c) == 0);
      delaunay.insert(c.add_point({0.4321, 0.531, 0.611}));
      CHECK(not_delaunay(c) == 0);
      CHECK(checked_volume(c) == doctest::Approx(whole).epsilon(1e-12));
    }
    TetComplex twice;
    twice.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0}};
    CHECK_THROWS_WITH_AS(Delaunay{twice}, doctest::Contains("coincide"), MeshError);
  }

  TEST_CASE(
      "meshing: the quality of a tetrahedron is 1 for the regular one and its sines are those of its "
      "angles") {
    const Vec3 a(1, 1, 1), b(-1, 1, -1), c(1, -1, -1), d(-1, -1, 1);
    REQUIRE(orient3d(a, b, c, d) > 0);
    CHECK(mean_ratio(a, b, c, d) == doctest::Approx(1).epsilon(1e-14));
    for (const double angle : dihedral_angles(a, b, c, d))
      CHECK(angle == doctest::Approx(std::acos(1.0 / 3)).epsilon(1e-14));
    CHECK(sine_quality(b, a, c, d) == -1);
    CHECK(mean_ratio(b, a, c, d) == 0);
    const auto p = random_points(80, 5);
    for (std::size_t i = 0; i + 3 < p.size(); i += 4) {
      if (!(orient3d(p[i], p[i + 1], p[i + 2], p[i + 3]) > 0)) continue;
      double least = 2;
      for (const double angle : dihedral_angles(p[i], p[i + 1], p[i + 2], p[i + 3]))
        least = std::min(least, std::sin(angle));
      CHECK(sine_quality(p[i], p[i + 1], p[i + 2], p[i + 3]) == doctest::Approx(least).epsilon(1e-10));
    }
  }

  TEST_CASE("meshing: the best triangulation of a polygon is that of a search through all") {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> uniform(0.05, 1);
    for (int corners = 3; corners <= 8; ++corners) {
      std::vector<double> table(512);
      for (double& q : table) q = uniform(random);
      const auto quality = [&](int i, int k, int j) {
        return table[static_cast<std::size_t>(64 * i + 8 * k + j)];
      };
      const auto search = [&](const auto& self, int i, int j) -> double {
        if (j - i < 2) return 2;
        double best = -1;
        for (int k = i + 1; k < j; ++k)
          best = std::max(best, std::min({self(self, i, k), self(self, k, j), quality(i, k, j)}));
        return best;
      };
      CavityPolygon polygon;
      const double best = polygon.triangulate(corners, 0, quality);
      CHECK(best == search(search, 0, corners - 1));
      REQUIRE(polygon.triangles.size() == static_cast<std::size_t>(corners - 2));
      double worst = 2;
      for (const auto& [i, k, j] : polygon.triangles) worst = std::min(worst, quality(i, k, j));
      CHECK(worst == best);
      CHECK(polygon.triangulate(corners, 1, quality) == -1);
      CHECK(polygon.triangles.empty());
    }
  }

  TEST_CASE("meshing: flips and splits and insertions fill the same place") {
    TetComplex c;
    c.points = random_points(40, 2);
    const Delaunay delaunay(c);
    const double whole = checked_volume(c);
    CavityFlips flips(c);
    int flipped = 0, removed = 0;
    for (Index t = 0; t < c.size() && flipped < 10; ++t)
      for (int f = 0; f < 4; ++f) {
        if (!c.alive(t) || c.across(t, f) < 0) continue;
        const Index u = c.nodes(t)[static_cast<std::size_t>(f)];
        const Index w = c.nodes(c.across(t, f) / 4)[static_cast<std::size_t>(c.across(t, f) % 4)];
        if (!flips.face_to_edge(t, f)) continue;
        ++flipped;
        CHECK(checked_volume(c) == doctest::Approx(whole).epsilon(1e-12));
        const Index with = c.tet_with(u, w, flips.scratch);
        REQUIRE(with >= 0);
        removed += flips.remove_edge(with, u, w, 0, [](Index, Index) { return true; });
        CHECK(c.tet_with(u, w, flips.scratch) == -1);
      }
    CHECK(flipped > 0);
    CHECK(removed == flipped);
    Index t = 0;
    while (!c.alive(t) || c.across(t, 0) < 0) ++t;
    const Quad n = c.nodes(t);
    const Index p = c.add_point(vec::between(c.point(n[0]), c.point(n[1]), 0.5));
    const auto with_edge = [&](Index a, Index b) {
      int count = 0;
      for (Index e = 0; e < c.size(); ++e) count += c.alive(e) && c.has(e, a) && c.has(e, b);
      return count;
    };
    const int around = with_edge(n[0], n[1]);
    REQUIRE(around >= 3);
    CHECK_FALSE(flips.split_edge(t, n[0], n[1], p, 1));  // no sine is larger
    CHECK(with_edge(n[0], n[1]) == around);
    CHECK(c.tet_of[static_cast<std::size_t>(p)] == -1);
    const double worst = worst_quality(c);
    CHECK(flips.split_edge(t, n[0], n[1], p));
    CHECK(worst > 0);
    CHECK(with_edge(n[0], n[1]) == 0);
    CHECK(with_edge(n[0], p) == around);
    CHECK(with_edge(p, n[1]) == around);
    CHECK(with_edge(p, p) == 2 * around);
    CHECK(checked_volume(c) == doctest::Approx(whole).epsilon(1e-12));

    const FrontSurface none(test::icosphere(0).nodes, test::icosphere(0).cells);
    CavityInsert insert(c, none);
    const Vec3 x(0.48, 0.51, 0.53);
    const Index home = containing(c, x, c.tet_of[0]);
    REQUIRE(home >= 0);
    for (int f = 0; f < 4; ++f) {
      const Triple m = c.face(home, f);
      CHECK(orient3d(c.point(m[0]), c.point(m[1]), c.point(m[2]), x) <= 0);
    }
    const std::array<Index, 1> seed{home};
    constexpr double floor = 1e-9;
    const std::size_t points = c.points.size();
    CHECK(insert.insert(x, seed, 1) == -1);  // no sine is larger
    CHECK(c.points.size() == points);
    CHECK(c.alive(home));
    const Index node = insert.insert(x, seed, floor);
    CHECK(node == static_cast<Index>(points));
    CHECK(c.points.size() == points + 1);
    CHECK(c.points.back() == x);
    int there = 0;
    for (Index e = 0; e < c.size(); ++e) {
      if (!c.alive(e) || !c.has(e, node)) continue;
      const Quad& m = c.nodes(e);
      CHECK(sine_quality(c.point(m[0]), c.point(m[1]), c.point(m[2]), c.point(m[3])) > floor);
      ++there;
    }
    CHECK(there >= 4);
    for (const Index m : n) CHECK(c.tet_of[static_cast<std::size_t>(m)] >= 0);  // none is swallowed
    CHECK(checked_volume(c) == doctest::Approx(whole).epsilon(1e-12));
  }

  TEST_CASE("meshing: the surface of the filler knows its edges and triangles and who owns a point") {
    const auto s = test::icosphere(2);
    FrontSurface f(s.nodes, s.cells);
    CHECK(f.edges.size() == static_cast<std::size_t>(s.cell_count()) * 3 / 2);
    for (std::size_t t = 0; t < f.triangles.size(); ++t) {
      const Triple n = f.triangles[t];
      CHECK(f.triangle_of({n[2], n[0], n[1]}) == static_cast<Index>(t));
      for (std::size_t i = 0; i < 3; ++i) {
        const auto& e = f.edges[static_cast<std::size_t>(f.triangle_edges[t][i])];
        CHECK(e.triangles[n[i] < n[(i + 1) % 3] ? 0 : 1] == static_cast<Index>(t));
        CHECK(f.locked(n[i], n[(i + 1) % 3]));
      }
    }
    const Index point = f.nodes + 5, other = f.nodes + 6;
    CHECK(f.edge_between(0, point) == -1);
    f.own(point, {.edge = f.triangle_edges[7][1]});
    CHECK(f.on(point, 7));
    CHECK_FALSE(f.on(other, 7));
    f.lock_piece(other, point);
    CHECK(f.locked(point, other));
    f.unlock_piece(point, other);
    CHECK_FALSE(f.locked(point, other));
    f.disown(point);
    CHECK_FALSE(f.on(point, 7));
  }

  TEST_CASE("meshing: each way to recover a surface ends with the surface as its border") {
    using Way = FrontRecovery::Way;
    for (const Way way : {Way::forward, Way::backward, Way::halving})
      for (const auto& s : {test::schoenhardt_prism(0.4), test::noisy_sphere(2, 0.2, 3),
                            test::joined(test::icosphere(2), test::reversed(test::icosphere(2, 0.5)))}) {
        const FrontSurface front(s.nodes, s.cells);
        std::vector<Vec3> nodes;
        for (Index n = 0; n < s.node_count(); ++n) nodes.push_back(vec::column(s.nodes, n));
        TetComplex c;
        (void)FrontRecovery::run(c, front, nodes, {}, way);
        std::vector<Index> met;
        for (Index t = 0; t < c.size(); ++t)
          for (int f = 0; c.alive(t) && f < 4; ++f)
            if (c.across(t, f) < 0) met.push_back(front.triangle_of(c.face(t, f)));
        std::sort(met.begin(), met.end());
        REQUIRE(met.size() == front.triangles.size());
        for (std::size_t t = 0; t < met.size(); ++t) CHECK(met[t] == static_cast<Index>(t));
        double bounded = 0;
        for (const Triple& t : front.triangles)
          bounded += orient3d(nodes[static_cast<std::size_t>(t[0])], nodes[static_cast<std::size_t>(t[1])],
                              nodes[static_cast<std::size_t>(t[2])], Vec3(0, 0, 0));
        CHECK(checked_volume(c) == doctest::Approx(-bounded).epsilon(1e-12));
      }
  }

  TEST_CASE("meshing: improvement makes the worst no worse and leaves what is held") {
    TetComplex c;
    c.points = random_points(120, 4);
    const Delaunay delaunay(c);
    const double whole = checked_volume(c), before = worst_quality(c);
    Improve::flip(c, 0.3);
    const double flipped = worst_quality(c);
    CHECK(flipped >= before);
    CHECK(checked_volume(c) == doctest::Approx(whole).epsilon(1e-12));
    std::vector<char> held(c.points.size(), 0);
    for (std::size_t n = 0; n < held.size(); n += 2) held[n] = 1;
    std::fill(held.end() - 4, held.end(), char{1});  // the corners of the whole
    const auto places = c.points;
    Improve::loosen(c, held, 0.3);
    CHECK(worst_quality(c) >= flipped);
    CHECK(checked_volume(c) == doctest::Approx(whole).epsilon(1e-12));
    Index moved = 0;
    for (std::size_t n = 0; n < held.size(); ++n) {
      if (held[n] != 0) CHECK(c.points[n] == places[n]);
      if (held[n] != 0) CHECK(c.tet_of[n] >= 0);
      moved += c.points[n] != places[n];
    }
    MESSAGE("least sine of 120 random points " << before << ", flipped " << flipped << ", loosened "
                                               << worst_quality(c) << ", " << moved << " nodes moved");
    CHECK(moved > 0);
  }

  TEST_CASE("meshing: the size that a surface carries inside grows no faster than it is told") {
    const auto s = test::icosphere(3);
    for (const double growth : {0.0, 0.3}) {
      const SurfaceSize size(s.nodes, s.cells, growth);
      const double at_surface = size.node_sizes()[0];
      CHECK(at_surface == doctest::Approx(0.14).epsilon(0.2));
      CHECK(size({0, 0, 0}) == doctest::Approx(at_surface + growth).epsilon(0.2));
      const auto points = random_points(200, 6);
      for (std::size_t i = 0; i + 1 < points.size(); i += 2) {
        const Vec3 x = vec::minus(vec::scaled(2.4, points[i]), {1.2, 1.2, 1.2});
        const Vec3 y = vec::along(x, 0.05, points[i + 1]);
        const auto near = size.nearest(x);
        const double depth = 1 - vec::length(x);
        CHECK(std::abs(near.distance - std::abs(depth)) < 0.01);  // the sagitta of the triangles is 0.003
        if (std::abs(depth) > 0.01) CHECK(near.inside == (depth > 0));
        // sizes on the sphere differ by little: what is left over distance is the growth
        CHECK(std::abs(size(x) - size(y)) <= growth * vec::distance(x, y) + 0.03);
      }
    }
  }
}
