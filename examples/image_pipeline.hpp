// SPDX-License-Identifier: MIT
// From an image to a closed, capped, remeshed surface and its tetrahedra: segmentation, contour,
// smoothing, cuts and caps, remeshing, filling. Lengths are in the unit of the image. [PEREZ08, 3]
#pragma once

#include "cli.hpp"
#include "image_options.hpp"
#include "json.hpp"
#include "mesh_figures.hpp"
#include "stages.hpp"
#include "tunica/core/text.hpp"
#include "tunica/image/components.hpp"
#include "tunica/image/phantom.hpp"
#include "tunica/image/sampling.hpp"
#include "tunica/io/vtk_image.hpp"
#include "tunica/mesh/topology.hpp"
#include "tunica/meshing/cavities.hpp"
#include "tunica/meshing/contour_triangles.hpp"
#include "tunica/meshing/cut.hpp"
#include "tunica/meshing/level.hpp"
#include "tunica/meshing/marching_cubes.hpp"
#include "tunica/meshing/remesh.hpp"
#include "tunica/meshing/smooth.hpp"
#include "tunica/meshing/tetrahedra.hpp"
#include "tunica/meshing/untangle.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace tunica::examples {

/// The image, the voxels of the vessel, and the options with what the image settles of them.
struct [[nodiscard]] ImageVessel {
  ImageOptions options;  // iso has a value
  image::Image<float> image;
  image::Region region;
  double edge = 0;      // target length, 0: the contourer's triangles
  double smallest = 0;  // spacing of the voxels
};

/// What the image became, in its unit.
struct [[nodiscard]] ImageMeshes {
  mesh::Surface surface;  // closed; regions: wall, the cuts in their order, the borders of the image
  mesh::TetMesh tets;     // its nodes begin with those of the surface
};

namespace detail {

[[nodiscard]] inline image::Image<float> load(ImageOptions& o, Json& report) {
  Json& j = report["image"];
  image::Image<float> image;
  if (o.image.empty()) {
    image = image::sample<float>(image::Phantom{}, {});
    if (!o.iso) o.iso = image::Phantom::surface;
    if (o.cuts.empty())
      for (const auto& port : image::Phantom::ports())
        o.cuts.push_back({.point = port.point, .normal = port.normal, .name = port.name});
    j["name"] = "phantom";
  } else {
    if (!o.iso) throw UsageError("--iso is needed with an image");
    image = io::read_vtk_image(o.image).image;
    j["name"] = o.image;
  }
  const auto range = image::data_range(image);
  for (int a = 0; a < 3; ++a) j["size"].push(image.size(a));
  j["lowest"] = range.lowest, j["highest"] = range.highest;
  return image;
}

/// Between neighbouring voxels along any axis.
struct Spacing {
  double smallest = std::numeric_limits<double>::infinity(), largest = 0;
};

[[nodiscard]] inline Spacing spacing_of(const image::Image<float>& image) {
  Spacing h;
  for (const auto& axis : image.axes)
    for (std::size_t i = 1; i < axis.size(); ++i) {
      h.smallest = std::min(h.smallest, axis[i] - axis[i - 1]);
      h.largest = std::max(h.largest, axis[i] - axis[i - 1]);
    }
  return h;
}

/// The closed surface of the region, and what the report says of its borders with the image.
[[nodiscard]] inline mesh::Surface contour(const image::Image<float>& image, const image::Region& region,
                                           const ImageOptions& o, Json& report) {
  auto contour = o.surface == Contourer::dual_contouring
                     ? meshing::dual_contour_image(image, region.mask.inside, *o.iso)
                     : meshing::marching_cubes(image, region.mask.inside, *o.iso);
  report = Json(std::vector<double>{});
  for (const auto& b : contour.borders) {
    Json j;
    j["name"] = b.name, j["area"] = b.area, j["centre"] = b.centre;
    report.push(std::move(j));
  }
  return std::move(contour.surface);
}

/// Fills the cavities that no triangle of that edge length can line: each would be lined by tiny ones.
[[nodiscard]] inline mesh::Surface without_specks(mesh::Surface s, double edge, Json& figures, Json& report) {
  const auto topology = mesh::topology(s);
  auto result = meshing::fill_cavities(std::move(s), topology, edge * edge * edge);
  meshing::Cavity largest;
  double volume = 0;
  for (const auto& c : result.filled) {
    volume += c.volume;
    if (c.volume > largest.volume) largest = c;
  }
  figures["count"] = result.filled.size(), figures["volume"] = volume;
  if (!result.filled.empty())
    warn(report, count_text(result.filled.size(), "cavity", "cavities") +
                     " smaller than the cube of the edge length filled, " + short_text(volume) +
                     " in all; the largest of " + short_text(largest.volume) + " is at " +
                     place(largest.centre) + ". --edge 0 keeps them");
  return std::move(result.surface);
}

}  // namespace detail

/// Reads the image and finds the vessel; figures go to the report, warnings to it and to stderr. InputError
/// names what cannot be used. Two stages.
inline constexpr int segment_stages = 2;
[[nodiscard]] inline ImageVessel segment_image(const ImageOptions& options, Stages& stage, Json& report) {
  ImageVessel v{.options = options, .image = {}, .region = {}};
  ImageOptions& o = v.options;
  report["warnings"] = Json(std::vector<std::string>{});
  v.image = stage("read", [&] { return detail::load(o, report); });
  v.region = stage("segment", [&] { return image::segment(v.image, {.iso = *o.iso, .seed = o.seed}); });
  Json& segment = report["segmentation"];
  segment["iso"] = *o.iso, segment["voxels"] = v.region.voxels;
  segment["touches"] = Json(std::vector<std::string>{});
  for (std::size_t f = 0; f < 6; ++f)
    if (v.region.touches[f]) segment["touches"].push(image::face_names[f]);
  const auto spacing = detail::spacing_of(v.image);
  v.edge = o.edge.value_or(1.5 * spacing.largest), v.smallest = spacing.smallest;
  return v;
}

/// The smoothed contour of the vessel between its cuts. MeshError names what cannot be done. Three stages.
inline constexpr int surface_stages = 3;
[[nodiscard]] inline mesh::Surface surface_of(const ImageVessel& v, Stages& stage, Json& report) {
  const ImageOptions& o = v.options;
  Json borders, specks;
  mesh::Surface s = stage("contour", [&] {
    auto made =
        detail::without_specks(detail::contour(v.image, v.region, o, borders), v.edge, specks, report);
    if (o.surface == Contourer::dual_contouring) {  // its faces lie outside of what is convex, and may cross
      meshing::level(made, v.image, *o.iso, {.reach = 0.25 * v.smallest});
      const auto tangled = meshing::untangle(made);
      if (tangled.crossings_after > 0)
        warn(report, "the contour still crosses itself: " +
                         count_text(tangled.crossings_after, "pair", "pairs") + " of triangles");
      if (tangled.released > 0)
        warn(report, count_text(static_cast<std::size_t>(tangled.released), "node", "nodes") +
                         " at the border of the image left its planes, where the contour crossed itself");
    }
    return made;
  });
  const auto contoured = mesh::topology(s);
  report["contour"] = surface_figures(s, contoured);
  report["contour"]["borders"] = borders, report["contour"]["filled_cavities"] = specks;
  tell_topology(s, contoured, report);

  stage("smooth", [&] {
    if (o.smooth == 0) return;
    const auto r = meshing::smooth(s, {.sweeps = o.smooth});
    Json& j = report["smooth"];
    j["sweeps"] = o.smooth, j["volume_before"] = r.volume_before, j["volume_after"] = r.volume_after;
    j["held_back"] = r.held_back, j["frozen"] = r.frozen, j["largest_move"] = r.largest_move;
  });

  stage("cut", [&] {
    meshing::CutOptions how;
    if (o.seed) how.seed = v.image.position(*o.seed);
    auto cut = meshing::cut(std::move(s), o.cuts, how);
    s = std::move(cut.surface);
    for (const auto& c : cut.cuts) {
      Json j;
      j["name"] = c.name, j["patch"] = c.region, j["area"] = c.area, j["centre"] = c.centre;
      j["rim_edges"] = c.rim_edges;
      report["cuts"].push(std::move(j));
    }
    report["cut_volume"] = mesh::enclosed_volume(s);
  });
  const auto left = mesh::topology(s);
  if (left.components.size() > contoured.components.size())
    for (const auto& c : left.components)
      warn(report, "the cuts leave " + std::to_string(left.components.size()) + " parts; one of volume " +
                       short_text(c.volume) + " is at " + place(c.centre));
  for (std::size_t r = 0; r < s.region_names.size(); ++r)
    if (s.region_names[r].rfind(meshing::border_prefix, 0) == 0)
      warn(report, "the vessel leaves the image: patch " + std::to_string(r) + " is its flat end at " +
                       s.region_names[r]);
  return s;
}

/// Triangles of the edge length asked for; remesh() makes them of a surface. One stage.
template <class Remesh>
[[nodiscard]] mesh::Surface remeshed(mesh::Surface s, const ImageVessel& v, Stages& stage, Json& report,
                                     Remesh&& remesh) {
  stage("remesh", [&] {
    report["edge"] = v.edge;
    if (!(v.edge > 0)) return;
    auto made = remesh(s);
    s = std::move(made.surface);
    report["remesh"] = remesh_figures(made.report);
  });
  report["surface"] = surface_figures(s, mesh::topology(s));
  return s;
}

/// The whole path to tetrahedra. Seven stages.
inline constexpr int image_stages = segment_stages + surface_stages + 2;
[[nodiscard]] inline ImageMeshes mesh_image(const ImageOptions& options, Stages& stage, Json& report) {
  const auto vessel = segment_image(options, stage, report);
  ImageMeshes out;
  out.surface = remeshed(surface_of(vessel, stage, report), vessel, stage, report, [&](const auto& s) {
    require_countable(s, vessel.edge);
    return meshing::remesh(s, {.edge = vessel.edge});
  });
  stage("fill", [&] {
    auto filled = meshing::tetrahedra(out.surface);
    out.tets = std::move(filled.mesh);
    tell_tetrahedra(filled.report, out.tets, report);
  });
  return out;
}

}  // namespace tunica::examples
