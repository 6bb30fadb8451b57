// SPDX-License-Identifier: MIT
// The two meshes of artery_fsi in SI: tetrahedra of the lumen, hexahedra of the wall. [PEREZ08, 3]
#pragma once

#include "artery_options.hpp"
#include "artery_scene.hpp"
#include "image_pipeline.hpp"
#include "json.hpp"
#include "mesh_figures.hpp"
#include "stages.hpp"
#include "tunica/core/error.hpp"
#include "tunica/core/text.hpp"
#include "tunica/mesh/mesh.hpp"
#include "tunica/meshing/vessel_wall.hpp"

#include <algorithm>
#include <string>
#include <utility>

namespace tunica::artery {

/// Patch 0 of the lumen is the wall, 1 the inlet, the others outlets; the wall has "inner" and "ends".
struct Meshes {
  mesh::TetMesh lumen;
  mesh::HexMesh wall;
};

/// How far a node of the lumen may lie from the wall that moves it, in mean diagonals of the wall's faces.
/// Where a blind branch is too thin for hexahedra its nodes move with the nearest ones, and the run warns
/// of it: on a real aorta, with its lumbar stubs cut short, they lay up to 0.44 diagonals away.
inline constexpr double longest_stub = 2;  // [-]

/// Figures and warnings of the wall, in the unit of the image; MeshError where a cell is inverted.
inline void tell_wall(const meshing::WallReport& wall, examples::Json& report) {
  const auto& extrusion = wall.extrusion;
  const auto& apart = wall.distance;
  if (extrusion.quality.inverted > 0)
    throw MeshError("the wall has " + std::to_string(extrusion.quality.inverted) +
                    " inverted hexahedra: choose another --edge");
  if (extrusion.least_share < 0.9)
    warn(report["image_to_mesh"], "the wall gives way at " + std::to_string(extrusion.thinned) +
                                      " nodes, down to " + examples::short_text(100 * extrusion.least_share) +
                                      " % of its thickness");
  const double most_apart = std::max(apart.wall_max, apart.quads_max);
  if (!wall.within)
    warn(report["image_to_mesh"],
         "lumen and wall are up to " + examples::short_text(most_apart) + " apart, at " +
             place(apart.wall_max < apart.quads_max ? apart.quads_place : apart.wall_place));
  examples::Json& j = report["wall"];
  j["smallest_scaled_jacobian"] = extrusion.quality.scaled_jacobian.least;
  j["least_share_of_thickness"] = extrusion.least_share;
  j["least_share_between_nodes"] = extrusion.least_between;
  j["interfaces_apart"] = most_apart;
  j["grown_quadrilaterals"] = wall.grown;
}

[[nodiscard]] inline Meshes meshes(const Options& o, examples::Stages& stage, examples::Json& report) {
  auto [surface, tets] = mesh_image(o.image, stage, report["image_to_mesh"]);
  auto wall = stage("wall", [&] {
    return meshing::vessel_wall(
        surface, {.thickness = thickness / o.unit, .edge = o.wall_edge(), .layers = o.layers()});
  });
  report["wall"]["hexahedra"] = wall.wall.cell_count(), report["wall"]["nodes"] = wall.wall.node_count();
  tell_wall(wall.report, report);
  tets.nodes *= o.unit;
  wall.wall.nodes *= o.unit;
  return {std::move(tets), std::move(wall.wall)};
}

}  // namespace tunica::artery
