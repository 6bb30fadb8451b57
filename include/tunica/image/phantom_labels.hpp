// SPDX-License-Identifier: MIT
// The phantom as a segmentation of several materials: lumen, a crescent of thrombus in the aorta, wall.
#pragma once

#include "tunica/core/expect.hpp"
#include "tunica/image/image.hpp"
#include "tunica/image/phantom.hpp"

#include <cstddef>
#include <cstdint>

namespace tunica::image {

enum class PhantomLabel : std::int32_t { outside, lumen, thrombus, wall };

/// Voxels of that spacing and a wall of that thickness [mm]; both ends of the vessel lie in the border of the
/// image.
struct PhantomLabels {
  double spacing = 1, thickness = 2;

  [[nodiscard]] Image<std::int32_t> operator()() const {
    TUNICA_EXPECT(spacing > 0 && thickness > 0, "spacing and thickness are positive");
    const Vec3 lo(200, 95, 5), hi(245, 165, 40);
    Image<std::int32_t> image;
    for (int a = 0; a < 3; ++a)
      for (int i = 0; lo[a] + i * spacing <= hi[a]; ++i)
        image.axes[static_cast<std::size_t>(a)].push_back(lo[a] + i * spacing);
    for (const double z : image.axes[2])
      for (const double y : image.axes[1])
        for (const double x : image.axes[0])
          image.values.push_back(static_cast<std::int32_t>(label({x, y, z})));
    return image;
  }

  /// What is at a point [mm].
  [[nodiscard]] PhantomLabel label(const Vec3& x) const {
    constexpr double lowest = 136, radius = 5.5;  // of the thrombus; of the channel that it leaves [mm]
    const Phantom phantom;
    const double level = phantom.level(x).value;
    if (level > 0) return level > thickness ? PhantomLabel::outside : PhantomLabel::wall;
    const Vec3 channel = phantom.axis(0, x[1]).centre + Vec3(1.5, 0, 1.5);
    return x[1] > lowest && (x - channel).norm() > radius ? PhantomLabel::thrombus : PhantomLabel::lumen;
  }
};

}  // namespace tunica::image
