// SPDX-License-Identifier: MIT
// Remeshing to a target edge length or a size field [BOTSCH04]: split, collapse, flip, relax along the
// surface. Rims, flat regions and the volume are kept; no edit folds the surface or makes it cross itself.
#pragma once

#include "tunica/core/expect.hpp"
#include "tunica/core/text.hpp"
#include "tunica/mesh/quality.hpp"
#include "tunica/meshing/remesh_angles.hpp"
#include "tunica/meshing/remesh_fit.hpp"
#include "tunica/meshing/remesh_relax.hpp"
#include "tunica/meshing/restore_volume.hpp"

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace tunica::meshing {

struct RemeshOptions {
  double edge = 0;  // target length, in the unit of the surface; with a size field the longest, 0: any
  int passes = 8;   // of split, collapse, flip and relax
  double sharp_angle = 180;  // [degrees] edges that turn by more are kept too; 180: only rims of regions
};

struct RemeshReport {
  Index triangles = 0;
  double smallest_angle = 0;  // [degrees]
  double volume_before = 0, volume_after = 0;
  LeftOut left_out;         // edits that would have folded or crossed the surface
  Index kept_features = 0;  // collapses left out because they would have worn down a feature
};

struct [[nodiscard]] Remeshed {
  mesh::Surface surface;
  RemeshReport report;
};

namespace detail {

/// Brings the enclosed volume back to that of the source.
template <class Size>
void restore(const RemeshState<Size>& w, const mesh::Surface& source, mesh::Surface& made) {
  constexpr double most_offset = 0.1;  // of the edge: farther off the surface would have left its target
  const double volume = mesh::enclosed_volume(source);
  if constexpr (RemeshState<Size>::constant) {
    restore_volume(made, volume, most_offset * w.size.edge);
  } else {
    std::vector<double> share;
    for (Index n = 0; n < made.node_count(); ++n) share.push_back(w.size(mesh::node(made, n)));
    restore_volume(made, volume, most_offset, share);
  }
}

/// All passes on one surface.
template <class Size>
[[nodiscard]] mesh::Surface run(RemeshState<Size>& w, const mesh::Surface& source, int passes) {
  constexpr int repairs = 4, fits = 4;  // passes, each of which finds less to do than the one before
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
  constexpr double poor = 0.26;  // [rad] 15 degrees: worse than a fold
  w.edit.allow_folds(EditableSurface::five_degrees);
  for (int pass = 0; pass < repairs; ++pass) repair_angles(w, poor);
  mesh::Surface r = w.edit.surface();  // labelled by facets: flat ones stay flat, also without regions
  r.region_names.resize(w.facets.region.size());
  restore(w, source, r);
  for (Index& label : r.region) label = w.facets.region[static_cast<std::size_t>(label)];
  r.region_names = source.region_names;
  return r;
}

/// How many triangles with these edges a surface takes; MeshError where that is too many, or no number.
template <SizeField Size>
[[nodiscard]] double count_triangles(const mesh::Surface& s, const Size& size) {
  constexpr double most_triangles = 2e7;          // more would not be held in memory
  const double equilateral = std::sqrt(3.0) / 4;  // area of the triangle with edges of length 1
  double wanted = 0, least = std::numeric_limits<double>::infinity();
  if constexpr (std::same_as<Size, ConstantSize>) {
    least = size.edge;
    wanted = mesh::area(s) / size.edge / size.edge / equilateral;
  } else {
    for (Index t = 0; t < s.cell_count(); ++t) {
      const mesh::Triangle f = mesh::triangle(s, t);
      for (const Vec3& x : {vec::between(f.a, f.b, 0.5), vec::between(f.b, f.c, 0.5),
                            vec::between(f.c, f.a, 0.5)}) {  // exact for a quadratic 1/h^2
        const double h = size(x);
        least = std::min(least, h);
        wanted += f.area() / 3 / h / h / equilateral;
      }
    }
  }
  if (!(wanted <= most_triangles))
    throw MeshError("an edge length of " + seven_digits(least) + " would take " + seven_digits(wanted) +
                    " triangles, more than " + seven_digits(most_triangles));
  return wanted;
}

template <class Size>
[[nodiscard]] Remeshed remeshed(RemeshState<Size>& work, const mesh::Surface& s, int passes) {
  Remeshed r;
  r.report.volume_before = mesh::enclosed_volume(s);
  r.surface = run(work, s, passes);
  r.report.left_out = work.edit.left_out(), r.report.kept_features = work.kept_features;
  r.report.volume_after = mesh::enclosed_volume(r.surface);
  r.report.triangles = r.surface.cell_count();
  r.report.smallest_angle = mesh::quality(r.surface).angle.least;
  return r;
}

}  // namespace detail

/// Remeshes a closed surface to triangles whose edges are about options.edge long. Regions, their rims and
/// their planes are kept, and the enclosed volume. MeshError if the surface is not closed or crosses itself,
/// with a place.
[[nodiscard]] inline Remeshed remesh(const mesh::Surface& s, const RemeshOptions& options) {
  TUNICA_EXPECT(options.edge > 0, "the target edge length is positive");
  const ConstantSize size{options.edge};
  (void)detail::count_triangles(s, size);
  require_no_crossing(s);
  detail::RemeshState work(s, size, options.sharp_angle);
  return detail::remeshed(work, s, options.passes);
}

/// As above, to edges about as long as the size field says where they are, and options.edge at most if that
/// is positive. The field should grow slowly along the surface, by a third of the length at most. MeshError
/// also where it gives no positive length, with the place.
template <SizeField Size>
[[nodiscard]] Remeshed remesh(const mesh::Surface& s, const RemeshOptions& options, const Size& size) {
  TUNICA_EXPECT(options.edge >= 0, "the longest edge is positive, or 0 for any");
  const double longest = options.edge > 0 ? options.edge : std::numeric_limits<double>::infinity();
  const auto bounded = [&size, longest](const Vec3& x) {
    const double h = std::min(static_cast<double>(size(x)), longest);
    if (!(h > 0 && std::isfinite(h)))
      throw MeshError("the size field gives an edge length of " + seven_digits(h) + " at " + place(x));
    return h;
  };
  const double wanted = detail::count_triangles(s, bounded);
  require_no_crossing(s);
  // of even triangles of that number
  const double typical = std::sqrt(mesh::area(s) / std::max(wanted, 1.0) / (std::sqrt(3.0) / 4));
  detail::RemeshState work(s, bounded, options.sharp_angle, typical);
  return detail::remeshed(work, s, options.passes);
}

}  // namespace tunica::meshing
