// SPDX-License-Identifier: MIT
// From the cells of a row to triangles: the numbers of their cut edges go along with the cells.
#pragma once

#include "tunica/core/types.hpp"
#include "tunica/meshing/cell_loops.hpp"
#include "tunica/meshing/marching_cubes_table.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

#if defined(__AVX512F__)
#include <immintrin.h>
#endif

namespace tunica::meshing::detail {

/// Numbers of the next cut edges of a row of cells: in +x from the node rows (y, z), (y + 1, z), (y, z + 1),
/// (y + 1, z + 1), in +y from (y, z) and (y, z + 1), in +z from (y, z) and (y + 1, z).
using RowEdges = std::array<Index, 8>;

/// For each case: what its cell adds to the numbers of its row, and its triangles as places in a list of the
/// eight numbers before that and the eight after.
struct MarchingSteps {
  static constexpr std::size_t longest = 15;  // five triangles
  struct Case {
    alignas(32) RowEdges step{};
    alignas(16) std::array<std::uint8_t, longest> place{};
    std::uint8_t count = 0;  // of places
  };
  std::array<Case, 256> of{};

  MarchingSteps() {
    const auto& table = marching_table();
    for (unsigned signs = 0; signs < 256; ++signs) {
      Case& c = of[signs];
      for (std::size_t e = 0; e < 12; ++e)
        if (const auto& ends = cell_tables.edge_corners[e];
            place_of[e] < 8 && corner_inside(signs, ends[0]) != corner_inside(signs, ends[1]))
          c.step[place_of[e]] = 1;
      for (std::size_t t = 0; t < static_cast<std::size_t>(table[signs].count); ++t)
        for (const std::int8_t e : table[signs].triangle[t])
          c.place[c.count++] = place_of[static_cast<std::size_t>(e)];
    }
  }

  /// Where the number of an edge of the cell is: edges at the upper x have those of the next cell.
  static constexpr std::array<std::uint8_t, 12> place_of{0, 1, 2, 3, 4, 5, 12, 13, 6, 14, 7, 15};
};

[[nodiscard]] inline const MarchingSteps& marching_steps() {
  static const MarchingSteps steps;
  return steps;
}

#if defined(__AVX512F__)
/// The same as write_triangles, as long as there is room for 16 numbers: signs, at and out move on.
inline void write_triangles_at_once(const std::uint8_t*& signs, const std::uint8_t* end, RowEdges& at,
                                    const MarchingSteps& steps, Index*& out, const Index* limit) {
  constexpr __mmask16 all = 0xffff;
  __m256i before = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(at.data()));
  for (; signs != end && limit - out >= 16; ++signs) {
    const MarchingSteps::Case& c = steps.of[*signs];
    const auto* step = reinterpret_cast<const __m256i*>(c.step.data());
    const auto* place = reinterpret_cast<const __m128i*>(c.place.data());
    const __m256i after = _mm256_add_epi32(before, _mm256_load_si256(step));
    const __m512i number = _mm512_maskz_inserti64x4(0xff, _mm512_castsi256_si512(before), after, 1);
    const __m512i places = _mm512_maskz_cvtepu8_epi32(all, _mm_load_si128(place));
    _mm512_storeu_si512(out, _mm512_maskz_permutexvar_epi32(all, places, number));
    before = after;
    out += c.count;
  }
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(at.data()), before);
}
#endif

/// The triangles of a row of cells, three numbers each, written from `out` on. Beyond them, but before
/// `limit`, anything may be written. Returns the end of the triangles.
[[nodiscard]] inline Index* write_triangles(const std::uint8_t* signs, Index cells, RowEdges at,
                                            const MarchingSteps& steps, Index* out, const Index* limit) {
  const std::uint8_t* end = signs + cells;
#if defined(__AVX512F__)
  write_triangles_at_once(signs, end, at, steps, out, limit);
#endif
  constexpr std::ptrdiff_t at_once = 12;  // one case in eight has more
  alignas(16) std::array<Index, 16> number;
  for (; signs != end; ++signs) {
    const MarchingSteps::Case& c = steps.of[*signs];
    for (std::size_t n = 0; n < 8; ++n) number[n] = at[n];
    for (std::size_t n = 0; n < 8; ++n) number[8 + n] = at[n] += c.step[n];
    std::size_t n = 0;
    if (limit - out >= at_once)
      for (; n < at_once; ++n) out[n] = number[c.place[n]];
    for (; n < c.count; ++n) out[n] = number[c.place[n]];
    out += c.count;
  }
  return out;
}

}  // namespace tunica::meshing::detail
