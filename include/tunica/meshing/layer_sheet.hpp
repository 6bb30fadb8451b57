// SPDX-License-Identifier: MIT
// The part of a closed surface on which layers grow, and what binds the foot of each column: nothing, the
// plane of a flat end, the line in which two of them meet, or everything.
#pragma once

#include "tunica/core/error.hpp"
#include "tunica/core/vec.hpp"
#include "tunica/mesh/adjacency.hpp"
#include "tunica/mesh/measures.hpp"
#include "tunica/meshing/flat_regions.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace tunica::meshing {

/// Where the column above a node may go. `none`: no triangle at the node carries layers. `fixed`: the layers
/// end there, because the neighbour without layers is curved or no direction sees all triangles.
enum class ColumnFoot : std::uint8_t { none, free, plane, line, fixed };

/// The triangles that carry layers, with what is known of their nodes.
struct LayerSheet {
  const mesh::Surface& surface;
  std::vector<char> carries;      // one a triangle
  std::vector<Index> triangles;   // those that carry layers, ascending
  std::vector<Vec3> inward;       // unit normal of every triangle, to the inside
  std::vector<ColumnFoot> foot;   // one a node
  std::vector<Vec3> axis;         // of a node: normal of its plane, direction of its line
  mesh::Rows around, neighbours;  // of a node: its triangles that carry layers, its neighbours on them

  [[nodiscard]] Vec3 node(Index n) const { return vec::column(surface.nodes, n); }
  [[nodiscard]] std::array<Index, 3> corners(Index t) const {
    return {surface.cells(0, t), surface.cells(1, t), surface.cells(2, t)};
  }
  [[nodiscard]] bool grows(Index n) const {
    const ColumnFoot f = foot[static_cast<std::size_t>(n)];
    return f != ColumnFoot::none && f != ColumnFoot::fixed;
  }
};

namespace detail {

/// Which regions carry layers: those named, else all that are not flat. MeshError for a name that there is
/// not.
[[nodiscard]] inline std::vector<char> layered_regions(const mesh::Surface& s,
                                                       const std::vector<std::optional<Plane>>& planes,
                                                       const std::vector<std::string>& names) {
  std::vector<char> layered(planes.size(), 0);
  for (std::size_t r = 0; names.empty() && r < planes.size(); ++r) layered[r] = !planes[r];
  for (const std::string& name : names) {
    const auto found = std::find(s.region_names.begin(), s.region_names.end(), name);
    if (found == s.region_names.end())
      throw MeshError("layers are asked for on \"" + name + "\", which is no region of the surface");
    layered[static_cast<std::size_t>(found - s.region_names.begin())] = 1;
  }
  return layered;
}

/// The foot of a node that carries layers, by the regions without layers at it.
inline void bind(LayerSheet& sheet, Index n, const std::vector<Index>& others,
                 const std::vector<std::optional<Plane>>& planes) {
  const auto i = static_cast<std::size_t>(n);
  sheet.foot[i] = ColumnFoot::free;
  for (const Index r : others)
    if (!planes[static_cast<std::size_t>(r)]) {
      sheet.foot[i] = ColumnFoot::fixed;
      return;
    }
  if (others.empty()) return;
  const Vec3& first = planes[static_cast<std::size_t>(others[0])]->normal;
  sheet.foot[i] = ColumnFoot::plane, sheet.axis[i] = first;
  if (others.size() == 1) return;
  const Vec3 line = vec::cross(first, planes[static_cast<std::size_t>(others[1])]->normal);
  constexpr double parallel = 0.1;  // sine below which two planes have no line that a column could follow
  const bool one = others.size() == 2 && vec::length(line) > parallel;
  sheet.foot[i] = one ? ColumnFoot::line : ColumnFoot::fixed;
  sheet.axis[i] = vec::unit(line);
}

}  // namespace detail

/// The sheet of a closed surface. MeshError when no triangle carries layers.
[[nodiscard]] inline LayerSheet layer_sheet(const mesh::Surface& s, const std::vector<std::string>& regions) {
  const auto planes = flat_regions(s);
  const auto layered = detail::layered_regions(s, planes, regions);
  const auto at = [](Index i) { return static_cast<std::size_t>(i); };
  LayerSheet sheet{s,
                   std::vector<char>(at(s.cell_count()), 0),
                   {},
                   std::vector<Vec3>(at(s.cell_count())),
                   std::vector<ColumnFoot>(at(s.node_count()), ColumnFoot::none),
                   std::vector<Vec3>(at(s.node_count()), Vec3(0, 0, 0)),
                   {},
                   {}};
  for (Index t = 0; t < s.cell_count(); ++t) {
    sheet.inward[at(t)] = vec::scaled(-1, vec::unit(mesh::triangle(s, t).area_vector()));
    if (layered[at(s.region_of(t))] == 0) continue;
    sheet.carries[at(t)] = 1;
    sheet.triangles.push_back(t);
  }
  if (sheet.triangles.empty())
    throw MeshError("no region can carry layers: all are flat ends; name those that shall");

  const mesh::Rows cells = mesh::cells_of_nodes(s.cells, s.node_count());
  std::vector<Index> seen(at(s.node_count()), -1), others;
  for (Index n = 0; n < s.node_count(); ++n) {
    others.clear();
    for (const Index t : cells[n]) {
      if (sheet.carries[at(t)] != 0) {
        sheet.around.item.push_back(t);
        for (const Index m : sheet.corners(t))
          if (m != n && seen[at(m)] != n) seen[at(m)] = n, sheet.neighbours.item.push_back(m);
      } else if (std::find(others.begin(), others.end(), s.region_of(t)) == others.end()) {
        others.push_back(s.region_of(t));
      }
    }
    sheet.around.offset.push_back(static_cast<Index>(sheet.around.item.size()));
    sheet.neighbours.offset.push_back(static_cast<Index>(sheet.neighbours.item.size()));
    if (!sheet.around[n].empty()) detail::bind(sheet, n, others, planes);
  }
  return sheet;
}

}  // namespace tunica::meshing
