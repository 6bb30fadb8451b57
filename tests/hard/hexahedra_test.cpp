// SPDX-License-Identifier: MIT
// Hexahedra in bifurcations, the phantom between its ports, real data, thin gaps and noise: none is inverted.
#include "support/hexahedra.hpp"
#include "support/contours.hpp"
#include "support/shared.hpp"
#include "support/vessels.hpp"
#include "support/work_cases.hpp"
#include "tunica/image/components.hpp"
#include "tunica/io/vtk_image.hpp"
#include "tunica/mesh/patch_nodes.hpp"
#include "tunica/meshing/dual_hexahedra.hpp"
#include "tunica/meshing/marching_cubes.hpp"
#include "tunica/meshing/smooth.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

using namespace tunica;

namespace {

/// Fills the surface, prints the figures and checks what must hold however rough the surface is.
meshing::HexFillReport filled(const std::string& name, const mesh::Surface& s, double edge) {
  const auto fill = meshing::dual_hexahedra(s, {.edge = edge});
  const auto& r = fill.report;
  MESSAGE(name << ", edge " << edge << ": " << r.cells << " hexahedra, scaled Jacobian least "
               << r.least_jacobian << " at " << r.worst_place.transpose() << ", 1st percentile "
               << r.first_percentile << ", mean " << r.mean_jacobian << "; below 0.2: " << r.below_sound
               << ", inverted: " << r.inverted << "; volume " << 100 * (r.volume / r.surface_volume - 1)
               << " % off; from the surface rms " << r.distance_rms / edge << ", at most "
               << r.distance_max / edge << " edge at " << r.distance_place.transpose() << "; " << r.released
               << " nodes released; specks " << r.specks.dropped << " + " << r.specks.filled);
  CHECK(r.inverted == 0);
  CHECK(test::least_determinant(fill.mesh, 8) > 0);
  const auto f = test::hex_faces(fill.mesh);
  CHECK(f.unmatched == 0);
  CHECK(f.missing == 0);
  const auto t = test::contours::topology(test::border_of(fill.mesh));
  CHECK(t.open_edges + t.wrong_edges + t.wrong_vertices == 0);
  const auto planes = meshing::flat_regions(s);
  const double size = mesh::bounding_box(s.nodes).diagonal();
  for (std::size_t p = 0; p < fill.mesh.patches.size(); ++p)
    if (planes[p])
      for (const Index n : mesh::patch_nodes(fill.mesh.patches[p]))
        CHECK(std::abs(planes[p]->distance(fill.mesh.nodes.col(n))) < 1e-13 * size);
  return r;
}

mesh::Surface bifurcation(Index n) {
  return meshing::marching_cubes(test::sampled<float>(n, [](const Vec3& x) { return -test::bifurcation(x); }),
                                 0)
      .surface;
}

}  // namespace

TEST_SUITE("hard") {
  TEST_CASE("meshing: hexahedra in the bifurcation are as good at 64 as at 128") {
    for (const Index n : {64, 128}) {
      const double h = 1.0 / (n - 1);
      const auto r = filled("bifurcation " + std::to_string(n), bifurcation(n), h);
      CHECK(r.least_jacobian >= 0.4);
      CHECK(r.first_percentile >= 0.5);
      CHECK(r.mean_jacobian >= 0.85);
      CHECK(r.distance_rms <= 0.03 * h);
      CHECK(std::abs(r.volume / r.surface_volume - 1) <= 0.005);
    }
  }

  TEST_CASE("meshing: hexahedra in the phantom end flat at its ports") {
    const auto lumen = test::vessels::bifurcation(1.0);
    for (const double edge : {3.0, 2.0, 1.0}) {
      const auto r = filled("phantom", lumen, edge);
      CHECK(r.least_jacobian >= 0.2);
      CHECK(r.mean_jacobian >= 0.75);
      CHECK(std::abs(r.volume / r.surface_volume - 1) <= 0.005);
    }
  }

  TEST_CASE("meshing: hexahedra in random waves with thin gaps") {
    for (const std::uint64_t seed : {1U, 3U}) {
      const test::RandomWaves waves(seed);
      const auto s =
          meshing::marching_cubes(test::sampled<float>(40, [&](const Vec3& x) { return -waves(x); }), 0)
              .surface;
      const auto r = filled("waves " + std::to_string(seed), s, 1.0 / 39);
      CHECK(r.below_sound == 0);
    }
  }

  TEST_CASE("meshing: hexahedra in noise with three edges a voxel") {
    for (const bool integers : {false, true}) {
      const auto im = integers ? test::integer_noise_volume(10, 2) : test::noise_volume(10, 1);
      const auto s = meshing::marching_cubes(im, 0).surface;
      (void)filled(integers ? "integer noise" : "noise", s, 1.0 / 27);
    }
  }

  TEST_CASE("meshing: hexahedra in the real bifurcation and where it leaves the image") {
    const auto path = test::shared("data/aorta_bifurcation.vtk");
    if (!path) return;
    const auto im = io::read_vtk_image<float>(*path).image;
    for (const double iso : {1250.0, 1299.5, 1350.0}) {
      const auto region = image::segment(im, {.iso = iso});
      auto s = meshing::marching_cubes(im, region.mask.inside, iso).surface;
      (void)meshing::smooth(s);
      for (const double edge : {2.0, 1.0}) {
        const auto r = filled("aorta at " + std::to_string(iso), s, edge);
        CHECK(r.below_sound == 0);
        CHECK(r.mean_jacobian >= 0.8);
        CHECK(std::abs(r.volume / r.surface_volume - 1) <= 0.005);
      }
    }
  }
}
