// SPDX-License-Identifier: MIT
#include "tunica/meshing/smooth.hpp"

#include "support/work_cases.hpp"
#include "tunica/core/parallel.hpp"
#include "tunica/mesh/quality.hpp"
#include "tunica/mesh/topology.hpp"
#include "tunica/meshing/marching_cubes.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>

using namespace tunica;

TEST_SUITE("unit") {
  TEST_CASE("meshing: smoothing keeps volume and shape of a sphere and a bifurcation") {
    const auto run = [](const std::string& name, auto field, Index n, int sweeps) {
      const double h = 1.0 / (n - 1);
      auto s = meshing::marching_cubes(test::sampled<float>(n, [&](const Vec3& x) { return -field(x); }), 0)
                   .surface;
      const double volume = mesh::enclosed_volume(s);
      const auto report = meshing::smooth(s, {.sweeps = sweeps});
      const auto [rms, most] = test::distance_to_zero(s.nodes, field);
      const auto q = mesh::quality(s);
      const double drift = mesh::enclosed_volume(s) / volume - 1;
      MESSAGE(name, " ", n, ", ", sweeps, " sweeps: drift ", drift, ", vertex rms ", rms / h, " h, max ",
              most / h, " h, angle min ", q.angle.least, " 1 % ", q.angle.quantile(0.01));
      CHECK(std::abs(drift) <= 1e-12);
      CHECK(report.volume_after == mesh::enclosed_volume(s));
      CHECK(rms / h <= 1.6e-2);
      CHECK(most / h <= 0.1);
      CHECK(q.angle.quantile(0.01) >= 28);
      CHECK(mesh::topology(s).closed());
    };
    run("sphere", test::sphere, 64, 20);
    run("bif", test::bifurcation, 128, 20);
    run("bif", test::bifurcation, 128, 50);
  }

  TEST_CASE("meshing: smoothing keeps flat ends in their planes and rims on them") {
    auto s = meshing::marching_cubes(
                 test::sampled<float>(
                     31, [](const Vec3& x) { return 0.2 - std::hypot(x[0] - 0.5 - 0.1 * x[2], x[1] - 0.5); }),
                 0)
                 .surface;
    const auto before = s;
    const auto report = meshing::smooth(s);
    MESSAGE("tube: largest move ", report.largest_move, ", area of an end ", mesh::area_of_region(s, 1),
            " before ", mesh::area_of_region(before, 1));
    CHECK(std::abs(report.volume_after / report.volume_before - 1) <= 1e-12);
    CHECK(report.largest_move > 0);
    for (Index t = 0; t < s.cell_count(); ++t)
      for (int k = 0; k < 3; ++k)
        if (s.region_of(t) > 0) CHECK(s.nodes(2, s.cells(k, t)) == before.nodes(2, before.cells(k, t)));
    for (Index r = 1; r <= 2; ++r)
      CHECK(mesh::area_of_region(s, r) == doctest::Approx(mesh::area_of_region(before, r)).epsilon(0.005));
    CHECK(mesh::quality(s).angle.least > mesh::quality(before).angle.least);
    CHECK(meshing::self_intersections(s).empty());
  }

  TEST_CASE("meshing: smoothing keeps the volume of every component") {
    auto s = meshing::marching_cubes(test::sampled<float>(41,
                                                          [](const Vec3& x) {
                                                            return std::max(
                                                                0.3 - (x - Vec3(0.4, 0.4, 0.4)).norm(),
                                                                0.05 - (x - Vec3(0.9, 0.9, 0.9)).norm());
                                                          }),
                                     0)
                 .surface;
    const auto before = mesh::topology(s);
    REQUIRE(before.components.size() == 2);
    (void)meshing::smooth(s, {.sweeps = 50});
    const auto after = mesh::topology(s);
    for (std::size_t c = 0; c < 2; ++c)
      CHECK(after.components[c].volume == doctest::Approx(before.components[c].volume).epsilon(1e-11));
  }

  TEST_CASE("meshing: smoothing keeps the volume in each sweep") {
    const auto raw = meshing::marching_cubes(
                         test::sampled<float>(32, [](const Vec3& x) { return -test::bifurcation(x); }), 0)
                         .surface;
    const auto rough = meshing::marching_cubes(test::noise_volume(10, 5), 0).surface;
    double most = 0;
    for (const auto& start : {raw, rough}) {
      const auto before = mesh::topology(start);
      for (int sweeps = 1; sweeps <= 12; ++sweeps) {
        auto s = start;
        (void)meshing::smooth(s, {.sweeps = sweeps});
        const auto after = mesh::topology(s);
        REQUIRE(after.components.size() == before.components.size());
        for (std::size_t c = 0; c < after.components.size(); ++c)
          most = std::max(most, std::abs(after.components[c].volume / before.components[c].volume - 1));
      }
    }
    MESSAGE("largest drift of a component after 1 to 12 sweeps: ", most);
    CHECK(most <= 1e-12);
  }

  TEST_CASE("meshing: smoothing has the same bits on any number of threads") {
    const auto raw = meshing::marching_cubes(
                         test::sampled<float>(48, [](const Vec3& x) { return -test::bifurcation(x); }), 0)
                         .surface;
    auto one = raw, four = raw;
    (void)meshing::smooth(one);
    thread_count() = 4;
    (void)meshing::smooth(four);
    thread_count() = 1;
    CHECK(one.nodes == four.nodes);
  }

  TEST_CASE("meshing: smoothing without sweeps changes nothing") {
    auto s =
        meshing::marching_cubes(test::sampled<float>(12, [](const Vec3& x) { return -test::sphere(x); }), 0)
            .surface;
    const auto before = s;
    const auto report = meshing::smooth(s, {.sweeps = 0});
    CHECK(s.nodes == before.nodes);
    CHECK(report.largest_move == 0);
    CHECK_THROWS_AS((void)meshing::smooth(s, {.factor = 0.9}), ContractError);
  }
}

TEST_SUITE("slow") {
  TEST_CASE("meshing: smoothing makes none of 200 random surfaces cross itself") {
    Index frozen = 0, held = 0;
    int crossing = 0;
    double drift = 0;
    constexpr int surfaces = 200;
    for (int seed = 1; seed <= surfaces; ++seed) {
      const test::RandomWaves waves(static_cast<std::uint64_t>(seed));
      auto s = meshing::marching_cubes(test::sampled<float>(40, [&](const Vec3& x) { return -waves(x); }), 0)
                   .surface;
      const auto report = meshing::smooth(s, {.sweeps = 30});
      frozen += report.frozen, held += report.held_back;
      drift = std::max(drift, std::abs(report.volume_after / report.volume_before - 1));
      crossing += !meshing::self_intersections(s, 1).empty();
    }
    MESSAGE(surfaces, " random surfaces, 30 sweeps: ", crossing, " cross themselves, largest drift ", drift,
            ", moves left out ", held, ", nodes frozen ", frozen);
    CHECK(crossing == 0);
    CHECK(drift <= 1e-12);
  }
}
