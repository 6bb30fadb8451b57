// SPDX-License-Identifier: MIT
// A label image as regions: connected sets of voxels of one label, under the neighbours of Kuhn's split of
// the grid into tetrahedra, so that two regions of one label never touch.
#pragma once

#include "tunica/core/error.hpp"
#include "tunica/core/text.hpp"
#include "tunica/image/image.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace tunica::image {

/// A connected set of voxels of one label.
struct LabelRegion {
  std::int64_t label = 0;  // 0: outside
  std::size_t voxels = 0;
  double volume = 0;       // of its voxels, in the cube of the image's unit
  bool at_border = false;  // has a voxel at the border of the image
};

/// Regions in the order of their first voxels. A voxel reaches half-way to its neighbours and, at the border
/// of the image, as far outward as inward.
struct [[nodiscard]] LabelRegions {
  std::array<std::vector<double>, 3> axes;   // places of the voxels, unit of the image
  std::array<std::vector<double>, 3> faces;  // between the voxels and at both ends: one more than axes
  std::vector<Index> of;                     // region of each voxel, x fastest
  std::vector<LabelRegion> regions;

  [[nodiscard]] Index size(std::size_t axis) const { return static_cast<Index>(axes[axis].size()); }
  [[nodiscard]] std::size_t offset(Index i, Index j, Index k) const {
    return static_cast<std::size_t>(i) +
           axes[0].size() * (static_cast<std::size_t>(j) + axes[1].size() * static_cast<std::size_t>(k));
  }
  [[nodiscard]] std::int64_t label(Index region) const {
    return regions[static_cast<std::size_t>(region)].label;
  }
};

/// The seven neighbours of a voxel in the tetrahedra's positive directions: bit a steps along axis a.
inline constexpr std::array<int, 7> kuhn_directions{1, 2, 3, 4, 5, 6, 7};

namespace detail {

/// InputError unless the axis has two samples or more that increase; the faces between its voxels.
[[nodiscard]] inline std::vector<double> voxel_faces(const std::vector<double>& axis, char name) {
  if (axis.size() < 2) throw InputError(std::string("the label image has fewer than 2 voxels along ") + name);
  std::vector<double> faces(axis.size() + 1);
  for (std::size_t i = 0; i < axis.size(); ++i) {
    if (!std::isfinite(axis[i]) || (i > 0 && !(axis[i] > axis[i - 1])))
      throw InputError(std::string("the positions along ") + name + " do not increase at voxel " +
                       std::to_string(i));
    if (i > 0) faces[i] = 0.5 * (axis[i - 1] + axis[i]);
  }
  faces.front() = axis[0] - (faces[1] - axis[0]);
  faces.back() = axis.back() + (axis.back() - faces[axis.size() - 1]);
  return faces;
}

}  // namespace detail

/// Samples of any type as labels. InputError, with the place, where one is no whole number from 0 to 2^31
/// - 1.
template <class T>
[[nodiscard]] Image<std::int32_t> as_labels(const Image<T>& image) {
  Image<std::int32_t> labels{image.axes, std::vector<std::int32_t>(image.values.size())};
  for (std::size_t o = 0; o < image.values.size(); ++o) {
    const auto value = static_cast<double>(image.values[o]);
    if (!(value >= 0 && value <= 2147483647.0) || value != std::floor(value)) {
      const std::size_t nx = image.axes[0].size(), ny = image.axes[1].size();
      const Voxel v{static_cast<Index>(o % nx), static_cast<Index>(o / nx % ny),
                    static_cast<Index>(o / (nx * ny))};
      throw InputError("the image has the value " + number_text(value) + " at " + place(image.position(v)) +
                       ", which is no label");
    }
    labels.values[o] = static_cast<std::int32_t>(value);
  }
  return labels;
}

/// The regions of an image of integer labels, 0 outside. InputError where a label is negative, where the
/// image has fewer than 2 voxels along an axis, or where no voxel has a label.
template <std::integral T>
[[nodiscard]] LabelRegions label_regions(const Image<T>& image) {
  LabelRegions r;
  for (std::size_t a = 0; a < 3; ++a) {
    r.axes[a] = image.axes[a];
    r.faces[a] = detail::voxel_faces(r.axes[a], "xyz"[a]);
  }
  const Index nx = r.size(0), ny = r.size(1), nz = r.size(2);
  if (image.values.size() != r.offset(0, 0, nz)) throw InputError("the label image has too few values");
  r.of.assign(image.values.size(), -1);
  std::vector<Voxel> stack;
  for (std::size_t seed = 0; seed < r.of.size(); ++seed) {
    if (r.of[seed] >= 0) continue;
    const T value = image.values[seed];
    const auto at = [&](std::size_t o) {
      const auto x = static_cast<std::size_t>(nx), y = static_cast<std::size_t>(ny);
      return Voxel{static_cast<Index>(o % x), static_cast<Index>(o / x % y), static_cast<Index>(o / (x * y))};
    };
    if (value < 0)
      throw InputError("label " + std::to_string(value) + " at " + place(image.position(at(seed))) +
                       " is negative");
    const auto number = static_cast<Index>(r.regions.size());
    LabelRegion region{.label = static_cast<std::int64_t>(value)};
    stack.assign(1, at(seed));
    r.of[seed] = number;
    while (!stack.empty()) {
      const Voxel v = stack.back();
      stack.pop_back();
      ++region.voxels;
      double volume = 1;
      const std::array<Index, 3> ijk{v.i, v.j, v.k};
      for (std::size_t a = 0; a < 3; ++a) {
        const auto i = static_cast<std::size_t>(ijk[a]);
        volume *= r.faces[a][i + 1] - r.faces[a][i];
        region.at_border = region.at_border || ijk[a] == 0 || ijk[a] == r.size(a) - 1;
      }
      region.volume += volume;
      for (const int bits : kuhn_directions)
        for (const Index sense : {-1, 1}) {
          const Voxel w{v.i + sense * (bits & 1), v.j + sense * (bits >> 1 & 1), v.k + sense * (bits >> 2)};
          if (w.i < 0 || w.j < 0 || w.k < 0 || w.i >= nx || w.j >= ny || w.k >= nz) continue;
          const std::size_t o = r.offset(w.i, w.j, w.k);
          if (r.of[o] >= 0 || image.values[o] != value) continue;
          r.of[o] = number;
          stack.push_back(w);
        }
    }
    r.regions.push_back(region);
  }
  if (std::none_of(r.regions.begin(), r.regions.end(), [](const LabelRegion& g) { return g.label != 0; }))
    throw InputError("no voxel of the image has a label: all are 0");
  return r;
}

}  // namespace tunica::image
