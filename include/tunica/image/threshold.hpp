// SPDX-License-Identifier: MIT
// Masks of an image: value >= iso, or a band of values. [PEREZ08, 3.2]
#pragma once

#include "tunica/core/error.hpp"
#include "tunica/core/text.hpp"
#include "tunica/image/image.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace tunica::image {

/// Which voxels of a grid are inside: one byte a voxel, x fastest.
struct Mask {
  std::array<Index, 3> size{};
  std::vector<std::uint8_t> inside;  // nx*ny*nz

  [[nodiscard]] std::size_t offset(Voxel v) const {
    return static_cast<std::size_t>(v.i) +
           static_cast<std::size_t>(size[0]) *
               (static_cast<std::size_t>(v.j) +
                static_cast<std::size_t>(size[1]) * static_cast<std::size_t>(v.k));
  }
  [[nodiscard]] bool operator()(Voxel v) const { return inside[offset(v)] != 0; }
  [[nodiscard]] std::size_t count() const {
    return static_cast<std::size_t>(
        std::count_if(inside.begin(), inside.end(), [](auto b) { return b != 0; }));
  }
};

/// Both ends belong to it.
struct Band {
  double lowest = 0, highest = 0;  // unit of the samples
};

/// Least and greatest sample. InputError if the image has no voxel.
template <class T>
[[nodiscard]] Band data_range(const Image<T>& image) {
  if (image.values.empty()) throw InputError("the image has no voxels");
  const auto [lo, hi] = std::minmax_element(image.values.begin(), image.values.end());
  return {static_cast<double>(*lo), static_cast<double>(*hi)};
}

[[nodiscard]] inline std::string range_text(const Band& b) {
  return "data range " + number_text(b.lowest) + ".." + number_text(b.highest);
}

/// InputError, with the range of the data, unless some voxels are at or above iso and some below.
template <class T>
void require_crossing(const Image<T>& image, double iso) {
  const Band range = data_range(image);
  if (!std::isfinite(iso)) throw InputError("iso-value is not a number; " + range_text(range));
  if (range.lowest == range.highest && iso > range.highest)
    throw InputError("no voxel at or above " + number_text(iso) + " (" + range_text(range) + ")");
  if (range.lowest == range.highest || iso == range.lowest)
    throw InputError("every voxel is at or above " + number_text(iso) + " (" + range_text(range) +
                     "): the region touches all six faces of the image and there is no surface");
  if (iso < range.lowest || iso > range.highest)
    throw InputError("iso-value " + number_text(iso) + " outside " + range_text(range));
}

namespace detail {
template <class T, class Inside>
[[nodiscard]] Mask mask_of(const Image<T>& image, Inside inside) {
  Mask mask{{image.size(0), image.size(1), image.size(2)}, std::vector<std::uint8_t>(image.values.size())};
  std::transform(image.values.begin(), image.values.end(), mask.inside.begin(),
                 [&](T v) { return static_cast<std::uint8_t>(inside(static_cast<double>(v))); });
  return mask;
}
}  // namespace detail

/// Voxels with value >= iso.
template <class T>
[[nodiscard]] Mask at_or_above(const Image<T>& image, double iso) {
  return detail::mask_of(image, [iso](double v) { return v >= iso; });
}

/// Voxels with lowest <= value <= highest.
template <class T>
[[nodiscard]] Mask within(const Image<T>& image, const Band& band) {
  return detail::mask_of(image, [&](double v) { return v >= band.lowest && v <= band.highest; });
}

}  // namespace tunica::image
