// SPDX-License-Identifier: MIT
// Levelling and untangling: what dual contouring leaves behind on curved and on rough data.
#include "tunica/meshing/level.hpp"

#include "support/contours.hpp"
#include "tunica/mesh/topology.hpp"
#include "tunica/meshing/contour_triangles.hpp"
#include "tunica/meshing/untangle.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

using namespace tunica;

namespace {

constexpr double radius = 0.31;
const Vec3 centre(0.51, 0.49, 0.52);

double sphere(const Vec3& x) {
  return radius - vec::distance(x, centre);
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("meshing: levelling gives the dual contour of a sphere its volume") {
    const double volume = 4 * std::numbers::pi / 3 * radius * radius * radius;
    double coarse = 0;
    for (const int n : {17, 33}) {
      const auto image = test::contours::sampled(n, sphere);
      auto surface = meshing::dual_contour_image(image, {}, 0).surface;
      const double before = mesh::enclosed_volume(surface) / volume - 1;
      meshing::level(surface, sphere, 0, {.reach = 0.25 / (n - 1)});
      const double after = mesh::enclosed_volume(surface) / volume - 1;
      MESSAGE(n, " samples: volume of the dual contour ", 100 * before, " %, levelled ", 100 * after, " %");
      CHECK(std::abs(after) < 0.1 * std::abs(before));
      CHECK(mesh::topology(surface).closed());
      if (coarse != 0) CHECK(std::abs(after) < 0.5 * std::abs(coarse));
      coarse = after;
    }
  }

  TEST_CASE("meshing: levelling moves no node farther than its reach and flat ends stay flat") {
    const auto ball = [](const Vec3& x) { return 0.31 - vec::distance(x, {0.9, 0.5, 0.1}); };
    const auto image = test::contours::sampled(24, ball);
    const auto before = meshing::dual_contour_image(image, {}, 0).surface;
    auto after = before;
    constexpr double reach = 1e-3;
    meshing::level(after, ball, 0, {.reach = reach});
    CHECK(after.cells == before.cells);
    CHECK(after.nodes != before.nodes);
    for (Index n = 0; n < after.node_count(); ++n)
      CHECK(vec::distance(mesh::node(after, n), mesh::node(before, n)) < reach * (1 + 1e-12));
    for (Index t = 0; t < after.cell_count(); ++t)
      for (int k = 0; k < 3; ++k) {
        const Vec3 x = mesh::node(after, after.cells(k, t));
        if (after.region_of(t) == 1) CHECK(std::abs(x[0] - 1) < 1e-12);
        if (after.region_of(t) == 2) CHECK(std::abs(x[2]) < 1e-12);
      }
  }

  TEST_CASE("meshing: a node pushed through its surface is untangled and the rest stays") {
    const auto image = test::contours::sampled(17, sphere);
    auto surface = meshing::dual_contour_image(image, {}, 0).surface;
    CHECK(meshing::untangle(surface).crossings_before == 0);
    const auto before = surface;
    const Vec3 x = mesh::node(surface, 0);  // to the far side and out of it
    vec::set_column(surface.nodes, 0, vec::along(x, -2.2, vec::minus(x, centre)));
    const auto r = meshing::untangle(surface);
    CHECK(r.crossings_before > 0);
    CHECK(r.crossings_after == 0);
    CHECK(meshing::self_intersections(surface).empty());
    CHECK(surface.cells == before.cells);
    Index moved = 0;
    for (Index n = 1; n < surface.node_count(); ++n) moved += mesh::node(surface, n) != mesh::node(before, n);
    MESSAGE(r.crossings_before, " crossings, ", r.moved, " of ", surface.node_count(), " nodes moved");
    CHECK(moved + 1 >= r.moved);
    CHECK(r.moved < surface.node_count() / 2);
  }

  TEST_CASE("meshing: rough dual contours are untangled within their flat ends") {
    for (std::uint64_t seed = 0; seed < 3; ++seed) {  // a ball at a corner of the image, roughened by noise
      const auto noise = test::contours::noise(20, false, 77 + 1000 * seed);
      auto image = noise;
      for (std::size_t v = 0; v < image.values.size(); ++v) {
        const auto i = static_cast<Index>(v % 20), j = static_cast<Index>(v / 20 % 20),
                   k = static_cast<Index>(v / 400);
        const Vec3 x = image.position({i, j, k});
        image.values[v] = static_cast<decltype(image.values[v] + 0)>(
            0.7 - vec::length(x) + 0.02 * static_cast<double>(noise.values[v]));
      }
      auto surface = meshing::dual_contour_image(image, {}, 0).surface;
      const auto r = meshing::untangle(surface);
      MESSAGE(r.crossings_before, " crossings, ", r.crossings_after, " left, ", r.moved, " nodes moved");
      CHECK(r.crossings_after == 0);
      CHECK(mesh::topology(surface).closed());
      for (Index t = 0; t < surface.cell_count(); ++t)
        if (const Index region = surface.region_of(t); region > 0)
          for (int a = 0; a < 3; ++a)
            if (surface.region_names[static_cast<std::size_t>(region)] ==
                std::string("border ") + "xyz"[a] + "0")
              for (int k = 0; k < 3; ++k) CHECK(std::abs(surface.nodes(a, surface.cells(k, t))) < 1e-12);
    }
  }
}
