// SPDX-License-Identifier: MIT
// How long 50 sweeps over the bifurcation 128^3 take: alone, and with all that a call does.
#pragma once

#include "support/stopwatch.hpp"
#include "support/work_cases.hpp"
#include "tunica/meshing/flat_regions.hpp"
#include "tunica/meshing/marching_cubes.hpp"
#include "tunica/meshing/smooth.hpp"
#include "tunica/meshing/smooth_sweeps.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

namespace tunica::bench {

/// Least CPU times of several runs, and what was smoothed.
struct SmoothingTime {
  static constexpr Index n = 128;
  static constexpr int sweeps = 50, repeats = 5;
  double alone = std::numeric_limits<double>::infinity(), call = 0;  // [s]
  mesh::Surface raw, smoothed;

  explicit SmoothingTime(const image::Image<float>& image) : raw(meshing::marching_cubes(image, 0).surface) {
    call = best_cpu_seconds(repeats, [&] {
      smoothed = raw;
      static_cast<void>(meshing::smooth(smoothed, {.sweeps = sweeps}));
    });
    const auto planes = meshing::flat_regions(raw);
    const meshing::Bonds bonds;
    const std::vector<char> held(static_cast<std::size_t>(raw.node_count()), 0);
    for (int i = 0; i < repeats; ++i) {
      meshing::detail::Sweeps work(raw, planes, bonds, held);
      alone = std::min(alone, best_cpu_seconds(1, [&] {
                         for (int k = 0; k < sweeps; ++k) static_cast<void>(work.sweep(0.5));
                       }));
    }
  }

  /// A vertex and sweep [ns].
  [[nodiscard]] double per_move(double seconds) const { return 1e9 * seconds / (sweeps * raw.node_count()); }
};

/// The samples that are smoothed: inside where they are positive.
[[nodiscard]] inline image::Image<float> smoothing_volume() {
  return test::sampled<float>(SmoothingTime::n, [](const Vec3& x) { return -test::bifurcation(x); });
}

}  // namespace tunica::bench
