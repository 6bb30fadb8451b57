// SPDX-License-Identifier: MIT
// Area, perimeter, equivalent diameter and centroid of the sections of a closed surface by planes.
#pragma once

#include "tunica/meshing/section.hpp"

#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace tunica::meshing {

struct SectionPlane {
  Vec3 point, normal;  // the normal has length 1
};

/// One connected part of a section, without its holes.
struct SectionArea {
  double area = 0;                 // in the unit of the surface squared
  double perimeter = 0;            // with that of its holes
  double equivalent_diameter = 0;  // of the circle of that area
  Vec3 centroid{0, 0, 0};
  double distance = 0;  // from the point of the plane: 0 where the part holds it
};

/// A closed surface that is cut again and again; it must outlive this.
class SectionFinder {
 public:
  explicit SectionFinder(const mesh::Surface& s)
      : surface_(s),
        twin_(mesh::twins(s.cells, s.node_count())),
        distance_(static_cast<std::size_t>(s.node_count())) {}

  /// All parts of the section; empty where the plane misses the surface.
  [[nodiscard]] std::vector<SectionArea> operator()(const SectionPlane& plane) {
    for (Index n = 0; n < surface_.node_count(); ++n)
      distance_[static_cast<std::size_t>(n)] =
          vec::dot(plane.normal, vec::minus(mesh::node(surface_, n), plane.point));
    std::vector<SectionArea> parts;
    for (const Section& p : sections(surface_, twin_, distance_, PlaneFrame(plane.point, plane.normal)))
      parts.push_back({.area = p.area,
                       .perimeter = p.perimeter,
                       .equivalent_diameter = 2 * std::sqrt(p.area / std::numbers::pi),
                       .centroid = p.centroid,
                       .distance = p.nearest});
    return parts;
  }

  /// The part that holds the point of the plane, or the one nearest to it; of area 0 when there is none.
  [[nodiscard]] SectionArea at(const SectionPlane& plane) {
    SectionArea best;
    for (const SectionArea& p : (*this)(plane))
      if (best.area == 0 || p.distance < best.distance) best = p;
    return best;
  }

 private:
  const mesh::Surface& surface_;
  std::vector<Index> twin_;
  std::vector<double> distance_;
};

/// The parts of the sections of a closed surface, plane by plane: O(triangles) a plane.
[[nodiscard]] inline std::vector<std::vector<SectionArea>> section_areas(
    const mesh::Surface& s, const std::vector<SectionPlane>& planes) {
  SectionFinder find(s);
  std::vector<std::vector<SectionArea>> result;
  for (const SectionPlane& p : planes) result.push_back(find(p));
  return result;
}

}  // namespace tunica::meshing
