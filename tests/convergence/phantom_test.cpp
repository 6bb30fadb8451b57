// SPDX-License-Identifier: MIT
// The contour of the sampled phantom against its true surface and volume: both of second order.
#include "tunica/image/phantom_truth.hpp"
#include "tunica/image/sampling.hpp"
#include "tunica/mesh/measures.hpp"
#include "tunica/meshing/cut.hpp"
#include "tunica/meshing/marching_cubes.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <vector>

using namespace tunica;

TEST_SUITE("convergence") {
  TEST_CASE("image: contour of the phantom converges to its true surface and volume") {
    const image::Phantom phantom;
    const double truth = image::lumen_volume(phantom);
    std::vector<meshing::Cut> ends;
    for (const auto& port : image::Phantom::ports())
      ends.push_back({.point = port.point, .normal = port.normal, .name = port.name});
    std::array<double, 3> volume_error{}, distance{};
    for (std::size_t level = 0; level < 3; ++level) {
      const auto scan = image::sample(phantom, image::Sampling{}.refined(1 << level));
      auto surface = meshing::marching_cubes(scan, image::Phantom::surface).surface;
      double sum = 0;
      Index count = 0;
      for (Index n = 0; n < surface.node_count(); n += 1 << (2 * level)) {  // about as many at each level
        const Vec3 x = surface.nodes.col(n);
        if (x[1] < 90 || x[1] > 180) continue;  // the border of the image has caps
        const double d = image::nearest_on_surface(phantom, x).distance;
        sum += d * d, ++count;
      }
      distance[level] = std::sqrt(sum / count);
      surface = meshing::cut(surface, ends).surface;
      volume_error[level] = std::abs(mesh::enclosed_volume(surface) / truth - 1);
    }
    const auto order = [](double coarse, double fine) { return std::log2(coarse / fine); };
    MESSAGE("rms distance ", distance[0], " ", distance[1], " ", distance[2], " mm: orders ",
            order(distance[0], distance[1]), " ", order(distance[1], distance[2]));
    MESSAGE("volume error ", volume_error[0], " ", volume_error[1], " ", volume_error[2], ": orders ",
            order(volume_error[0], volume_error[1]), " ", order(volume_error[1], volume_error[2]));
    CHECK(order(distance[1], distance[2]) > 1.9);
    CHECK(order(volume_error[1], volume_error[2]) > 1.9);
  }
}
