// SPDX-License-Identifier: MIT
// What a contourer returns: the surface with its named regions, and the faces of the image that it touches.
#pragma once

#include "tunica/mesh/mesh.hpp"

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace tunica::meshing {

/// What becomes of the surface at the border of the image.
enum class Border { capped, open };

struct MarchingCubesOptions {
  Border border = Border::capped;
};

/// A face of the image that the inside touches.
struct BorderContact {
  std::string name;            // "border x0", "border x1", "border y0" ...
  double area = 0;             // of its cap, in the unit of the image squared
  Vec3 centre = Vec3::Zero();  // of its cap
  Index region = 0;            // of the cap in the surface
};

struct [[nodiscard]] Contour {
  mesh::Surface surface;               // regions: "wall", then a cap for each face touched
  std::vector<BorderContact> borders;  // in the order x0, x1, y0, y1, z0, z1
};

inline constexpr std::array<const char*, 6> border_names{"border x0", "border x1", "border y0",
                                                         "border y1", "border z0", "border z1"};

/// Regions of a surface whose names begin like this are caps at the border of the image.
inline constexpr std::string_view border_prefix = "border ";

}  // namespace tunica::meshing
