// SPDX-License-Identifier: MIT
// Observed orders of marching cubes: vertices, volume and area on a sphere and on a bifurcation.
#include "tunica/meshing/marching_cubes.hpp"

#include "support/work_cases.hpp"
#include "tunica/mesh/measures.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <numbers>

using namespace tunica;

TEST_SUITE("convergence") {
  TEST_CASE("meshing: marching cubes is of second order on a sphere") {
    // off the symmetry of the grid, which repeats each cut 48 times
    const auto sphere = [](const Vec3& x) { return (x - Vec3(0.513, 0.487, 0.506)).norm() - 0.4; };
    const double volume = 4.0 / 3 * std::numbers::pi * 0.064, area = 4 * std::numbers::pi * 0.16;
    std::array<double, 3> vertex{}, vol{}, surf{};
    const std::array<Index, 3> sizes{33, 65, 129};
    for (std::size_t n = 0; n < 3; ++n) {
      const auto c = meshing::marching_cubes(
          test::sampled<double>(sizes[n], [&](const Vec3& x) { return -sphere(x); }), 0);
      vertex[n] = test::distance_to_zero(c.surface.nodes, sphere).first;
      vol[n] = std::abs(mesh::enclosed_volume(c.surface) / volume - 1);
      surf[n] = std::abs(mesh::area(c.surface) / area - 1);
      MESSAGE("sphere ", sizes[n], "^3: vertex rms ", vertex[n], " volume ", vol[n], " area ", surf[n]);
    }
    for (std::size_t n = 1; n < 3; ++n) {
      MESSAGE("orders: vertex ", std::log2(vertex[n - 1] / vertex[n]), " volume ",
              std::log2(vol[n - 1] / vol[n]), " area ", std::log2(surf[n - 1] / surf[n]));
      CHECK(std::log2(vertex[n - 1] / vertex[n]) > 1.9);
      CHECK(std::log2(vol[n - 1] / vol[n]) > 1.9);
      CHECK(std::log2(surf[n - 1] / surf[n]) > 1.9);
    }
  }

  TEST_CASE("meshing: marching cubes is of second order on a bifurcation") {
    std::array<double, 2> rms{};
    const std::array<Index, 2> sizes{64, 128};
    for (std::size_t n = 0; n < 2; ++n) {
      const double h = 1.0 / (sizes[n] - 1);
      const auto c = meshing::marching_cubes(
          test::sampled<float>(sizes[n], [](const Vec3& x) { return -test::bifurcation(x); }), 0);
      const auto [r, most] = test::distance_to_zero(c.surface.nodes, test::bifurcation);
      rms[n] = r;
      MESSAGE("bif ", sizes[n], ": ", c.surface.cell_count(), " triangles, vertex rms ", r / h, " h, max ",
              most / h, " h");
      CHECK(r / h < 1.01 * (n == 0 ? 7.14e-3 : 3.61e-3));  // what the same linear cut gives elsewhere
    }
    CHECK(rms[0] / rms[1] > 3.7);
  }
}
