// SPDX-License-Identifier: MIT
// Edges that are short where a surface is curved: the middle of an edge of length l lies k l^2 / 8 off a
// surface of curvature k.
#pragma once

#include "tunica/meshing/curvature.hpp"
#include "tunica/meshing/graded_size.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace tunica::meshing {

/// Lengths in the unit of the surface.
struct CurvatureSizeOptions {
  double edge = 0;             // longest edge, where the surface is flat
  double chord_error = 0;      // most that the middle of an edge lies off; 0: a fortieth of the longest edge
  double edge_per_radius = 0;  // most of an edge over the radius of curvature; 0: not asked for
  double least = 0;            // shortest edge; 0: a quarter of the longest
  double growth = 0.25;        // of the edge per length, along the surface and away from it
  CurvatureOptions fit{};
};

/// h = min(edge, sqrt(8 chord_error / k), edge_per_radius / k), at least `least`, for a closed surface; then
/// graded. k is the larger principal curvature, and more on spheres and saddles, whose triangles deviate
/// more.
[[nodiscard]] inline GradedSize size_from_curvature(const mesh::Surface& s,
                                                    const CurvatureSizeOptions& options) {
  TUNICA_EXPECT(options.edge > 0, "the longest edge is positive");
  constexpr double chord_share = 1.0 / 40, least_share = 0.25;
  const double chord = options.chord_error > 0 ? options.chord_error : chord_share * options.edge;
  const double least = std::min(options.least > 0 ? options.least : least_share * options.edge, options.edge);
  std::vector<double> size;
  for (const Curvature& c : curvatures(s, options.fit)) {
    const double k = std::max(c.sharpest(), c.deviating());
    double h = options.edge;
    if (k > 0) h = std::min(h, std::sqrt(8 * chord / k));
    if (k > 0 && options.edge_per_radius > 0) h = std::min(h, options.edge_per_radius / k);
    size.push_back(std::max(h, least));
  }
  // Sizes at the rim of a flat end say nothing of its inside, where triangles may be as large as the end.
  const auto planes = flat_regions(s);
  const auto curved = [&](Index t) { return !planes[static_cast<std::size_t>(s.region_of(t))]; };
  return graded_size(s, std::move(size), options.growth, options.edge, curved);
}

}  // namespace tunica::meshing
