// SPDX-License-Identifier: MIT
// multi_region(labels): tetrahedra of several materials from a label image; they conform where materials
// meet. Interfaces are contoured, smoothed and remeshed together, then each region is filled and keeps them.
#pragma once

#include "tunica/core/parallel.hpp"
#include "tunica/meshing/interface_nudge.hpp"
#include "tunica/meshing/interface_relax.hpp"
#include "tunica/meshing/interface_remesh.hpp"
#include "tunica/meshing/label_contour.hpp"
#include "tunica/meshing/region_materials.hpp"
#include "tunica/meshing/tetrahedra.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace tunica::meshing {

struct MultiRegionOptions {
  double edge = 0;  // length of the interfaces' edges, in the unit of the image; 0: that of a voxel
  int sweeps = 20;  // of the smoothing; 0: neither smoothed nor remeshed
  // [degrees] Tetrahedra below it may move nodes of interfaces, which costs some of the volumes' accuracy.
  double nudge_below = 12;
  std::vector<LabelName> names{};
  FillOptions fill{};
};

struct MultiRegionReport {
  std::vector<MaterialReport> materials;  // by label
  Index triangles = 0;                    // of the interfaces
  Index nudged = 0;                       // nodes of interfaces that moved for flat tetrahedra
  Index held = 0;                         // nodes that the smoothing sent back: triangles would have crossed
  double smallest_angle = 0;              // of the interfaces' triangles [degrees]
  double smallest_fold = 0;               // least inner angle between two triangles of a region [degrees]
  double min_dihedral = 0, mean_ratio = 0;
  double volume_error = 0;  // of a filling against what its surface encloses, relative
  double deviation = 0;     // of a region's volume from that of its voxels, relative
};

struct [[nodiscard]] MultiRegionResult {
  mesh::TetMesh mesh;  // region: material, in the order of the report; nodes of interfaces first
  std::vector<std::int64_t> material;  // label of each tetrahedron
  Interfaces interfaces;
  MultiRegionReport report;
};

namespace detail {

/// What the mesh of all regions is: volumes of materials and regions, angles. region: of each tetrahedron.
inline void measure(const MultiRegionResult& m, const std::vector<Index>& region,
                    const image::LabelRegions& regions, const std::vector<Index>& material_of,
                    MultiRegionReport& r) {
  std::vector<long double> volume(regions.regions.size(), 0);
  double least = std::numbers::pi, ratio = 0;
  for (Index t = 0; t < m.mesh.cell_count(); ++t) {
    std::array<Vec3, 4> p;
    for (std::size_t i = 0; i < 4; ++i)
      p[i] = vec::column(m.mesh.nodes, m.mesh.cells(static_cast<Eigen::Index>(i), t));
    volume[static_cast<std::size_t>(region[static_cast<std::size_t>(t)])] +=
        six_volumes(p[0], p[1], p[2], p[3]);
    for (const double a : dihedral_angles(p[0], p[1], p[2], p[3])) least = std::min(least, a);
    ratio += mean_ratio(p[0], p[1], p[2], p[3]);
    ++r.materials[static_cast<std::size_t>(m.mesh.region[static_cast<std::size_t>(t)])].tetrahedra;
  }
  r.min_dihedral = least * 180 / std::numbers::pi;
  r.mean_ratio = ratio / std::max<double>(1, m.mesh.cell_count());
  const auto enclosed = volumes_of(m.interfaces, volume.size());
  for (std::size_t i = 0; i < volume.size(); ++i) {
    if (material_of[i] < 0) continue;
    const auto v = static_cast<double>(volume[i] / 6);
    r.materials[static_cast<std::size_t>(material_of[i])].volume += v;
    r.volume_error = std::max(r.volume_error, std::abs(v / enclosed[i] - 1));
    r.deviation = std::max(r.deviation, std::abs(v / regions.regions[i].volume - 1));
  }
  r.triangles = static_cast<Index>(m.interfaces.faces.size());
  double thin = std::numbers::pi;
  for (std::size_t t = 0; t < m.interfaces.faces.size(); ++t)
    thin = std::min(thin, m.interfaces.triangle(t).smallest_angle());
  r.smallest_angle = thin * 180 / std::numbers::pi;
}

/// Fills every region but the outside by fill(surface) -> FillResult, which keeps the surface, and joins the
/// fillings over the nodes of the interfaces.
template <class Fill>
[[nodiscard]] MultiRegionResult fill_regions(Interfaces interfaces, Materials materials, double edge,
                                             const image::LabelRegions& regions,
                                             const MultiRegionOptions& options, const Fill& fill) {
  MultiRegionResult result;
  MultiRegionReport& report = result.report;
  report.materials = std::move(materials.list);
  report.smallest_fold = 360;
  std::vector<Vec3> nodes = interfaces.nodes;
  std::vector<std::array<Index, 4>> cells;
  std::vector<Index> region;
  const auto surfaces = region_surfaces(interfaces, regions.regions.size());
  std::vector<FillResult> fillings(surfaces.size());
  std::vector<std::string> failures(surfaces.size());
  parallel_chunks(static_cast<std::ptrdiff_t>(surfaces.size()), 1, [&](std::ptrdiff_t first, std::ptrdiff_t) {
    const auto r = static_cast<std::size_t>(first);
    if (materials.of[r] < 0) return;
    try {
      fillings[r] = fill(surfaces[r].surface);
    } catch (const MeshError& error) {
      failures[r] = error.what();
    }
  });
  for (std::size_t r = 0; r < surfaces.size(); ++r) {
    if (materials.of[r] < 0) continue;
    const MaterialReport& material = report.materials[static_cast<std::size_t>(materials.of[r])];
    if (!failures[r].empty())
      throw MeshError(material.name + " (label " + std::to_string(material.label) + "): " + failures[r]);
    const FillResult& filled = fillings[r];
    report.smallest_fold = std::min(report.smallest_fold, filled.report.surface_min_dihedral);
    std::vector<Index> number = surfaces[r].node;
    for (Index n = surfaces[r].surface.node_count(); n < filled.mesh.node_count(); ++n) {
      number.push_back(static_cast<Index>(nodes.size()));
      nodes.push_back(vec::column(filled.mesh.nodes, n));
    }
    for (Index t = 0; t < filled.mesh.cell_count(); ++t) {
      std::array<Index, 4> q{};
      for (std::size_t i = 0; i < 4; ++i)
        q[i] = number[static_cast<std::size_t>(filled.mesh.cells(static_cast<Eigen::Index>(i), t))];
      cells.push_back(q);
      region.push_back(static_cast<Index>(r));
      result.mesh.region.push_back(materials.of[r]);
      result.material.push_back(material.label);
    }
  }
  result.mesh.cells.resize(4, static_cast<Eigen::Index>(cells.size()));
  for (std::size_t t = 0; t < cells.size(); ++t)
    for (std::size_t i = 0; i < 4; ++i)
      result.mesh.cells(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(t)) = cells[t][i];
  if (options.sweeps > 0) {
    report.nudged = InterfaceNudge(interfaces, edge, nodes, result.mesh.cells).run(options.nudge_below);
    std::copy_n(nodes.begin(), interfaces.nodes.size(), interfaces.nodes.begin());
  }
  result.mesh.nodes = vec::columns(nodes);
  for (const MaterialReport& m : report.materials) result.mesh.region_names.push_back(m.name);
  result.mesh.patches = interface_patches(interfaces, report.materials, materials.of);
  result.interfaces = std::move(interfaces);
  measure(result, region, regions, materials.of, report);
  return result;
}

}  // namespace detail

/// Meshes all labels but 0 of an image. Tetrahedra carry their material, faces between two materials are
/// shared by one tetrahedron of each; a patch for each pair in contact ("lumen|wall"), with the outside
/// ("wall|outside") and, where the image ends, with its border ("lumen|border z0"). InputError for images
/// that are no labels, MeshError with the material and the place where a region cannot be filled.
template <std::integral T>
[[nodiscard]] MultiRegionResult multi_region(const image::Image<T>& labels,
                                             const MultiRegionOptions& options = {}) {
  const image::LabelRegions regions = image::label_regions(labels);
  const detail::Materials materials = detail::materials_of(regions, options.names);
  // The interfaces at each stage: those of the last one are filled, and if that fails those before it.
  std::vector<Interfaces> stages{label_contour(regions)};
  RelaxReport relaxed;
  std::vector<double> target;  // outside that reaches the border of the image takes what is left
  double volume = 0;
  for (const auto& r : regions.regions) {
    target.push_back(r.label == 0 && r.at_border ? -1 : r.volume);
    volume += r.volume;
  }
  const double edge =
      options.edge > 0 ? options.edge : std::cbrt(volume / static_cast<double>(labels.values.size()));
  if (options.sweeps > 0) {
    const auto relax = [&](Interfaces s, int sweeps) {
      relaxed = InterfaceRelax(s).run(sweeps, target);
      return s;
    };
    stages.push_back(relax(stages[0], options.sweeps));
    const Interfaces even = relax(remeshed(stages[1], edge), options.sweeps);
    stages.push_back(relax(tidied(relax(remeshed(even, edge), options.sweeps), edge), 0));
  }
  for (;;) {
    try {
      const auto fill = [&](const mesh::Surface& s) { return tetrahedra(s, options.fill); };
      auto result = detail::fill_regions(std::move(stages.back()), materials, edge, regions, options, fill);
      result.report.held = relaxed.held;
      return result;
    } catch (const MeshError&) {
      stages.pop_back();
      if (stages.empty()) throw;
    }
  }
}

}  // namespace tunica::meshing
