// SPDX-License-Identifier: MIT
// Several materials from a label image: closed manifold boundaries, conforming tetrahedra, volumes, names.
#include "tunica/meshing/multi_region.hpp"

#include "support/label_images.hpp"

#include "tunica/core/parallel.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace {

using namespace tunica;
using test::check_conforming;
using test::label_image;

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("image: labels become regions that never touch one of their own label") {
    // Two voxels of label 1 that share a corner only: joined along the diagonal (1 1 1), not along (1 1 -1).
    auto g = label_image({4, 4, 4}, {1, 1, 1}, [](const Vec3&) { return 0; });
    g.values[g.offset({1, 1, 1})] = g.values[g.offset({2, 2, 2})] = 1;
    CHECK(image::label_regions(g).regions.size() == 2);
    g.values[g.offset({2, 2, 2})] = 0, g.values[g.offset({2, 2, 0})] = 1;
    CHECK(image::label_regions(g).regions.size() == 3);
    g.axes[0] = {0, 1, 3, 7};  // voxels of uneven width reach half-way, the last as far outward as inward
    const auto r = image::label_regions(g);
    CHECK(r.faces[0] == std::vector<double>{-0.5, 0.5, 2, 5, 9});
    double volume = 0;
    for (const auto& one : r.regions) volume += one.volume;
    CHECK(volume == doctest::Approx(9.5 * 16).epsilon(1e-14));
    g.values[5] = -1;
    CHECK_THROWS_WITH_AS(image::label_regions(g), doctest::Contains("negative"), InputError);
    g.values.assign(g.values.size(), 0);
    CHECK_THROWS_WITH_AS(image::label_regions(g), doctest::Contains("no voxel"), InputError);
    image::Image<float> scan{g.axes, std::vector<float>(64, 2.0F)};
    CHECK(image::as_labels(scan).values == std::vector<std::int32_t>(64, 2));
    scan.values[7] = 2.5F;
    CHECK_THROWS_WITH_AS(image::as_labels(scan), doctest::Contains("2.5"), InputError);
  }

  TEST_CASE("meshing: the contour of any labels bounds every region by closed manifolds that do not cross") {
    for (const int labels : {2, 3, 4, 6})
      for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        const auto g = test::label_noise({7, 8, 9}, labels, seed);
        const auto regions = image::label_regions(g);
        const auto s = meshing::label_contour(regions);
        CAPTURE(labels);
        CAPTURE(seed);
        test::check_manifold(s, regions);
        CHECK(meshing::self_intersections(s.surface(), 1).empty());
        double inside = 0;  // the labelled part of the box
        const auto volume = meshing::volumes_of(s, regions.regions.size());
        for (std::size_t r = 0; r < volume.size(); ++r)
          if (regions.regions[r].label != 0) {
            CHECK(volume[r] > 0);
            inside += volume[r];
          }
        if (labels == 6) CHECK(inside < 7 * 8 * 9);
      }
    // a full box has its volume
    const auto full = label_image({3, 4, 5}, {1, 2, 0.5}, [](const Vec3&) { return 7; });
    const auto regions = image::label_regions(full);
    CHECK(meshing::volumes_of(meshing::label_contour(regions), 1)[0] == doctest::Approx(60).epsilon(1e-14));
  }

  TEST_CASE("meshing: concentric spheres of three materials conform and have the volumes of their voxels") {
    const auto g = label_image({20, 20, 20}, {1, 1, 1}, [](const Vec3& x) {
      const double r = (x - Vec3(9.5, 9.5, 9.5)).norm();
      return r < 4 ? 1 : r < 6.3 ? 2 : r < 8.5 ? 3 : 0;
    });
    const auto m = meshing::multi_region(g, {.names = {{1, "lumen"}, {2, "thrombus"}, {3, "wall"}}});
    check_conforming(m);
    const auto& r = m.report;
    REQUIRE(r.materials.size() == 3);
    CHECK(r.deviation < 1e-9);
    MESSAGE("dihedral ", r.min_dihedral, " degrees, mean ratio ", r.mean_ratio, ", volumes within ",
            r.deviation);
    CHECK(r.min_dihedral >= 12);
    REQUIRE(m.mesh.patches.size() == 3);
    CHECK(m.mesh.patches[0].name == "lumen|thrombus");
    CHECK(m.mesh.patches[1].name == "thrombus|wall");
    CHECK(m.mesh.patches[2].name == "wall|outside");
    CHECK(m.mesh.region_names == std::vector<std::string>{"lumen", "thrombus", "wall"});
  }

  TEST_CASE("meshing: materials that end at the border of the image have flat caps named by it") {
    const auto g = label_image({10, 9, 12}, {1, 1, 0.75}, [](const Vec3& x) {
      const double r = std::hypot(x[0] - 4.6, x[1] - 3.9);
      return r < 2.2 ? 1 : r < 3.6 ? 2 : 0;
    });
    const auto m = meshing::multi_region(g, {.names = {{1, "lumen"}, {2, "wall"}}});
    check_conforming(m);
    CHECK(m.report.deviation < 1e-9);
    std::vector<std::string> names;
    for (const auto& p : m.mesh.patches) names.push_back(p.name);
    CHECK(names == std::vector<std::string>{"lumen|wall", "lumen|border z0", "lumen|border z1",
                                            "wall|outside", "wall|border z0", "wall|border z1"});
    const auto& cap = m.mesh.patch("lumen|border z1");
    for (Eigen::Index i = 0; i < cap.faces.size(); ++i)
      CHECK(m.mesh.nodes(2, cap.faces.data()[i]) == 11.5 * 0.75);  // half a voxel beyond the last one
  }

  TEST_CASE(
      "meshing: islands and contacts at edges and corners are filled; patches need no labels in a row") {
    auto g = label_image({7, 7, 7}, {1, 1, 1}, [](const Vec3&) { return 0; });
    const auto set = [&](Index i, Index j, Index k, int label) { g.values[g.offset({i, j, k})] = label; };
    set(1, 1, 1, 5), set(1, 2, 2, 5), set(2, 1, 2, 9), set(2, 2, 1, 9);  // edges crossed by edges
    set(5, 5, 5, 5), set(4, 4, 5, 9), set(4, 5, 4, 9);                   // corners
    set(6, 6, 0, 7), set(6, 0, 6, 9);  // at an edge and a corner of the image
    const auto m = meshing::multi_region(g);
    check_conforming(m);
    CHECK(m.mesh.region_names == std::vector<std::string>{"material 5", "material 7", "material 9"});
    thread_count() = 2;  // regions are filled beside one another: the same bits
    const auto again = meshing::multi_region(g);
    thread_count() = 1;
    CHECK(again.mesh.nodes == m.mesh.nodes);
    CHECK(again.mesh.cells == m.mesh.cells);
    MESSAGE("volumes of the voxels missed by up to ", m.report.deviation, ", dihedral ",
            m.report.min_dihedral);
  }
}
