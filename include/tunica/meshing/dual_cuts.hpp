// SPDX-License-Identifier: MIT
// Dual contouring of an image together with planes and discs that cut it: ends of vessels are flat regions of
// their own, their rims sharp, in one go. [JU02]
#pragma once

#include "tunica/core/error.hpp"
#include "tunica/image/image.hpp"
#include "tunica/image/require_grid.hpp"
#include "tunica/meshing/contour_triangles.hpp"
#include "tunica/meshing/cut.hpp"
#include "tunica/meshing/dual_sweep.hpp"
#include "tunica/meshing/grid_cuts.hpp"
#include "tunica/meshing/padded_bits.hpp"
#include "tunica/meshing/sign_bits.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace tunica::meshing {

struct [[nodiscard]] CutContour {
  Contour contour;              // regions: "wall", the cuts in their order, the borders of the image
  std::vector<CutReport> cuts;  // one for each cut, in order
};

/// The surface of {value >= iso} on the voxels kept (one byte a voxel, 0 is dropped; empty keeps all) behind
/// the cuts, as quadrilaterals: closed and manifold. A plane removes all in front of it; a disc severs only
/// the vessel that it crosses, and the part with the seed stays (without a seed the larger one), on either
/// side. Nodes of the region of a cut lie in its plane to rounding, its rim is where wall and plane meet.
/// MeshError where nothing crosses, where a cut meets nothing (with its distance), does not sever its vessel
/// (with the radius that is missing), leaves nothing, or is taken away by others.
template <class T>
[[nodiscard]] mesh::QuadSurface dual_contour_quads(const image::Image<T>& image,
                                                   std::span<const std::uint8_t> kept, double iso,
                                                   std::span<const Cut> cuts,
                                                   const CutOptions& cut_options = {},
                                                   const DualImageOptions& options = {}) {
  image::require_grid(image, kept);
  detail::PaddedBits bits(SignBits(image, kept, iso),
                          {image.axes[0].size(), image.axes[1].size(), image.axes[2].size()});
  detail::expect_crossing(bits, iso);
  detail::GridCutter cutter(image.axes, bits);
  for (const Cut& c : cuts) cutter.apply(c, cut_options);
  const detail::CutCrossings<T> crossings(image, kept, iso, cutter.cuts(), cutter.nearest());
  std::vector<HermiteRegion> regions{{}};
  for (const auto& c : cutter.cuts()) regions.push_back(c.plane);
  auto quads = detail::DualSweep(image.axes, bits, crossings, regions, options.hold,
                                 detail::least_error_options(options))
                   .run();
  for (std::size_t r = 1; r < regions.size(); ++r)
    if (std::find(quads.region.begin(), quads.region.end(), static_cast<Index>(r)) == quads.region.end())
      throw MeshError("the other cuts remove all of \"" + regions[r].name + "\"");
  return quads;
}

/// The same as triangles, with area, centre and rim of each end.
template <class T>
[[nodiscard]] CutContour dual_contour_image(const image::Image<T>& image, std::span<const std::uint8_t> kept,
                                            double iso, std::span<const Cut> cuts,
                                            const CutOptions& cut_options = {},
                                            const DualImageOptions& options = {}) {
  CutContour result{detail::contour_of(dual_contour_quads(image, kept, iso, cuts, cut_options, options)), {}};
  for (std::size_t c = 0; c < cuts.size(); ++c) {
    result.cuts.push_back({.name = result.contour.surface.region_names[c + 1]});
    detail::measure(result.contour.surface, result.cuts.back());
  }
  return result;
}

}  // namespace tunica::meshing
