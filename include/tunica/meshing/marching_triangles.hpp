// SPDX-License-Identifier: MIT
// From the cells of a row to triangles: the numbers of their cut edges go along with the cells.
#pragma once

#include "tunica/core/types.hpp"
#include "tunica/meshing/cell_loops.hpp"
#include "tunica/meshing/marching_cubes_table.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

namespace tunica::meshing::detail {

/// Numbers of the next cut edges of a row of cells: in +x from the node rows (y, z), (y + 1, z), (y, z + 1),
/// (y + 1, z + 1), in +y from (y, z) and (y, z + 1), in +z from (y, z) and (y + 1, z).
using RowEdges = std::array<Index, 8>;

/// For each case: what its cell adds to the numbers of its row, and its triangles as places in a list of
/// the numbers before and, from the fifth on, after that.
struct MarchingSteps {
  static constexpr std::size_t longest = 15;  // five triangles
  struct Case {
    alignas(16) RowEdges step{};
    std::array<std::uint8_t, longest> place{};
    std::uint8_t count = 0;  // of places
  };
  std::array<Case, 256> of{};

  MarchingSteps() {
    const auto& table = marching_table();
    for (unsigned signs = 0; signs < 256; ++signs) {
      for (std::size_t e = 0; e < 12; ++e)
        if (const auto& ends = cell_tables.edge_corners[e];
            place_of(e) < 8 && corner_inside(signs, ends[0]) != corner_inside(signs, ends[1]))
          of[signs].step[place_of(e)] = 1;
      for (std::size_t t = 0; t < static_cast<std::size_t>(table[signs].count); ++t)
        for (const std::int8_t e : table[signs].triangle[t])
          of[signs].place[of[signs].count++] =
              static_cast<std::uint8_t>(place_of(static_cast<std::size_t>(e)));
    }
  }

  /// The edges of a cell in the list: those of its lower x first, then the four of its upper x.
  [[nodiscard]] static constexpr std::size_t place_of(std::size_t edge) {
    constexpr std::array<std::size_t, 12> place{0, 1, 2, 3, 4, 5, 8, 9, 6, 10, 7, 11};
    return place[edge];
  }
};

[[nodiscard]] inline const MarchingSteps& marching_steps() {
  static const MarchingSteps steps;
  return steps;
}

/// The triangles of a row of cells, three numbers each, written from `out` on. Beyond them, but before
/// `limit`, anything may be written. Returns the end of the triangles.
[[nodiscard]] inline Index* write_triangles(const std::uint8_t* signs, Index cells, const RowEdges& start,
                                            const MarchingSteps& steps, Index* out, const Index* limit) {
  constexpr std::ptrdiff_t at_once = 12;
  alignas(16) std::array<Index, 12> number;
  alignas(16) RowEdges at = start;
  for (const std::uint8_t* end = signs + cells; signs != end; ++signs) {
    const MarchingSteps::Case& c = steps.of[*signs];
    for (std::size_t n = 0; n < 8; ++n) number[n] = at[n];
    for (std::size_t n = 0; n < 8; ++n) at[n] += c.step[n];
    for (std::size_t n = 0; n < 4; ++n) number[8 + n] = at[4 + n];
    std::size_t n = 0;
    if (limit - out >= at_once)
      for (; n < at_once; ++n) out[n] = number[c.place[n]];
    for (; n < c.count; ++n) out[n] = number[c.place[n]];
    out += c.count;
  }
  return out;
}

}  // namespace tunica::meshing::detail
