// SPDX-License-Identifier: MIT
// Isotropic remeshing to a target edge length [BOTSCH04]: split, collapse, flip, relax along the surface.
// Rims, flat regions and the volume are kept; no edit folds the surface or makes it cross itself.
#pragma once

#include "tunica/core/expect.hpp"
#include "tunica/core/text.hpp"
#include "tunica/mesh/quality.hpp"
#include "tunica/meshing/remesh_angles.hpp"
#include "tunica/meshing/remesh_fit.hpp"
#include "tunica/meshing/remesh_relax.hpp"
#include "tunica/meshing/restore_volume.hpp"

#include <cmath>
#include <cstddef>
#include <string>

namespace tunica::meshing {

struct RemeshOptions {
  double edge = 0;           // target length, in the unit of the surface
  int passes = 8;            // of split, collapse, flip and relax
  double sharp_angle = 180;  // [degrees] edges that turn by more are kept too; 180: only rims of regions
};

struct RemeshReport {
  Index triangles = 0;
  double smallest_angle = 0;  // [degrees]
  double volume_before = 0, volume_after = 0;
  LeftOut left_out;         // edits that would have folded or crossed the surface
  Index kept_features = 0;  // collapses left out because they would have worn down a feature
};

namespace detail {

/// All passes on one surface.
[[nodiscard]] inline mesh::Surface run(RemeshState& w, const mesh::Surface& source, int passes) {
  constexpr int repairs = 4, fits = 4;  // passes, each of which finds less to do than the one before
  constexpr double most_offset = 0.1;   // of the edge: farther off the surface would have left its target
  for (int pass = 0; pass < passes; ++pass) {
    split_long(w);
    collapse_short(w);
    flip_to_valence(w.edit);
    relax(w);
  }
  for (int pass = 0; pass < repairs; ++pass) {
    flip_to_angle(w.edit);
    repair_angles(w);
    relax(w);
  }
  flip_to_angle(w.edit);
  for (int pass = 0; pass < fits; ++pass) fit(w);
  flip_to_angle(w.edit);
  repair_angles(w);
  mesh::Surface r = w.edit.surface();  // labelled by facets: flat ones stay flat, also without regions
  r.region_names.resize(w.facets.region.size());
  restore_volume(r, mesh::enclosed_volume(source), most_offset * w.edge);
  for (Index& label : r.region) label = w.facets.region[static_cast<std::size_t>(label)];
  r.region_names = source.region_names;
  return r;
}

}  // namespace detail

struct [[nodiscard]] Remeshed {
  mesh::Surface surface;
  RemeshReport report;
};

/// Remeshes a closed surface to triangles whose edges are about options.edge long. Regions, their rims and
/// their planes are kept, and the enclosed volume. MeshError if the surface is not closed or crosses itself,
/// with a place.
[[nodiscard]] inline Remeshed remesh(const mesh::Surface& s, const RemeshOptions& options) {
  TUNICA_EXPECT(options.edge > 0, "the target edge length is positive");
  constexpr double most_triangles = 2e7;          // more would not be held in memory
  const double equilateral = std::sqrt(3.0) / 4;  // area of the triangle with edges of length 1
  if (const double wanted = mesh::area(s) / options.edge / options.edge / equilateral;
      !(wanted <= most_triangles))
    throw MeshError("an edge length of " + seven_digits(options.edge) + " would take " +
                    seven_digits(wanted) + " triangles, more than " + seven_digits(most_triangles));
  require_no_crossing(s);
  Remeshed r;
  r.report.volume_before = mesh::enclosed_volume(s);
  detail::RemeshState work(s, options.edge, options.sharp_angle);
  r.surface = detail::run(work, s, options.passes);
  r.report.left_out = work.edit.left_out(), r.report.kept_features = work.kept_features;
  r.report.volume_after = mesh::enclosed_volume(r.surface);
  r.report.triangles = r.surface.cell_count();
  r.report.smallest_angle = mesh::quality(r.surface).angle.least;
  return r;
}

}  // namespace tunica::meshing
