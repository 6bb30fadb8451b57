// SPDX-License-Identifier: MIT
// Repair of a surface from elsewhere: welded, freed of degenerate, duplicate and hanging facets, sewn,
// turned, its holes filled, its touching sheets parted, its crossings drawn apart, each with its count and a
// place.
#pragma once

#include "tunica/mesh/topology.hpp"
#include "tunica/meshing/repair_facets.hpp"
#include "tunica/meshing/repair_holes.hpp"
#include "tunica/meshing/repair_orient.hpp"
#include "tunica/meshing/repair_report.hpp"
#include "tunica/meshing/repair_seams.hpp"
#include "tunica/meshing/repair_split.hpp"
#include "tunica/meshing/untangle.hpp"

#include <utility>

namespace tunica::meshing {

struct [[nodiscard]] RepairedSurface {
  mesh::Surface surface;  // regions are kept; a filling has the region around it
  RepairReport report;
};

namespace detail {

/// Equal nodes, facets without area and duplicates.
inline void clean(mesh::Surface& s, RepairReport& report) {
  weld_equal(s, report);
  constexpr int most_rounds = 50;  // a split may show another facet without area
  for (int n = 0; n < most_rounds && drop_flat(s, report) > 0; ++n) {
  }
  drop_duplicates(s, report);
}

}  // namespace detail

/// Repairs what it can and counts it. What is left (holes that are too long, edges of three facets,
/// crossings) stays for mesh::topology and the exact tests to name. MeshError where a sheet has one side
/// only.
[[nodiscard]] inline RepairedSurface repair(mesh::Surface s, const RepairOptions& options = {}) {
  RepairReport report;
  detail::clean(s, report);
  if (options.extent == RepairExtent::full && s.cell_count() > 0) {
    const double gap = options.seam * mesh::bounding_box(s.nodes).diagonal();
    constexpr int most_rounds = 20;  // one flap may hang on another
    for (int n = 0; n < most_rounds && detail::drop_flaps(s, report); ++n) {
    }
    detail::weld_seams(s, gap, report);
    for (int n = 0; n < most_rounds && detail::sew_nodes(s, gap, report); ++n) {
    }
    detail::clean(s, report);
    detail::drop_strays(s, options.stray, report);
  }
  detail::agree(s, report);
  if (options.extent == RepairExtent::full) {
    if (options.hole_edges > 0) {
      detail::fill_holes(s, options.hole_edges, report);
      detail::drop_duplicates(s, report);  // a lone facet and the one that fills it bound nothing
    }
    drop_unused_nodes(s);
    detail::face_outward(s, report);
    detail::part_sheets(s, report);
    if (options.untangle_rounds > 0 && mesh::topology(s).closed()) {
      const UntangleReport u = untangle(s, options.untangle_rounds);
      report.crossings_before = u.crossings_before, report.crossings_after = u.crossings_after;
      if (u.crossings_after > 0)
        for (const auto& [t, other] : self_intersections(s))
          report.crossing.add(mesh::triangle(s, t).centroid());
    }
  }
  drop_unused_nodes(s);
  return {std::move(s), std::move(report)};
}

}  // namespace tunica::meshing
