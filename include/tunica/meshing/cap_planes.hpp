// SPDX-License-Identifier: MIT
// The planes of the flat caps of a surface.
#pragma once

#include "tunica/meshing/flat_regions.hpp"

namespace tunica::meshing {

[[nodiscard]] inline std::vector<std::optional<Plane>> cap_planes(const mesh::Surface& surface) {
  return flat_regions(surface);
}

}  // namespace tunica::meshing
