// SPDX-License-Identifier: MIT
// An analytic field sampled to an image, with blur and seeded noise: the same bits on any machine for
// the noise, whose generator is splitmix64.
#pragma once

#include "tunica/core/error.hpp"
#include "tunica/image/image.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>
#include <vector>

namespace tunica::image {

/// The grid of the MR angiography that the phantom is modelled on, in mm, by default.
struct Sampling {
  std::array<Index, 3> size{68, 118, 34};
  Vec3 origin{195.116864, 86.13282, 0};       // position of voxel 0,0,0 [mm]
  Vec3 spacing{0.878906, 0.878906, 1.50009};  // [mm]
  double blur = 0;                            // standard deviation of a Gaussian [mm]; 0: none
  double noise = 0;                           // standard deviation [intensity]; 0: none
  std::uint64_t seed = 1;                     // of the noise

  /// The same region with `factor` times as many samples a length.
  [[nodiscard]] Sampling refined(Index factor) const {
    Sampling s = *this;
    for (auto& n : s.size) n = (n - 1) * factor + 1;
    s.spacing /= factor;
    return s;
  }
};

/// The generator splitmix64: the k-th number of a seed is splitmix64(seed + k * golden).
[[nodiscard]] constexpr std::uint64_t splitmix64(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

namespace detail {

/// The sum of 12 uniform numbers less 6: mean 0, variance 1, no library function.
[[nodiscard]] inline double bell(std::uint64_t seed, std::size_t index) {
  double sum = -6;
  for (std::uint64_t k = 0; k < 12; ++k)
    sum += static_cast<double>(splitmix64(splitmix64(seed) + 12 * index + k) >> 11) * 0x1p-53;
  return sum;
}

/// Convolves along one axis with a Gaussian of `sigma` samples; the border value goes on outside.
inline void blur_axis(std::vector<double>& values, const std::array<Index, 3>& size, std::size_t axis,
                      double sigma) {
  const auto reach = static_cast<std::ptrdiff_t>(std::ceil(4 * sigma));
  std::vector<double> kernel;
  double sum = 0;
  for (std::ptrdiff_t d = -reach; d <= reach; ++d)
    sum += kernel.emplace_back(std::exp(-0.5 * static_cast<double>(d * d) / (sigma * sigma)));
  for (double& w : kernel) w /= sum;
  std::ptrdiff_t stride = 1;
  for (std::size_t a = 0; a < axis; ++a) stride *= size[a];
  const std::ptrdiff_t n = size[axis];
  const std::vector<double> old = values;
  for (std::ptrdiff_t at = 0; at < static_cast<std::ptrdiff_t>(values.size()); ++at) {
    const std::ptrdiff_t i = at / stride % n;
    double v = 0;
    for (std::ptrdiff_t d = -reach; d <= reach; ++d)
      v += kernel[static_cast<std::size_t>(d + reach)] *
           old[static_cast<std::size_t>(at + (std::clamp(i + d, std::ptrdiff_t{0}, n - 1) - i) * stride)];
    values[static_cast<std::size_t>(at)] = v;
  }
}

template <class T>
[[nodiscard]] T stored(double v) {
  if constexpr (std::is_integral_v<T>)
    return static_cast<T>(std::clamp(std::round(v), static_cast<double>(std::numeric_limits<T>::min()),
                                     static_cast<double>(std::numeric_limits<T>::max())));
  else
    return static_cast<T>(v);
}

}  // namespace detail

/// field.value(x) at the nodes of the grid, blurred, then noisy; integers are rounded to nearest.
template <class T = float, class Field>
requires requires(const Field& f, const Vec3& x) {
  { f.value(x) } -> std::convertible_to<double>;
}
[[nodiscard]] Image<T> sample(const Field& field, const Sampling& how) {
  Image<T> image;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto d = static_cast<Eigen::Index>(a);
    if (how.size[a] < 1 || !(how.spacing[d] > 0))
      throw InputError("sampling: sizes and spacings must be positive");
    for (Index i = 0; i < how.size[a]; ++i) image.axes[a].push_back(how.origin[d] + i * how.spacing[d]);
  }
  std::vector<double> values;
  for (Index k = 0; k < how.size[2]; ++k)
    for (Index j = 0; j < how.size[1]; ++j)
      for (Index i = 0; i < how.size[0]; ++i) values.push_back(field.value(image.position({i, j, k})));
  if (how.blur > 0)
    for (std::size_t a = 0; a < 3; ++a)
      detail::blur_axis(values, how.size, a, how.blur / how.spacing[static_cast<Eigen::Index>(a)]);
  image.values.reserve(values.size());
  for (std::size_t i = 0; i < values.size(); ++i)
    image.values.push_back(
        detail::stored<T>(values[i] + (how.noise > 0 ? how.noise * detail::bell(how.seed, i) : 0)));
  return image;
}

}  // namespace tunica::image
