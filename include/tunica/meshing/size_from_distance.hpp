// SPDX-License-Identifier: MIT
// Edges that are short at given places and grow with the distance from them: points, the wall, a named end.
#pragma once

#include "tunica/core/error.hpp"
#include "tunica/meshing/graded_size.hpp"

#include <algorithm>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tunica::meshing {

/// Lengths in the unit of the surface.
struct DistanceSizeOptions {
  double edge = 0;       // longest edge, far from the places
  double least = 0;      // edge at the places; 0: a third of the longest
  double growth = 0.25;  // of the edge per distance

  [[nodiscard]] double at_places() const { return least > 0 ? least : edge / 3; }
};

/// h(x) = min(edge, least + growth d(x)), d the distance to the nearest of the points.
[[nodiscard]] inline GradedSize size_from_distance(std::span<const Vec3> points,
                                                   const DistanceSizeOptions& options) {
  TUNICA_EXPECT(options.edge > 0 && options.growth > 0, "the longest edge and the growth are positive");
  const double h = std::min(options.at_places(), options.edge);
  std::vector<ValuedTriangle> places;
  for (const Vec3& x : points) places.push_back({{x, x, x}, {h, h, h}});
  return {std::move(places), options.growth, options.edge};
}

/// The distance is that to the triangles of one region of the surface, such as "wall" or the name of an end;
/// MeshError with the names there are when there is none of that name.
[[nodiscard]] inline GradedSize size_from_distance(const mesh::Surface& s, std::string_view region,
                                                   const DistanceSizeOptions& options) {
  TUNICA_EXPECT(options.edge > 0 && options.growth > 0, "the longest edge and the growth are positive");
  const auto found = std::find(s.region_names.begin(), s.region_names.end(), region);
  if (found == s.region_names.end()) {
    std::string known;
    for (const std::string& name : s.region_names) known += (known.empty() ? "" : ", ") + name;
    throw MeshError("the surface has no region \"" + std::string(region) + "\"; there are: " + known);
  }
  const auto number = static_cast<Index>(found - s.region_names.begin());
  const double h = std::min(options.at_places(), options.edge);
  std::vector<ValuedTriangle> places;
  for (Index t = 0; t < s.cell_count(); ++t)
    if (s.region_of(t) == number) places.push_back({mesh::triangle(s, t), {h, h, h}});
  return {std::move(places), options.growth, options.edge};
}

}  // namespace tunica::meshing
