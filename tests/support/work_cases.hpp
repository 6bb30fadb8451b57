// SPDX-License-Identifier: MIT
// The generated volumes on which contourers and smoothers are measured: unit cube, n^3 samples, x fastest.
#pragma once

#include "tunica/image/image.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace tunica::test {

[[nodiscard]] inline std::uint64_t splitmix64(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

/// Uniform in [-1, 1).
[[nodiscard]] inline double noise(std::uint64_t seed) {
  return static_cast<double>(splitmix64(seed) >> 11) * 0x1p-52 - 1;
}

/// Samples of field(x) on the unit cube.
template <class T, class Field>
[[nodiscard]] image::Image<T> sampled(Index n, Field&& field) {
  image::Image<T> im;
  for (auto& axis : im.axes)
    for (Index i = 0; i < n; ++i) axis.push_back(static_cast<double>(i) / (n - 1));
  im.values.reserve(static_cast<std::size_t>(n) * static_cast<std::size_t>(n) * static_cast<std::size_t>(n));
  for (const double z : im.axes[2])
    for (const double y : im.axes[1])
      for (const double x : im.axes[0]) im.values.push_back(static_cast<T>(field(Vec3(x, y, z))));
  return im;
}

/// Values by voxel number, with an outer layer of one value: all surfaces are closed inside.
template <class T, class Value>
[[nodiscard]] image::Image<T> random_volume(Index n, T outer, Value&& value) {
  std::uint64_t index = 0;
  const double last = 1;
  return sampled<T>(n, [&](const Vec3& x) {
    const T v = static_cast<T>(value(index++));
    return (x.array() == 0).any() || (x.array() == last).any() ? outer : v;
  });
}

/// Noise of positive inside: every sample is random.
[[nodiscard]] inline image::Image<float> noise_volume(Index n, std::uint64_t seed = 0) {
  return random_volume<float>(n, -1.0F, [seed](std::uint64_t i) { return -noise(1 + i + (seed << 32)); });
}

/// Noise of integers -2 .. 2: a fifth of the samples lie on the iso-value 0.
[[nodiscard]] inline image::Image<float> integer_noise_volume(Index n, std::uint64_t seed = 0) {
  return random_volume<float>(n, -2.0F, [seed](std::uint64_t i) {
    return 2.0 - static_cast<double>(splitmix64(1 + i + (seed << 32)) % 5);
  });
}

[[nodiscard]] inline double capsule(const Vec3& p, const Vec3& a, const Vec3& b, double r) {
  const Vec3 ab = b - a;
  const double t = std::clamp((p - a).dot(ab) / ab.squaredNorm(), 0.0, 1.0);
  return (p - a - t * ab).norm() - r;
}

[[nodiscard]] inline double smooth_min(double a, double b, double k) {
  const double overlap = std::max(k - std::abs(a - b), 0.0);
  return std::min(a, b) - overlap * overlap / (4 * k);
}

/// A bifurcation of three capsules; negative inside.
[[nodiscard]] inline double bifurcation(const Vec3& x) {
  const Vec3 a(.5, .5, .14), b(.5, .5, .5), c(.25, .45, .86), d(.76, .57, .84);
  return smooth_min(smooth_min(capsule(x, a, b, .11), capsule(x, b, c, .08), .06), capsule(x, b, d, .07),
                    .06);
}

[[nodiscard]] inline double sphere(const Vec3& x) {
  return (x - Vec3::Constant(0.5)).norm() - 0.4;
}

/// 24 random waves cut off near the faces of the cube: closed, high genus, thin gaps; negative inside.
class RandomWaves {
 public:
  explicit RandomWaves(std::uint64_t seed) {
    std::uint64_t at = seed << 20;
    for (Wave& w : waves_) {
      Vec3 a;
      do {
        for (double& c : a) c = noise(++at);
      } while (a.norm() > 1);
      w = {8 * std::numbers::pi * a, std::numbers::pi * noise(++at)};
    }
  }
  [[nodiscard]] double operator()(const Vec3& x) const {
    double sum = 0;
    for (const Wave& w : waves_) sum += std::cos(w.a.dot(x) + w.phase);
    return std::max(sum / 48, (x - Vec3::Constant(0.5)).cwiseAbs().maxCoeff() - 0.46);
  }

 private:
  struct Wave {
    Vec3 a = Vec3::Zero();
    double phase = 0;
  };
  std::array<Wave, 24> waves_{};
};

/// Root-mean-square and largest distance of the nodes to the zero of field, by Newton's method along its
/// gradient (central differences of step d).
template <class Field>
[[nodiscard]] std::pair<double, double> distance_to_zero(const Points<3>& nodes, const Field& field,
                                                         double d = 1e-6) {
  double sum = 0, most = 0;
  for (Eigen::Index n = 0; n < nodes.cols(); ++n) {
    Vec3 x = nodes.col(n);
    for (int it = 0; it < 3; ++it) {
      Vec3 g;
      for (int a = 0; a < 3; ++a) {
        const Vec3 e = d * Vec3::Unit(a);
        g[a] = (field(x + e) - field(x - e)) / (2 * d);
      }
      x -= field(x) / g.squaredNorm() * g;
    }
    const double dist = (x - nodes.col(n)).norm();
    sum += dist * dist, most = std::max(most, dist);
  }
  return {std::sqrt(sum / static_cast<double>(nodes.cols())), most};
}

}  // namespace tunica::test
