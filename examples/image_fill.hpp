// SPDX-License-Identifier: MIT
// What image_to_mesh fills a vessel with, each from what it needs of the image: tetrahedra, with layers at
// the wall and sizes that follow the vessel, hexahedra, voxels, or nothing.
#pragma once

#include "image_pipeline.hpp"
#include "patch_surface.hpp"
#include "tunica/meshing/boundary_layers.hpp"
#include "tunica/meshing/cut_voxels.hpp"
#include "tunica/meshing/dual_hexahedra.hpp"
#include "tunica/meshing/size_from_curvature.hpp"
#include "tunica/meshing/size_from_diameter.hpp"
#include "tunica/meshing/size_from_distance.hpp"
#include "tunica/meshing/voxel_hexahedra.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tunica::examples {

enum class Fill { tets, hexes, voxels, none };
enum class SizeFrom { constant, curvature, distance, diameter };

struct FillChoice {
  Fill fill = Fill::tets;
  SizeFrom size_from = SizeFrom::constant;
  int layers = 0;  // of tetrahedra at the wall
};

inline void add_fill_options(Cli& cli, FillChoice& o) {
  cli.choice<Fill>(
      "--fill",
      "what fills it: tetrahedra (as without it), hexahedra of a grid of spacing L, one hexahedron a voxel,\n"
      "nothing",
      {{"tets", Fill::tets}, {"hexes", Fill::hexes}, {"voxels", Fill::voxels}, {"none", Fill::none}}, o.fill);
  cli.choice<SizeFrom>(
      "--size-from",
      "what edges follow (none: all are about L): curvature, shorter than L where the wall is curved (it\n"
      "lies within L/40 of them); diameter, shorter where the vessel is thin (8 across); distance, L at the\n"
      "wall and up to 3 L away from it",
      {{"curvature", SizeFrom::curvature},
       {"distance", SizeFrom::distance},
       {"diameter", SizeFrom::diameter}},
      o.size_from);
  cli.option("--layers", "N",
             "layers of tetrahedra at the wall, each 1.2 times as high as the one outside it (0)",
             [&o](const std::string& text) {
               o.layers = number_of<int>(text);
               constexpr int most = 30;  // the lowest is then 200 times as low as the highest
               if (o.layers < 0 || o.layers > most)
                 throw UsageError("must be from 0 to " + std::to_string(most));
             });
}

/// UsageError for options that have no meaning together.
inline void require_sense(const FillChoice& fill, const ImageOptions& o) {
  const bool sized = fill.size_from != SizeFrom::constant;
  if (fill.layers > 0 && fill.fill != Fill::tets) throw UsageError("--layers needs --fill tets");
  if (sized && (fill.fill == Fill::hexes || fill.fill == Fill::voxels))
    throw UsageError("--size-from needs --fill tets or none");
  if (sized && o.edge && *o.edge == 0) throw UsageError("--size-from needs an --edge of more than 0");
  if (fill.fill == Fill::hexes && o.edge && *o.edge == 0)
    throw UsageError("--fill hexes needs an --edge of more than 0");
  if (fill.fill == Fill::voxels && o.edge)
    throw UsageError("--fill voxels has the edges of the voxels, not --edge");
}

/// A volume mesh with the surface that bounds it; one of the two is empty, and all with Fill::none but the
/// surface of triangles.
struct [[nodiscard]] FilledVessel {
  mesh::TetMesh tets;
  mesh::HexMesh hexes;
  mesh::Surface triangles;
  mesh::QuadSurface quads;
  std::vector<Index> in_layers;  // 1 for tetrahedra of the layers, 0 for the others; empty without layers
};

namespace detail {

[[nodiscard]] inline std::optional<meshing::GradedSize> size_of(const mesh::Surface& s, SizeFrom from,
                                                                double edge) {
  constexpr double coarsest = 3;  // edges at the wall
  switch (from) {
    case SizeFrom::curvature: return meshing::size_from_curvature(s, {.edge = edge});
    case SizeFrom::diameter: return meshing::size_from_diameter(s, {.edge = edge});
    case SizeFrom::distance:
      return meshing::size_from_distance(s, s.region_names.front(), {.edge = coarsest * edge, .least = edge});
    case SizeFrom::constant: break;
  }
  return std::nullopt;
}

/// Figures of the whole mesh, and of the layers beside it.
inline void tell_layers(const meshing::LayerReport& r, const mesh::TetMesh& tets, Json& report) {
  meshing::FillReport whole = r.fill;
  whole.nodes = tets.node_count(), whole.tetrahedra = tets.cell_count();
  whole.volume = r.volume, whole.volume_error = r.volume_error;
  whole.min_dihedral = std::min(r.layer.min_dihedral, r.core.min_dihedral);
  whole.max_dihedral = std::max(r.layer.max_dihedral, r.core.max_dihedral);
  whole.mean_ratio = (r.layer.tetrahedra * r.layer.mean_ratio + r.core.tetrahedra * r.core.mean_ratio) /
                     (r.layer.tetrahedra + r.core.tetrahedra);
  tell_tetrahedra(whole, tets, report);
  Json& j = report["layers"];
  j["count"] = r.layers, j["tetrahedra"] = r.layer.tetrahedra, j["columns"] = r.columns;
  j["vanished"] = r.vanished, j["full_share"] = r.full_share, j["least_share"] = r.least_share;
  j["mean_share"] = r.mean_share, j["thinnest"] = r.thinnest, j["mean_aspect"] = r.layer.mean_aspect;
  j["smallest_dihedral_degrees"] = r.layer.min_dihedral;
  if (r.full_share < 0.99)
    warn(report, "the layers give way on " + short_text(100 * (1 - r.full_share)) +
                     " % of the wall, down to " + short_text(100 * r.least_share) + " % of their height at " +
                     place(r.thinnest));
  if (r.vanished > 0)
    warn(report, "the layers end at " + count_text(static_cast<std::size_t>(r.vanished), "node", "nodes") +
                     " of the wall, where there is no room for them");
}

inline void tell_hexahedra(const mesh::HexMesh& hexes, const mesh::HexQuality& q, Json& report) {
  Json& j = report["fill"];
  j["nodes"] = hexes.node_count(), j["hexahedra"] = hexes.cell_count(), j["inverted"] = q.inverted;
  j["volume"] = mesh::volume(hexes);
  j["smallest_scaled_jacobian"] = q.scaled_jacobian.least, j["mean_scaled_jacobian"] = q.scaled_jacobian.mean;
  j["one_percent_scaled_jacobian"] = q.scaled_jacobian.quantile(0.01), j["worst_place"] = q.worst_place;
  tell_cells(hexes.cell_count(), "hexahedra",
             "least scaled Jacobian " + short_text(q.scaled_jacobian.least) + ", mean " +
                 short_text(q.scaled_jacobian.mean));
}

}  // namespace detail

/// Tetrahedra, or the triangles alone.
inline void fill_triangles(const FillChoice& how, const ImageVessel& vessel, FilledVessel& out, Stages& stage,
                           Json& report) {
  auto cut = surface_of(vessel, stage, report);
  const auto size = detail::size_of(cut, how.size_from, vessel.edge);
  out.triangles = remeshed(std::move(cut), vessel, stage, report, [&](const auto& s) {
    if (how.fill == Fill::tets) require_countable(s, vessel.edge);
    return size ? meshing::remesh(s, {}, *size) : meshing::remesh(s, {.edge = vessel.edge});
  });
  stage("fill", [&] {
    if (how.fill == Fill::none) return;
    if (how.layers > 0) {
      auto filled = meshing::layered_tetrahedra(out.triangles, {.layers = how.layers});
      out.tets = std::move(filled.mesh), out.triangles = std::move(filled.outer);
      out.in_layers.assign(static_cast<std::size_t>(out.tets.cell_count()), 0);
      std::fill_n(out.in_layers.begin(), filled.report.layer.tetrahedra, 1);  // they come first
      detail::tell_layers(filled.report, out.tets, report);
    } else {
      auto filled = size ? meshing::tetrahedra(out.triangles, {}, *size) : meshing::tetrahedra(out.triangles);
      out.tets = std::move(filled.mesh);
      tell_tetrahedra(filled.report, out.tets, report);
    }
  });
}

/// A grid over the surface that would not be held in memory is refused before it is made.
inline void require_grid(const mesh::Surface& s, double edge) {
  constexpr double most = 1e9;
  const Box box = mesh::bounding_box(s.nodes);
  double nodes = 1;
  for (int a = 0; a < 3; ++a) nodes *= (box.hi[a] - box.lo[a]) / edge + 1;
  if (!(nodes <= most))
    throw MeshError("an edge length of " + short_text(edge) + " would take a grid of " + short_text(nodes) +
                    " nodes, more than " + short_text(most));
}

/// Hexahedra of a grid over the cut surface.
inline void fill_hexahedra(const ImageVessel& vessel, FilledVessel& out, Stages& stage, Json& report) {
  const auto cut = surface_of(vessel, stage, report);
  report["edge"] = vessel.edge;
  require_grid(cut, vessel.edge);
  auto filled = stage("fill", [&] { return meshing::dual_hexahedra(cut, {.edge = vessel.edge}); });
  out.hexes = std::move(filled.mesh);
  const auto q = mesh::quality(out.hexes);
  detail::tell_hexahedra(out.hexes, q, report);
  report["fill"]["surface_distance_rms"] = filled.report.distance_rms;
  report["fill"]["surface_distance_max"] = filled.report.distance_max;
  if (filled.report.inverted > 0)
    throw MeshError(count_text(static_cast<std::size_t>(filled.report.inverted), "hexahedron", "hexahedra") +
                    " would be inverted, the worst at " + place(q.worst_place) +
                    "; a shorter --edge gives more room");
  if (filled.report.below_sound > 0)
    warn(report, count_text(static_cast<std::size_t>(filled.report.below_sound), "hexahedron", "hexahedra") +
                     " with a scaled Jacobian below 0.2, the worst of " +
                     short_text(q.scaled_jacobian.least) + " at " + place(q.worst_place));
}

/// A hexahedron for each voxel between the cuts.
inline void fill_voxels(const ImageVessel& vessel, FilledVessel& out, Stages& stage, Json& report) {
  const ImageOptions& o = vessel.options;
  const auto kept = stage(
      "cut", [&] { return meshing::cut_voxels(vessel.image, vessel.region.mask.inside, o.cuts, o.seed); });
  auto filled = stage("fill", [&] {
    return meshing::voxel_hexahedra(vessel.image, kept, {.contacts = meshing::VoxelContacts::filled});
  });
  out.hexes = std::move(filled.mesh);
  detail::tell_hexahedra(out.hexes, mesh::quality(out.hexes), report);
  const std::size_t more = filled.contacts.filled_voxels;
  report["fill"]["voxels_added"] = more;
  if (more > 0)
    warn(report,
         count_text(more, "voxel", "voxels") + " added where others touched by an edge or a corner alone" +
             (filled.contacts.places.empty() ? ""
                                             : ", the first at " + place(filled.contacts.places.front())));
}

/// The vessel of the image, filled; figures go to the report, warnings to it and to stderr. InputError or
/// MeshError name what cannot be used.
[[nodiscard]] inline FilledVessel fill_image(const ImageOptions& options, const FillChoice& how,
                                             Stages& stage, Json& report) {
  const auto vessel = segment_image(options, stage, report);
  FilledVessel out;
  if (how.fill == Fill::voxels) {
    fill_voxels(vessel, out, stage, report);
  } else if (how.fill == Fill::hexes) {
    fill_hexahedra(vessel, out, stage, report);
  } else {
    fill_triangles(how, vessel, out, stage, report);
  }
  if (out.hexes.cell_count() > 0) out.quads = surface_of_patches(out.hexes);
  return out;
}

/// Histograms and worst cells of all that was made.
inline void tell_quality(const FilledVessel& v, Json& report) {
  if (v.triangles.cell_count() > 0) tell_quality("surface", v.triangles, report);
  if (v.tets.cell_count() > 0) tell_quality("tetrahedra", v.tets, report);
  if (v.hexes.cell_count() > 0) tell_quality("hexahedra", v.hexes, report);
}

/// Stages of fill_image.
[[nodiscard]] constexpr int fill_stages(Fill fill) {
  return segment_stages + (fill == Fill::voxels  ? 2
                           : fill == Fill::hexes ? surface_stages + 1
                                                 : surface_stages + 2);
}

}  // namespace tunica::examples
