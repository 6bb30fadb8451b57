// SPDX-License-Identifier: MIT
// The contour of an image by dual contouring: image_to_mesh --surface dual-contouring.
#pragma once

#include "tunica/core/error.hpp"
#include "tunica/core/text.hpp"
#include "tunica/image/image.hpp"
#include "tunica/image/require_grid.hpp"
#include "tunica/mesh/measures.hpp"
#include "tunica/mesh/mesh.hpp"
#include "tunica/meshing/contour.hpp"
#include "tunica/meshing/dual_sweep.hpp"
#include "tunica/meshing/grid_crossing.hpp"
#include "tunica/meshing/padded_bits.hpp"
#include "tunica/meshing/quad_diagonals.hpp"
#include "tunica/meshing/sign_bits.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace tunica::meshing {

struct DualImageOptions {
  QefOptions qef{};
  /// Vertices keep this share of their cell from its sides; a negative share lets them leave it by so much:
  /// sharp edges that pass just outside are met, at the price of overlaps on rough data.
  double hold = 1e-3;
  /// Share of the step from the mean of the crossings to the least error where the surface is smooth. That
  /// mean lies as far on one side of a curved surface as the least error on the other: half-way the vertex
  /// lies as near to the surface as the crossings do; 1 is [JU02]. Planes, edges and corners are the same for
  /// any.
  double smooth_share = 0.5;
};

namespace detail {

/// All nodes alike: nothing but the border of the image would bound them.
inline void expect_crossing(const PaddedBits& bits, double iso) {
  if (!bits.alike()) return;
  throw MeshError("no edge of the grid crosses the iso-value " + seven_digits(iso) +
                  ": all of the image is " + (bits.inside(1, 1, 1) ? "inside" : "outside"));
}

[[nodiscard]] inline LeastErrorOptions least_error_options(const DualImageOptions& options) {
  return {.cut = options.qef.cut * options.qef.cut, .smooth = options.smooth_share};
}

/// Triangles, and the faces of the image that they touch.
[[nodiscard]] inline Contour contour_of(mesh::QuadSurface quads) {
  Contour contour{triangles_of(std::move(quads)), {}};
  const mesh::Surface& s = contour.surface;
  for (std::size_t r = 1; r < s.region_names.size(); ++r) {
    if (s.region_names[r].compare(0, border_prefix.size(), border_prefix) != 0) continue;
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

}  // namespace detail

/// The surface of {value >= iso} on the voxels kept (one byte a voxel, 0 is dropped; empty keeps all) as
/// quadrilaterals, one for each edge of the grid that it crosses: closed and manifold for every input, the
/// same bits on any number of threads. Regions as those of marching_cubes: "wall" first, then a flat region
/// for each face of the image that the inside touches. MeshError when nothing crosses or an axis has a single
/// sample.
template <class T>
[[nodiscard]] mesh::QuadSurface dual_contour_quads(const image::Image<T>& image,
                                                   std::span<const std::uint8_t> kept, double iso,
                                                   const DualImageOptions& options = {}) {
  image::require_grid(image, kept);
  const detail::PaddedBits bits(SignBits(image, kept, iso),
                                {image.axes[0].size(), image.axes[1].size(), image.axes[2].size()});
  detail::expect_crossing(bits, iso);
  const detail::GridCrossings<T> crossings(image, iso);
  return detail::DualSweep(image.axes, bits, crossings, {{}}, options.hold,
                           detail::least_error_options(options))
      .run();
}

/// The same as triangles, each quadrilateral cut along the better diagonal; no triangle is degenerate while
/// vertices are held in their cells.
template <class T>
[[nodiscard]] Contour dual_contour_image(const image::Image<T>& image, std::span<const std::uint8_t> kept,
                                         double iso, const DualImageOptions& options = {}) {
  return detail::contour_of(dual_contour_quads(image, kept, iso, options));
}

/// The surface alone.
template <class T>
[[nodiscard]] mesh::Surface dual_contour_triangles(const image::Image<T>& image,
                                                   std::span<const std::uint8_t> kept, double iso,
                                                   const DualImageOptions& options = {}) {
  return dual_contour_image(image, kept, iso, options).surface;
}

}  // namespace tunica::meshing
