// SPDX-License-Identifier: MIT
// Connected components of a mask (6, 18 or 26 neighbours): all of them, the largest, that of a seed.
#pragma once

#include "tunica/image/threshold.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

namespace tunica::image {

/// Which voxels are neighbours: those that share a face, an edge too, or a corner too.
enum class Neighbours { faces = 6, edges = 18, corners = 26 };

/// The six faces of the grid, in the order of Region::touches.
inline constexpr std::array<const char*, 6> face_names{"x0", "x1", "y0", "y1", "z0", "z1"};

/// One connected component of a mask.
struct [[nodiscard]] Region {
  Mask mask;
  std::size_t voxels = 0;
  Voxel lowest, highest;          // bounding box, both ends inside
  std::array<bool, 6> touches{};  // faces of the image, in the order of face_names
};

/// All components: those of lower first voxels come first.
struct [[nodiscard]] Components {
  std::array<Index, 3> size{};
  std::vector<Index> label;         // one a voxel; -1 outside the mask
  std::vector<std::size_t> voxels;  // one a component

  [[nodiscard]] std::size_t count() const { return voxels.size(); }
  /// The one with most voxels, the first of equals; InputError when there is none.
  [[nodiscard]] Index largest() const {
    if (voxels.empty()) throw InputError("the mask is empty: it has no component");
    return static_cast<Index>(std::max_element(voxels.begin(), voxels.end()) - voxels.begin());
  }
};

namespace detail {

struct Step {
  Index i, j, k;
};

[[nodiscard]] inline std::vector<Step> steps_of(Neighbours n) {
  const int reach = n == Neighbours::faces ? 1 : n == Neighbours::edges ? 2 : 3;
  std::vector<Step> steps;
  for (Index k = -1; k <= 1; ++k)
    for (Index j = -1; j <= 1; ++j)
      for (Index i = -1; i <= 1; ++i)
        if (const int away = std::abs(i) + std::abs(j) + std::abs(k); away > 0 && away <= reach)
          steps.push_back({i, j, k});
  return steps;
}

[[nodiscard]] inline Voxel voxel_at(const std::array<Index, 3>& size, std::size_t offset) {
  const auto nx = static_cast<std::size_t>(size[0]), ny = static_cast<std::size_t>(size[1]);
  return {static_cast<Index>(offset % nx), static_cast<Index>(offset / nx % ny),
          static_cast<Index>(offset / (nx * ny))};
}

/// Gives every voxel that is connected to the start the label; returns how many there are.
[[nodiscard]] inline std::size_t flood(const Mask& mask, std::size_t start, const std::vector<Step>& steps,
                                       Index value, std::vector<Index>& label,
                                       std::vector<std::size_t>& stack) {
  stack.assign(1, start);
  label[start] = value;
  std::size_t voxels = 0;
  while (!stack.empty()) {
    const Voxel v = voxel_at(mask.size, stack.back());
    stack.pop_back();
    ++voxels;
    for (const Step& s : steps) {
      const Voxel w{v.i + s.i, v.j + s.j, v.k + s.k};
      if (w.i < 0 || w.j < 0 || w.k < 0 || w.i >= mask.size[0] || w.j >= mask.size[1] || w.k >= mask.size[2])
        continue;
      const std::size_t at = mask.offset(w);
      if (mask.inside[at] == 0 || label[at] >= 0) continue;
      label[at] = value;
      stack.push_back(at);
    }
  }
  return voxels;
}

}  // namespace detail

[[nodiscard]] inline Components components(const Mask& mask, Neighbours neighbours = Neighbours::faces) {
  Components all{mask.size, std::vector<Index>(mask.inside.size(), -1), {}};
  const auto steps = detail::steps_of(neighbours);
  std::vector<std::size_t> stack;
  for (std::size_t at = 0; at < mask.inside.size(); ++at)
    if (mask.inside[at] != 0 && all.label[at] < 0)
      all.voxels.push_back(
          detail::flood(mask, at, steps, static_cast<Index>(all.voxels.size()), all.label, stack));
  return all;
}

/// The mask of one component, its bounding box and the faces of the image that it touches.
[[nodiscard]] inline Region region_of(const Components& all, Index component) {
  Region r;
  r.mask = {all.size, std::vector<std::uint8_t>(all.label.size())};
  r.lowest = {all.size[0], all.size[1], all.size[2]}, r.highest = {-1, -1, -1};
  for (std::size_t at = 0; at < all.label.size(); ++at) {
    if (all.label[at] != component) continue;
    const Voxel v = detail::voxel_at(all.size, at);
    r.mask.inside[at] = 1;
    ++r.voxels;
    r.lowest = {std::min(r.lowest.i, v.i), std::min(r.lowest.j, v.j), std::min(r.lowest.k, v.k)};
    r.highest = {std::max(r.highest.i, v.i), std::max(r.highest.j, v.j), std::max(r.highest.k, v.k)};
  }
  r.touches = {r.lowest.i == 0, r.highest.i == all.size[0] - 1,
               r.lowest.j == 0, r.highest.j == all.size[1] - 1,
               r.lowest.k == 0, r.highest.k == all.size[2] - 1};
  return r;
}

struct Segmentation {
  double iso = 0;               // unit of the samples; inside is value >= iso
  std::optional<Voxel> seed{};  // none: the largest component
  Neighbours neighbours = Neighbours::faces;
};

/// The component of {value >= iso} that holds the seed, or the largest one. InputError with the
/// range of the data when nothing crosses iso, or when the seed is outside the image or the vessel.
template <class T>
[[nodiscard]] Region segment(const Image<T>& image, const Segmentation& how) {
  const auto text = [](Voxel v) {
    return std::to_string(v.i) + "," + std::to_string(v.j) + "," + std::to_string(v.k);
  };
  if (how.seed && !image.contains(*how.seed))
    throw InputError("seed " + text(*how.seed) + " is outside the image of " +
                     text({image.size(0), image.size(1), image.size(2)}) + " voxels");
  require_crossing(image, how.iso);
  if (how.seed && !(static_cast<double>(image(*how.seed)) >= how.iso))
    throw InputError("seed " + text(*how.seed) + " has the value " +
                     number_text(static_cast<double>(image(*how.seed))) + ", below the iso-value " +
                     number_text(how.iso));
  const Components all = components(at_or_above(image, how.iso), how.neighbours);
  return region_of(all, how.seed ? all.label[image.offset(*how.seed)] : all.largest());
}

/// The image with every other voxel at or above iso mirrored to below it, so that only the region
/// is inside. With face neighbours no grid edge that crosses the surface of the region changes.
template <class T>
[[nodiscard]] Image<T> keep_only(const Image<T>& image, const Region& region, double iso) {
  const Band range = data_range(image);
  Image<T> kept = image;
  for (std::size_t at = 0; at < kept.values.size(); ++at) {
    const double v = static_cast<double>(kept.values[at]);
    if (region.mask.inside[at] != 0 || v < iso) continue;
    const auto mirrored = static_cast<T>(std::max(range.lowest, 2 * iso - v));
    kept.values[at] = static_cast<double>(mirrored) < iso ? mirrored : static_cast<T>(range.lowest);
  }
  return kept;
}

}  // namespace tunica::image
