// SPDX-License-Identifier: MIT
// The wall of a vessel: quadrilaterals of the edge length asked for on the lumen's wall, by dual contouring,
// extruded to hexahedra. [PEREZ08, 3.2.2]
#pragma once

#include "tunica/core/error.hpp"
#include "tunica/core/expect.hpp"
#include "tunica/core/vec.hpp"
#include "tunica/mesh/mesh.hpp"
#include "tunica/meshing/dual_contouring.hpp"
#include "tunica/meshing/extrude.hpp"
#include "tunica/meshing/hermite_surface.hpp"
#include "tunica/meshing/interface_distance.hpp"
#include "tunica/meshing/quad_fit.hpp"
#include "tunica/meshing/quad_lens.hpp"
#include "tunica/meshing/quad_smooth.hpp"
#include "tunica/meshing/rim_curve.hpp"
#include "tunica/meshing/surface_foot.hpp"
#include "tunica/meshing/wall_quads.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace tunica::meshing {

template <Thickness T = double>
struct WallOptions {
  T thickness;  // [unit of the lumen]; a number, or a function of the place on the lumen
  double edge;  // mean edge length of the quadrilaterals [unit of the lumen]
  int layers = 1;
  double tolerance = 0.1;  // distance of the two interfaces that is aimed at [edge]
  int refinements = 3;     // rounds in which the grid is drawn together where they lie farther apart, at most
  double finest = 0.5;     // spacing to which it is drawn together at most [spacing elsewhere]
  QuadSmoothOptions smooth{};
};

struct WallReport {
  InterfaceDistance distance;  // of the quadrilaterals and the lumen's wall, with the places of the largest
  bool within = false;         // the tolerance, everywhere
  int refinements = 0;         // rounds in which the grid was drawn together
  std::size_t lenses = 0;      // places where it was
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

/// The wall's quadrilaterals on a grid of that spacing as the lenses draw it together.
[[nodiscard]] inline WallQuads quads_through(const Lenses& lenses, const mesh::Surface& lumen, double spacing,
                                             const Rims& rims) {
  if (lenses.empty())
    return wall_quads(dual_contour(hermite_of_surface(lumen, {.spacing = spacing}), {.hold = -0.5}), rims);
  mesh::Surface magnified = lumen;
  for (Index n = 0; n < lumen.node_count(); ++n)
    vec::set_column(magnified.nodes, n, lenses.magnified(vec::column(lumen.nodes, n)));
  mesh::QuadSurface contour =
      dual_contour(hermite_of_surface(magnified, {.spacing = spacing}), {.hold = -0.5});
  for (Index n = 0; n < contour.node_count(); ++n)
    vec::set_column(contour.nodes, n, lenses.restored(vec::column(contour.nodes, n)));
  return wall_quads(contour, rims);
}

/// A lens for each group of places that lie within an edge of each other; false if there is none to add.
inline bool add_lenses(Lenses& lenses, const std::vector<FarPlace>& far, double edge, double tolerance,
                       double most) {
  std::vector<char> used(far.size(), 0);
  std::vector<Lens> added;
  for (std::size_t i = 0; i < far.size(); ++i) {
    if (used[i] != 0) continue;
    std::vector<std::size_t> group{i};
    used[i] = 1;
    for (std::size_t g = 0; g < group.size(); ++g)
      for (std::size_t j = 0; j < far.size(); ++j)
        if (used[j] == 0 && vec::distance(far[group[g]].place, far[j].place) < edge)
          used[j] = 1, group.push_back(j);
    Vec3 sum = Vec3::Zero();
    double weight = 0, radius = edge, worst = 0;
    for (const std::size_t g : group) {
      const double w = far[g].distance - 0.9 * tolerance;
      sum = vec::along(sum, w, far[g].place), weight += w;
      worst = std::max(worst, far[g].distance);
    }
    const Vec3 centre = vec::scaled(1 / weight, sum);
    for (const std::size_t g : group) radius = std::max(radius, vec::distance(far[g].place, centre));
    // distances go with the square of the spacing
    const double power = std::clamp(std::sqrt(worst / tolerance) - 0.8, 0.25, 1.0);
    added.push_back({centre, std::min(radius, 3 * edge), power});
  }
  bool any = false;
  for (Lens& lens : added) {
    lens.power = std::min(lens.power, most / lenses.magnification(lens.centre) - 1);
    if (!(lens.power > 0.1)) continue;
    lenses.add(lens);
    any = true;
  }
  return any;
}

/// Smooths the quadrilaterals of the contour and lays them level with the lumen.
[[nodiscard]] inline mesh::QuadSurface fitted_sheet(WallQuads& quads, const FootFinder& finder,
                                                    const Rims& rims, const std::vector<Vec3>& targets,
                                                    const QuadSmoothOptions& smooth, double tolerance,
                                                    WallReport& report) {
  report.dropped = quads.dropped;
  report.smoothing = smooth_quads(quads, finder, rims, smooth, targets);
  fit_quads(quads, finder, targets, {.tolerance = 0.85 * tolerance});
  mesh::QuadSurface sheet;
  sheet.nodes = quads.nodes;
  sheet.cells = quads.cells;
  sheet.region_names = {"wall"};
  return sheet;
}

/// Lower is better: no inverted cell before all; then the sum of what lies beyond the tolerance, to which a
/// scaled Jacobian of 0.1 below the sound one adds a hundred places that are twice as far off as they may be,
/// and a share of the thickness of 0.1 below half adds fifty.
[[nodiscard]] inline double wall_badness(const WallReport& report, const std::vector<FarPlace>& far,
                                         double tolerance) {
  constexpr double sound = 0.2;  // scaled Jacobian
  constexpr double thick = 0.5;  // share of the thickness
  const auto& quality = report.extrusion.quality;
  double sum = 0;
  for (const FarPlace& place : far) sum += place.distance / tolerance - 1;
  if (quality.inverted > 0) sum += 1e6 * quality.inverted;
  if (!(quality.scaled_jacobian.least >= sound)) sum += 1e3 * (sound - quality.scaled_jacobian.least);
  if (!(report.extrusion.least_share >= thick)) sum += 500 * (thick - report.extrusion.least_share);
  return sum;
}

}  // namespace detail

/// lumen: closed, region 0 the wall, the others flat caps. Inner faces follow the wall on the average, and
/// within the tolerance where they can; those of the ends lie exactly on the rims, in the planes of the caps.
/// Where the sheet is farther from the lumen the grid is drawn together, and the best of the sheets is kept:
/// one without inverted cells before all. Where the sheet folds it is smoothed again with nodes that may go
/// farther from their places. MeshError where the edge length is too coarse for the vessel, or where the
/// sheet folds however it is smoothed.
template <Thickness T = double>
[[nodiscard]] WallResult vessel_wall(const mesh::Surface& lumen, WallOptions<T> options) {
  TUNICA_EXPECT(options.edge > 0, "a wall has an edge length");
  const Rims rims = rims_of(lumen);
  const FootFinder finder(lumen);
  const std::vector<Vec3> targets = wall_points(lumen);
  // A uniform grid of spacing s crosses a surface of area A about 3 A / (2 s^2) times.
  const double spacing = options.edge * std::sqrt(1.5), tolerance = options.tolerance * options.edge;
  Lenses lenses;
  std::optional<WallResult> best;
  double least = std::numeric_limits<double>::infinity();
  constexpr int attempts = 3;
  for (int round = 0; round <= options.refinements; ++round) {
    std::vector<FarPlace> far;
    QuadSmoothOptions smooth = options.smooth;
    const WallQuads contour = detail::quads_through(lenses, lumen, spacing, rims);
    for (int attempt = 1; attempt <= attempts; ++attempt, smooth.reach *= 3) {
      WallQuads quads = contour;
      WallResult result;
      try {
        result.inner = detail::fitted_sheet(quads, finder, rims, targets, smooth, tolerance, result.report);
        far.clear();
        result.report.distance = interface_distance(result.inner, targets, finder, tolerance, &far);
        std::vector<SheetRim> ends;
        for (std::size_t r = 0; r < rims.curves.size(); ++r)
          ends.push_back({rims.curves[r].name(), rims.curves[r].plane().normal, quads.loops[r]});
        Extruded extruded =
            extrude(result.inner, std::span<const SheetRim>(ends),
                    ExtrudeOptions<T>{.thickness = options.thickness, .layers = options.layers});
        result.wall = std::move(extruded.mesh);
        result.report.extrusion = std::move(extruded.report);
      } catch (const MeshError&) {
        if (attempt == attempts && round == options.refinements && !best) throw;
        continue;
      }
      result.report.attempts = attempt;
      result.report.refinements = round, result.report.lenses = lenses.count();
      result.report.within = far.empty();
      const double badness = detail::wall_badness(result.report, far, tolerance);
      const bool sound = result.report.extrusion.quality.inverted == 0;
      if (badness < least) least = badness, best = std::move(result);
      if (sound) break;
    }
    if (far.empty() || !detail::add_lenses(lenses, far, options.edge, tolerance, 1 / options.finest)) break;
  }
  return std::move(*best);
}

}  // namespace tunica::meshing
