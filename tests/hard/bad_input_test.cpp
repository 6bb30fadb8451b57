// SPDX-License-Identifier: MIT
// What a mesher must refuse by name and what it must not: sizes that are no lengths, lone facets, more labels
// than materials; noise that leaves its image.
#include "support/filled.hpp"
#include "support/label_images.hpp"
#include "support/surfaces.hpp"
#include "support/work_cases.hpp"
#include "tunica/core/error.hpp"
#include "tunica/io/closed_surface.hpp"
#include "tunica/meshing/contour_triangles.hpp"
#include "tunica/meshing/intersections.hpp"
#include "tunica/meshing/remesh.hpp"
#include "tunica/meshing/repair.hpp"
#include "tunica/meshing/tetrahedra.hpp"
#include "tunica/meshing/untangle.hpp"
#include "tunica/meshing/vessel_wall.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

using namespace tunica;

namespace {

template <class Work>
std::string refusal(Work&& work) {
  try {
    work();
  } catch (const MeshError& e) {
    return e.what();
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// Noise up to the border, where the surface ends in caps; spacing h.
image::Image<float> open_noise(std::array<Index, 3> size, const Vec3& h, std::uint64_t seed, bool bits) {
  image::Image<float> im;
  for (std::size_t a = 0; a < 3; ++a)
    for (Index i = 0; i < size[a]; ++i) im.axes[a].push_back(i * h[static_cast<Eigen::Index>(a)]);
  const std::size_t count = im.axes[0].size() * im.axes[1].size() * im.axes[2].size();
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint64_t r = test::splitmix64(1 + i + (seed << 32));
    im.values.push_back(bits ? static_cast<float>(r % 2) - 0.5F
                             : static_cast<float>(test::noise(1 + i + (seed << 32))));
  }
  return im;
}

}  // namespace

TEST_SUITE("hard") {
  TEST_CASE("meshing: dual contours of noise that leaves its image are untangled and filled") {
    int tangled = 0, released = 0;
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
      const Vec3 h = seed % 3 == 0 ? Vec3(1, 1, 20) : seed % 3 == 1 ? Vec3(0.05, 1, 1) : Vec3(1, 1, 1);
      const auto size = std::array<Index, 3>{6, static_cast<Index>(5 + seed % 4), 7};
      auto s = meshing::dual_contour_image(open_noise(size, h, seed, seed % 2 == 0), {}, 0).surface;
      const auto report = meshing::untangle(s);
      CAPTURE(seed);
      CHECK(report.crossings_after == 0);
      CHECK(meshing::self_intersections(s, 1).empty());
      CHECK(mesh::topology(s).closed());
      CHECK(test::filling_fault(s, meshing::tetrahedra(s).mesh) == "");
      tangled += report.crossings_before > 0, released += report.released > 0;
    }
    MESSAGE(tangled, " of 12 crossed themselves, ", released, " needed nodes off the border's planes");
    CHECK(released > 0);
  }

  TEST_CASE("meshing: sizes that are no lengths are refused with their place and end at once") {
    const auto s = test::icosphere(3);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const double h : {nan, 0.0, -1.0, -std::numeric_limits<double>::infinity()}) {
      CAPTURE(h);
      const auto everywhere = [h](const Vec3&) { return h; };
      const auto deep = [h](const Vec3& x) { return x.norm() < 0.7 ? h : 0.15; };
      // between the places that are looked at before the work
      const auto seldom = [h](const Vec3& x) {
        return static_cast<std::uint64_t>(std::abs(x[0]) * 1e6) % 97 == 3 ? h : 0.15;
      };
      CHECK(has(refusal([&] { (void)meshing::tetrahedra(s, {}, everywhere); }), "an edge length of"));
      CHECK(has(refusal([&] { (void)meshing::tetrahedra(s, {}, deep); }), " at ("));
      CHECK(has(refusal([&] { (void)meshing::remesh(s, {}, everywhere); }), "an edge length of"));
      CHECK(has(refusal([&] { (void)meshing::remesh(s, {}, seldom); }), " at ("));
    }
    const auto tiny = [](const Vec3& x) { return x.norm() < 0.5 ? 1e-6 : 0.15; };
    CHECK(has(refusal([&] { (void)meshing::tetrahedra(s, {}, tiny); }), "more than 2e+08 tetrahedra"));
    // infinite: the surface alone says how long edges are
    const auto any = [](const Vec3&) { return std::numeric_limits<double>::infinity(); };
    CHECK(test::filling_fault(s, meshing::tetrahedra(s, {}, any).mesh) == "");
  }

  TEST_CASE("meshing: lone facets leave nothing and the refusal says so") {
    mesh::Surface facets;  // 20 apart, then two back to back
    facets.nodes.resize(3, 66), facets.cells.resize(3, 22);
    for (Index t = 0; t < 22; ++t)
      for (Index k = 0; k < 3; ++k) {
        const auto from = static_cast<std::uint64_t>(9 * t + 3 * k);
        facets.cells(k, t) = 3 * t + k;
        for (std::uint64_t a = 0; a < 3; ++a)
          facets.nodes(static_cast<Eigen::Index>(a), 3 * t + k) = test::node_noise(from + a) + 3 * t;
      }
    facets.cells.col(21) << 61, 60, 62;
    for (const auto extent : {meshing::RepairExtent::safe, meshing::RepairExtent::full}) {
      const bool full = extent == meshing::RepairExtent::full;
      io::StlFile file{.surface = meshing::repair(facets, {.extent = extent}).surface, .facets = 22};
      CHECK(file.surface.cell_count() == (full ? 0 : 20));
      CHECK(has(refusal([&] { (void)io::closed_surface("soup.stl", std::move(file)); }),
                full ? "soup.stl: no facet is left of 22" : "soup.stl: the surface is open"));
    }
  }

  TEST_CASE("meshing: a wall without a thickness is refused with its place") {
    const auto tube = test::tube_surface(16, 12, 3, 1, 4);
    for (const double t :
         {0.0, -0.2, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
      const meshing::WallOptions<double> options{.thickness = t, .edge = 0.5};
      CHECK(has(refusal([&] { (void)meshing::vessel_wall(tube, options); }), "a thickness of"));
    }
  }

  TEST_CASE("meshing: an image of as many labels as voxels is no segmentation") {
    int value = 0;
    const auto grey = test::label_image({22, 22, 22}, {1, 1, 1}, [&](const Vec3&) { return ++value; });
    CHECK(has(refusal([&] { (void)meshing::multi_region(grey); }), "10648 labels, more than 10000"));
  }
}
