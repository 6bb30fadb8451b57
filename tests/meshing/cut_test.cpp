// SPDX-License-Identifier: MIT
#include "tunica/meshing/cut.hpp"

#include "support/shared.hpp"
#include "support/work_cases.hpp"
#include "tunica/image/components.hpp"
#include "tunica/io/vtk_image.hpp"
#include "tunica/mesh/quality.hpp"
#include "tunica/mesh/topology.hpp"
#include "tunica/meshing/handles.hpp"
#include "tunica/meshing/intersections.hpp"
#include "tunica/meshing/marching_cubes.hpp"
#include "tunica/meshing/smooth.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <vector>

using namespace tunica;

namespace {

mesh::Surface contour_of(Index n, double (*field)(const Vec3&)) {
  return meshing::marching_cubes(test::sampled<float>(n, [&](const Vec3& x) { return -field(x); }), 0)
      .surface;
}

/// Largest distance of the nodes of a region from a plane.
double off_plane(const mesh::Surface& s, Index region, const meshing::Cut& c) {
  double most = 0;
  for (Index t = 0; t < s.cell_count(); ++t)
    for (int k = 0; k < 3; ++k)
      if (s.region_of(t) == region)
        most = std::max(most, std::abs(c.normal.normalized().dot(s.nodes.col(s.cells(k, t)) - c.point)));
  return most;
}

std::string refusal(const mesh::Surface& s, const meshing::Cut& c, const meshing::CutOptions& o = {}) {
  try {
    (void)meshing::cut(s, {&c, 1}, o);
  } catch (const MeshError& e) {
    return e.what();
  }
  return "";
}

double last_number(const std::string& text) {
  return std::stod(text.substr(text.rfind(' ')));
}

/// A tube bent to a U in the plane x = 0.5, both ends upward.
double bow(const Vec3& x) {
  if (x[2] < 0.5) return std::hypot(std::hypot(x[1] - 0.5, x[2] - 0.5) - 0.3, x[0] - 0.5) - 0.1;
  const double z = std::max(x[2] - 0.85, 0.0);
  return std::hypot(std::min(std::abs(x[1] - 0.2), std::abs(x[1] - 0.8)), x[0] - 0.5, z) - 0.1;
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("meshing: planes cut and cap a bifurcation with sharp plane ends") {
    const auto whole = contour_of(64, test::bifurcation);
    const std::vector<meshing::Cut> cuts{
        {.point = {0.5, 0.5, 0.2}, .normal = {0.02, 0.03, -2}, .name = "inlet"},
        {.point = {0.3, 0.46, 0.78}, .normal = {-0.25, -0.05, 0.36}},
        {.point = {0.7, 0.55, 0.76}, .normal = {0.26, 0.07, 0.34}, .name = "outlet"}};
    const auto r = meshing::cut(whole, cuts);
    const auto t = mesh::topology(r.surface);
    CHECK(t.closed());
    CHECK(t.genus() == 0);
    CHECK(t.components.size() == 1);
    CHECK(mesh::quality(r.surface).angle.least > 0);
    CHECK(meshing::self_intersections(r.surface).empty());
    CHECK(r.surface.region_names == std::vector<std::string>{"wall", "inlet", "cut 2", "outlet"});
    const double diagonal = mesh::bounding_box(r.surface.nodes).diagonal();
    for (std::size_t c = 0; c < cuts.size(); ++c) {
      CHECK(r.cuts[c].region == static_cast<Index>(c + 1));
      CHECK(r.cuts[c].area == doctest::Approx(mesh::area_of_region(r.surface, r.cuts[c].region)));
      CHECK(off_plane(r.surface, r.cuts[c].region, cuts[c]) <= 1e-9 * diagonal);
      CHECK(r.cuts[c].rim_edges > 10);
    }
    CHECK(mesh::enclosed_volume(r.surface) < mesh::enclosed_volume(whole));
  }

  TEST_CASE("meshing: the volume in front of and behind a plane adds up") {
    const auto whole = contour_of(40, test::sphere);
    const Vec3 n = Vec3(1, 2, 3).normalized();
    const meshing::Cut one{.point = Vec3(0.5, 0.5, 0.5) + 0.1 * n, .normal = n},
        other{.point = one.point, .normal = -n};
    const auto behind = meshing::cut(whole, {&one, 1}), front = meshing::cut(whole, {&other, 1});
    const double sum = mesh::enclosed_volume(behind.surface) + mesh::enclosed_volume(front.surface);
    CHECK(sum == doctest::Approx(mesh::enclosed_volume(whole)).epsilon(1e-4));  // snapped nodes move a little
    const double r2 = 0.16 - 0.01;
    CHECK(behind.cuts[0].area == doctest::Approx(std::numbers::pi * r2).epsilon(0.01));
    CHECK((behind.cuts[0].centre - one.point).norm() < 1e-3);
  }

  TEST_CASE("meshing: a disc severs one limb and keeps the part of the seed") {
    const auto whole = contour_of(61, bow);
    const meshing::Cut disc{.point = {0.5, 0.2, 0.6}, .normal = {0, 0, 1}, .radius = 0.15};
    const auto large = meshing::cut(whole, {&disc, 1});
    CHECK(mesh::topology(large.surface).closed());
    CHECK(mesh::topology(large.surface).components.size() == 1);
    CHECK(mesh::bounding_box(large.surface.nodes).hi[2] > 0.9);  // the other limb is whole
    CHECK(large.cuts[0].area == doctest::Approx(std::numbers::pi * 0.01).epsilon(0.02));
    const auto tip = meshing::cut(whole, {&disc, 1}, {.seed = Vec3(0.5, 0.2, 0.8)});
    CHECK(mesh::topology(tip.surface).closed());
    CHECK(mesh::bounding_box(tip.surface.nodes).lo[2] == doctest::Approx(0.6));
    CHECK(mesh::enclosed_volume(tip.surface) + mesh::enclosed_volume(large.surface) ==
          doctest::Approx(mesh::enclosed_volume(whole)).epsilon(1e-4));
    const meshing::Cut plane{.point = disc.point, .normal = disc.normal};  // takes both limbs
    CHECK(mesh::bounding_box(meshing::cut(whole, {&plane, 1}).surface.nodes).hi[2] == doctest::Approx(0.6));
  }

  TEST_CASE("meshing: cuts that cannot be made are refused with their distance") {
    const auto whole = contour_of(61, bow);
    CHECK(refusal(whole, {.point = {0.5, 0.5, 1.5}, .normal = {0, 0, 1}}).find("meets nothing") !=
          std::string::npos);
    CHECK(last_number(refusal(whole, {.point = {0.5, 0.5, 1.5}, .normal = {0, 0, 1}})) ==
          doctest::Approx(0.55).epsilon(1e-3));
    CHECK(refusal(whole, {.point = {0.5, 0.5, -1}, .normal = {0, 0, 1}}).find("leaves nothing") !=
          std::string::npos);
    const auto missing = refusal(whole, {.point = {0.5, 0.22, 0.6}, .normal = {0, 0, 1}, .radius = 0.08});
    CHECK(missing.find("too small by") != std::string::npos);
    CHECK(last_number(missing) == doctest::Approx(0.04).epsilon(0.01));
    CHECK(missing.find("its radius 0.08 is too small by 0.0") != std::string::npos);
    CHECK(refusal(whole, {.point = {0.5, 0.5, 0.6}, .normal = {0, 0, 1}, .radius = 0.05})
              .find("meets nothing") != std::string::npos);
    // a ring: a disc opens it but leaves it connected
    const auto ring = contour_of(41, [](const Vec3& x) {
      return std::hypot(std::hypot(x[0] - 0.5, x[1] - 0.5) - 0.3, x[2] - 0.5) - 0.1;
    });
    CHECK(refusal(ring, {.point = {0.8, 0.5, 0.5}, .normal = {0, 1, 0}, .radius = 0.15}).find("connected") !=
          std::string::npos);
    CHECK(refusal(whole, {.point = {0.5, 0.2, 0.6}, .normal = {0, 0, 1}, .radius = 0.15},
                  {.seed = Vec3(2, 2, 2)})
              .find("seed") != std::string::npos);
    const std::vector<meshing::Cut> swallowed{
        {.point = {0.5, 0.2, 0.8}, .normal = {0, 0, 1}, .radius = 0.15},
        {.point = {0.5, 0.2, 0.6}, .normal = {0, 0, 1}, .radius = 0.15}};
    CHECK_THROWS_WITH_AS((void)meshing::cut(whole, swallowed), doctest::Contains("removes all of \"cut 1\""),
                         MeshError);
  }

  TEST_CASE("meshing: a section with a hole is capped round it") {
    const auto shell =
        contour_of(41, [](const Vec3& x) { return std::abs((x - Vec3(0.5, 0.5, 0.5)).norm() - 0.3) - 0.1; });
    const meshing::Cut c{.point = {0.5, 0.5, 0.53}, .normal = {0.1, 0.2, 1}};
    const auto r = meshing::cut(shell, {&c, 1});
    const auto t = mesh::topology(r.surface);
    CHECK(t.closed());
    CHECK(t.components.size() == 1);
    CHECK(r.cuts[0].area == doctest::Approx(std::numbers::pi * (0.16 - 0.04)).epsilon(0.02));
  }

  TEST_CASE("meshing: planes through nodes and along flat borders leave closed surfaces") {
    const auto tube =
        meshing::marching_cubes(test::sampled<float>(21,
                                                     [](const Vec3& x) {
                                                       return 0.2 - std::hypot(x[0] - 0.5, x[1] - 0.5) +
                                                              0.1 * std::sin(9 * x[2]);
                                                     }),
                                0)
            .surface;
    int made = 0, refused = 0;
    for (const auto& s : {contour_of(24, test::bifurcation), tube}) {
      for (Index n = 0; n < s.node_count(); n += 7) {
        Vec3 normal(test::noise(static_cast<std::uint64_t>(n) + 1),
                    test::noise(static_cast<std::uint64_t>(n) + 2),
                    test::noise(static_cast<std::uint64_t>(n) + 3));
        if (n % 2 == 0) normal = Vec3::Unit(n % 3);  // along the grid: many nodes lie in the plane
        const meshing::Cut c{.point = s.nodes.col(n), .normal = normal};
        mesh::Surface r;
        try {
          r = meshing::cut(s, {&c, 1}).surface;
        } catch (const MeshError& e) {
          const std::string what = e.what();
          INFO(what);
          CHECK((what.find("meets nothing") != std::string::npos ||
                 what.find("leaves nothing") != std::string::npos ||
                 what.find("only touches") != std::string::npos));
          ++refused;
          continue;
        }
        ++made;
        INFO("node ", n, " of ", s.node_count());
        const auto t = mesh::topology(r);
        CHECK(t.open_edges == 0);
        CHECK(t.nonmanifold_edges == 0);
        CHECK(t.nonmanifold_nodes == 0);
        CHECK(t.misoriented_edges == 0);
        CHECK(mesh::quality(r).angle.least > 0);
        CHECK(off_plane(r, 1, c) <= 1e-9);
      }
    }
    MESSAGE(made, " cuts made, ", refused, " refused because they meet nothing");
    CHECK(made > 150);
  }

  TEST_CASE("meshing: the aortic bifurcation is contoured and cut to its known volume") {
    const auto path = test::shared("data/aorta_bifurcation.vtk");
    if (!path) return;
    const auto image = io::read_vtk_image<short>(*path).image;
    const auto region = image::segment(image, {.iso = 1299.5, .seed = image::Voxel{30, 73, 15}});
    const auto open =
        meshing::marching_cubes(image, region.mask.inside, 1299.5, {.border = meshing::Border::open});
    const auto raw = mesh::topology(open.surface);
    CHECK(raw.nodes == 8072);
    CHECK(raw.triangles == 16018);
    CHECK(raw.loops.size() == 3);
    CHECK(raw.open_edges == 128);
    CHECK(mesh::area(open.surface) ==
          doctest::Approx(5550.58).epsilon(1e-3));  // loops may be triangulated otherwise
    auto contour = meshing::marching_cubes(image, region.mask.inside, 1299.5);
    REQUIRE(contour.borders.size() == 2);
    CHECK(contour.borders[0].name == "border y0");
    CHECK(contour.borders[1].name == "border y1");
    const std::vector<meshing::Cut> cuts{
        {.point = {221.567, 165.000, 22.215}, .normal = {0.0011, 0.9996, -0.0283}, .name = "inlet"},
        {.point = {207.554, 94.976, 33.243}, .normal = {-0.2769, -0.9166, 0.2883}, .name = "outlet1"},
        {.point = {237.629, 95.025, 31.872}, .normal = {0.2506, -0.8866, 0.3888}, .name = "outlet2"}};
    for (const int sweeps : {0, 20}) {
      auto surface = contour.surface;
      const auto smoothing = meshing::smooth(surface, {.sweeps = sweeps});
      CHECK(std::abs(smoothing.volume_after / smoothing.volume_before - 1) <= 1e-6);
      const auto r = meshing::cut(surface, cuts);
      const auto t = mesh::topology(r.surface);
      const double volume = mesh::enclosed_volume(r.surface);
      MESSAGE(sweeps, " sweeps: ", r.surface.cell_count(), " triangles, V ", volume, " mm3 (",
              100 * (volume / 10154.17 - 1), " %), A ", mesh::area(r.surface), ", caps ", r.cuts[0].area, " ",
              r.cuts[1].area, " ", r.cuts[2].area, ", smallest angle ", mesh::quality(r.surface).angle.least);
      CHECK(t.closed());
      CHECK(t.genus() == 0);
      CHECK(t.components.size() == 1);
      CHECK(volume == doctest::Approx(10154.17).epsilon(0.005));
      CHECK(r.surface.region_names == std::vector<std::string>{"wall", "inlet", "outlet1", "outlet2"});
      CHECK(r.cuts[0].area == doctest::Approx(171.70).epsilon(0.01));
      CHECK(r.cuts[1].area == doctest::Approx(53.79).epsilon(0.015));
      CHECK(r.cuts[2].area == doctest::Approx(48.04).epsilon(0.015));
      for (std::size_t c = 0; c < 3; ++c)
        CHECK(off_plane(r.surface, r.cuts[c].region, cuts[c]) <=
              1e-9 * mesh::bounding_box(r.surface.nodes).diagonal());
      CHECK(meshing::self_intersections(r.surface).empty());
    }
    // discs do the same where planes also cross the other vessel
    auto discs = cuts;
    discs[0].radius = 9, discs[1].radius = 6, discs[2].radius = 6;
    const auto severed = meshing::cut(contour.surface, discs, {.seed = Vec3(221.484, 150.293, 22.501)});
    CHECK(mesh::enclosed_volume(severed.surface) == doctest::Approx(10154.17).epsilon(0.005));
    const auto small =
        refusal(contour.surface, {.point = cuts[1].point, .normal = cuts[1].normal, .radius = 3});
    CHECK(small.find("too small by 1.48") != std::string::npos);  // its largest radius is 4.48 mm
  }

  TEST_CASE("meshing: the traps of the aortic bifurcation are reported") {
    const auto path = test::shared("data/aorta_bifurcation.vtk");
    if (!path) return;
    const auto image = io::read_vtk_image<short>(*path).image;
    const auto at = [&](double iso) {
      const auto region = image::segment(image, {.iso = iso, .seed = image::Voxel{30, 73, 15}});
      return meshing::marching_cubes(image, region.mask.inside, iso);
    };
    const auto equal = at(1300).surface;  // 13 nodes lie on the iso-value
    CHECK(mesh::quality(equal).angle.least > 0);
    CHECK(mesh::topology(equal).closed());
    const auto handle = at(1199.5).surface;
    const auto t = mesh::topology(handle);
    CHECK(t.genus() == 1);
    const auto found = meshing::handles(handle, t);
    REQUIRE(found.size() == 1);
    MESSAGE("handle at ", found[0].place.transpose(), ", ", found[0].length, " mm round");
    CHECK(found[0].length < 10);
    CHECK(at(1100).borders.size() == 3);  // a lumbar branch leaves through z1
    CHECK(at(1100).borders.back().name == "border z1");
  }
}
