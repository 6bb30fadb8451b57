// SPDX-License-Identifier: MIT
// The contour of an image by dual contouring, as triangles: image_to_mesh --surface dual-contouring.
#pragma once

#include "tunica/image/image.hpp"
#include "tunica/mesh/mesh.hpp"
#include "tunica/meshing/dual_contouring.hpp"
#include "tunica/meshing/hermite_field.hpp"
#include "tunica/meshing/split_quads.hpp"

namespace tunica::meshing {

/// Closed and manifold. kept[offset] != 0 marks the voxels of the region (each at least iso, their
/// other neighbours below). Where the region meets the border of the image the surface is closed
/// there by a flat region: "wall" first, then "border x0", ... as far as there are any.
template <class T, class Kept>
[[nodiscard]] mesh::Surface dual_contour_triangles(const image::Image<T>& image, const Kept& kept, double iso,
                                                   const DualContouringOptions& options = {}) {
  return split_quads(dual_contour(hermite_of_image(image, kept, iso), options));
}

}  // namespace tunica::meshing
