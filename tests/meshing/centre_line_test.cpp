// SPDX-License-Identifier: MIT
// Sections and centre lines on tubes with exact axes and radii, on the phantom and on a real vessel.
#include "tunica/meshing/centre_line.hpp"

#include "support/shared.hpp"
#include "support/surfaces.hpp"
#include "support/vessels.hpp"
#include "tunica/io/closed_surface.hpp"

#include <Eigen/Geometry>

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

using namespace tunica;

namespace {

/// A tube of radius 1 along z, bent to an arc of radius 4 in the plane of x and z.
mesh::Surface bent_tube(int around, double length) {
  auto s = test::tube_surface(around, static_cast<int>(around * length / 4), around / 4, 1, length);
  for (Index n = 0; n < s.node_count(); ++n) {
    const double r = 4 + s.nodes(0, n), y = s.nodes(1, n), angle = s.nodes(2, n) / 4;
    s.nodes.col(n) << r * std::cos(angle), y, r * std::sin(angle);
  }
  return s;
}

struct OnLine {
  double distance = 1e300, radius = 0;
  Vec3 place{0, 0, 0};
};

/// The point of the line that is nearest to x.
OnLine nearest_on(const meshing::CentreLine& line, const Vec3& x) {
  OnLine best;
  for (const auto& b : line.branches)
    for (std::size_t i = 0; i + 1 < b.points.size(); ++i) {
      const auto &p = b.points[i], &q = b.points[i + 1];
      const Vec3 way = q.place - p.place;
      const double t = std::clamp((x - p.place).dot(way) / way.squaredNorm(), 0.0, 1.0);
      const Vec3 foot = p.place + t * way;
      if (const double d = (x - foot).norm(); d < best.distance)
        best = {d, (1 - t) * p.radius + t * q.radius, foot};
    }
  return best;
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("meshing: sections have the areas and perimeters of their polygons") {
    const int n = 24;
    const auto tube = test::tube_surface(n, 8, 3);
    const double turn = 2 * std::numbers::pi / n, area = 0.5 * n * std::sin(turn),
                 perimeter = 2 * n * std::sin(turn / 2);
    const auto square = meshing::section_areas(tube, {{{0.3, 0.2, 1.3}, {0, 0, 1}}, {{0, 0, 9}, {0, 0, 1}}});
    REQUIRE(square.size() == 2);
    REQUIRE(square[0].size() == 1);
    CHECK(square[1].empty());
    CHECK(square[0][0].area == doctest::Approx(area).epsilon(1e-13));
    CHECK(square[0][0].perimeter == doctest::Approx(perimeter).epsilon(1e-13));
    CHECK(square[0][0].equivalent_diameter == doctest::Approx(2 * std::sqrt(area / std::numbers::pi)));
    CHECK((square[0][0].centroid - Vec3(0, 0, 1.3)).norm() < 1e-13);
    CHECK(square[0][0].distance == 0);
    const Vec3 slope = Vec3(0, 1, 1).normalized();  // an oblique plane: 1/cos of the area
    const auto oblique = meshing::section_areas(tube, {{{0, 0, 2}, slope}});
    CHECK(oblique[0][0].area == doctest::Approx(area * std::numbers::sqrt2).epsilon(1e-13));
    // a cavity is a hole; two legs of a ring are two parts, told apart by the point
    auto hollow = test::joined(test::icosphere(4), test::reversed(test::icosphere(4, 0.5)));
    const auto ring = meshing::section_areas(hollow, {{{0, 0, 0.01}, {0, 0, 1}}});
    REQUIRE(ring[0].size() == 1);
    CHECK(ring[0][0].area == doctest::Approx(std::numbers::pi * 0.75).epsilon(0.01));
    CHECK(ring[0][0].perimeter == doctest::Approx(std::numbers::pi * 3).epsilon(0.01));
    CHECK(ring[0][0].distance == doctest::Approx(0.5).epsilon(0.01));
    const auto torus = test::torus(32, 64);
    meshing::SectionFinder find(torus);
    const auto leg = find.at({{-1.1, 0.001, 0}, {0, 1, 0}});
    CHECK(find({{-1.1, 0.001, 0}, {0, 1, 0}}).size() == 2);
    CHECK(leg.centroid[0] == doctest::Approx(-1).epsilon(0.01));
    CHECK(leg.area == doctest::Approx(std::numbers::pi * 0.09).epsilon(0.02));
  }

  TEST_CASE("meshing: the centre line of a tube is its axis and has its radius to second order") {
    double before = 0;
    for (const int n : {24, 48}) {
      const auto s = test::tube_surface(n, 2 * n, n / 4, 1, 6);
      const auto line = meshing::centre_line(s, meshing::vessel_ends(s));
      REQUIRE(line.branches.size() == 1);
      const auto& branch = line.to("outlet");
      CHECK(line.root == "inlet");
      const auto areas = meshing::section_areas(s, branch);
      double off = 0, error = 0, turned = 0, area = 0;
      for (std::size_t i = 0; i < areas.size(); ++i) {
        const auto& p = branch.points[i];
        off = std::max(off, std::hypot(p.place[0], p.place[1]));
        error = std::max(error, std::abs(p.radius - 1));
        turned = std::max(turned, (p.tangent - Vec3(0, 0, 1)).norm());
        area = std::max(area, std::abs(areas[i].area - 0.5 * n * std::sin(2 * std::numbers::pi / n)));
        CHECK(p.arc == doctest::Approx(p.place[2]).epsilon(1e-6));
      }
      CHECK(off < 1e-6);
      CHECK(turned < 1e-6);
      CHECK(area < 1e-9);
      CHECK(error == doctest::Approx(1 - std::cos(std::numbers::pi / n)).epsilon(1e-4));  // of the prism
      if (before > 0) {
        MESSAGE("radius of a tube: observed order ", std::log2(before / error));
        CHECK(std::log2(before / error) == doctest::Approx(2).epsilon(0.02));
      }
      before = error;
      CHECK(branch.points.front().place[2] == doctest::Approx(0));
      CHECK(branch.points.back().place[2] == doctest::Approx(6));
    }
  }

  TEST_CASE("meshing: the centre line of a bent tube follows its arc to second order") {
    double before = 0;
    for (const int n : {24, 48}) {
      const auto s = bent_tube(n, 8);
      const auto line = meshing::centre_line(s, meshing::vessel_ends(s));
      REQUIRE(line.branches.size() == 1);
      const auto& branch = line.branches.front();
      const auto areas = meshing::section_areas(s, branch);
      double off = 0, radius = 0, area = 0;
      for (std::size_t i = 0; i < areas.size(); ++i) {
        const Vec3& x = branch.points[i].place;
        off = std::max(off, std::hypot(std::hypot(x[0], x[2]) - 4, x[1]));
        radius = std::max(radius, std::abs(branch.points[i].radius - 1));
        area = std::max(area, std::abs(areas[i].area / std::numbers::pi - 1));
      }
      MESSAGE("bent tube of ", n, " facets: off the arc by ", off, ", radius by ", radius, ", area by ", area,
              ", length ", branch.points.back().arc);
      if (before > 0) CHECK(std::log2(before / off) > 1.8);
      before = off;
      CHECK(radius < 1.1 * (1 - std::cos(std::numbers::pi / n)));
      CHECK(area < 1.2 * (1 - std::sin(2 * std::numbers::pi / n) * n / (2 * std::numbers::pi)));
      CHECK(branch.points.back().arc == doctest::Approx(8).epsilon(2e-3));
    }
    // an arc that nearly closes: its ends are near, and the way is long
    const auto ring = bent_tube(24, 8 * std::numbers::pi - 0.2);
    const auto line = meshing::centre_line(ring, meshing::vessel_ends(ring));
    CHECK(line.branches.front().points.back().arc ==
          doctest::Approx(8 * std::numbers::pi - 0.2).epsilon(5e-3));
  }

  TEST_CASE("meshing: the phantom has three branches with the radii of its ports") {
    const auto s = test::vessels::bifurcation(1.5);
    auto ends = meshing::vessel_ends(s);
    REQUIRE(ends.size() == 3);
    const auto line = meshing::centre_line(s, ends);
    REQUIRE(line.branches.size() == 3);
    const image::Phantom phantom;
    for (const auto& port : image::Phantom::ports()) {
      const auto& p =
          port.name == "inlet" ? line.branches.front().points.front() : line.to(port.name).points.back();
      MESSAGE(port.name, ": radius ", p.radius, " of ", port.radius, ", off by ",
              (p.place - port.point).norm());
      CHECK(std::abs(p.radius - port.radius) < 0.03);
      CHECK((p.place - port.point).norm() < 0.03);
      CHECK((p.tangent - (port.name == "inlet" ? -1 : 1) * port.normal).norm() < 0.02);
    }
    double off = 0;  // away from the fork the axes are known
    for (const auto& b : line.branches)
      for (const auto& p : b.points)
        if (p.place[1] > 148 || p.place[1] < 122)
          off = std::max(off, std::min((phantom.axis(0, p.place[1]).centre - p.place).norm(),
                                       (phantom.axis(1, p.place[1]).centre - p.place).norm()));
    const Vec3 fork = line.branches.front().points.back().place;
    MESSAGE("off the axes by at most ", off, " mm; fork at y = ", fork[1], " mm");
    CHECK(off < 0.1);
    CHECK(std::abs(fork[1] - 139) < 6);  // above the flow divider at 131, below the straight aorta at 145
    for (const auto& b : line.branches) {
      CHECK(b.parent == (b.end.empty() ? -1 : 0));
      for (std::size_t i = 1; i < b.points.size(); ++i) CHECK(b.points[i].arc > b.points[i - 1].arc);
    }
    std::swap(ends[0], ends[2]);  // from another end the same tree, its first branch the other way
    const auto back = meshing::centre_line(s, ends);
    CHECK(back.branches.size() == 3);
    CHECK(nearest_on(back, fork).distance < 0.5);
  }

  TEST_CASE("meshing: centre lines are refused by name where there are none") {
    const auto refusal = [](const mesh::Surface& s, const std::vector<meshing::VesselEnd>& ends) {
      try {
        (void)meshing::centre_line(s, ends);
      } catch (const MeshError& e) {
        return std::string(e.what());
      }
      return std::string();
    };
    const auto ball = test::icosphere(3);
    CHECK(refusal(ball, meshing::vessel_ends(ball)).find("needs two ends or more") != std::string::npos);
    auto tube = test::tube_surface(16, 8, 3);
    auto ends = meshing::vessel_ends(tube);
    const auto two = test::joined(tube, test::icosphere(2, 1, Vec3(5, 0, 0)));
    meshing::VesselEnd apart;
    apart.name = "apart", apart.point = Vec3(5, 0, 0);
    ends.push_back(apart);
    CHECK(refusal(two, ends) == "no way leads from the end \"inlet\" to \"apart\" within the surface");
    for (const double x : {5.0, 1e9, std::nan("")}) {
      ends.back().point = Vec3(x, 3, 3);
      CHECK(refusal(tube, ends).find("the end \"apart\" at (") == 0);
    }
    ends.back().point = Vec3(0.5, 0, 1.5);
    CHECK(refusal(tube, ends).empty());
  }

  TEST_CASE("meshing: the centre line of a real vessel agrees with one found from its Voronoi diagram") {
    const auto path = test::shared("data/vmtk_levelset_surface.stl");
    if (!path) return;
    const auto s = io::read_closed_stl(*path).surface;
    // blind ends; places and radii along a centre line that was made by minimal paths on the Voronoi diagram
    std::vector<meshing::VesselEnd> ends(3);
    ends[0].name = "aorta", ends[0].point = {222.0963, 175.870, 21.673};
    ends[1].name = "right", ends[1].point = {234.354, 101.314, 28.987};
    ends[2].name = "left", ends[2].point = {210.200, 103.046, 31.688};
    const std::vector<std::pair<Vec3, double>> known{
        {{221.942, 170.049, 22.113}, 7.056}, {{221.890, 160.066, 22.520}, 7.464},
        {{221.388, 150.078, 23.163}, 7.214}, {{222.785, 139.994, 23.818}, 6.319},
        {{227.485, 130.060, 23.765}, 4.430}, {{229.929, 120.042, 24.962}, 4.373},
        {{232.103, 111.983, 26.504}, 4.315}, {{234.018, 105.987, 27.937}, 4.244},
        {{220.571, 140.129, 24.166}, 6.579}, {{216.111, 129.959, 25.506}, 4.622},
        {{214.281, 120.027, 27.482}, 4.435}, {{212.593, 111.967, 28.510}, 4.208},
        {{211.013, 106.021, 30.155}, 4.155}};
    const auto line = meshing::centre_line(s, ends, {.step = 1});
    CHECK(line.branches.size() == 3);
    // Within the inscribed ball of the fork the vessel is twice as wide as deep, and the centres of balls
    // that are inscribed lie on a ridge from one branch to the other, not on a line: there both methods must
    // be on one ridge, so that the wall comes no nearer on the straight way between them.
    const meshing::CentrePoint& fork = line.branches.front().points.back();
    const meshing::WallDistance wall(s, ends);
    double most = 0, radii = 0, apart = 0, dip = 0;
    int in_fork = 0;
    for (const auto& [x, r] : known) {
      const OnLine ours = nearest_on(line, x);
      radii = std::max(radii, std::abs(ours.radius - r));
      if ((x - fork.place).norm() > fork.radius) {
        most = std::max(most, ours.distance);
        continue;
      }
      ++in_fork;
      apart = std::max(apart, ours.distance);
      constexpr int steps = 20;
      for (int k = 0; k <= steps; ++k)
        dip = std::max(dip, std::max(wall(ours.place), wall(x)) -
                                wall(ours.place + (x - ours.place) * (static_cast<double>(k) / steps)));
    }
    MESSAGE("apart by at most ", most, " mm, radii by ", radii, " mm; ", in_fork,
            " places within the ball of the fork, of ", fork.radius, " mm, apart by ", apart,
            " mm on a ridge that dips by ", dip, " mm");
    CHECK(in_fork >= 2);
    CHECK(in_fork <= 4);
    CHECK(most < 0.44);  // half a voxel
    CHECK(dip < 0.22);   // a quarter of a voxel, as the radii
    CHECK(radii < 0.22);
    // and no point of the plane square to the line is farther from the wall than the line is
    double more = 0;
    for (const auto& b : line.branches)
      for (std::size_t i = 1; i + 1 < b.points.size(); ++i) {
        const auto& p = b.points[i];
        if ((p.place - fork.place).norm() > fork.radius) continue;
        const Vec3 u = p.tangent.unitOrthogonal(), v = p.tangent.cross(u);
        for (int k = 0; k < 64; ++k) {
          const double a = 2 * std::numbers::pi * (k % 16) / 16, step = 0.05 * p.radius * (1 + k / 16);
          more = std::max(more, wall(p.place + step * (std::cos(a) * u + std::sin(a) * v)) - p.radius);
        }
      }
    MESSAGE("in the fork a point beside the line is farther from the wall by ", more, " mm at most");
    CHECK(more < 1e-3 * fork.radius);
  }
}
