// SPDX-License-Identifier: MIT
// The contour of an image by dual contouring, as triangles: image_to_mesh --surface dual-contouring.
#pragma once

#include "tunica/image/image.hpp"
#include "tunica/mesh/measures.hpp"
#include "tunica/mesh/mesh.hpp"
#include "tunica/meshing/contour.hpp"
#include "tunica/meshing/dual_contouring.hpp"
#include "tunica/meshing/hermite_field.hpp"
#include "tunica/meshing/split_quads.hpp"

#include <cstddef>
#include <cstdint>
#include <span>

namespace tunica::meshing {

/// The surface of {value >= iso} on the voxels kept (one byte a voxel, 0 is dropped; empty keeps all), closed
/// and manifold for every input. Regions and borders as those of marching_cubes: "wall" first, then a flat
/// region for each face of the image that the inside touches. MeshError when nothing crosses.
template <class T>
[[nodiscard]] Contour dual_contour_image(const image::Image<T>& image, std::span<const std::uint8_t> kept,
                                         double iso, const DualContouringOptions& options = {}) {
  Contour contour{split_quads(dual_contour(hermite_of_image(image, kept, iso), options)), {}};
  const mesh::Surface& s = contour.surface;
  for (std::size_t r = 1; r < s.region_names.size(); ++r) {
    BorderContact border{.name = s.region_names[r], .region = static_cast<Index>(r)};
    for (Index t = 0; t < s.cell_count(); ++t) {
      if (s.region_of(t) != border.region) continue;
      const auto triangle = mesh::triangle(s, t);
      border.area += triangle.area(), border.centre += triangle.area() * triangle.centroid();
    }
    border.centre /= border.area;
    contour.borders.push_back(border);
  }
  return contour;
}

/// The surface alone.
template <class T>
[[nodiscard]] mesh::Surface dual_contour_triangles(const image::Image<T>& image,
                                                   std::span<const std::uint8_t> kept, double iso,
                                                   const DualContouringOptions& options = {}) {
  return dual_contour_image(image, kept, iso, options).surface;
}

}  // namespace tunica::meshing
