// SPDX-License-Identifier: MIT
// Observed orders of marching cubes: vertices, volume, area and normals on a sphere, a bifurcation and the
// phantom.
#include "tunica/meshing/marching_cubes.hpp"

#include "support/work_cases.hpp"
#include "tunica/image/phantom_truth.hpp"
#include "tunica/image/sampling.hpp"
#include "tunica/mesh/measures.hpp"
#include "tunica/meshing/cut.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

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

  TEST_CASE(
      "meshing: marching cubes of the phantom has vertices and volume of second order and normals of first") {
    const image::Phantom phantom;
    const double truth = image::lumen_volume(phantom);
    std::vector<meshing::Cut> ends;
    for (const auto& port : image::Phantom::ports())
      ends.push_back({.point = port.point, .normal = port.normal, .name = port.name});
    std::array<double, 3> vertex{}, normal{}, volume{};
    for (std::size_t level = 0; level < 3; ++level) {
      const auto scan = image::sample(phantom, image::Sampling{}.refined(1 << level));
      const auto surface = meshing::marching_cubes(scan, image::Phantom::surface).surface;
      // between the ports: the border of the image has caps
      const auto within = [](const Vec3& x) {
        return x[1] > image::Phantom::outlet_y && x[1] < image::Phantom::inlet_y;
      };
      double squares = 0, turns = 0, area = 0;
      Index count = 0;
      const Index every = 1 << (2 * level);  // about as many at each level
      for (Index n = 0; n < surface.node_count(); n += every) {
        const Vec3 x = surface.nodes.col(n);
        if (!within(x)) continue;
        const double d = image::nearest_on_surface(phantom, x).distance;
        squares += d * d, ++count;
      }
      for (Index t = 0; t < surface.cell_count(); t += every) {
        const auto triangle = mesh::triangle(surface, t);
        const Vec3 x = triangle.centroid(), n = triangle.area_vector();
        if (!within(x)) continue;
        const Vec3 exact = phantom.level(image::nearest_on_surface(phantom, x).point).gradient.normalized();
        const double angle = std::atan2(n.cross(exact).norm(), n.dot(exact));
        turns += triangle.area() * angle * angle, area += triangle.area();
      }
      vertex[level] = std::sqrt(squares / count);
      normal[level] = std::sqrt(turns / area) * 180 / std::numbers::pi;
      volume[level] = std::abs(mesh::enclosed_volume(meshing::cut(surface, ends).surface) / truth - 1);
      MESSAGE("phantom, refined ", 1 << level, " times: vertices ", vertex[level], " mm, normals ",
              normal[level], " degrees (rms), volume ", volume[level]);
    }
    for (std::size_t n = 1; n < 3; ++n)
      MESSAGE("orders: vertices ", std::log2(vertex[n - 1] / vertex[n]), " normals ",
              std::log2(normal[n - 1] / normal[n]), " volume ", std::log2(volume[n - 1] / volume[n]));
    CHECK(std::log2(vertex[1] / vertex[2]) > 1.9);
    CHECK(std::log2(normal[1] / normal[2]) > 0.9);
    CHECK(std::log2(volume[1] / volume[2]) > 1.9);
  }
}
