// SPDX-License-Identifier: MIT
// Which inside corners of a grid cell hang together as its loops part them: one node of the dual lattice
// each.
#pragma once

#include "tunica/meshing/cell_loops.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

namespace tunica::meshing::detail {

/// Part of each corner of a cell (-1: outside), and how many parts there are.
struct CellParts {
  std::array<std::int8_t, 8> part{};
  std::int8_t count = 0;
};

/// Inside corners are joined by edges of the cell, and across ambiguous faces whose strands cut off the
/// outside corners. Where all strands of such a face are one loop they cut off the inside ones (cell_loops).
[[nodiscard]] inline CellParts cell_parts(unsigned signs, const CellLoops& loops) {
  std::array<std::int8_t, 8> root{0, 1, 2, 3, 4, 5, 6, 7};
  const auto join = [&](int p, int q) {
    const std::int8_t r = root[static_cast<std::size_t>(p)], s = root[static_cast<std::size_t>(q)];
    const std::int8_t low = r < s ? r : s, high = r < s ? s : r;
    for (auto& x : root)
      if (x == high) x = low;
  };
  for (const auto& e : cell_tables.edge_corners)
    if (corner_inside(signs, e[0]) && corner_inside(signs, e[1])) join(e[0], e[1]);
  for (std::size_t f = 0; f < 6; ++f) {
    if (!ambiguous(signs, f) || strands_meet(loops, f)) continue;
    const auto& e = cell_tables.face_edges[f];
    const auto& c = cell_tables.face_corners[f];
    const auto loop = [&](int n) {
      return loops.loop[static_cast<std::size_t>(e[static_cast<std::size_t>(n)])];
    };
    const bool cut_odd = loop(0) == loop(1), even_inside = corner_inside(signs, c[0]);
    if (cut_odd == even_inside) join(even_inside ? c[0] : c[1], even_inside ? c[2] : c[3]);
  }
  CellParts parts;
  for (int c = 0; c < 8; ++c) {
    const auto at = static_cast<std::size_t>(c);
    parts.part[at] = -1;
    if (!corner_inside(signs, c)) continue;
    parts.part[at] = root[at] == c ? parts.count++ : parts.part[static_cast<std::size_t>(root[at])];
  }
  return parts;
}

}  // namespace tunica::meshing::detail
