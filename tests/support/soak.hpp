// SPDX-License-Identifier: MIT
// The soak of the filler: families of generated surfaces, each made by a seed. What a family makes is closed,
// manifold and outward unless it says otherwise; whether it crosses itself is for an exact test to tell.
#pragma once

#include "support/notched_box.hpp"
#include "support/soak_shapes.hpp"
#include "support/surfaces.hpp"
#include "support/work_cases.hpp"
#include "tunica/meshing/contour_triangles.hpp"
#include "tunica/meshing/marching_cubes.hpp"
#include "tunica/meshing/smooth.hpp"
#include "tunica/meshing/untangle.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

namespace tunica::test::soak {

using mesh::Surface;

/// `make` gives surface number `seed` = 1 .. count. broken: the filler must refuse all of them.
struct Family {
  const char* name;
  int count;
  Surface (*make)(std::uint64_t seed);
  bool broken = false;
};

namespace detail {

template <class Field>
Surface zero_of(Index n, const Field& inside_negative) {
  return meshing::marching_cubes(sampled<float>(n, [&](const Vec3& x) { return -inside_negative(x); }), 0.0)
      .surface;
}

inline Surface smoothed(Surface s) {
  static_cast<void>(meshing::smooth(s, {.sweeps = 30}));
  return s;
}

/// Without its crossings: where the contour itself crosses.
inline Surface untangled(Surface s) {
  static_cast<void>(meshing::untangle(s));
  return s;
}

/// A vessel with two branches: angles 20 .. 160 degrees, radii 0.3 .. 1, every second one with a stenosis
/// down to two voxels, every third one with another vessel that passes at a gap of half a voxel and more.
inline Surface bifurcation(std::uint64_t seed) {
  Random r(seed);
  const auto n = static_cast<Index>(r.whole(36, 56));
  const double h = 1.0 / (n - 1), radius = r.between(0.07, 0.11);
  const double angle = r.between(20, 160) * std::numbers::pi / 180, share = r.between(0.3, 1);
  const Vec3 root(.5, .5, .12), fork(.5, .5, .5);
  const double roll = r.between(0, 2 * std::numbers::pi), split = r.between(0.3, 0.7);
  const auto tip = [&](double a) {
    return Vec3(fork + 0.33 * Vec3(std::sin(a) * std::cos(roll), std::sin(a) * std::sin(roll), std::cos(a)));
  };
  const Vec3 left = tip(split * angle), right = tip((split - 1) * angle);
  const bool narrow = seed % 2 == 0, kissing = seed % 3 == 0;
  const double throat = std::max(h, r.between(0.1, 0.6) * radius);
  const double gap = r.between(0.5, 2) * h, aside = 2.0 * radius * r.between(0.5, 1);
  const Vec3 beside =
      fork + Vec3(std::cos(roll + 1.57), std::sin(roll + 1.57), 0) * (radius + gap + 0.5 * aside);
  return zero_of(n, [&](const Vec3& x) {
    const double at = std::clamp((x[2] - root[2]) / (fork[2] - root[2]), 0.0, 1.0);
    const double pinch = narrow ? (radius - throat) * std::exp(-std::pow((at - 0.5) / 0.15, 2)) : 0;
    double d = capsule(x, root, fork, radius - pinch);
    d = smooth_min(d, capsule(x, fork, left, std::max(0.75 * radius, 1.1 * h)), 0.03);
    d = smooth_min(d, capsule(x, fork, right, std::max(0.75 * share * radius, 1.1 * h)), 0.03);
    if (kissing) d = std::min(d, capsule(x, beside - Vec3(0, 0, .3), beside + Vec3(0, 0, .3), 0.5 * aside));
    return d;
  });
}

/// Three generations of branches.
inline Surface tree(std::uint64_t seed) {
  struct Branch {
    Vec3 a, b;
    double radius;
  };
  Random r(seed);
  std::vector<Branch> branches{{Vec3(.5, .5, .1), Vec3(.5, .5, .35), r.between(0.05, 0.08)}};
  for (std::size_t i = 0; i < branches.size() && branches.size() < 15; ++i)
    for (int k = 0; k < 2; ++k) {
      const Branch& from = branches[i];
      const Vec3 way = (from.b - from.a).normalized() + 0.9 * r.direction();
      const Vec3 end = (from.b + 0.8 * (from.b - from.a).norm() * way.normalized()).cwiseMax(0.08);
      const double radius = std::max(0.78 * from.radius, 0.022);
      const Vec3 start = from.b;
      branches.push_back({start, end.cwiseMin(0.92), radius});
    }
  return zero_of(static_cast<Index>(r.whole(40, 56)), [&](const Vec3& x) {
    double d = 1;
    for (const Branch& b : branches) d = smooth_min(d, capsule(x, b.a, b.b, b.radius), 0.02);
    return d;
  });
}

inline Surface waves(std::uint64_t seed) {
  const RandomWaves field(seed);
  return zero_of(seed <= 10 ? 40 : static_cast<Index>(22 + seed % 9), field);
}

inline Surface real_noise(std::uint64_t seed) {
  return meshing::marching_cubes(noise_volume(static_cast<Index>(6 + seed % 8), seed), 0.0).surface;
}
inline Surface integer_noise(std::uint64_t seed) {
  return meshing::marching_cubes(integer_noise_volume(static_cast<Index>(6 + seed % 8), seed), 0.0).surface;
}
inline Surface bits(std::uint64_t seed) {
  const auto bit = [seed](std::uint64_t i) {
    return static_cast<double>(splitmix64(1 + i + (seed << 32)) % 2);
  };
  return meshing::marching_cubes(random_volume<float>(static_cast<Index>(6 + seed % 8), 0.0F, bit), 0.5)
      .surface;
}
inline Surface dual_noise(std::uint64_t seed) {
  return untangled(
      meshing::dual_contour_image(noise_volume(static_cast<Index>(6 + seed % 6), seed), {}, 0.0).surface);
}
inline Surface dual_waves(std::uint64_t seed) {
  const RandomWaves field(seed + 1000);
  const auto image =
      sampled<float>(static_cast<Index>(20 + seed % 6), [&](const Vec3& x) { return -field(x); });
  return untangled(meshing::dual_contour_image(image, {}, 0.0).surface);
}

/// Slabs down to a millionth thin, flat, wavy and rough, as they come and rotated.
inline Surface slab(std::uint64_t seed) {
  Random r(seed);
  const double thick = std::pow(10, -r.between(1, 6)), wave = seed % 3 == 0 ? 0 : r.between(0.02, 0.2);
  const double rough = seed % 4 == 1 ? 0.4 * thick : 0;
  const auto cells = static_cast<int>(r.whole(4, 14));
  const double u = r.between(2, 9), v = r.between(2, 9);
  const auto middle = [&](double x, double y) { return wave * std::sin(u * x) * std::cos(v * y); };
  Surface s = sheet(
      cells, cells + 3, [&](double x, double y) { return middle(x, y) - thick * 0.5; },
      [&](double x, double y) { return middle(x, y) + thick * 0.5 + rough * (r.between(0, 1)); });
  return seed % 2 == 0 ? rotated(s, r) : s;
}

/// Two to four sheets upon one another, gaps of a tenth to a millionth.
inline Surface sheets(std::uint64_t seed) {
  Random r(seed);
  const auto cells = static_cast<int>(r.whole(4, 12));
  const double wave = r.between(0, 0.2), u = r.between(2, 9), gap = std::pow(10, -r.between(1, 6));
  const auto height = [&](double x, double y) { return wave * std::sin(u * (x + 0.4 * y)); };
  Surface s;
  double floor = 0;
  for (auto k = r.whole(2, 4); k > 0; --k) {
    const double thick = r.between(0.05, 0.3);
    const Surface next = sheet(
        cells, cells, [&](double x, double y) { return floor + height(x, y); },
        [&](double x, double y) { return floor + thick + height(x, y); });
    s = s.cell_count() == 0 ? next : joined(s, next);
    floor += thick + gap;
  }
  return seed % 2 == 0 ? rotated(s, r) : s;
}

/// Needles and slivers: spheres, tori and tubes stretched up to 1000 : 1, edges split next to their ends.
inline Surface slivers(std::uint64_t seed) {
  Random r(seed);
  const double f = std::pow(10, -r.between(0, 3)), g = std::pow(10, -r.between(0, 3));
  switch (seed % 5) {
    case 0: return rotated(stretched(noisy_sphere(2, 0.2, seed), Vec3(1, f, g)), r);
    case 1: return stretched(torus(static_cast<int>(r.whole(5, 14)), 40), Vec3(1, f, std::max(f, 0.1)));
    case 2:
      return tube_surface(static_cast<int>(r.whole(20, 90)), static_cast<int>(r.whole(1, 4)), 4, 1, 8 * f);
    case 3: return needled(icosphere(2), r, f * 1e-3);
    default: return rotated(needled(box_surface(2), r, f * 1e-3), r);
  }
}

inline Surface rough_sphere(std::uint64_t seed) {
  Random r(seed);
  return noisy_sphere(static_cast<int>(r.whole(1, 3)), r.between(0.05, 0.95), seed);
}

/// Twelve kinds, each valid: fans, shells, tubes of a voxel, twisted prisms, wedges, tiny beside large,
/// far from the origin, notched, stepped, coarse, spiked, graded.
inline Surface degenerate(std::uint64_t seed) {
  Random r(seed);
  switch (seed % 12) {
    case 0: return fans(static_cast<int>(r.whole(8, 60)), r.between(0.01, 2));
    case 1: return shells(static_cast<int>(r.whole(2, 5)), std::pow(10, -r.between(1, 4)));
    case 2: return voxel_tube(seed);
    case 3: return prisms(static_cast<int>(r.whole(1, 6)), r.between(0.05, 1.03));
    case 4: return needled(icosphere(1), r, 1e-5);
    case 5: return joined(icosphere(2), icosphere(2, 1e-4, Vec3(1.001, 0, 0)));
    case 6: return moved(noisy_sphere(2, 0.3, seed), Vec3(1e6, -3e5, 7e5));
    case 7: return notched(static_cast<int>(r.whole(1, 5)), std::exp2(-static_cast<double>(r.whole(2, 7))));
    case 8: return steps(static_cast<int>(r.whole(2, 7)));
    case 9: return wedge(std::pow(10, -r.between(1, 5)));
    case 10: return rotated(noisy_sphere(1, 0.98, seed), r);
    default: return graded_box(static_cast<int>(r.whole(4, 16)));
  }
}

/// Eight kinds that must be refused.
inline Surface broken(std::uint64_t seed) {
  Random r(seed);
  const Surface sphere = icosphere(2);
  switch (seed % 8) {
    case 0: return without_triangle(sphere, static_cast<Index>(r.whole(0, 300)));
    case 1: return joined(sphere, icosphere(2, 1, Vec3(r.between(0.1, 1.8), 0.1, 0.05)));
    case 2: return touching_at_node(r.between(0.3, 2));
    case 3: return joined(box_surface(1), moved(box_surface(1), Vec3(1, 0.5, 0.5)));  // a common point
    case 4: return joined(sphere, moved(reversed(sphere), Vec3(3, 0, 0)));
    case 5: return reversed(noisy_sphere(2, 0.2, seed));
    case 6: return with_flat_triangle(box_surface(2), static_cast<Index>(r.whole(0, 191)));
    default: return with_turned_triangle(sphere, static_cast<Index>(r.whole(0, 300)));
  }
}

}  // namespace detail

/// All families; their counts make 1,070 surfaces, 40 of which must be refused.
[[nodiscard]] inline std::span<const Family> families() {
  using namespace detail;
  static constexpr std::array<Family, 16> all{
      {{"bifurcations", 80, bifurcation},
       {"bifurcations, smoothed", 80, [](std::uint64_t s) { return smoothed(bifurcation(s + 500)); }},
       {"trees", 60, tree},
       {"random waves", 120, waves},
       {"random waves, smoothed", 120, [](std::uint64_t s) { return smoothed(waves(s)); }},
       {"noise", 80, real_noise},
       {"noise of integers", 80, integer_noise},
       {"noise of bits", 60, bits},
       {"noise, dual contouring", 40, dual_noise},
       {"waves, dual contouring", 40, dual_waves},
       {"thin slabs", 60, slab},
       {"near sheets", 50, sheets},
       {"slivers and needles", 60, slivers},
       {"rough spheres", 40, rough_sphere},
       {"degenerate", 60, degenerate},
       {"broken", 40, broken, true}}};
  return all;
}

}  // namespace tunica::test::soak
