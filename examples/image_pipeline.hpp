// SPDX-License-Identifier: MIT
// From an image to a closed, capped, remeshed surface and its tetrahedra: segmentation, contour,
// smoothing, cuts and caps, remeshing, filling. Lengths are in the unit of the image. [PEREZ08, 3]
#pragma once

#include "cli.hpp"
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
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tunica::examples {

enum class Contourer { marching_cubes, dual_contouring };
enum class Fill { tets, none };

struct ImageOptions {
  std::string image{};                 // a VTK file; empty: the phantom, with its iso-value and ports
  std::optional<double> iso{};         // inside is value >= iso
  std::optional<image::Voxel> seed{};  // none: the largest component
  std::vector<meshing::Cut> cuts{};    // in order; unnamed ones become "cut 1", "cut 2" ...
  Contourer surface = Contourer::marching_cubes;
  Fill fill = Fill::tets;
  std::optional<double> edge{};  // 0 keeps the contourer's triangles; none: 1.5 largest spacing
  int smooth = 20;               // sweeps
};

/// What the image became, in its unit.
struct [[nodiscard]] ImageMeshes {
  mesh::Surface surface;  // closed; regions: wall, the cuts in their order, the borders of the image
  mesh::TetMesh tets;     // its nodes begin with those of the surface; empty with Fill::none
};

[[nodiscard]] inline meshing::Cut cut_of(const std::string& text) {
  const auto v = numbers_of<double>(text);
  if (v.size() != 6 && v.size() != 7)
    throw UsageError("a cut is px,py,pz,nx,ny,nz or with a radius at the end");
  meshing::Cut cut{.point = {v[0], v[1], v[2]}, .normal = {v[3], v[4], v[5]}, .name = ""};
  if (!(cut.normal.norm() > 0) || !cut.point.allFinite() || !cut.normal.allFinite())
    throw UsageError("the normal of a cut must have a length");
  if (v.size() == 7) cut.radius = v[6];
  if (!(cut.radius > 0)) throw UsageError("the radius of a cut must be positive");
  return cut;
}

/// edge_default: what holds without --edge, for --help.
inline void add_image_options(Cli& cli, ImageOptions& o,
                              const std::string& edge_default = "1.5 times the largest spacing") {
  cli.option("--iso", "V", "iso-value: inside is value >= V", o.iso);
  cli.option("--seed", "i,j,k", "a voxel of the vessel (none: the largest component)",
             [&o](const std::string& text) {
               const auto v = numbers_of<Index>(text);
               if (v.size() != 3) throw UsageError("a seed is i,j,k");
               o.seed = image::Voxel{v[0], v[1], v[2]};
             });
  cli.repeated("--cut", "px,py,pz,nx,ny,nz[,r]",
               "a plane, outward normal, or with r a disc that severs only the vessel it crosses",
               [&o](const std::string& text) { o.cuts.push_back(cut_of(text)); });
  cli.choice<Contourer>(
      "--surface", "how the surface is contoured",
      {{"marching-cubes", Contourer::marching_cubes}, {"dual-contouring", Contourer::dual_contouring}},
      o.surface);
  cli.choice<Fill>("--fill", "what fills it", {{"tets", Fill::tets}, {"none", Fill::none}}, o.fill);
  cli.option("--edge", "L", "edge length (none: " + edge_default + "; 0: the contourer's triangles)",
             [&o](const std::string& text) {
               o.edge = number_of<double>(text);
               if (!(*o.edge >= 0 && std::isfinite(*o.edge))) throw UsageError("must be 0 or more");
             });
  cli.option("--smooth", "N", "sweeps of smoothing that keeps the volume (20)",
             [&o](const std::string& text) {
               o.smooth = number_of<int>(text);
               if (o.smooth < 0) throw UsageError("must be 0 or more");
             });
}

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

/// The whole path; figures go to the report, warnings to it and to stderr. InputError or MeshError
/// name what cannot be used. Seven stages.
inline constexpr int image_stages = 7;
[[nodiscard]] inline ImageMeshes mesh_image(ImageOptions o, Stages& stage, Json& report) {
  ImageMeshes out;
  mesh::Surface& s = out.surface;
  report["warnings"] = Json(std::vector<std::string>{});
  const auto image = stage("read", [&] { return detail::load(o, report); });

  const auto region =
      stage("segment", [&] { return image::segment(image, {.iso = *o.iso, .seed = o.seed}); });
  Json& segment = report["segmentation"];
  segment["iso"] = *o.iso, segment["voxels"] = region.voxels;
  segment["touches"] = Json(std::vector<std::string>{});
  for (std::size_t f = 0; f < 6; ++f)
    if (region.touches[f]) segment["touches"].push(image::face_names[f]);

  const auto spacing = detail::spacing_of(image);
  const double edge = o.edge.value_or(1.5 * spacing.largest);
  Json borders, specks;
  s = stage("contour", [&] {
    auto made = detail::without_specks(detail::contour(image, region, o, borders), edge, specks, report);
    if (o.surface == Contourer::dual_contouring) {  // its faces lie outside of what is convex, and may cross
      meshing::level(made, image, *o.iso, {.reach = 0.25 * spacing.smallest});
      if (const auto tangled = meshing::untangle(made); tangled.crossings_after > 0)
        warn(report, "the contour still crosses itself: " +
                         count_text(tangled.crossings_after, "pair", "pairs") + " of triangles");
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
    if (o.seed) how.seed = image.position(*o.seed);
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

  stage("remesh", [&] {
    report["edge"] = edge;
    if (!(edge > 0)) return;
    if (o.fill == Fill::tets) require_countable(s, edge);
    auto remeshed = meshing::remesh(s, {.edge = edge});
    s = std::move(remeshed.surface);
    report["remesh"] = remesh_figures(remeshed.report);
  });
  const auto made = mesh::topology(s);
  report["surface"] = surface_figures(s, made);
  if (made.components.size() > contoured.components.size())
    for (const auto& c : made.components)
      warn(report, "the cuts leave " + std::to_string(made.components.size()) + " parts; one of volume " +
                       short_text(c.volume) + " is at " + place(c.centre));
  for (std::size_t r = 0; r < s.region_names.size(); ++r)
    if (s.region_names[r].rfind(meshing::border_prefix, 0) == 0)
      warn(report, "the vessel leaves the image: patch " + std::to_string(r) + " is its flat end at " +
                       s.region_names[r]);

  stage("fill", [&] {
    if (o.fill == Fill::none) return;
    auto filled = meshing::tetrahedra(s);
    out.tets = std::move(filled.mesh);
    tell_tetrahedra(filled.report, out.tets, report);
  });
  return out;
}

}  // namespace tunica::examples
