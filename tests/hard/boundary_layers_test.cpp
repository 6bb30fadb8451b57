// SPDX-License-Identifier: MIT
// Boundary layers where there is little room: the crotch of a bifurcation, stubs thinner than the layers,
// walls that nearly touch, rough and noisy surfaces, the real aorta. No cell may be inverted anywhere.
#include "tunica/meshing/boundary_layers.hpp"

#include "support/layers.hpp"
#include "support/shared.hpp"
#include "support/surfaces.hpp"
#include "support/vessels.hpp"
#include "support/work_cases.hpp"
#include "tunica/image/components.hpp"
#include "tunica/io/stl.hpp"
#include "tunica/io/vtk_image.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace tunica;
using mesh::Surface;
namespace layers = test::layers;

meshing::LayeredFill filled(const std::string& name, const Surface& s, const meshing::LayerOptions& o = {}) {
  auto fill = meshing::layered_tetrahedra(s, o);
  layers::check(name, s, fill);
  layers::tell(name, s, fill);
  return fill;
}

/// Least share over the nodes of the wall for which far(place) holds.
template <class Far>
double least_share(const Surface& s, const meshing::LayeredFill& fill, const Far& far) {
  double least = 1;
  for (Index n = 0; n < s.node_count(); ++n)
    if (far(Vec3(s.nodes.col(n)))) least = std::min(least, fill.share[static_cast<std::size_t>(n)]);
  return least;
}

double distance_to_segment(const Vec3& x, const Vec3& a, const Vec3& b) {
  const double t = std::clamp((x - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (x - a - t * (b - a)).norm();
}

/// What an image gives without cuts: closed, of one region.
Surface contour(const image::Image<float>& im, double sign, int sweeps) {
  image::Image<float> inside = im;
  std::vector<std::uint8_t> kept;
  for (float& v : inside.values) v *= static_cast<float>(sign), kept.push_back(v >= 0 ? 1 : 0);
  Surface s = meshing::marching_cubes(inside, kept, 0.0).surface;
  if (sweeps > 0) (void)meshing::smooth(s, {.sweeps = sweeps});
  return s;
}

}  // namespace

TEST_SUITE("hard") {
  TEST_CASE("meshing: layers in a sharp crotch lean away from its edge") {
    // Two tubes of radius 3 that leave one of radius 4 at 25 degrees to each side, joined without any blend.
    const Vec3 foot(0, 0, 0), top(0, 0, 14);
    const std::vector<Vec3> ends{Vec3(8, 0, 31), Vec3(-8, 0, 31)};
    const auto level = [&](const Vec3& x) {
      double v = 4 - distance_to_segment(x, foot - Vec3(0, 0, 5), top);
      for (const Vec3& e : ends) v = std::max(v, 3 - distance_to_segment(x, top, top + 1.5 * (e - top)));
      return v;
    };
    std::vector<meshing::Cut> ports{{.point = foot, .normal = Vec3(0, 0, -1), .name = "inlet"}};
    for (const Vec3& e : ends)
      ports.push_back({.point = e, .normal = (e - top).normalized(), .radius = 4.5, .name = "outlet"});
    ports[1].name += " left", ports[2].name += " right";
    for (const double edge : {1.5, 0.75}) {
      const Surface s = layers::vessel(level, ports, {Vec3(-13, -6, -2), Vec3(13, 6, 36)}, 0.5, edge);
      const auto fill = filled("crotch, edge " + std::to_string(edge), s);
      CHECK(fill.report.vanished == 0);
      CHECK(fill.report.full_share > 0.9);
      const Vec3 crotch = fill.report.thinnest;
      CHECK(least_share(s, fill, [&](const Vec3& x) { return (x - crotch).norm() > 8; }) > 0.5);
    }
  }

  TEST_CASE("meshing: layers end in stubs thinner than they are and are whole elsewhere") {
    for (const double radius : {0.5, 0.8, 1.5})
      for (const double length : {1.5, 3.0}) {
        const auto level = [&](const Vec3& x) {
          return std::max(6 - std::hypot(x[0], x[1]),
                          radius - distance_to_segment(x, Vec3(0, 0, 10), Vec3(6 + length - radius, 0, 10)));
        };
        const Surface s =
            layers::vessel(level,
                           {{.point = Vec3(0, 0, 0), .normal = Vec3(0, 0, -1), .name = "inlet"},
                            {.point = Vec3(0, 0, 20), .normal = Vec3(0, 0, 1), .name = "outlet"}},
                           {Vec3(-7, -7, -1.1), Vec3(10, 7, 21.1)}, 0.25, 1);
        const auto fill = filled("stub of radius " + std::to_string(radius).substr(0, 3) + " and length " +
                                     std::to_string(length).substr(0, 3),
                                 s, {.layers = 4});
        CHECK(fill.report.full_share > 0.9);
        const Vec3 root(6, 0, 10);  // columns are at most 2.5 high, and slopes 0.5
        CHECK(least_share(s, fill, [&](const Vec3& x) { return (x - root).norm() > 8; }) > 0.95);
      }
  }

  TEST_CASE("meshing: layers give way between walls whose gap is far below their edges") {
    for (const double gap : {0.3, 0.1, 0.02, 0.004}) {  // a hole in a sphere, edges of 0.15
      Surface s = test::icosphere(4, 2.0);
      Surface hole = test::icosphere(3, 1.0, Vec3(1 - gap, 0, 0));
      hole.cells.row(1).swap(hole.cells.row(2));
      s = test::joined(s, hole);
      const auto fill = filled("gap of " + std::to_string(gap), s, {.layers = 3});
      CHECK(fill.report.full_share > 0.5);
      CHECK(fill.report.thinnest[0] > 1.5);
    }
  }

  TEST_CASE("meshing: layers on smoothed random waves and on noise never turn a cell over") {
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
      const auto image = test::sampled<float>(24, test::RandomWaves(seed));
      (void)filled("waves " + std::to_string(seed), contour(image, -1, 20), {.layers = 3});
    }
    for (const std::uint64_t seed : {1U, 2U, 3U})
      (void)filled("noise " + std::to_string(seed), contour(test::noise_volume(10, seed), 1, 0),
                   {.layers = 3});
  }

  TEST_CASE("meshing: layers in the phantom and in the real aorta") {
    for (const double edge : {2.0, 1.5}) {
      const Surface s = meshing::remesh(test::vessels::bifurcation(edge), {.edge = edge}).surface;
      const auto fill = filled("phantom, edge " + std::to_string(edge), s);
      CHECK(fill.report.full_share > 0.9);
      CHECK(fill.report.vanished == 0);
    }
    const auto path = test::shared("data/aorta_bifurcation.vtk");
    if (!path) return;
    const auto image = io::read_vtk_image(*path).image;
    constexpr double iso = 1299.5;
    const image::Voxel seed{30, 73, 15};
    const auto region = image::segment(image, {.iso = iso, .seed = seed});
    Surface whole = meshing::marching_cubes(image, region.mask.inside, iso).surface;
    (void)meshing::smooth(whole);
    const std::vector<meshing::Cut> cuts{
        {.point = {221.567, 165, 22.215}, .normal = {0.0011, 0.9996, -0.0283}, .name = "inlet"},
        {.point = {207.554, 94.976, 33.243}, .normal = {-0.2769, -0.9166, 0.2883}, .name = "left"},
        {.point = {237.629, 95.025, 31.872}, .normal = {0.2506, -0.8866, 0.3888}, .name = "right"}};
    meshing::CutOptions how;
    how.seed = image.position(seed);
    const Surface vessel = meshing::cut(std::move(whole), cuts, how).surface;
    for (const double edge : {2.25, 1.5, 1.0}) {
      const Surface s = meshing::remesh(vessel, {.edge = edge}).surface;
      const auto fill = filled("real bifurcation, edge " + std::to_string(edge), s);
      CHECK(fill.report.full_share > 0.9);
      CHECK(fill.report.core.min_dihedral > 5);
      // The thinnest place is the blind stub.
      CHECK((fill.report.thinnest - Vec3(211.2, 118.9, 34.6)).norm() < 3);
    }
  }

  TEST_CASE("meshing: layers on a clipped lumen with angles of a hundredth of a degree") {
    const auto path = test::shared("data/lumen_iso1299.5_clipped.stl");
    if (!path) return;
    const auto fill = filled("clipped lumen", io::read_stl(*path).surface, {.layers = 3});
    CHECK(fill.report.columns > 5000);
  }
}
