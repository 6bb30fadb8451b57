// SPDX-License-Identifier: MIT
// Exact test of a triangle surface for self-intersection.
#pragma once

#include "tunica/core/error.hpp"
#include "tunica/core/text.hpp"
#include "tunica/core/vec.hpp"
#include "tunica/mesh/measures.hpp"
#include "tunica/meshing/open_stars.hpp"
#include "tunica/meshing/triangles_cross.hpp"
#include "tunica/search/octree.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace tunica::meshing {

/// Pairs (i < j) of triangles that cross or touch other than in a common node or edge, in ascending order; a
/// triangle without area is paired with itself. At most the first `limit` of them. Exact, O(n log n) on
/// surfaces.
[[nodiscard]] inline std::vector<std::pair<Index, Index>> self_intersections(
    const mesh::Surface& s, std::size_t limit = std::numeric_limits<std::size_t>::max()) {
  const auto stars = detail::open_stars(s);
  const auto count = static_cast<std::size_t>(s.cell_count());
  std::vector<std::uint64_t> found;  // i << 32 | j
  const auto put = [&](Index i, Index j) {
    found.push_back(static_cast<std::uint64_t>(i) << 32U | static_cast<std::uint64_t>(j));
  };
  std::vector<Box> boxes(count);
  std::vector<std::array<Index, 3>> settled(count);  // corners of open stars, other numbers for the others
  Index other = -1;
  for (std::size_t t = 0; t < count; ++t) {
    const auto cell = static_cast<Index>(t);
    const mesh::Triangle f = mesh::triangle(s, cell);
    const bool flat = stars.unknown[t] && detail::projection_axis(f) < 0;
    if (flat)
      put(cell, cell);
    else
      boxes[t] = f.box();
    for (int k = 0; k < 3; ++k) {
      const Index n = s.cells(k, cell);
      settled[t][static_cast<std::size_t>(k)] = stars.open[static_cast<std::size_t>(n)] ? n : other--;
    }
  }
  const auto position = [&](Index n) { return vec::column(s.nodes, n); };
  const auto nodes = [&](Index t) {
    return std::array<Index, 3>{s.cells(0, t), s.cells(1, t), s.cells(2, t)};
  };
  search::Octree(std::move(boxes)).pairs([&](Index t, Index u) {
    bool apart = false;  // in the open star of a common corner
    for (const Index n : settled[static_cast<std::size_t>(t)])
      for (const Index m : settled[static_cast<std::size_t>(u)]) apart |= n == m;
    if (!apart && cross(nodes(t), nodes(u), position)) put(t, u);
  });
  std::sort(found.begin(), found.end());
  if (found.size() > limit) found.resize(limit);
  std::vector<std::pair<Index, Index>> pairs;
  for (const std::uint64_t f : found)
    pairs.emplace_back(static_cast<Index>(f >> 32U), static_cast<Index>(f & 0xFFFFFFFFU));
  return pairs;
}

/// MeshError, with a place, where a surface crosses itself.
inline void require_no_crossing(const mesh::Surface& s) {
  const auto pairs = self_intersections(s, 1);
  if (pairs.empty()) return;
  const auto& [t, u] = pairs.front();
  throw MeshError("the surface crosses itself at " + place(mesh::triangle(s, t).centroid()) + ": triangles " +
                  std::to_string(t) + " and " + std::to_string(u));
}

}  // namespace tunica::meshing
