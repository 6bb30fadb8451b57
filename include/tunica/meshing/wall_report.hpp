// SPDX-License-Identifier: MIT
// The wall of a vessel as it was made, what there is to say of it, and which of two walls is better.
#pragma once

#include "tunica/mesh/mesh.hpp"
#include "tunica/meshing/extrude.hpp"
#include "tunica/meshing/interface_distance.hpp"
#include "tunica/meshing/quad_smooth.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace tunica::meshing {

struct WallReport {
  InterfaceDistance distance;  // of the quadrilaterals and the lumen's wall, with the places of the largest
  bool within = false;         // the tolerance, everywhere
  int refinements = 0;         // rounds in which the grid was drawn together
  std::size_t lenses = 0;      // places where it was
  Index grown = 0;             // quadrilaterals by which blind branches were grown
  double shortest_side = 0;    // of the quadrilaterals [edge]
  QuadSmoothReport smoothing;
  ExtrudeReport extrusion;
  Index dropped = 0;  // quadrilaterals that hung on the sheet by a corner
  int attempts = 1;   // at smoothing, until no cell is inverted
};

/// inner: the quadrilaterals on the lumen, normals outward of it; its nodes are the first of the wall's.
struct [[nodiscard]] WallResult {
  mesh::QuadSurface inner;
  mesh::HexMesh wall;  // patches "inner", "outer", "ends", then one of the name of each cap
  WallReport report;
};

namespace detail {

/// Lower is better: no inverted cell before all; then the sum of what lies beyond the tolerance, to which a
/// scaled Jacobian of 0.1 below the sound one adds a hundred places that are twice as far off as they may be,
/// and a share of the thickness of 0.1 below half, or a side of 0.1 of the edge below a tenth, adds fifty.
[[nodiscard]] inline double wall_badness(const WallReport& report, const std::vector<FarPlace>& far,
                                         double tolerance) {
  constexpr double sound = 0.2;       // scaled Jacobian
  constexpr double thick = 0.5;       // share of the thickness
  constexpr double least_side = 0.1;  // [edge]
  constexpr double per_inverted = 1e6, per_jacobian = 1e3, per_share = 500, per_side = 500;
  const auto& quality = report.extrusion.quality;
  double sum = 0;
  for (const FarPlace& place : far) sum += place.distance / tolerance - 1;
  if (quality.inverted > 0) sum += per_inverted * quality.inverted;
  if (!(quality.scaled_jacobian.least >= sound))
    sum += per_jacobian * (sound - quality.scaled_jacobian.least);
  const double share = std::min(report.extrusion.least_share, report.extrusion.least_between);
  if (!(share >= thick)) sum += per_share * (thick - share);
  if (!(report.shortest_side >= least_side)) sum += per_side * (least_side - report.shortest_side);
  return sum;
}

/// A scaled Jacobian from which on a better one is worth nothing more, and what the whole thickness is worth:
/// as much.
inline constexpr double good_jacobian = 0.3, worth_of_thickness = 0.3;

/// Higher is better, among walls that are equally bad.
[[nodiscard]] inline double wall_worth(const WallReport& report) {
  const auto& e = report.extrusion;
  return std::min(e.quality.scaled_jacobian.least, good_jacobian) +
         worth_of_thickness * std::min(e.least_share, e.least_between);
}

/// A scaled Jacobian of 0.3 with nearly half of the thickness, or one of 0.2 with four fifths.
inline constexpr double ample_worth = 0.44;

}  // namespace detail

}  // namespace tunica::meshing
