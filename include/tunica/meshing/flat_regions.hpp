// SPDX-License-Identifier: MIT
// Which regions of a surface are flat, and how that binds its nodes: in a plane, on a rim, at a corner.
#pragma once

#include "tunica/core/vec.hpp"
#include "tunica/mesh/adjacency.hpp"
#include "tunica/mesh/measures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace tunica::meshing {

struct Plane {
  Vec3 point, normal;  // unit normal

  [[nodiscard]] double distance(const Vec3& x) const { return vec::dot(normal, vec::minus(x, point)); }
  [[nodiscard]] Vec3 projected(const Vec3& x) const { return vec::along(x, -distance(x), normal); }
};

/// A region is flat when its nodes lie within this part of the bounding box's diagonal of one plane:
/// coordinates of single precision will do.
inline constexpr double flat_tolerance = 1e-6;

/// The plane of each region of the surface, outward normal; none where it is curved or empty.
[[nodiscard]] inline std::vector<std::optional<Plane>> flat_regions(const mesh::Surface& s) {
  std::size_t regions = std::max<std::size_t>(1, s.region_names.size());
  for (const Index r : s.region) regions = std::max(regions, static_cast<std::size_t>(r) + 1);
  std::vector<Vec3> normal(regions, Vec3(0, 0, 0)), centre(regions, Vec3(0, 0, 0));
  std::vector<double> area(regions, 0.0), off(regions, 0.0);
  for (Index t = 0; t < s.cell_count(); ++t) {
    const auto r = static_cast<std::size_t>(s.region_of(t));
    const mesh::Triangle f = mesh::triangle(s, t);
    normal[r] = vec::plus(normal[r], f.area_vector());
    area[r] += f.area();
    centre[r] = vec::along(centre[r], f.area(), f.centroid());
  }
  std::vector<std::optional<Plane>> planes(regions);
  for (std::size_t r = 0; r < regions; ++r)
    if (vec::length(normal[r]) > 0.5 * area[r])  // else it is closed or folded, and its normal is noise
      planes[r] = Plane{vec::divided(centre[r], area[r]), vec::unit(normal[r])};
  for (Index t = 0; t < s.cell_count(); ++t) {
    const auto r = static_cast<std::size_t>(s.region_of(t));
    for (int k = 0; planes[r] && k < 3; ++k)
      off[r] = std::max(off[r], std::abs(planes[r]->distance(mesh::node(s, s.cells(k, t)))));
  }
  const double reach = s.node_count() > 0 ? flat_tolerance * mesh::bounding_box(s.nodes).diagonal() : 0;
  for (std::size_t r = 0; r < regions; ++r)
    if (off[r] > reach) planes[r].reset();
  return planes;
}

/// How a node may move: anywhere, within the plane of its flat region, along the rim of one, or not at all.
enum class Bond : std::uint8_t { none, plane, rim, corner };

/// The bond of each node, with the flat region that binds it and the neighbours of a rim node on the rim.
struct Bonds {
  std::vector<Bond> bond;
  std::vector<Index> region;                // of the plane; -1 without a bond
  std::vector<std::array<Index, 2>> along;  // of a rim node

  [[nodiscard]] Bond of(Index n) const { return bond[static_cast<std::size_t>(n)]; }
  [[nodiscard]] bool any() const {
    return std::any_of(bond.begin(), bond.end(), [](Bond b) { return b != Bond::none; });
  }
};

/// Bonds of the nodes of a closed surface. A rim node touches one flat region and one that is not flat; where
/// two flat regions meet, or a rim is not a simple curve, nodes are corners.
[[nodiscard]] inline Bonds bonds(const mesh::Surface& s, const std::vector<std::optional<Plane>>& planes) {
  const auto n = static_cast<std::size_t>(s.node_count());
  Bonds b{std::vector<Bond>(n, Bond::none), std::vector<Index>(n, -1),
          std::vector<std::array<Index, 2>>(n, {-1, -1})};
  std::vector<char> curved(n, 0);
  for (Index t = 0; t < s.cell_count(); ++t) {
    const Index r = s.region_of(t);
    for (int k = 0; k < 3; ++k) {
      const auto node = static_cast<std::size_t>(s.cells(k, t));
      if (!planes[static_cast<std::size_t>(r)]) {
        curved[node] = 1;
      } else if (b.region[node] >= 0 && b.region[node] != r) {
        b.bond[node] = Bond::corner;
      } else {
        b.region[node] = r;
        if (b.bond[node] == Bond::none) b.bond[node] = Bond::plane;
      }
    }
  }
  for (std::size_t i = 0; i < n; ++i)
    if (b.bond[i] == Bond::plane && curved[i]) b.bond[i] = Bond::rim;
  std::vector<Index> degree(n, 0);
  const auto twin = mesh::twins(s.cells, s.node_count());
  for (Index h = 0; h < static_cast<Index>(twin.size()); ++h) {
    const Index g = twin[static_cast<std::size_t>(h)];
    if (g >= 0 && s.region_of(h / 3) == s.region_of(g / 3)) continue;
    const auto e = mesh::half_edge(s.cells, h);
    const auto node = static_cast<std::size_t>(e.from);
    if (b.bond[node] != Bond::rim) continue;
    if (degree[node] < 2) b.along[node][static_cast<std::size_t>(degree[node])] = e.to;
    ++degree[node];
  }
  // each rim edge is met once from either of its triangles: two edges, two half-edges that leave the node
  for (std::size_t i = 0; i < n; ++i)
    if (b.bond[i] == Bond::rim && (degree[i] != 2 || b.along[i][0] == b.along[i][1]))
      b.bond[i] = Bond::corner;
  return b;
}

}  // namespace tunica::meshing
