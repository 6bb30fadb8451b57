// SPDX-License-Identifier: MIT
// Surfaces that break smoothers: thin gaps, high genus, noise.
#include "support/work_cases.hpp"
#include "tunica/mesh/topology.hpp"
#include "tunica/meshing/marching_cubes.hpp"
#include "tunica/meshing/smooth.hpp"

#include <doctest/doctest.h>

using namespace tunica;

TEST_SUITE("hard") {
  TEST_CASE("meshing: smoothing makes no random surface cross itself") {
    Index frozen = 0, held = 0;
    int crossing = 0;
    double drift = 0;
    constexpr int surfaces = 20;
    for (int seed = 1; seed <= surfaces; ++seed) {
      const test::RandomWaves waves(static_cast<std::uint64_t>(seed));
      auto s = meshing::marching_cubes(test::sampled<float>(40, [&](const Vec3& x) { return -waves(x); }), 0)
                   .surface;
      const auto report = meshing::smooth(s, {.sweeps = 30});
      frozen += report.frozen, held += report.held_back;
      drift = std::max(drift, std::abs(report.volume_after / report.volume_before - 1));
      crossing += !meshing::self_intersections(s, 1).empty();
    }
    MESSAGE(surfaces, " random surfaces (seeds 1 ..), 30 sweeps: ", crossing,
            " cross themselves, largest drift ", drift, ", moves left out ", held, ", nodes frozen ", frozen);
    CHECK(crossing == 0);
    CHECK(drift <= 1e-12);
  }

  TEST_CASE("meshing: smoothing noise neither crosses nor opens it") {
    for (std::uint64_t seed = 1; seed <= 3; ++seed)
      for (const bool integer : {false, true}) {
        auto s = meshing::marching_cubes(
                     integer ? test::integer_noise_volume(16, seed) : test::noise_volume(16, seed), 0)
                     .surface;
        const auto report = meshing::smooth(s);
        MESSAGE("noise 16, seed ", seed, ": ", s.cell_count(), " triangles, moves left out ",
                report.held_back, ", nodes frozen ", report.frozen, ", drift ",
                report.volume_after / report.volume_before - 1);
        CHECK(meshing::self_intersections(s, 1).empty());
        CHECK(mesh::topology(s).closed());
        CHECK(std::abs(report.volume_after / report.volume_before - 1) <= 1e-12);
      }
  }
}
