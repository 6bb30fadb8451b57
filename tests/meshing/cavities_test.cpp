// SPDX-License-Identifier: MIT
#include "tunica/meshing/cavities.hpp"

#include "tunica/image/image.hpp"
#include "tunica/meshing/marching_cubes.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace tunica;

namespace {

/// A block of 11 x 9 x 9 voxels within 13 x 11 x 11, with a cavity of one voxel and one of 3 x 3 x 3.
image::Image<float> block() {
  image::Image<float> image;
  for (int i = 0; i < 13; ++i) image.axes[0].push_back(0.5 * i);
  for (int i = 0; i < 11; ++i) image.axes[1].push_back(0.5 * i), image.axes[2].push_back(0.5 * i);
  for (int k = 0; k < 11; ++k)
    for (int j = 0; j < 11; ++j)
      for (int i = 0; i < 13; ++i) {
        const bool border = i == 0 || j == 0 || k == 0 || i == 12 || j == 10 || k == 10;
        const bool speck = i == 3 && j == 5 && k == 5;
        const bool hole = std::abs(i - 8) <= 1 && std::abs(j - 5) <= 1 && std::abs(k - 5) <= 1;
        image.values.push_back(border || speck || hole ? 0.0F : 2.0F);
      }
  return image;
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("meshing: cavities smaller than asked for are filled and the others stay as they are") {
    const auto surface = meshing::marching_cubes(block(), 1).surface;
    const auto topology = mesh::topology(surface);
    REQUIRE(topology.components.size() == 3);
    const double whole = mesh::enclosed_volume(surface);
    // halfway cuts: the speck is an octahedron of half-diagonal h/2, that is h^3/6
    const double speck = 0.125 / 6;

    const auto none = meshing::fill_cavities(surface, topology, 0);
    CHECK(none.filled.empty());
    CHECK(none.surface.nodes == surface.nodes);
    CHECK(none.surface.cells == surface.cells);

    const auto one = meshing::fill_cavities(surface, topology, 1.0);
    REQUIRE(one.filled.size() == 1);
    CHECK(one.filled[0].volume == doctest::Approx(speck));
    CHECK(vec::distance(one.filled[0].centre, {1.5, 2.5, 2.5}) < 1e-12);
    const auto kept = mesh::topology(one.surface);
    CHECK(kept.closed());
    CHECK(kept.unused_nodes == 0);
    CHECK(kept.components.size() == 2);
    CHECK(mesh::enclosed_volume(one.surface) == doctest::Approx(whole + speck).epsilon(1e-12));
    CHECK(one.surface.region.size() == static_cast<std::size_t>(one.surface.cell_count()));
    CHECK(one.surface.region_names == surface.region_names);

    const auto both = meshing::fill_cavities(surface, topology, 100.0);
    CHECK(both.filled.size() == 2);
    CHECK(mesh::topology(both.surface).components.size() == 1);
  }

  TEST_CASE("meshing: a speck that is inside out is filled and the body itself never") {
    auto surface = meshing::marching_cubes(block(), 1).surface;
    const auto before = mesh::topology(surface);
    for (Index t = 0; t < surface.cell_count(); ++t)
      if (std::abs(
              before.components[static_cast<std::size_t>(before.component_of[static_cast<std::size_t>(t)])]
                  .volume) < 0.1)
        std::swap(surface.cells(1, t), surface.cells(2, t));
    CHECK(meshing::fill_cavities(surface, mesh::topology(surface), 1.0).filled.size() == 1);
    const auto all = meshing::fill_cavities(surface, mesh::topology(surface), 1e9);
    CHECK(all.filled.size() == 2);
    CHECK(mesh::topology(all.surface).components.size() == 1);
    CHECK(mesh::enclosed_volume(all.surface) > 100 * 0.125);
  }
}
