// SPDX-License-Identifier: MIT
// Dual contouring together with cuts: sharp rims, ends in their planes, closed for any plane and any data.
#include "tunica/meshing/dual_cuts.hpp"

#include "support/contours.hpp"
#include "tunica/core/parallel.hpp"
#include "tunica/mesh/measures.hpp"

#include <doctest/doctest.h>

#include <Eigen/Geometry>

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

using namespace tunica;
using meshing::Cut;

namespace {

// Open, wrong and degenerate things of a surface, and how far nodes of flat regions lie from their planes.
struct Faults {
  int topology = 0;
  Index degenerate = 0;
  double off_plane = 0;
  long euler = 0;
};

Faults faults(const mesh::Surface& s, const std::vector<Cut>& cuts) {
  Faults f;
  const auto t = test::contours::topology(s);
  f.topology = t.open_edges + t.wrong_edges + t.wrong_vertices + t.loose_vertices;
  f.euler = t.euler;
  for (Index c = 0; c < s.cell_count(); ++c) {
    f.degenerate += !(mesh::triangle(s, c).area() > 0);
    const auto r = static_cast<std::size_t>(s.region_of(c));
    if (r == 0 || r > cuts.size()) continue;
    const Cut& cut = cuts[r - 1];
    for (int k = 0; k < 3; ++k)
      f.off_plane = std::max(f.off_plane,
                             std::abs(cut.normal.normalized().dot(mesh::node(s, s.cells(k, c)) - cut.point)));
  }
  return f;
}

// Nodes of a region that the wall has too.
std::vector<Vec3> rim(const mesh::Surface& s, Index region) {
  std::vector<char> wall(static_cast<std::size_t>(s.node_count()), 0), seen(wall);
  for (Index c = 0; c < s.cell_count(); ++c)
    if (s.region_of(c) == 0)
      for (int k = 0; k < 3; ++k) wall[static_cast<std::size_t>(s.cells(k, c))] = 1;
  std::vector<Vec3> nodes;
  for (Index c = 0; c < s.cell_count(); ++c)
    if (s.region_of(c) == region)
      for (int k = 0; k < 3; ++k) {
        const auto n = static_cast<std::size_t>(s.cells(k, c));
        if (wall[n] != 0 && seen[n] == 0) seen[n] = 1, nodes.push_back(mesh::node(s, s.cells(k, c)));
      }
  return nodes;
}

struct Random {
  std::uint64_t at;
  double operator()() { return static_cast<double>(test::contours::splitmix64(++at) >> 11) * 0x1p-52 - 1; }
  Vec3 vector() {
    const double x = (*this)(), y = (*this)(), z = (*this)();
    return {x, y, z};
  }
};

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("meshing: a cylinder contoured with its cuts has sharp rims in their planes") {
    const double radius = 0.23;
    const Vec3 centre(0.51, 0.49, 0.5), axis = Vec3(1, 2, 6).normalized();
    const auto off = [&](const Vec3& x) { return (x - centre).cross(axis).norm() - radius; };
    for (const Index n : {32, 64}) {
      const double h = 1.0 / (n - 1);
      const auto im = test::contours::sampled(n, [&](const Vec3& x) { return -off(x); });
      // one square to the axis, one oblique, both of lengths other than 1
      const std::vector<Cut> cuts{{.point = centre + 0.24 * axis, .normal = 3 * axis, .name = "outlet"},
                                  {.point = centre - 0.2 * axis, .normal = -axis + Vec3(0.3, -0.2, 0)}};
      const auto made = meshing::dual_contour_image(im, {}, 0, cuts);
      const mesh::Surface& s = made.contour.surface;
      CHECK(s.region_names == std::vector<std::string>{"wall", "outlet", "cut 2"});
      CHECK(made.contour.borders.empty());
      const Faults f = faults(s, cuts);
      CHECK(f.topology == 0);
      CHECK(f.degenerate == 0);
      CHECK(f.euler == 2);
      CHECK(f.off_plane < 1e-14);
      double worst = 0;
      for (Index r = 1; r <= 2; ++r)
        for (const Vec3& x : rim(s, r)) worst = std::max(worst, std::abs(off(x)));
      const double volume = std::numbers::pi * radius * radius *
                            0.44;  // a plane through the axis point halves what it leans over
      MESSAGE(n, " samples: rims off the cylinder by at most ", worst / h, " h; volume ",
              100 * (mesh::enclosed_volume(s) / volume - 1), " %; outlet ",
              100 * (made.cuts[0].area / (std::numbers::pi * radius * radius) - 1), " %");
      CHECK(worst < 0.05 * h);
      CHECK(mesh::enclosed_volume(s) == doctest::Approx(volume).epsilon(n == 32 ? 0.01 : 0.0025));
      CHECK(made.cuts[0].area ==
            doctest::Approx(std::numbers::pi * radius * radius).epsilon(n == 32 ? 0.01 : 0.0025));
      CHECK((made.cuts[0].centre - cuts[0].point).norm() < 0.02 * h);
      CHECK(made.cuts[1].rim_edges > 20);
    }
  }

  TEST_CASE("meshing: noise contoured with any cut is closed and has no degenerate triangle") {
    Random random{7};
    int tried = 0;
    double off_plane = 0;
    for (const bool integers : {false, true})
      for (int trial = 0; trial < 40; ++trial) {
        const auto im = test::contours::noise(11, integers, 1000 * static_cast<std::uint64_t>(1 + trial));
        Cut cut{.point = Vec3::Constant(0.5) + 0.2 * random.vector(), .normal = random.vector()};
        if (trial % 4 > 0) {  // through nodes: along faces, across edges, across corners
          cut.point = Vec3(0.5, 0.4, 0.6);
          cut.normal = trial % 4 == 1 ? Vec3(0, 0, trial % 8 < 4 ? 1 : -1)
                                      : Vec3(1, trial % 8 < 4 ? 1 : -1, trial % 4 == 2 ? 0 : 1);
        }
        if (trial % 3 == 0) cut.normal[0] = 1e-7;
        std::vector<Cut> cuts{cut};
        if (trial % 5 == 4)
          cuts.push_back({.point = cut.point - 0.3 * cut.normal.normalized(), .normal = -cut.normal});
        const auto quads = meshing::dual_contour_quads(im, {}, 0, cuts);
        const auto s = meshing::dual_contour_image(im, {}, 0, cuts).contour.surface;
        const Faults f = faults(s, cuts);
        CAPTURE(trial);
        CHECK(test::contours::topology(quads).wrong_edges == 0);
        CHECK(f.topology == 0);
        CHECK(f.degenerate == 0);
        off_plane = std::max(off_plane, f.off_plane);
        ++tried;
      }
    MESSAGE(tried, " surfaces; nodes of cuts off their planes by at most ", off_plane);
    CHECK(off_plane < 1e-14);
  }

  TEST_CASE("meshing: cuts at the border of an image keep both flat parts") {
    const auto im =
        test::contours::sampled(24, [](const Vec3& x) { return 0.31 - (x - Vec3(0.9, 0.5, 0.1)).norm(); });
    const std::vector<Cut> cuts{{.point = Vec3(0.9, 0.45, 0.1), .normal = Vec3(0.1, -1, 0.2)}};
    const auto made = meshing::dual_contour_image(im, {}, 0, cuts);
    const mesh::Surface& s = made.contour.surface;
    CHECK(s.region_names == std::vector<std::string>{"wall", "cut 1", "border x1", "border z0"});
    CHECK(made.contour.borders.size() == 2);
    const Faults f = faults(s, cuts);
    CHECK(f.topology == 0);
    CHECK(f.degenerate == 0);
    CHECK(f.euler == 2);
    CHECK(f.off_plane < 1e-15);
    for (Index t = 0; t < s.cell_count(); ++t)
      for (int k = 0; k < 3; ++k) {
        if (s.region_of(t) == 2) CHECK(s.nodes(0, s.cells(k, t)) == 1.0);
        if (s.region_of(t) == 3) CHECK(s.nodes(2, s.cells(k, t)) == 0.0);
      }
  }

  TEST_CASE("meshing: discs sever only their vessels before the contour is made") {
    const auto im = test::contours::sampled(48, test::contours::bifurcation);
    const Vec3 B(.5, .5, .5), C(.25, .45, .86), D(.76, .57, .84);
    const Vec3 one = (C - B).normalized(), two = (D - B).normalized();
    // the planes of the discs cross the other branch and the trunk as well
    std::vector<Cut> discs{
        {.point = Vec3(.5, .5, .2), .normal = Vec3(0, 0, -1), .radius = 0.2, .name = "inlet"},
        {.point = B + 0.3 * one, .normal = one, .radius = 0.13},
        {.point = B + 0.3 * two, .normal = two, .radius = 0.12}};
    const auto made = meshing::dual_contour_image(im, {}, 0, discs);
    const mesh::Surface& s = made.contour.surface;
    const Faults f = faults(s, discs);
    CHECK(f.topology == 0);
    CHECK(f.degenerate == 0);
    CHECK(f.euler == 2);
    CHECK(f.off_plane < 1e-14);
    CHECK(made.cuts[0].area == doctest::Approx(std::numbers::pi * .11 * .11).epsilon(0.02));
    CHECK(made.cuts[1].area == doctest::Approx(std::numbers::pi * .08 * .08).epsilon(0.02));
    CHECK(made.cuts[2].area == doctest::Approx(std::numbers::pi * .07 * .07).epsilon(0.02));
    const double h = 1.0 / 47;
    for (Index r = 1; r <= 3; ++r)
      for (const Vec3& x : rim(s, r)) CHECK(std::abs(test::contours::bifurcation(x)) < 0.05 * h);

    auto turned = discs;  // what stays does not depend on the side that normals point to
    for (Cut& c : turned) c.normal *= -2;
    const auto same = meshing::dual_contour_image(im, {}, 0, turned).contour.surface;
    CHECK(same.cells == s.cells);
    CHECK((same.nodes - s.nodes).cwiseAbs().maxCoeff() < 1e-12);
    thread_count() = 2;
    CHECK(meshing::dual_contour_image(im, {}, 0, discs).contour.surface.nodes == s.nodes);
    thread_count() = 1;

    // the seed takes the tip of the branch instead
    const std::vector<Cut> tip{discs[1]};
    const auto branch = meshing::dual_contour_image(im, {}, 0, tip, {.seed = C}).contour.surface;
    CHECK(faults(branch, tip).topology == 0);
    CHECK(mesh::enclosed_volume(branch) < 0.3 * mesh::enclosed_volume(s));
    CHECK(mesh::bounding_box(branch.nodes).lo[2] > 0.6);

    const auto refusal = [&](const Cut& cut) {
      try {
        (void)meshing::dual_contour_quads(im, {}, 0, std::vector<Cut>{cut});
      } catch (const MeshError& e) {
        return std::string(e.what());
      }
      return std::string();
    };
    CHECK(refusal({.point = B + 0.3 * one, .normal = one, .radius = 0.05})
              .find("does not sever the vessel round") != std::string::npos);
    CHECK(
        refusal({.point = Vec3(.5, .9, .5), .normal = Vec3(0, 0, 1), .radius = 0.05}).find("meets nothing") !=
        std::string::npos);
    CHECK(refusal({.point = Vec3(.5, .5, -2), .normal = Vec3(0, 0, 1)}).find("leaves nothing") !=
          std::string::npos);
    CHECK(refusal({.point = Vec3(.5, .5, 2), .normal = Vec3(0, 0, 1)}).find("at a distance of 1.") !=
          std::string::npos);
  }
}
