// SPDX-License-Identifier: MIT
// The named ends of a vessel, and the distance from a point within it to its wall: to all but the ends.
#pragma once

#include "tunica/mesh/measures.hpp"
#include "tunica/search/octree.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace tunica::meshing {

/// Where a centre line begins or ends: a flat region, or a point within the vessel (a blind end).
struct VesselEnd {
  std::string name;
  Vec3 point{0, 0, 0};   // within the vessel or on its flat end
  Vec3 normal{0, 0, 0};  // unit, outward; zero at a blind end
  double area = 0;       // of the region; 0 at a blind end
  Index region = -1;     // of the surface; -1 at a blind end
};

/// The regions of a surface but the first ("wall"), in their order.
[[nodiscard]] inline std::vector<VesselEnd> vessel_ends(const mesh::Surface& s) {
  std::vector<VesselEnd> ends;
  for (std::size_t r = 1; r < s.region_names.size(); ++r) {
    VesselEnd e{.name = s.region_names[r], .region = static_cast<Index>(r)};
    for (Index t = 0; t < s.cell_count(); ++t) {
      if (s.region_of(t) != e.region) continue;
      const mesh::Triangle f = mesh::triangle(s, t);
      const double a = f.area();
      e.normal = vec::plus(e.normal, f.area_vector());
      e.point = vec::along(e.point, a, f.centroid()), e.area += a;
    }
    if (!(e.area > 0)) continue;
    e.point = vec::divided(e.point, e.area), e.normal = vec::unit(e.normal);
    ends.push_back(e);
  }
  return ends;
}

/// Distance to the triangles of a surface that belong to no end.
class WallDistance {
 public:
  WallDistance(const mesh::Surface& s, const std::vector<VesselEnd>& ends) {
    std::vector<Box> boxes;
    for (Index t = 0; t < s.cell_count(); ++t) {
      const bool at_end = std::any_of(ends.begin(), ends.end(), [&](const VesselEnd& e) {
        return e.region >= 0 && e.region == s.region_of(t);
      });
      if (at_end) continue;
      shape_.push_back(mesh::triangle(s, t));
      boxes.push_back(shape_.back().box());
    }
    tree_ = search::Octree(boxes);
  }

  struct Touch {
    Index triangle = -1;  // -1: none within the bound
    double distance = std::numeric_limits<double>::infinity();
  };
  /// The nearest triangle within the bound.
  [[nodiscard]] Touch nearest(const Vec3& x, double bound = std::numeric_limits<double>::infinity()) const {
    const auto found = tree_.nearest(
        x, [&](Index i) { return squared_to(i, x); }, bound * bound);
    return {found.item, std::sqrt(found.squared_distance)};
  }
  [[nodiscard]] double operator()(const Vec3& x) const { return nearest(x).distance; }

  /// The squared distance to one triangle.
  [[nodiscard]] double squared_to(Index triangle, const Vec3& x) const {
    const mesh::Triangle& t = shape_[static_cast<std::size_t>(triangle)];
    return vec::squared(vec::minus(t.at(t.nearest(x)), x));
  }

 private:
  std::vector<mesh::Triangle> shape_;
  search::Octree tree_;
};

}  // namespace tunica::meshing
