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
#include "tunica/meshing/quad_smooth.hpp"
#include "tunica/meshing/rim_curve.hpp"
#include "tunica/meshing/surface_foot.hpp"
#include "tunica/meshing/wall_quads.hpp"

#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace tunica::meshing {

struct WallOptions {
  double thickness;  // [unit of the lumen]
  double edge;       // mean edge length of the quadrilaterals [unit of the lumen]
  int layers = 1;
  QuadSmoothOptions smooth{};
};

struct WallReport {
  InterfaceDistance distance;  // between the quadrilaterals and the lumen's wall, both ways
  QuadSmoothReport smoothing;
  ExtrudeReport extrusion;
  Index dropped = 0;  // quadrilaterals that hung on the sheet by a corner
};

/// inner: the quadrilaterals on the lumen, normals outward of it; its nodes are the first of the wall's.
struct [[nodiscard]] WallResult {
  mesh::QuadSurface inner;
  mesh::HexMesh wall;  // patches "inner", "outer", "ends", then one of the name of each cap
  WallReport report;
};

/// lumen: closed, region 0 the wall, the others flat caps. Inner nodes lie on the wall, those of the ends
/// exactly in the planes of their caps. MeshError where the edge length is too coarse for the vessel.
[[nodiscard]] inline WallResult vessel_wall(const mesh::Surface& lumen, const WallOptions& options) {
  TUNICA_EXPECT(options.edge > 0 && options.thickness > 0, "a wall has an edge length and a thickness");
  const Rims rims = rims_of(lumen);
  const FootFinder finder(lumen);
  // A uniform grid of spacing s crosses a surface of area A about 3 A / (2 s^2) times.
  const double spacing = options.edge * std::sqrt(1.5);
  const mesh::QuadSurface contour =
      dual_contour(hermite_of_surface(lumen, {.spacing = spacing}), {.hold = -0.5});
  WallQuads quads = wall_quads(contour, rims);

  WallResult result;
  result.report.dropped = quads.dropped;
  result.report.smoothing = smooth_quads(quads, finder, rims, options.smooth);
  result.inner.nodes = std::move(quads.nodes);
  result.inner.cells = std::move(quads.cells);
  result.inner.region_names = {"wall"};
  result.report.distance = interface_distance(result.inner, lumen, finder);

  std::vector<SheetRim> ends;
  for (std::size_t r = 0; r < rims.curves.size(); ++r)
    ends.push_back({rims.curves[r].name(), rims.curves[r].plane().normal, quads.loops[r]});
  Extruded extruded = extrude(result.inner, ends, {.thickness = options.thickness, .layers = options.layers});
  result.wall = std::move(extruded.mesh);
  result.report.extrusion = std::move(extruded.report);
  return result;
}

}  // namespace tunica::meshing
