// SPDX-License-Identifier: MIT
// Regions as materials: names, the closed surface of each region out of the interfaces, a patch for each pair
// of materials in contact.
#pragma once

#include "tunica/image/labels.hpp"
#include "tunica/meshing/interfaces.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace tunica::meshing {

/// What a label is called in patches: "lumen". Without a name label 3 is "material 3".
struct LabelName {
  std::int64_t label = 0;
  std::string name;
};

/// One material. Volumes in the cube of the image's unit.
struct MaterialReport {
  std::int64_t label = 0;
  std::string name;
  Index regions = 0, tetrahedra = 0;    // connected parts
  double voxel_volume = 0, volume = 0;  // of its voxels, of its tetrahedra
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
  std::vector<std::int64_t> labels;  // ascending
  const auto place_of = [&labels](std::int64_t label) {
    return std::lower_bound(labels.begin(), labels.end(), label);
  };
  for (const auto& r : regions.regions)
    if (const auto at = place_of(r.label); r.label != 0 && (at == labels.end() || *at != r.label))
      labels.insert(at, r.label);
  constexpr std::size_t most = 10000;  // pairs of them are counted by an Index
  if (labels.size() > most)
    throw InputError("the image has " + std::to_string(labels.size()) + " labels, more than " +
                     std::to_string(most));
  for (const std::int64_t label : labels) {
    MaterialReport one{.label = label, .name = "material " + std::to_string(label)};
    for (const LabelName& n : names)
      if (n.label == label) one.name = n.name;
    m.list.push_back(one);
  }
  for (const auto& r : regions.regions) {
    m.of.push_back(r.label == 0 ? -1 : static_cast<Index>(place_of(r.label) - labels.begin()));
    if (r.label == 0) continue;
    MaterialReport& one = m.list[static_cast<std::size_t>(m.of.back())];
    ++one.regions;
    one.voxel_volume += r.volume;
  }
  return m;
}

/// A patch for each pair of materials in contact, then for each material those with the outside and with the
/// borders of the image. Faces are outward of the material that is named first.
[[nodiscard]] inline std::vector<mesh::Patch<mesh::Tri3>> interface_patches(
    const Interfaces& s, const std::vector<MaterialReport>& materials, const std::vector<Index>& of) {
  constexpr std::array<const char*, 6> border{"x0", "x1", "y0", "y1", "z0", "z1"};
  const auto count = static_cast<Index>(materials.size());
  const Index kinds = count + 1 + static_cast<Index>(border.size());  // materials, outside, borders
  std::vector<std::vector<std::array<Index, 3>>> faces(static_cast<std::size_t>(kinds * kinds));
  for (std::size_t t = 0; t < s.faces.size(); ++t) {
    auto f = s.faces[t];
    Index a = of[static_cast<std::size_t>(s.sides[t][0])], b = count;
    if (const int side = border_face(s.sides[t][1]); side >= 0)
      b = count + 1 + side;
    else
      b = of[static_cast<std::size_t>(s.sides[t][1])];
    if (a < 0) a = count;  // the outside comes after the materials
    if (b < 0) b = count;
    if (b < a) std::swap(a, b), std::swap(f[1], f[2]);
    faces[static_cast<std::size_t>(a * kinds + b)].push_back(f);
  }
  std::vector<mesh::Patch<mesh::Tri3>> patches;
  for (Index pair = 0; pair < kinds * kinds; ++pair) {
    const auto& list = faces[static_cast<std::size_t>(pair)];
    if (list.empty()) continue;
    const auto name = [&](Index i) -> std::string {
      if (i < count) return materials[static_cast<std::size_t>(i)].name;
      if (i == count) return "outside";
      return std::string("border ") + border[static_cast<std::size_t>(i - count - 1)];
    };
    mesh::Patch<mesh::Tri3> p{name(pair / kinds) + "|" + name(pair % kinds), {}};
    p.faces.resize(3, static_cast<Eigen::Index>(list.size()));
    for (std::size_t t = 0; t < list.size(); ++t)
      for (std::size_t i = 0; i < 3; ++i)
        p.faces(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(t)) = list[t][i];
    patches.push_back(std::move(p));
  }
  return patches;
}

}  // namespace detail

}  // namespace tunica::meshing
