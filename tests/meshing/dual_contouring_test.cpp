// SPDX-License-Identifier: MIT
// Dual contouring: topology for any signs, accuracy on smooth fields, sharp rims, exact planes.
#include "tunica/meshing/dual_contouring.hpp"

#include "support/contours.hpp"
#include "tunica/core/parallel.hpp"
#include "tunica/mesh/measures.hpp"
#include "tunica/meshing/cell_loops.hpp"
#include "tunica/meshing/contour_triangles.hpp"
#include "tunica/meshing/hermite_field.hpp"
#include "tunica/meshing/hermite_surface.hpp"
#include "tunica/meshing/quad_lens.hpp"
#include "tunica/meshing/tube.hpp"

#include <doctest/doctest.h>

#include <Eigen/Geometry>

#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <utility>
#include <vector>

using namespace tunica;

namespace {

template <class C>
void check_manifold(const mesh::Mesh<C, 3>& m) {
  const auto t = test::contours::topology(m);
  CHECK(t.open_edges == 0);
  CHECK(t.wrong_edges == 0);
  CHECK(t.wrong_vertices == 0);
  CHECK(t.loose_vertices == 0);
}

// Normal and area of a quadrilateral; slivers along a rim have no normal to speak of.
Vec3 quad_area(const mesh::QuadSurface& m, Index q) {
  const auto x = [&](int k) { return Vec3(m.nodes.col(m.cells(k, q))); };
  return 0.5 * (x(2) - x(0)).cross(x(3) - x(1));
}
Vec3 quad_normal(const mesh::QuadSurface& m, Index q) {
  const auto x = [&](int k) { return Vec3(m.nodes.col(m.cells(k, q))); };
  return (x(2) - x(0)).cross(x(3) - x(1)).normalized();
}

// A triangulated cylinder about a tilted axis, its ends regions of their own.
mesh::Surface cylinder(double radius, double length, Index around, const Eigen::Matrix3d& turn) {
  const auto tets = meshing::lumen({.radius = radius, .length = length, .cells = {3, around, around / 2}});
  mesh::Surface s;
  s.nodes = turn * tets.nodes;
  Eigen::Index n = 0;
  for (const auto& p : tets.patches) {
    s.region_names.push_back(p.name);
    s.cells.conservativeResize(3, n + p.faces.cols());
    s.cells.rightCols(p.faces.cols()) = p.faces;
    s.region.insert(s.region.end(), static_cast<std::size_t>(p.faces.cols()),
                    static_cast<Index>(s.region_names.size()) - 1);
    n += p.faces.cols();
  }
  return s;
}

const Eigen::Matrix3d tilt = Eigen::AngleAxisd(0.5, Vec3(1, 2, 0.5).normalized()).toRotationMatrix();

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("meshing: cell tables of the dual contouring are consistent") {
    using namespace meshing::detail;
    for (std::size_t f = 0; f < 6; ++f)
      for (std::size_t n = 0; n < 4; ++n) {
        const auto& ends = cell_tables.edge_corners[static_cast<std::size_t>(cell_tables.face_edges[f][n])];
        const int a = cell_tables.face_corners[f][n], b = cell_tables.face_corners[f][(n + 1) % 4];
        CHECK(std::minmax(a, b) == std::minmax(ends[0], ends[1]));
      }
    for (unsigned signs = 0; signs < 256; ++signs)
      for (unsigned joined = 0; joined < 64; ++joined) {
        const auto loops = cell_loops(signs, joined);
        std::array<int, 12> length{};
        for (const auto l : loops.loop)
          if (l >= 0) ++length[static_cast<std::size_t>(l)];
        CHECK((loops.count == 0) == (signs == 0 || signs == 255));
        for (int l = 0; l < loops.count; ++l) CHECK(length[static_cast<std::size_t>(l)] >= 3);
      }
  }

  TEST_CASE("meshing: dual contouring is closed and manifold on noise") {
    for (const bool integers : {false, true})
      for (std::uint64_t seed = 0; seed < 6; ++seed) {
        const auto im = test::contours::noise(16, integers, 1000 * seed);
        const auto kept = test::contours::at_least(im, 0);
        const auto quads = meshing::dual_contour(meshing::hermite_of_image(im, kept, 0));
        check_manifold(quads);
        const auto triangles = meshing::dual_contour_triangles(im, kept, 0);
        check_manifold(triangles);
        int degenerate = 0;
        for (Index t = 0; t < triangles.cell_count(); ++t)
          if (!(mesh::triangle(triangles, t).area() > 0)) ++degenerate;
        CHECK(degenerate == 0);
        CHECK(test::contours::enclosed_volume(quads) > 0);
      }
  }

  TEST_CASE("meshing: the sweep over an image is the dual contouring of its Hermite data") {
    // balls at a corner and across the middle, a mask that parts them, steps of uneven length, and noise
    auto ball = test::contours::sampled(20, [](const Vec3& x) {
      return std::max(0.42 - (x - Vec3(0.9, 0.5, 0.1)).norm(), 0.31 - (x - Vec3(0.4, 0.4, 0.6)).norm());
    });
    for (std::size_t a = 0; a < 3; ++a)
      for (double& x : ball.axes[a]) x = x * (1 + 0.3 * static_cast<double>(a) * x) - 7;
    std::vector<std::uint8_t> mask(ball.values.size(), 1);
    for (std::size_t v = 0; v < mask.size(); v += 7) mask[v] = 0;
    const auto noise = test::contours::noise(14, false, 5);
    const auto wide = test::contours::noise(70, false, 6);  // rows of more than one word
    const auto compare = [](const auto& im, const std::vector<std::uint8_t>& kept, double hold) {
      const auto general = meshing::dual_contour(meshing::hermite_of_image(im, kept, 0), {.hold = hold});
      const auto swept = meshing::dual_contour_quads(im, kept, 0, {.hold = hold, .smooth_share = 1});
      CHECK(swept.cells == general.cells);
      CHECK(swept.region == general.region);
      CHECK(swept.region_names == general.region_names);
      REQUIRE(swept.node_count() == general.node_count());
      Index apart = 0;
      for (Index v = 0; v < swept.node_count(); ++v) {
        const bool same = (swept.nodes.col(v) - general.nodes.col(v)).norm() < 1e-10;
        bool border = false;  // where the plane comes first for the sweep, last for the general way
        for (int a = 0; a < 3; ++a)
          border |= swept.nodes(a, v) == im.axes[static_cast<std::size_t>(a)].front() ||
                    swept.nodes(a, v) == im.axes[static_cast<std::size_t>(a)].back();
        apart += !same && !border;
      }
      CHECK(apart == 0);
    };
    compare(ball, {}, 1e-3);
    compare(ball, mask, 1e-3);
    compare(noise, {}, 1e-3);
    compare(wide, {}, 0.01);
  }

  TEST_CASE("meshing: dual contouring has the same bits on any number of threads") {
    const auto im = test::contours::noise(40, true, 3);
    const auto one = meshing::dual_contour_image(im, {}, 0);
    thread_count() = 3;
    const auto three = meshing::dual_contour_image(im, {}, 0);
    thread_count() = 1;
    CHECK(one.surface.nodes == three.surface.nodes);
    CHECK(one.surface.cells == three.surface.cells);
    CHECK(one.surface.region == three.surface.region);
  }

  TEST_CASE("meshing: vertices of dual contouring lie within their cells and nowhere twice") {
    for (const bool integers : {false, true}) {
      const auto im = test::contours::noise(48, integers, 11);
      const auto surface = meshing::dual_contour_image(im, {}, 0).surface;
      std::set<std::array<double, 3>> places;
      Index on_a_side = 0;
      for (Index v = 0; v < surface.node_count(); ++v) {
        const Vec3 x = surface.nodes.col(v);
        places.insert({x[0], x[1], x[2]});
        for (int a = 0; a < 3; ++a) {
          const double t = x[a] * 47;
          on_a_side += std::abs(t - std::round(t)) < 0.9e-3;
        }
      }
      CHECK(on_a_side == 0);
      CHECK(static_cast<Index>(places.size()) == surface.node_count());
    }
  }

  TEST_CASE("meshing: dual contouring closes a region at the border of the image in flat parts") {
    const auto im =
        test::contours::sampled(24, [](const Vec3& x) { return 0.31 - (x - Vec3(0.9, 0.5, 0.1)).norm(); });
    const auto surface = meshing::dual_contour_triangles(im, test::contours::at_least(im, 0), 0);
    check_manifold(surface);
    CHECK(test::contours::topology(surface).euler == 2);
    const auto contour = meshing::dual_contour_image(im, {}, 0);  // no mask keeps all
    CHECK(contour.surface.nodes == surface.nodes);
    REQUIRE(contour.borders.size() == 2);
    CHECK(contour.borders[0].name == "border x1");
    CHECK(contour.borders[0].area == doctest::Approx(std::numbers::pi * (0.31 * 0.31 - 0.01)).epsilon(0.2));
    REQUIRE(surface.region_names == std::vector<std::string>{"wall", "border x1", "border z0"});
    for (Index t = 0; t < surface.cell_count(); ++t)
      for (int k = 0; k < 3; ++k) {
        if (surface.region_of(t) == 1) CHECK(surface.nodes(0, surface.cells(k, t)) == 1.0);
        if (surface.region_of(t) == 2) CHECK(surface.nodes(2, surface.cells(k, t)) == 0.0);
      }
    const auto sheet = test::contours::sampled(8, [](const Vec3&) { return 1.0; });
    CHECK_THROWS_AS((void)meshing::dual_contour_triangles(sheet, test::contours::at_least(sheet, 0), 0),
                    MeshError);
    CHECK_THROWS_AS((void)meshing::dual_contour_triangles(sheet, test::contours::at_least(sheet, 2), 2),
                    MeshError);
  }

  TEST_CASE("meshing: dual contouring keeps the edges of a cut cylinder sharp") {
    const double radius = 0.31, half = 0.33, h = 1.0 / 24;
    const Vec3 centre(0.51, 0.49, 0.5), axis = Vec3(1, 2, 3).normalized();
    const auto field = [&](const Vec3& x) {
      const double z = axis.dot(x - centre), r = (x - centre - z * axis).norm();
      return std::min(radius - r, half - std::abs(z));
    };
    const auto quads = meshing::dual_contour(
        meshing::hermite_of_field(field, meshing::uniform_axes({Vec3::Zero(), Vec3::Ones()}, h)),
        {.hold = -0.5});
    check_manifold(quads);
    // Edges that turn by more than 60 degrees are the rims: their nodes lie on the two circles.
    std::map<std::pair<Index, Index>, Vec3> seen;
    double worst = 0, length = 0, plane = 0;
    for (Index q = 0; q < quads.cell_count(); ++q) {
      const Vec3 n = quad_normal(quads, q);
      if (quad_area(quads, q).norm() < 0.02 * h * h) continue;
      for (int k = 0; k < 4; ++k) {
        const Index a = quads.cells(k, q), b = quads.cells((k + 1) % 4, q);
        const auto other = seen.find(std::minmax(a, b));
        if (other == seen.end()) {
          seen[std::minmax(a, b)] = n;
          continue;
        }
        if (n.dot(other->second) > 0.5) continue;
        length += (quads.nodes.col(a) - quads.nodes.col(b)).norm();
        for (const Index v : {a, b}) {
          const Vec3 x = quads.nodes.col(v) - centre;
          const double z = std::abs(axis.dot(x)), r = (x - axis.dot(x) * axis).norm();
          worst = std::max(worst, std::hypot(r - radius, z - half));
        }
      }
      if (std::abs(axis.dot(n)) > 0.999)
        for (int k = 0; k < 4; ++k)
          plane = std::max(plane,
                           std::abs(std::abs(axis.dot(quads.nodes.col(quads.cells(k, q)) - centre)) - half));
    }
    MESSAGE("cut cylinder: sharp edges within " << worst / h << " h; ends flat within " << plane / h
                                                << " h; rims " << length / (4 * std::numbers::pi * radius)
                                                << " of their length");
    CHECK(worst < 0.05 * h);
    CHECK(plane < 1e-6 * h);  // normals of the field are differenced
    CHECK(length == doctest::Approx(4 * std::numbers::pi * radius).epsilon(0.05));
  }

  TEST_CASE("meshing: lenses magnify a place and can be looked through both ways") {
    meshing::Lenses lenses;
    CHECK(lenses.magnified(Vec3(1, 2, 3)) == Vec3(1, 2, 3));
    lenses.add({.centre = Vec3(1, 0, 0), .radius = 2, .power = 1});
    lenses.add({.centre = Vec3(1.5, 0.5, -0.2), .radius = 0.7, .power = 4});
    CHECK(lenses.count() == 2);
    const meshing::Lens one{.centre = Vec3(1, 0, 0), .radius = 2, .power = 3};
    double before = 0;
    for (int i = 1; i <= 400; ++i) {
      const Vec3 x(1 + 0.02 * i, 0.3 * std::sin(i), 0.2 * std::cos(3 * i));
      CHECK((lenses.restored(lenses.magnified(x)) - x).norm() < 1e-12 * (1 + x.norm()));
      const double now = one.magnified(Vec3(1 + 0.02 * i, 0, 0))[0] - 1;
      CHECK(now - before > (1 - 3.0 / 8) * 0.02 * (1 - 1e-9));  // along the rays no shorter than 1 - a/8
      before = now;
    }
    const double step = 1e-6;
    const Vec3 moved = one.magnified(Vec3(1 + step, 0, 0)) - one.magnified(Vec3(1, 0, 0));
    CHECK(moved[0] / step == doctest::Approx(4));
  }

  TEST_CASE("meshing: the rank cut keeps sharp edges and does not chase waves in the normals") {
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, Vec3(1, 2, 0.5).normalized()).toRotationMatrix();
    const double h = 0.2;
    const auto box = [&](const Vec3& x, const Vec3& half) {
      const Vec3 y = (turn.transpose() * x).cwiseAbs() - half;
      return y.cwiseMax(0).norm() + std::min(0.0, y.maxCoeff());
    };
    const auto farthest = [&](const auto& level, double cut) {
      const auto field = [&](const Vec3& x) { return -level(x); };
      const auto grid = meshing::hermite_of_field(
          field, meshing::uniform_axes({Vec3(-2, -2, -2), Vec3(2.03, 2.01, 2.07)}, h));
      const auto surface = meshing::dual_contour(grid, {.qef = {.cut = cut}, .hold = -0.5});
      double most = 0;
      for (Index n = 0; n < surface.node_count(); ++n)
        most = std::max(most, std::abs(level(Vec3(surface.nodes.col(n)))) / h);
      return most;
    };
    const auto cube = [&](const Vec3& x) { return box(x, Vec3(1, 1, 1)); };
    const auto plate = [&](const Vec3& x) { return box(x, Vec3(1, 0.8, 0.75 * h)); };
    const auto waves = [&](const Vec3& x) {
      return x.norm() - 1 + 0.01 * std::sin(37 * x[0]) * std::sin(41 * x[1] + 1) * std::sin(43 * x[2] + 2);
    };
    const double cut = meshing::QefOptions{}.cut;
    CHECK(farthest(cube, cut) < 1e-6);
    CHECK(farthest(plate, cut) < 1e-6);
    MESSAGE("waves of 0.05 h: off by " << farthest(waves, cut) << " h, with a cut of 0.05 by "
                                       << farthest(waves, 0.05) << " h");
    CHECK(farthest(waves, cut) < 0.6 * farthest(waves, 0.05));
  }

  TEST_CASE("meshing: dual contouring of a closed surface keeps its flat ends and labels them") {
    const auto surface = cylinder(4, 20, 96, tilt);
    const double h = 0.8;
    const auto grid = meshing::hermite_of_surface(surface, {.spacing = h});
    const auto quads = meshing::dual_contour(grid, {.hold = -0.5});
    check_manifold(quads);
    CHECK(test::contours::topology(quads).euler == 2);
    REQUIRE(quads.region_names == std::vector<std::string>{"wall", "inlet", "outlet"});
    const Vec3 axis = tilt.col(2);
    double flat = 0, rim = 0, wall = 0;
    for (Index q = 0; q < quads.cell_count(); ++q) {
      const Index r = quads.region_of(q);
      CHECK(quad_normal(quads, q).dot(r == 0 ? Vec3(quads.nodes.col(quads.cells(0, q)) -
                                                    axis * axis.dot(quads.nodes.col(quads.cells(0, q))))
                                             : Vec3((r == 1 ? -1 : 1) * axis)) > 0);
      for (int k = 0; k < 4; ++k) {
        const Vec3 x = quads.nodes.col(quads.cells(k, q));
        if (r > 0) flat = std::max(flat, std::abs(axis.dot(x) - (r == 1 ? 0 : 20)));
        if (r == 0) wall = std::max(wall, std::abs((x - axis * axis.dot(x)).norm() - 4));
      }
    }
    std::vector<int> regions(static_cast<std::size_t>(quads.node_count()), 0);
    for (Index q = 0; q < quads.cell_count(); ++q)
      for (int k = 0; k < 4; ++k)
        regions[static_cast<std::size_t>(quads.cells(k, q))] |= quads.region_of(q) > 0 ? 2 : 1;
    for (Index v = 0; v < quads.node_count(); ++v) {
      const Vec3 x = quads.nodes.col(v);
      if (regions[static_cast<std::size_t>(v)] == 3)
        rim = std::max(rim, std::abs((x - axis * axis.dot(x)).norm() - 4));
    }
    MESSAGE("cylinder of radius 4 with spacing 0.8: ends flat to "
            << flat << "; rim nodes off the circle by at most " << rim / h << " h; wall nodes by " << wall / h
            << " h");
    CHECK(flat < 1e-13);
    CHECK(rim < 0.05 * h);
    CHECK(wall < 0.1 * h);
  }

  TEST_CASE("meshing: dual contouring refuses an open surface") {
    auto surface = cylinder(4, 20, 24, tilt);
    const auto closed =
        static_cast<Eigen::Index>(std::count(surface.region.begin(), surface.region.end(), 0));
    surface.cells.conservativeResize(3, closed + 1);
    surface.region.resize(static_cast<std::size_t>(closed) + 1);
    CHECK_THROWS_AS((void)meshing::hermite_of_surface(surface, {.spacing = 1.5}), MeshError);
  }
}

TEST_SUITE("convergence") {
  TEST_CASE("meshing: dual contouring of a sphere is of second order") {
    const auto field = [](const Vec3& x) { return 0.4 - (x - Vec3(0.503, 0.497, 0.501)).norm(); };
    std::vector<double> rms, volume;
    for (const int n : {16, 32, 64}) {
      const auto quads = meshing::dual_contour(
          meshing::hermite_of_field(field, meshing::uniform_axes({Vec3::Zero(), Vec3::Ones()}, 1.0 / n)));
      double sum = 0, largest = 0;
      for (Index v = 0; v < quads.node_count(); ++v) {
        const double d = field(quads.nodes.col(v));
        sum += d * d, largest = std::max(largest, std::abs(d));
      }
      rms.push_back(std::sqrt(sum / quads.node_count()));
      volume.push_back(std::abs(test::contours::enclosed_volume(quads) - 4.0 / 3 * std::numbers::pi * 0.064));
      MESSAGE("sphere, h = 1/" << n << ": vertices rms " << rms.back() * n << " h, max " << largest * n
                               << " h, volume error " << volume.back());
    }
    for (std::size_t i = 1; i < rms.size(); ++i) {
      const double order = std::log2(rms[i - 1] / rms[i]),
                   order_volume = std::log2(volume[i - 1] / volume[i]);
      MESSAGE("observed order: vertices " << order << ", volume " << order_volume);
      CHECK(order > 1.8);
      CHECK(order_volume > 1.8);
    }
  }

  TEST_CASE("meshing: dual contouring of the sampled bifurcation is within 0.02 h at 64") {
    std::vector<double> rms;
    for (const Index n : {32, 64}) {
      const auto im = test::contours::sampled(n, test::contours::bifurcation);
      const auto quads =
          meshing::dual_contour(meshing::hermite_of_image(im, test::contours::at_least(im, 0), 0));
      check_manifold(quads);
      CHECK(test::contours::topology(quads).euler == 2);
      double sum = 0, largest = 0;
      for (Index v = 0; v < quads.node_count(); ++v) {
        Vec3 x = quads.nodes.col(v);  // Newton projection onto the analytic field
        for (int i = 0; i < 20; ++i) {
          const Vec3 g = meshing::field_gradient(test::contours::bifurcation, x, 1e-6);
          x -= g * test::contours::bifurcation(x) / g.squaredNorm();
        }
        const double d = (x - quads.nodes.col(v)).norm() * (n - 1);
        sum += d * d, largest = std::max(largest, d);
      }
      rms.push_back(std::sqrt(sum / quads.node_count()));
      const auto swept = meshing::dual_contour_quads(im, {}, 0);  // half-way from the mean of the crossings
      double swept_sum = 0;
      for (Index v = 0; v < swept.node_count(); ++v) {
        const Vec3 x = swept.nodes.col(v);  // the field is a distance but in the crotch
        swept_sum += std::pow(test::contours::bifurcation(x), 2);
      }
      const double half_way = std::sqrt(swept_sum / swept.node_count()) * (n - 1);
      MESSAGE("bifurcation ", n, " in one sweep: vertices rms ", half_way, " h");
      if (n == 64) CHECK(half_way < 0.5 * rms.back());  // vessels of few samples have edges in their cells
      MESSAGE("bifurcation " << n << ": " << quads.cell_count() << " quadrilaterals, vertices rms "
                             << rms.back() << " h, max " << largest << " h");
    }
    CHECK(rms[1] <= 2.0e-2);
    CHECK(rms[1] < 0.65 * rms[0]);
  }
}
