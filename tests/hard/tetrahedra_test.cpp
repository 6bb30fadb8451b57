// SPDX-License-Identifier: MIT
// The soak of the filler: rough, thin, needle-like, nested, random and broken surfaces. None that is closed,
// manifold and free of crossings may be refused, and every border, sign and volume is as promised.
#include "tunica/meshing/tetrahedra.hpp"
#include "tunica/mesh/topology.hpp"
#include "tunica/meshing/intersections.hpp"
#include "tunica/meshing/marching_cubes.hpp"

#include "support/filled.hpp"
#include "support/soak.hpp"
#include "support/surfaces.hpp"
#include "support/work_cases.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <ctime>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace tunica;
using mesh::Surface;
using test::soak::prisms;
using test::soak::stretched;

double cpu_seconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

struct Soak {
  int filled = 0, refused = 0;
  Index triangles = 0, tetrahedra = 0;
  std::vector<std::string> refusals;

  /// Valid input: a refusal is a failure of the filler. The smallest dihedral angle [degrees].
  double valid(const std::string& name, const Surface& s) {
    triangles += s.cell_count();
    try {
      const auto result = meshing::tetrahedra(s);
      const auto& r = result.report;
      CHECK_MESSAGE(r.volume_error < 1e-12, name);
      CHECK_MESSAGE(r.tetrahedra == result.mesh.cell_count(), name);
      CHECK_MESSAGE(test::filling_fault(s, result.mesh) == "", name);
      tetrahedra += r.tetrahedra;
      ++filled;
      // Below a tenth of a degree the surface itself asks for flat tetrahedra.
      if (std::min(r.surface_min_angle, r.surface_min_dihedral) > 0.1)
        CHECK_MESSAGE(r.min_dihedral > 0, name);
      return r.min_dihedral;
    } catch (const MeshError& e) {
      ++refused;
      refusals.push_back(name + ": " + e.what());
    }
    return 0;
  }
};

/// Every node shaken by a share of the shortest edge: rough but free of crossings for small shares.
Surface shaken(Surface s, double share, std::uint64_t seed) {
  double shortest = 1e300;
  for (Index t = 0; t < s.cell_count(); ++t)
    for (int i = 0; i < 3; ++i)
      shortest =
          std::min(shortest, (s.nodes.col(s.cells(i, t)) - s.nodes.col(s.cells((i + 1) % 3, t))).norm());
  for (Index n = 0; n < s.node_count(); ++n)
    for (int k = 0; k < 3; ++k)
      s.nodes(k, n) +=
          share * shortest *
          test::node_noise(seed * 7919 + 3 * static_cast<std::uint64_t>(n) + static_cast<std::uint64_t>(k));
  return s;
}

/// How the surfaces of a family ended.
struct Ends {
  int filled = 0, refused = 0,
      wrong = 0;  // wrong: refused though valid, filled though broken, or not as promised
  double worst_seconds = 0, least_dihedral = 180;
  std::map<std::string, int> reasons;
};

/// Up to the place: what a refusal names.
std::string reason(const std::string& message) {
  return message.substr(0, std::min(message.find(" at ("), message.find_first_of("0123456789")));
}

/// Surfaces seed, seed + stride ... of a family. A closed, manifold surface without crossings must be filled.
Ends run(const test::soak::Family& family, std::uint64_t seed, std::uint64_t stride) {
  Ends ends;
  for (; seed <= static_cast<std::uint64_t>(family.count); seed += stride) {
    const Surface s = family.make(seed);
    const bool sound = !family.broken && mesh::topology(s).closed() &&
                       meshing::self_intersections(s, 1).empty() && test::nested_outward(s);
    const double start = cpu_seconds();
    std::string fault;
    try {
      const auto result = meshing::tetrahedra(s);
      fault = sound ? test::filling_fault(s, result.mesh) : "filled in spite of what is wrong with it";
      ends.least_dihedral = std::min(ends.least_dihedral, result.report.min_dihedral);
      ++ends.filled;
    } catch (const MeshError& e) {
      ++ends.refused, ++ends.reasons[reason(e.what())];
      if (sound) fault = e.what();
    }
    const double seconds = cpu_seconds() - start;
    ends.worst_seconds = std::max(ends.worst_seconds, seconds);
    if (!(seconds < 60)) fault += " after " + std::to_string(seconds) + " s";
    ends.wrong += !fault.empty();
    CHECK_MESSAGE(fault == "", std::string(family.name) << ", seed " << seed);
  }
  return ends;
}

/// Every stride-th surface of all families; the number of surfaces.
int run_all(std::uint64_t stride) {
  int count = 0, refused = 0, sound_refused = 0;
  for (const auto& family : test::soak::families()) {
    const Ends e = run(family, stride, stride);
    count += e.filled + e.refused, refused += e.refused;
    if (!family.broken) sound_refused += e.refused;
    std::string reasons;
    for (const auto& [text, times] : e.reasons) reasons += "; " + std::to_string(times) + " x " + text;
    MESSAGE(std::string(family.name) << ": " << e.filled + e.refused << " surfaces, " << e.filled
                                     << " filled, " << e.refused << " refused, at most " << e.worst_seconds
                                     << " s, least dihedral " << e.least_dihedral << reasons);
    if (family.broken) CHECK(e.filled == 0);
  }
  MESSAGE("soak: " << count << " surfaces, " << refused << " refused, of which " << sound_refused
                   << " were made to be filled");
  CHECK(refused <= 0.05 * count);
  return count;
}

}  // namespace

TEST_SUITE("hard") {
  TEST_CASE("meshing: tetrahedra fill a soak of hard surfaces") {
    using namespace test;
    Soak soak;
    for (std::uint64_t seed = 1; seed <= 4; ++seed)
      for (const double a : {0.05, 0.2, 0.4})
        soak.valid("noisy sphere " + std::to_string(seed), noisy_sphere(3, a, seed));
    for (const double twist : {0.1, 0.3, 0.6, 0.9, 1.0})
      soak.valid("twisted prism " + std::to_string(twist), schoenhardt_prism(twist));
    soak.valid("five twisted prisms", prisms(5, 0.5));
    for (const double thickness : {0.3, 0.1, 0.02, 1e-3})
      soak.valid("slab " + std::to_string(thickness), box_surface(4, Vec3(1, 1, thickness)));
    for (const double gap : {0.1, 0.01, 1e-3, 1e-6}) {
      soak.valid("spheres with gap " + std::to_string(gap),
                 joined(icosphere(3), icosphere(3, 1, Vec3(2 + gap, 0, 0))));
      soak.valid("shell of " + std::to_string(gap), joined(icosphere(3), reversed(icosphere(3, 1 - gap))));
    }
    for (const double f : {0.05, 0.01}) {  // its tube squeezed in one direction and in both
      soak.valid("ribbon torus", stretched(torus(10, 30), Vec3(1, f, 1)));
      soak.valid("squeezed torus", stretched(torus(10, 30), Vec3(1, f, f)));
    }
    for (const double f : {0.2, 0.05}) {
      soak.valid("flat sphere", stretched(icosphere(3), Vec3(1, 1, f)));
      soak.valid("needle sphere", stretched(icosphere(3), Vec3(f, f, 1)));
      CHECK(soak.valid("flat torus", stretched(torus(16, 48), Vec3(1, 1, f))) > 2);
    }
    for (const int around : {3, 5, 12}) {
      soak.valid("tube of few sides", tube_surface(around, 30, 2));
      soak.valid("tube of needles", tube_surface(around * 8, 4, 5, 1, 0.3));
      CHECK(soak.valid("thin torus", torus(around, 90, 0.05)) > 15);
    }
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      soak.valid("shaken torus", shaken(torus(20, 60), 0.15, seed));
      soak.valid("shaken box", shaken(box_surface(3), 0.2, seed));
    }
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      const RandomWaves waves(seed);
      const auto image = sampled<float>(20, [&](const Vec3& x) { return -waves(x); });
      soak.valid("random waves " + std::to_string(seed), meshing::marching_cubes(image, 0.0).surface);
    }
    soak.valid("flat sphere 100", stretched(icosphere(3), Vec3(1, 1, 0.01)));
    soak.valid("flat torus 100", stretched(torus(16, 48), Vec3(1, 1, 0.01)));
    soak.valid("real noise 24", meshing::marching_cubes(noise_volume(24, 2), 0.0).surface);
    for (const std::uint64_t seed : {1, 2})  // the second: a plane hexagon among tetrahedra flat to rounding
      soak.valid("integer noise 24", meshing::marching_cubes(integer_noise_volume(24, seed), 0.0).surface);
    const auto vessel = sampled<float>(40, [](const Vec3& x) { return -bifurcation(x); });
    soak.valid("bifurcation", meshing::marching_cubes(vessel, 0.0).surface);
    for (std::uint64_t seed = 1; seed <= 2; ++seed) {
      soak.valid("noise " + std::to_string(seed),
                 meshing::marching_cubes(noise_volume(8, seed), 0.0).surface);
      soak.valid("noise of integers " + std::to_string(seed),
                 meshing::marching_cubes(integer_noise_volume(8, seed), 0.0).surface);
    }
    // Bits: the surface has angles of 30 degrees and more, so nothing in it asks for flat tetrahedra.
    for (const auto& [n, seed] : {std::pair{12, 1}, {12, 3}, {24, 2}}) {
      const auto bit = [seed = static_cast<std::uint64_t>(seed)](std::uint64_t i) {
        return static_cast<double>(splitmix64(1 + i + (seed << 32)) % 2);
      };
      const auto image = random_volume<float>(n, 0.0F, bit);
      CHECK(soak.valid("noise of bits", meshing::marching_cubes(image, 0.5).surface) > 17);
    }
    MESSAGE("soak: " << soak.filled << " of " << soak.filled + soak.refused << " surfaces filled, "
                     << soak.triangles << " triangles, " << soak.tetrahedra << " tetrahedra");
    for (const auto& text : soak.refusals) MESSAGE("refused: " << text);
    CHECK(soak.filled + soak.refused >= 50);
    CHECK(soak.refused == 0);
  }

  TEST_CASE("meshing: tetrahedra fill what the contourers make of noise on 40 cubed nodes") {
    const auto fill = [](const std::string& name, const Surface& s) {
      const double start = cpu_seconds();
      const auto result = meshing::tetrahedra(s);
      const double seconds = cpu_seconds() - start;
      CHECK(test::filling_fault(s, result.mesh) == "");
      CHECK(seconds < 60);
      MESSAGE(name << ": " << s.cell_count() << " triangles, " << result.report.tetrahedra
                   << " tetrahedra in " << seconds << " s, smallest dihedral " << result.report.min_dihedral
                   << " (surface: angle " << result.report.surface_min_angle << ", dihedral "
                   << result.report.surface_min_dihedral << ")");
    };
    fill("noise", meshing::marching_cubes(test::noise_volume(40), 0.0).surface);
    fill("noise of integers", meshing::marching_cubes(test::integer_noise_volume(40), 0.0).surface);
    for (const bool integers : {false, true}) {
      auto s = meshing::dual_contour_image(integers ? test::integer_noise_volume(40) : test::noise_volume(40),
                                           {}, 0.0)
                   .surface;
      CHECK(meshing::untangle(s).crossings_after == 0);
      CHECK(test::nested_outward(s));
      fill(integers ? "noise of integers, dual contouring" : "noise, dual contouring", s);
    }
  }

  TEST_CASE("meshing: tetrahedra end as they must on fifty surfaces of the soak") {
    CHECK(run_all(20) >= 50);
  }
}

TEST_SUITE("slow") {
  TEST_CASE("meshing: tetrahedra end as they must on a thousand surfaces") {
    CHECK(run_all(1) >= 1000);
  }
}
