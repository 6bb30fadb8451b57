// SPDX-License-Identifier: MIT
// Size fields from curvature, distance and diameter, and what remeshing and filling make of them.
#include "tunica/meshing/size_field.hpp"

#include "support/folds.hpp"
#include "support/shared.hpp"
#include "support/surfaces.hpp"
#include "support/work_cases.hpp"
#include "tunica/core/parallel.hpp"
#include "tunica/image/components.hpp"
#include "tunica/io/vtk_image.hpp"
#include "tunica/mesh/topology.hpp"
#include "tunica/meshing/curvature.hpp"
#include "tunica/meshing/cut.hpp"
#include "tunica/meshing/graded_size.hpp"
#include "tunica/meshing/marching_cubes.hpp"
#include "tunica/meshing/remesh.hpp"
#include "tunica/meshing/size_from_curvature.hpp"
#include "tunica/meshing/size_from_diameter.hpp"
#include "tunica/meshing/size_from_distance.hpp"
#include "tunica/meshing/smooth.hpp"
#include "tunica/meshing/tetrahedra.hpp"
#include "tunica/meshing/triangle_tree.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

using namespace tunica;
using meshing::Curvature;

namespace {

/// A closed surface with three flat ends: the bifurcation of the work cases on n^3 samples.
mesh::Surface cut_bifurcation(Index n) {
  auto s =
      meshing::marching_cubes(test::sampled<float>(n, [](const Vec3& x) { return -test::bifurcation(x); }), 0)
          .surface;
  (void)meshing::smooth(s);
  const std::vector<meshing::Cut> cuts{{.point = {0.5, 0.5, 0.2}, .normal = {0.02, 0.03, -2}},
                                       {.point = {0.3, 0.46, 0.78}, .normal = {-0.25, -0.05, 0.36}},
                                       {.point = {0.7, 0.55, 0.76}, .normal = {0.26, 0.07, 0.34}}};
  return meshing::cut(s, cuts).surface;
}

mesh::Surface smooth_sphere() {
  auto s =
      meshing::marching_cubes(test::sampled<float>(32, [](const Vec3& x) { return -test::sphere(x); }), 0)
          .surface;
  (void)meshing::smooth(s);
  return s;
}

/// The real bifurcation, cut at three ends; empty where the data is not there.
mesh::Surface real_bifurcation() {
  const auto path = test::shared("data/aorta_bifurcation.vtk");
  if (!path) return {};
  const auto image = io::read_vtk_image<short>(*path).image;
  const auto region = image::segment(image, {.iso = 1299.5, .seed = image::Voxel{30, 73, 15}});
  auto s = meshing::marching_cubes(image, region.mask.inside, 1299.5).surface;
  (void)meshing::smooth(s);
  const std::vector<meshing::Cut> cuts{
      {.point = {221.567, 165.000, 22.215}, .normal = {0.0011, 0.9996, -0.0283}},
      {.point = {207.554, 94.976, 33.243}, .normal = {-0.2769, -0.9166, 0.2883}},
      {.point = {237.629, 95.025, 31.872}, .normal = {0.2506, -0.8866, 0.3888}}};
  return meshing::cut(s, cuts).surface;
}

/// Sorted lengths of edges over the size at their middles.
struct Ratios {
  std::vector<double> sorted;
  [[nodiscard]] double at(double share) const {
    return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
  }
  [[nodiscard]] double within(double lo, double hi) const {
    const auto in = std::count_if(sorted.begin(), sorted.end(), [&](double r) { return r >= lo && r <= hi; });
    return static_cast<double>(in) / static_cast<double>(sorted.size());
  }
};

template <class Cells, class Edges, class Size, class Counts>
Ratios ratios(const Points<3>& nodes, const Cells& cells, const Edges& edges, const Size& size,
              Counts&& counts) {
  std::vector<std::pair<Index, Index>> all;
  for (Eigen::Index c = 0; c < cells.cols(); ++c)
    for (const auto& [i, j] : edges) {
      const std::pair<Index, Index> e{std::min(cells(i, c), cells(j, c)), std::max(cells(i, c), cells(j, c))};
      if (counts(e)) all.push_back(e);
    }
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  Ratios r;
  for (const auto& [a, b] : all) {
    const Vec3 x = nodes.col(a), y = nodes.col(b);
    r.sorted.push_back((y - x).norm() / size(Vec3(0.5 * (x + y))));
  }
  std::sort(r.sorted.begin(), r.sorted.end());
  return r;
}

constexpr std::array<std::array<int, 2>, 3> triangle_edges{{{0, 1}, {1, 2}, {2, 0}}};

/// Remeshes to a field and checks all that is promised.
template <class Size>
mesh::Surface remeshed(const std::string& name, const mesh::Surface& s, const Size& size,
                       double least_angle) {
  const auto r = meshing::remesh(s, {}, size);
  const auto lengths = ratios(r.surface.nodes, r.surface.cells, triangle_edges, size,
                              [](const std::pair<Index, Index>&) { return true; });
  double lo = std::numeric_limits<double>::infinity(), hi = 0;
  for (Index n = 0; n < r.surface.node_count(); ++n) {
    const double h = size(mesh::node(r.surface, n));
    lo = std::min(lo, h), hi = std::max(hi, h);
  }
  MESSAGE(name, ": ", r.report.triangles, " triangles of ", lo, " to ", hi, ", length over target 2.5 % ",
          lengths.at(0.025), ", median ", lengths.at(0.5), ", 97.5 % ", lengths.at(0.975),
          ", within 0.6 .. 1.5 ", lengths.within(0.6, 1.5), ", smallest angle ", r.report.smallest_angle,
          ", volume ", r.report.volume_after / r.report.volume_before - 1);
  CHECK(lengths.at(0.5) == doctest::Approx(1).epsilon(0.1));
  CHECK(lengths.within(0.6, 1.5) >= 0.95);
  CHECK(r.report.smallest_angle >= least_angle);
  CHECK(r.report.volume_after == doctest::Approx(r.report.volume_before).epsilon(1e-10));
  const auto t = mesh::topology(r.surface), t0 = mesh::topology(s);
  CHECK(t.closed());
  CHECK(t.genus() == t0.genus());
  CHECK(t.components.size() == t0.components.size());
  CHECK(meshing::self_intersections(r.surface, 1).empty());
  CHECK(test::sharpest_fold(r.surface).degrees > 20);
  CHECK(r.surface.region_names == s.region_names);
  const auto planes = meshing::flat_regions(s), planes_now = meshing::flat_regions(r.surface);
  for (std::size_t p = 0; p < planes.size(); ++p)
    if (planes[p]) {  // flat ends lie in their planes and keep their rims
      REQUIRE(planes_now[p]);
      CHECK(std::abs(planes_now[p]->normal.dot(planes[p]->normal)) == doctest::Approx(1).epsilon(1e-12));
      CHECK(mesh::area_of_region(r.surface, static_cast<Index>(p)) ==
            doctest::Approx(mesh::area_of_region(s, static_cast<Index>(p))).epsilon(0.02));
    }
  return r.surface;
}

/// Fills to a field and checks what is promised of the tetrahedra. The field is bounded near the surface by
/// the surface's own edges.
template <class Size>
void filled(const std::string& name, const mesh::Surface& s, const Size& size) {
  const auto r = meshing::tetrahedra(s, {}, size);
  const meshing::SurfaceSize own(s.nodes, s.cells, 0.3);
  const auto bounded = [&](const Vec3& x) { return std::min<double>(size(x), own(x)); };
  const auto lengths =
      ratios(r.mesh.nodes, r.mesh.cells, mesh::Tet4::edges, bounded,
             [&](const std::pair<Index, Index>& e) { return e.second >= s.node_count(); });  // not on it
  MESSAGE(name, ": ", r.report.tetrahedra, " tetrahedra, dihedral angles ", r.report.min_dihedral, " .. ",
          r.report.max_dihedral, ", mean ratio ", r.report.mean_ratio, ", inner edges over target 5 % ",
          lengths.at(0.05), ", median ", lengths.at(0.5), ", 95 % ", lengths.at(0.95), ", within 0.6 .. 1.6 ",
          lengths.within(0.6, 1.6));
  CHECK(r.report.min_dihedral >= 18);
  CHECK(r.report.mean_ratio >= 0.8);
  CHECK(r.report.volume_error < 1e-12);
  CHECK(lengths.within(0.6, 1.6) >= 0.95);
}

/// Observed orders between the last errors of halved edges.
double order(const std::vector<double>& error) {
  return std::log2(error[error.size() - 2] / error.back());
}

}  // namespace

TEST_SUITE("convergence") {
  TEST_CASE("meshing: curvatures converge with the second order on spheres tori and tubes") {
    std::vector<double> sphere, torus, tube;
    for (int k = 3; k <= 5; ++k) {
      double most = 0;
      for (const Curvature& c : meshing::curvatures(test::icosphere(k, 2.0)))
        most = std::max({most, std::abs(c.least - 0.5), std::abs(c.most - 0.5)});
      sphere.push_back(most * 2);
    }
    for (const int n : {32, 64, 128}) {
      const auto s = test::torus(n, 3 * n);
      const auto c = meshing::curvatures(s);
      double most = 0;
      for (Index i = 0; i < s.node_count(); ++i) {
        const double r = std::hypot(s.nodes(0, i), s.nodes(1, i));  // cos(a) / r along the ring
        const auto& k = c[static_cast<std::size_t>(i)];
        most = std::max({most, std::abs(k.most - 1 / 0.3), std::abs(k.least - (r - 1) / 0.3 / r)});
      }
      torus.push_back(most * 0.3);
    }
    for (const int n : {32, 64, 128}) {
      const auto s = test::tube_surface(n, n, n / 4);
      const auto c = meshing::curvatures(s);
      double most = 0;
      for (Index i = 0; i < s.node_count(); ++i) {
        const auto& k = c[static_cast<std::size_t>(i)];
        const bool wall = std::hypot(s.nodes(0, i), s.nodes(1, i)) > 0.999;
        // rims are no curvature, flat ends have none
        most = std::max({most, std::abs(k.most - (wall ? 1 : 0)), std::abs(k.least)});
      }
      tube.push_back(most);
    }
    MESSAGE("largest relative errors: sphere ", sphere[0], " ", sphere[1], " ", sphere[2], " order ",
            order(sphere), ", torus ", torus[0], " ", torus[1], " ", torus[2], " order ", order(torus),
            ", tube with ends ", tube[0], " ", tube[1], " ", tube[2], " order ", order(tube));
    CHECK(order(sphere) > 1.9);
    CHECK(order(torus) > 1.9);
    CHECK(order(tube) > 1.9);
    CHECK(sphere.back() < 0.005);
    CHECK(torus.back() < 0.01);
    CHECK(tube.back() < 0.01);
  }
}

TEST_SUITE("unit") {
  TEST_CASE("meshing: a jet of the third order is fitted exactly") {
    const auto height = [](double x, double y) {
      return 0.01 + 0.3 * x - 0.2 * y + 0.5 * (1.5 * x * x + 0.8 * x * y - 0.7 * y * y) + 0.4 * x * x * y;
    };
    meshing::detail::JetFit fit(meshing::detail::JetFit::cubic);
    for (int i = 0; i < 40; ++i) {
      const double x = test::node_noise(static_cast<std::uint64_t>(2 * i)),
                   y = test::node_noise(static_cast<std::uint64_t>(2 * i + 1));
      fit.add(x, y, height(x, y), 1 + x * x);
    }
    REQUIRE(fit.solve());
    const Curvature k = fit.curvature();
    const double p = 0.3, q = -0.2, xx = 1.5, xy = 0.4, yy = -0.7, w = 1 + p * p + q * q;
    const double mean = ((1 + q * q) * xx - 2 * p * q * xy + (1 + p * p) * yy) / (2 * w * std::sqrt(w));
    const double gauss = (xx * yy - xy * xy) / (w * w);
    CHECK(0.5 * (k.least + k.most) == doctest::Approx(mean).epsilon(1e-10));
    CHECK(k.least * k.most == doctest::Approx(gauss).epsilon(1e-10));
    meshing::detail::JetFit line(meshing::detail::JetFit::quadratic);
    for (int i = 0; i < 20; ++i) line.add(0.1 * i, 0.2 * i, 1, 1);
    CHECK_FALSE(line.solve());  // samples on a line say nothing of what lies beside it
  }

  TEST_CASE("meshing: the deviation of a triangle from a paraboloid is as its curvatures say") {
    // mean square of the distance from the levelled triangle of edge 1, on a grid of barycentric points
    for (const auto& [k1, k2] : {std::pair{1.0, 0.0}, {1.0, 1.0}, {1.0, -1.0}, {0.3, 2.0}}) {
      const double side = 1, height = std::sqrt(3.0) / 2;
      const std::array<Vec3, 3> v{Vec3(0, 0, 0), Vec3(side, 0, 0), Vec3(side / 2, height, 0)};
      const auto z = [&, k1 = k1, k2 = k2](const Vec3& x) {
        return 0.5 * (k1 * x[0] * x[0] + k2 * x[1] * x[1]);
      };
      double sum = 0, squares = 0;
      int count = 0;
      constexpr int n = 200;
      for (int i = 0; i < n; ++i)
        for (int j = 0; i + j < n; ++j) {
          const double a = (i + 1.0 / 3) / n, b = (j + 1.0 / 3) / n;
          const Vec3 x = (1 - a - b) * v[0] + a * v[1] + b * v[2];
          const double e = z(x) - (1 - a - b) * z(v[0]) - a * z(v[1]) - b * z(v[2]);
          sum += e, squares += e * e, ++count;
        }
      const double deviation = std::sqrt(squares / count - sum / count * sum / count);
      CHECK(
          deviation ==
          doctest::Approx(0.02795 * Curvature{std::min(k1, k2), std::max(k1, k2)}.deviating()).epsilon(0.01));
    }
  }

  TEST_CASE("meshing: the tree of triangles finds what a search through all of them finds") {
    const auto s = test::torus(12, 40);
    std::vector<meshing::ValuedTriangle> items;
    for (Index t = 0; t < s.cell_count(); ++t) {
      meshing::ValuedTriangle item{mesh::triangle(s, t)};
      for (double& v : item.value) v = 0.3 + 0.2 * test::node_noise(static_cast<std::uint64_t>(t));
      items.push_back(item);
    }
    const meshing::TriangleTree tree(items);
    for (std::uint64_t i = 0; i < 300; ++i) {
      const Vec3 x(1.5 * test::node_noise(3 * i), 1.5 * test::node_noise(3 * i + 1),
                   0.5 * test::node_noise(3 * i + 2));
      double least = 0.6;
      for (const auto& item : items) {
        const Vec3 w = item.shape.nearest(x);
        least = std::min(least, item.at(w) + 0.4 * vec::distance(item.shape.at(w), x));
      }
      CHECK(tree.least(x, 0.4, 0.6) == least);
    }
    CHECK(meshing::TriangleTree().least({0, 0, 0}, 1, 7) == 7);
    // a ray from the middle of the tube of a ball leaves after its radius
    std::vector<meshing::ValuedTriangle> ball;
    const auto b = test::icosphere(3);
    for (Index t = 0; t < b.cell_count(); ++t) ball.push_back({mesh::triangle(b, t)});
    const meshing::TriangleTree round(ball);
    for (std::uint64_t i = 0; i < 100; ++i) {
      const Vec3 d = Vec3(test::node_noise(7 * i), test::node_noise(7 * i + 1), test::node_noise(7 * i + 2))
                         .normalized();
      CHECK(round.exit({0, 0, 0}, d, 0) == doctest::Approx(1).epsilon(0.01));
      CHECK(round.exit(Vec3(-0.5 * d), d, 0) == doctest::Approx(1.5).epsilon(0.01));
      CHECK(round.exit(Vec3(-3 * d), d, 0) == doctest::Approx(4).epsilon(0.01));  // not where it enters
      CHECK(std::isinf(round.exit(Vec3(3 * d), d, 0)));
    }
  }

  TEST_CASE("meshing: graded sizes grow no faster than asked along the surface and in space") {
    const auto s = cut_bifurcation(40);
    constexpr double growth = 0.3;
    std::vector<double> wild;
    for (Index n = 0; n < s.node_count(); ++n)
      wild.push_back(0.01 * std::pow(20, 0.5 + 0.5 * test::node_noise(static_cast<std::uint64_t>(n))));
    const auto size = meshing::graded(s, wild, growth);
    double fastest = 0;
    for (Index t = 0; t < s.cell_count(); ++t)
      for (int k = 0; k < 3; ++k) {
        const Index a = s.cells(k, t), b = s.cells((k + 1) % 3, t);
        const double l = vec::distance(mesh::node(s, a), mesh::node(s, b));
        fastest = std::max(
            fastest, (size[static_cast<std::size_t>(a)] - size[static_cast<std::size_t>(b)]) / l / growth);
      }
    CHECK(fastest <= 1 + 1e-9);
    CHECK(fastest > 0.9);
    for (std::size_t n = 0; n < wild.size(); ++n) CHECK(size[n] <= wild[n]);
    CHECK(*std::min_element(size.begin(), size.end()) == *std::min_element(wild.begin(), wild.end()));
    const auto field = meshing::graded_size(s, wild, growth, 0.15, [](Index) { return true; });
    double rise = 0, off = 0;
    for (std::uint64_t i = 0; i < 3000; ++i) {
      const Vec3 x(0.5 + 0.5 * test::node_noise(6 * i), 0.5 + 0.5 * test::node_noise(6 * i + 1),
                   0.5 + 0.5 * test::node_noise(6 * i + 2));
      const Vec3 y = x + 0.05 * Vec3(test::node_noise(6 * i + 3), test::node_noise(6 * i + 4),
                                     test::node_noise(6 * i + 5));
      rise = std::max(rise, std::abs(field(x) - field(y)) / (x - y).norm());
      CHECK(field(x) <= 0.15);
    }
    for (Index n = 0; n < s.node_count(); ++n)  // shorter ways through space than along the surface lower it
      off = std::max(off, field(mesh::node(s, n)) / std::min(0.15, size[static_cast<std::size_t>(n)]));
    CHECK(rise <= std::sqrt(2.0) * growth * (1 + 1e-9));
    CHECK(off <= 1 + 1e-12);
    // linear sizes below the growth are left as they are
    std::vector<double> slow;
    for (Index n = 0; n < s.node_count(); ++n) slow.push_back(0.1 + 0.29 * s.nodes(2, n));
    CHECK(meshing::graded(s, slow, growth) == slow);
  }

  TEST_CASE("meshing: sizes from distance are known in closed form") {
    const auto tube = test::tube_surface(48, 48, 8);  // radius 1, from z = 0 to 4
    const auto wall = meshing::size_from_distance(tube, "wall", {.edge = 0.3, .least = 0.1, .growth = 0.2});
    const auto end = meshing::size_from_distance(tube, "outlet", {.edge = 0.5, .least = 0.1, .growth = 0.2});
    const std::vector<Vec3> points{{0, 0, 1}, {0, 0, 3}};
    const auto near = meshing::size_from_distance(points, {.edge = 0.6, .growth = 0.5});
    for (const double z : {0.3, 1.0, 2.2, 3.9})
      for (const double r : {0.0, 0.5, 0.9}) {
        const Vec3 x(r * 0.6, r * 0.8, z);
        CHECK(wall(x) == doctest::Approx(std::min(0.3, 0.1 + 0.2 * (1 - r))).epsilon(0.005));
        CHECK(end(x) == doctest::Approx(std::min(0.5, 0.1 + 0.2 * (4 - z))).epsilon(1e-12));
        const double d = std::min(std::hypot(r, z - 1), std::hypot(r, z - 3));
        CHECK(near(x) == doctest::Approx(std::min(0.6, 0.2 + 0.5 * d)).epsilon(1e-12));
      }
    CHECK_THROWS_WITH_AS((void)meshing::size_from_distance(tube, "inlets", {.edge = 1}),
                         "the surface has no region \"inlets\"; there are: wall, inlet, outlet", MeshError);
  }

  TEST_CASE("meshing: local diameters of spheres tubes and tori") {
    const auto errors = [](const std::string& name, const mesh::Surface& s, double exact, double most) {
      double sum = 0, worst = 0;
      for (const double d : meshing::local_diameters(s))
        sum += d / exact - 1, worst = std::max(worst, std::abs(d / exact - 1));
      MESSAGE("diameter of a ", name, ": off by ", sum / s.node_count(), " in the mean and ", worst,
              " at most");
      CHECK(worst < most);
      CHECK(std::abs(sum / s.node_count()) < 0.5 * most);
    };
    errors("sphere", test::icosphere(4), 2, 0.01);
    errors("tube with ends", test::tube_surface(48, 48, 8), 2, 0.06);
    errors("torus", test::torus(32, 96), 0.6, 0.06);
    const auto s = cut_bifurcation(64);
    const auto d = meshing::local_diameters(s);
    double trunk = 0, first = 0, second = 0;  // of radii 0.11, 0.08 and 0.07
    int a = 0, b = 0, c = 0;
    for (Index n = 0; n < s.node_count(); ++n) {
      const Vec3 x = mesh::node(s, n);
      const double here = d[static_cast<std::size_t>(n)];
      if (x[2] < 0.32) trunk += here, ++a;
      if (x[2] > 0.65 && x[0] < 0.5) first += here, ++b;
      if (x[2] > 0.65 && x[0] > 0.5) second += here, ++c;
    }
    MESSAGE("bifurcation: ", trunk / a, ", ", first / b, ", ", second / c, " for 0.22, 0.16, 0.14");
    CHECK(trunk / a == doctest::Approx(0.22).epsilon(0.05));
    CHECK(first / b == doctest::Approx(0.16).epsilon(0.05));
    CHECK(second / c == doctest::Approx(0.14).epsilon(0.05));
  }

  TEST_CASE("meshing: size fields have the same bits on any number of threads") {
    const auto s = cut_bifurcation(40);
    const auto sizes = [&] {
      const auto curved = meshing::size_from_curvature(s, {.edge = 0.05});
      const auto wide = meshing::size_from_diameter(s, {.edge = 0.05});
      std::vector<double> h;
      for (Index n = 0; n < s.node_count(); ++n)
        h.push_back(curved(mesh::node(s, n))), h.push_back(wide(mesh::node(s, n)));
      return h;
    };
    const auto one = sizes();
    thread_count() = 3;
    const auto three = sizes();
    thread_count() = 1;
    CHECK(one == three);
  }

  TEST_CASE("meshing: spheres and tori are remeshed to sizes that vary") {
    const auto sphere = smooth_sphere();
    const std::vector<Vec3> top{{0.5, 0.5, 0.9}}, side{{1.3, 0, 0}};
    (void)remeshed(
        "sphere, linear", sphere, [](const Vec3& x) { return 0.02 + 0.1 * x[2]; }, 20);
    (void)remeshed("sphere, from a point", sphere,
                   meshing::size_from_distance(top, {.edge = 0.1, .least = 0.015}), 20);
    (void)remeshed("sphere, fast", sphere,
                   meshing::size_from_distance(top, {.edge = 0.15, .least = 0.01, .growth = 0.4}), 20);
    (void)remeshed("torus, from a point", test::torus(32, 96),
                   meshing::size_from_distance(side, {.edge = 0.2, .least = 0.03}), 20);
    const auto even = meshing::remesh(sphere, {.edge = 0.06}, [](const Vec3&) { return 1.0; });
    CHECK(even.report.triangles == doctest::Approx(mesh::area(sphere) / (0.433 * 0.0036)).epsilon(0.1));
  }

  TEST_CASE("meshing: a cut bifurcation is remeshed to sizes from curvature diameter and distance") {
    const auto s = cut_bifurcation(64);
    (void)remeshed("bifurcation, curvature", s, meshing::size_from_curvature(s, {.edge = 0.05}), 20);
    (void)remeshed("bifurcation, diameter", s, meshing::size_from_diameter(s, {.edge = 0.05}), 20);
    (void)remeshed("bifurcation, an end", s,
                   meshing::size_from_distance(s, s.region_names[1], {.edge = 0.05, .least = 0.01}), 20);
  }

  TEST_CASE("meshing: a size field that gives no length is refused") {
    const auto s = test::icosphere(2);
    CHECK_THROWS_WITH_AS((void)meshing::remesh(s, {}, [](const Vec3& x) { return x[2]; }),
                         doctest::Contains("the size field gives an edge length of "), MeshError);
    CHECK_THROWS_AS(
        (void)meshing::remesh(s, {}, [](const Vec3&) { return std::numeric_limits<double>::quiet_NaN(); }),
        MeshError);
    CHECK_THROWS_WITH_AS((void)meshing::remesh(s, {}, [](const Vec3&) { return 1e-6; }),
                         doctest::Contains("an edge length of 1e-06 would take "), MeshError);
  }
}

TEST_SUITE("hard") {
  TEST_CASE("meshing: triangles by curvature follow a bifurcation better than as many even ones") {
    const auto s = cut_bifurcation(96);
    struct Error {
      double rms = 0, most = 0;
    };
    // of the wall from the exact surface, at 21 points of each triangle
    const auto error = [](const mesh::Surface& made) {
      Error e;
      double area = 0;
      constexpr int n = 5;
      for (Index t = 0; t < made.cell_count(); ++t) {
        if (made.region_of(t) != 0) continue;
        const auto f = mesh::triangle(made, t);
        std::vector<Vec3> points;
        for (int i = 0; i <= n; ++i)
          for (int j = 0; i + j <= n; ++j)
            points.push_back(f.at({1 - (i + j) / double{n}, i / double{n}, j / double{n}}));
        const auto [rms, most] = test::distance_to_zero(vec::columns(points), test::bifurcation);
        e.rms += f.area() * rms * rms, area += f.area();
        e.most = std::max(e.most, most);
      }
      e.rms = std::sqrt(e.rms / area);
      return e;
    };
    double ratio = 1;  // of errors at the same number of triangles, as rms falls with one over it
    for (const double edge : {0.1, 0.08, 0.06}) {
      const auto by_curvature = meshing::remesh(s, {}, meshing::size_from_curvature(s, {.edge = edge}));
      double even_edge = edge / 2;
      meshing::Remeshed even;
      for (int search = 0; search < 4; ++search) {
        even = meshing::remesh(s, {.edge = even_edge});
        even_edge *= std::sqrt(static_cast<double>(even.report.triangles) / by_curvature.report.triangles);
      }
      const Error a = error(by_curvature.surface), b = error(even.surface);
      MESSAGE("longest edge ", edge, ": ", by_curvature.report.triangles, " triangles by curvature, rms ",
              a.rms, ", largest ", a.most, "; ", even.report.triangles, " even ones, rms ", b.rms,
              ", largest ", b.most);
      CHECK(by_curvature.report.triangles == doctest::Approx(even.report.triangles).epsilon(0.03));
      CHECK(a.most < 0.8 * b.most);
      ratio *= a.rms * by_curvature.report.triangles / (b.rms * even.report.triangles);
    }
    MESSAGE("rms times triangles, by curvature over even, in the mean ", std::cbrt(ratio));
    CHECK(std::cbrt(ratio) < 1);
  }

  TEST_CASE("meshing: tetrahedra follow a graded size field with dihedral angles of 18 degrees") {
    const auto ball = test::icosphere(4);  // edges of about 0.075
    filled("sphere, growing inward", ball, [](const Vec3& x) { return 0.075 + 0.3 * (1 - x.norm()); });
    filled("sphere, across", ball, [](const Vec3& x) { return 0.03 + 0.05 * (x[0] + 1); });
    filled("sphere, surface finer", ball, [](const Vec3&) { return 0.3; });
    const auto s = cut_bifurcation(64);
    const auto run = [&](const std::string& name, const auto& size) {
      filled("bifurcation, " + name, meshing::remesh(s, {}, size).surface, size);
    };
    run("curvature", meshing::size_from_curvature(s, {.edge = 0.04}));
    run("diameter", meshing::size_from_diameter(s, {.edge = 0.04}));
    run("wall", meshing::size_from_distance(s, "wall", {.edge = 0.06, .least = 0.015}));
  }

  TEST_CASE("meshing: the real bifurcation is remeshed and filled to sizes that vary") {
    const auto s = real_bifurcation();
    if (s.cell_count() == 0) return;
    const auto run = [&](const std::string& name, const auto& size) {
      filled("real, " + name, remeshed("real, " + name, s, size, 15), size);
    };
    run("curvature", meshing::size_from_curvature(s, {.edge = 2}));
    run("diameter", meshing::size_from_diameter(s, {.edge = 2}));
    run("wall", meshing::size_from_distance(s, "wall", {.edge = 3, .least = 1}));
    run("an end", meshing::size_from_distance(s, s.region_names[1], {.edge = 2.5, .least = 0.6}));
  }
}
