// SPDX-License-Identifier: MIT
// What every contourer asks of an image and its mask.
#pragma once

#include "tunica/core/error.hpp"
#include "tunica/core/expect.hpp"
#include "tunica/image/image.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace tunica::image {

/// Two samples or more an axis, else MeshError: nothing can cross. Its coordinates increase, there is a value
/// for each node, and the mask (one byte a voxel) has as many, or none: preconditions.
template <class T>
void require_grid(const Image<T>& image, [[maybe_unused]] std::span<const std::uint8_t> kept) {
  for (std::size_t a = 0; a < 3; ++a) {
    const auto& axis = image.axes[a];
    if (axis.size() < 2)
      throw MeshError("no edge of the grid crosses the iso-value: the image has " +
                      std::to_string(axis.size()) + " sample along axis " + std::string(1, "xyz"[a]) +
                      ", two are needed");
    for (std::size_t i = 0; i + 1 < axis.size(); ++i)
      TUNICA_EXPECT(axis[i] < axis[i + 1], "the coordinates of an axis increase");
  }
  TUNICA_EXPECT(image.values.size() == image.axes[0].size() * image.axes[1].size() * image.axes[2].size(),
                "an image has a value for each node of its grid");
  TUNICA_EXPECT(kept.empty() || kept.size() == image.values.size(), "the mask has one byte for each voxel");
}

}  // namespace tunica::image
