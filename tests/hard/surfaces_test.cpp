// SPDX-License-Identifier: MIT
// Surfaces that break smoothers: thin gaps, high genus, noise.
#include "support/work_cases.hpp"
#include "tunica/mesh/topology.hpp"
#include "tunica/meshing/marching_cubes.hpp"
#include "tunica/meshing/remesh.hpp"
#include "tunica/meshing/smooth.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>

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

  TEST_CASE("meshing: remeshing neither crosses nor opens rough surfaces") {
    const auto run = [](const std::string& name, mesh::Surface s, double edge, int sweeps) {
      (void)meshing::smooth(s, {.sweeps = sweeps});
      const auto before = mesh::topology(s);
      const auto r = meshing::remesh(s, {.edge = edge});
      const auto after = mesh::topology(r.surface);
      MESSAGE(name, ", ", sweeps, " sweeps, genus ", before.genus(), ": ", before.triangles, " -> ",
              after.triangles, " triangles, smallest angle ", r.report.smallest_angle, ", volume ",
              r.report.volume_after / r.report.volume_before - 1, ", left out ", r.report.left_out.folds,
              " folds ", r.report.left_out.crosses, " crossings");
      CHECK(after.closed());
      CHECK(after.genus() == before.genus());
      CHECK(meshing::self_intersections(r.surface, 1).empty());
    };
    for (int seed = 1; seed <= 3; ++seed) {
      const test::RandomWaves waves(static_cast<std::uint64_t>(seed));
      const auto s =
          meshing::marching_cubes(test::sampled<float>(40, [&](const Vec3& x) { return -waves(x); }), 0)
              .surface;
      run("random waves " + std::to_string(seed), s, 0.04, seed == 1 ? 0 : 20);
    }
    run("noise", meshing::marching_cubes(test::noise_volume(10, 7), 0).surface, 0.15, 0);
    run("integer noise", meshing::marching_cubes(test::integer_noise_volume(10, 7), 0).surface, 0.15, 20);
  }

  TEST_CASE("meshing: remeshing keeps two near sheets apart") {
    // two plates of a gap far below the edge length
    auto s =
        meshing::marching_cubes(
            test::sampled<float>(60,
                                 [](const Vec3& x) {
                                   const double body = 0.35 - (x - Vec3(0.5, 0.5, 0.5)).cwiseAbs().maxCoeff();
                                   return std::min(body, std::max(std::abs(x[2] - 0.5) - 0.012, x[0] - 0.75));
                                 }),
            0)
            .surface;
    (void)meshing::smooth(s);
    const auto r = meshing::remesh(s, {.edge = 0.1});
    MESSAGE("gap of a quarter of the edge: ", r.report.triangles, " triangles, left out ",
            r.report.left_out.folds, " folds ", r.report.left_out.crosses, " crossings, smallest angle ",
            r.report.smallest_angle);
    CHECK(mesh::topology(r.surface).closed());
    CHECK(meshing::self_intersections(r.surface, 1).empty());
  }
}
