// SPDX-License-Identifier: MIT
// A soak of the filler: rough, thin, needle-like, nested and random surfaces. None may be
// refused, and every border, sign and volume is as promised.
#include "tunica/meshing/tetrahedra.hpp"
#include "tunica/meshing/marching_cubes.hpp"

#include "support/surfaces.hpp"
#include "support/work_cases.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace tunica;
using mesh::Surface;

using Face = std::array<Index, 3>;

/// As it turns, from its smallest node on.
Face turned(Face f) {
  std::rotate(f.begin(), std::min_element(f.begin(), f.end()), f.end());
  return f;
}

std::vector<Face> triangles_of(const Surface& s) {
  std::vector<Face> all;
  for (Index t = 0; t < s.cell_count(); ++t)
    all.push_back(turned({s.cells(0, t), s.cells(1, t), s.cells(2, t)}));
  std::sort(all.begin(), all.end());
  return all;
}

/// Faces whose reverse no other tetrahedron has, sorted.
std::vector<Face> border(const mesh::TetMesh& m) {
  std::vector<Face> all, open;
  for (Index t = 0; t < m.cell_count(); ++t)
    for (const auto& f : mesh::Tet4::faces)
      all.push_back(turned({m.cells(f[0], t), m.cells(f[1], t), m.cells(f[2], t)}));
  std::sort(all.begin(), all.end());
  for (const Face& f : all)
    if (!std::binary_search(all.begin(), all.end(), turned({f[0], f[2], f[1]}))) open.push_back(f);
  return open;
}

int inverted(const mesh::TetMesh& m) {
  int count = 0;
  for (Index t = 0; t < m.cell_count(); ++t) {
    const auto x = [&](Index i) { return Vec3(m.nodes.col(m.cells(i, t))); };
    count += !(meshing::orient3d(x(0), x(1), x(2), x(3)) > 0);
  }
  return count;
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
      CHECK_MESSAGE(result.mesh.nodes.leftCols(s.node_count()) == s.nodes, name);
      CHECK_MESSAGE(inverted(result.mesh) == 0, name);
      CHECK_MESSAGE(border(result.mesh) == triangles_of(s), name);
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

Surface stretched(Surface s, const Vec3& factor) {
  for (Index n = 0; n < s.node_count(); ++n) s.nodes.col(n) = s.nodes.col(n).cwiseProduct(factor);
  return s;
}

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

/// Twisted prisms beside one another, each as hard as one.
Surface prisms(int count, double twist) {
  Surface s = test::schoenhardt_prism(twist);
  for (int i = 1; i < count; ++i) {
    Surface next = test::schoenhardt_prism(twist);
    next.nodes.row(0).array() += 1.9 * i;
    s = test::joined(s, next);
  }
  return s;
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
    soak.valid("integer noise 24", meshing::marching_cubes(integer_noise_volume(24, 1), 0.0).surface);
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
}
