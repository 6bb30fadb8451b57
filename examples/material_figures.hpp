// SPDX-License-Identifier: MIT
// What a report says of a mesh of several materials: volumes, contacts, quality.
#pragma once

#include "json.hpp"
#include "tunica/mesh/quality.hpp"
#include "tunica/meshing/multi_region.hpp"

#include <utility>

namespace tunica::examples {

[[nodiscard]] inline Json material_figures(const meshing::MultiRegionResult& m) {
  const auto& r = m.report;
  Json j;
  for (const auto& material : r.materials) {
    Json one;
    one["label"] = material.label, one["name"] = material.name;
    one["parts"] = material.regions, one["tetrahedra"] = material.tetrahedra;
    one["voxel_volume"] = material.voxel_volume, one["volume"] = material.volume;
    j["materials"].push(std::move(one));
  }
  for (const auto& patch : m.mesh.patches) {
    Json one;
    one["name"] = patch.name, one["triangles"] = patch.faces.cols();
    j["patches"].push(std::move(one));
  }
  j["nodes"] = m.mesh.node_count(), j["tetrahedra"] = m.mesh.cell_count();
  j["inverted"] = mesh::quality(m.mesh).inverted;
  j["interface_triangles"] = r.triangles, j["interface_smallest_angle_degrees"] = r.smallest_angle;
  j["interface_smallest_fold_degrees"] = r.smallest_fold;
  j["interface_nodes_moved_for_flat_tetrahedra"] = r.nudged;
  j["smallest_dihedral_degrees"] = r.min_dihedral, j["mean_ratio"] = r.mean_ratio;
  j["volume_error"] = r.volume_error, j["volume_against_voxels"] = r.deviation;
  return j;
}

}  // namespace tunica::examples
