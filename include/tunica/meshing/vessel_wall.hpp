// SPDX-License-Identifier: MIT
// The wall of a vessel: quadrilaterals of the edge length asked for on the lumen's wall, by dual contouring,
// extruded to hexahedra. [PEREZ08, 3.2.2]
#pragma once

#include "tunica/core/error.hpp"
#include "tunica/core/expect.hpp"
#include "tunica/mesh/mesh.hpp"
#include "tunica/meshing/dual_contouring.hpp"
#include "tunica/meshing/extrude.hpp"
#include "tunica/meshing/hermite_surface.hpp"
#include "tunica/meshing/interface_distance.hpp"
#include "tunica/meshing/quad_fit.hpp"
#include "tunica/meshing/quad_smooth.hpp"
#include "tunica/meshing/rim_curve.hpp"
#include "tunica/meshing/surface_foot.hpp"
#include "tunica/meshing/wall_quads.hpp"

#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace tunica::meshing {

template <Thickness T = double>
struct WallOptions {
  T thickness;  // [unit of the lumen]; a number, or a function of the place on the lumen
  double edge;  // mean edge length of the quadrilaterals [unit of the lumen]
  int layers = 1;
  QuadSmoothOptions smooth{};
};

struct WallReport {
  InterfaceDistance distance;  // of the quadrilaterals and the lumen's wall; tolerance: a tenth of the edge
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

/// Smooths the quadrilaterals of the contour and extrudes them.
template <Thickness T>
[[nodiscard]] WallResult extruded_wall(WallQuads quads, const mesh::Surface& lumen, const FootFinder& finder,
                                       const Rims& rims, const WallOptions<T>& options) {
  WallResult result;
  result.report.dropped = quads.dropped;
  result.report.smoothing = smooth_quads(quads, finder, rims, options.smooth);
  fit_quads(quads, finder, 0.1 * options.edge);
  result.inner.nodes = std::move(quads.nodes);
  result.inner.cells = std::move(quads.cells);
  result.inner.region_names = {"wall"};
  result.report.distance = interface_distance(result.inner, lumen, finder, 0.1 * options.edge);

  std::vector<SheetRim> ends;
  for (std::size_t r = 0; r < rims.curves.size(); ++r)
    ends.push_back({rims.curves[r].name(), rims.curves[r].plane().normal, quads.loops[r]});
  Extruded extruded = extrude(result.inner, std::span<const SheetRim>(ends),
                              ExtrudeOptions<T>{.thickness = options.thickness, .layers = options.layers});
  result.wall = std::move(extruded.mesh);
  result.report.extrusion = std::move(extruded.report);
  return result;
}

}  // namespace detail

/// lumen: closed, region 0 the wall, the others flat caps. Inner faces follow the wall on the average, their
/// nodes within a tenth of the edge of it; those of the ends lie exactly on the rims, in the planes of the
/// caps. Where the sheet folds, or a cell would be inverted, it is smoothed again with nodes that may go
/// farther from their places. MeshError where the edge length is too coarse for the vessel, or where the
/// sheet folds however it is smoothed.
template <Thickness T = double>
[[nodiscard]] WallResult vessel_wall(const mesh::Surface& lumen, WallOptions<T> options) {
  TUNICA_EXPECT(options.edge > 0, "a wall has an edge length");
  const Rims rims = rims_of(lumen);
  const FootFinder finder(lumen);
  // A uniform grid of spacing s crosses a surface of area A about 3 A / (2 s^2) times.
  const double spacing = options.edge * std::sqrt(1.5);
  const WallQuads quads =
      wall_quads(dual_contour(hermite_of_surface(lumen, {.spacing = spacing}), {.hold = -0.5}), rims);
  constexpr int attempts = 3;
  for (int attempt = 1;; ++attempt, options.smooth.reach *= 3) {
    try {
      WallResult result = detail::extruded_wall(quads, lumen, finder, rims, options);
      result.report.attempts = attempt;
      if (result.report.extrusion.quality.inverted == 0 || attempt == attempts) return result;
    } catch (const MeshError&) {
      if (attempt == attempts) throw;
    }
  }
}

}  // namespace tunica::meshing
