// SPDX-License-Identifier: MIT
// multi_region(labels): tetrahedra of several materials from a label image; they conform where materials
// meet. Interfaces are contoured, smoothed and remeshed together, then each region is filled and keeps them.
#pragma once

#include "tunica/meshing/interface_relax.hpp"
#include "tunica/meshing/label_contour.hpp"
#include "tunica/meshing/tetrahedra.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace tunica::meshing {

/// What a label is called in patches: "lumen". Without a name label 3 is "material 3".
struct LabelName {
  std::int64_t label = 0;
  std::string name;
};

struct MultiRegionOptions {
  int sweeps = 20;  // of the smoothing; 0: none, and volumes as contoured
  std::vector<LabelName> names{};
  FillOptions fill{};
};

/// One material. Volumes in the cube of the image's unit.
struct MaterialReport {
  std::int64_t label = 0;
  std::string name;
  Index regions = 0, tetrahedra = 0;    // connected parts
  double voxel_volume = 0, volume = 0;  // of its voxels, of its tetrahedra
};

struct MultiRegionReport {
  std::vector<MaterialReport> materials;  // by label
  Index triangles = 0;                    // of the interfaces
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

/// The boundary of a region: its triangles, turned outward, and the interfaces' number of each node.
struct RegionSurface {
  mesh::Surface surface;
  std::vector<Index> node;
};

[[nodiscard]] inline std::vector<RegionSurface> region_surfaces(const Interfaces& s, std::size_t regions) {
  std::vector<std::vector<std::array<Index, 3>>> faces(regions);
  for (std::size_t t = 0; t < s.faces.size(); ++t) {
    auto f = s.faces[t];
    faces[static_cast<std::size_t>(s.sides[t][0])].push_back(f);
    std::swap(f[1], f[2]);
    if (s.sides[t][1] >= 0) faces[static_cast<std::size_t>(s.sides[t][1])].push_back(f);
  }
  std::vector<RegionSurface> result(regions);
  std::vector<Index> number(s.nodes.size(), -1);
  for (std::size_t r = 0; r < regions; ++r) {
    RegionSurface& one = result[r];
    for (const auto& f : faces[r]) one.node.insert(one.node.end(), f.begin(), f.end());
    std::sort(one.node.begin(), one.node.end());
    one.node.erase(std::unique(one.node.begin(), one.node.end()), one.node.end());
    one.surface.nodes.resize(3, static_cast<Eigen::Index>(one.node.size()));
    for (std::size_t n = 0; n < one.node.size(); ++n) {
      number[static_cast<std::size_t>(one.node[n])] = static_cast<Index>(n);
      vec::set_column(one.surface.nodes, static_cast<Index>(n), s.at(one.node[n]));
    }
    one.surface.cells.resize(3, static_cast<Eigen::Index>(faces[r].size()));
    for (std::size_t t = 0; t < faces[r].size(); ++t)
      for (std::size_t i = 0; i < 3; ++i)
        one.surface.cells(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(t)) =
            number[static_cast<std::size_t>(faces[r][t][i])];
  }
  return result;
}

/// Which materials there are, by label, and which of them each region is (-1: outside).
struct Materials {
  std::vector<MaterialReport> list;
  std::vector<Index> of;
};

[[nodiscard]] inline Materials materials_of(const image::LabelRegions& regions,
                                            const std::vector<LabelName>& names) {
  Materials m;
  std::map<std::int64_t, Index> number;
  for (const auto& r : regions.regions)
    if (r.label != 0) number[r.label] = 0;
  for (auto& [label, index] : number) {
    index = static_cast<Index>(m.list.size());
    MaterialReport one{.label = label, .name = "material " + std::to_string(label)};
    for (const LabelName& n : names)
      if (n.label == label) one.name = n.name;
    m.list.push_back(one);
  }
  for (const auto& r : regions.regions) {
    m.of.push_back(r.label == 0 ? -1 : number[r.label]);
    if (r.label == 0) continue;
    MaterialReport& one = m.list[static_cast<std::size_t>(m.of.back())];
    ++one.regions;
    one.voxel_volume += r.volume;
  }
  return m;
}

/// A patch for each pair of materials in contact, then for each material those with the outside and with the
/// borders of the image. Faces are outward of the material that is named first.
[[nodiscard]] inline std::vector<mesh::Patch<mesh::Tri3>> interface_patches(const Interfaces& s,
                                                                            const Materials& m) {
  constexpr std::array<const char*, 6> border{"x0", "x1", "y0", "y1", "z0", "z1"};
  const auto count = static_cast<Index>(m.list.size());
  std::map<std::pair<Index, Index>, std::vector<std::array<Index, 3>>> faces;
  for (std::size_t t = 0; t < s.faces.size(); ++t) {
    auto f = s.faces[t];
    Index a = m.of[static_cast<std::size_t>(s.sides[t][0])], b = count;
    if (const int side = border_face(s.sides[t][1]); side >= 0)
      b = count + 1 + side;
    else
      b = m.of[static_cast<std::size_t>(s.sides[t][1])];
    if (a < 0) a = count;  // the outside comes after the materials
    if (b < 0) b = count;
    if (b < a) std::swap(a, b), std::swap(f[1], f[2]);
    faces[{a, b}].push_back(f);
  }
  std::vector<mesh::Patch<mesh::Tri3>> patches;
  for (const auto& [pair, list] : faces) {
    const auto name = [&](Index i) -> std::string {
      if (i < count) return m.list[static_cast<std::size_t>(i)].name;
      if (i == count) return "outside";
      return std::string("border ") + border[static_cast<std::size_t>(i - count - 1)];
    };
    mesh::Patch<mesh::Tri3> p{name(pair.first) + "|" + name(pair.second), {}};
    p.faces.resize(3, static_cast<Eigen::Index>(list.size()));
    for (std::size_t t = 0; t < list.size(); ++t)
      for (std::size_t i = 0; i < 3; ++i)
        p.faces(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(t)) = list[t][i];
    patches.push_back(std::move(p));
  }
  return patches;
}

/// Fills every region but the outside and joins the fillings over the nodes of the interfaces.
[[nodiscard]] inline MultiRegionResult fill_regions(Interfaces interfaces, Materials materials,
                                                    const image::LabelRegions& regions,
                                                    const FillOptions& options) {
  MultiRegionResult result;
  MultiRegionReport& report = result.report;
  report.min_dihedral = report.smallest_angle = report.smallest_fold = 360;
  std::vector<Vec3> nodes = interfaces.nodes;
  std::vector<std::array<Index, 4>> cells;
  const auto surfaces = region_surfaces(interfaces, regions.regions.size());
  for (std::size_t r = 0; r < surfaces.size(); ++r) {
    if (materials.of[r] < 0) continue;
    MaterialReport& material = materials.list[static_cast<std::size_t>(materials.of[r])];
    FillResult filled;
    try {
      filled = tetrahedra(surfaces[r].surface, options);
    } catch (const MeshError& error) {
      throw MeshError(material.name + " (label " + std::to_string(material.label) + "): " + error.what());
    }
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
      result.mesh.region.push_back(materials.of[r]);
      result.material.push_back(material.label);
    }
    const FillReport& f = filled.report;
    material.tetrahedra += f.tetrahedra;
    material.volume += f.volume;
    report.mean_ratio += f.mean_ratio * f.tetrahedra;
    report.min_dihedral = std::min(report.min_dihedral, f.min_dihedral);
    report.smallest_angle = std::min(report.smallest_angle, f.surface_min_angle);
    report.smallest_fold = std::min(report.smallest_fold, f.surface_min_dihedral);
    report.volume_error = std::max(report.volume_error, f.volume_error);
    report.deviation = std::max(report.deviation, std::abs(f.volume / regions.regions[r].volume - 1));
  }
  report.mean_ratio /= static_cast<double>(std::max<std::size_t>(1, cells.size()));
  report.triangles = static_cast<Index>(interfaces.faces.size());
  result.mesh.nodes = vec::columns(nodes);
  result.mesh.cells.resize(4, static_cast<Eigen::Index>(cells.size()));
  for (std::size_t t = 0; t < cells.size(); ++t)
    for (std::size_t i = 0; i < 4; ++i)
      result.mesh.cells(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(t)) = cells[t][i];
  for (const MaterialReport& m : materials.list) result.mesh.region_names.push_back(m.name);
  result.mesh.patches = interface_patches(interfaces, materials);
  report.materials = std::move(materials.list);
  result.interfaces = std::move(interfaces);
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
  Interfaces interfaces = label_contour(regions);
  RelaxReport relaxed;
  if (options.sweeps > 0) {
    std::vector<double> target;  // outside that reaches the border of the image takes what is left
    for (const auto& r : regions.regions) target.push_back(r.label == 0 && r.at_border ? -1 : r.volume);
    relaxed = InterfaceRelax(interfaces).run(options.sweeps, target);
  }
  auto result = detail::fill_regions(std::move(interfaces), materials, regions, options.fill);
  result.report.held = relaxed.held;
  return result;
}

}  // namespace tunica::meshing
