// SPDX-License-Identifier: MIT
// The cells that a contour passes, row by row, a byte each: which of their corners are inside.
#pragma once

#include "tunica/core/types.hpp"
#include "tunica/meshing/marching_cubes_table.hpp"
#include "tunica/meshing/sign_bits.hpp"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#if defined(__AVX512VBMI2__) && defined(__AVX512BW__)
#include <immintrin.h>
#endif

namespace tunica::meshing::detail {

/// Cells between slices begin and end of the grid, those whose corners are not all alike.
class MarchingCells {
 public:
  MarchingCells() = default;
  MarchingCells(const SignBits& bits, std::size_t nx, std::size_t ny, std::size_t begin, std::size_t end)
      : in_row_(std::make_unique_for_overwrite<Index[]>((ny - 1) * (end - begin))) {
    const auto& table = marching_table();
    std::size_t size = 0;
    Index* count = in_row_.get();
    for (std::size_t k = begin; k < end; ++k)
      for (std::size_t j = 0; j + 1 < ny; ++j) {
        const unsigned sides =
            bits.sides(j, k) | bits.sides(j + 1, k) | bits.sides(j, k + 1) | bits.sides(j + 1, k + 1);
        const std::size_t first = size;
        if (sides == SignBits::both_sides) {
          if (signs_.size() < size + nx + word_bits) signs_.resize(2 * (signs_.size() + nx) + word_bits);
          size = add_row(bits, j, k, size);
        }
        *count++ = static_cast<Index>(size - first);
      }
    for (std::size_t n = 0; n < size; ++n) triangles_ += table[signs_[n]].count;
  }

  /// Bit x + 2 y + 4 z: corner (x, y, z) is inside.
  [[nodiscard]] const std::uint8_t* signs() const { return signs_.data(); }
  /// How many cells each row has.
  [[nodiscard]] const Index* in_row() const { return in_row_.get(); }
  [[nodiscard]] Index triangles() const { return triangles_; }

 private:
  /// Adds the cells of a row behind the `size` ones there are; how many there are then.
  std::size_t add_row(const SignBits& bits, std::size_t j, std::size_t k, std::size_t size) {
    const std::array<const std::uint64_t*, 4> row{bits.row(j, k), bits.row(j + 1, k), bits.row(j, k + 1),
                                                  bits.row(j + 1, k + 1)};
    std::uint8_t* out = signs_.data() + size;
    for (std::size_t w = 0; w < bits.words(); ++w) {
      const std::array<std::uint64_t, 4> low{row[0][w], row[1][w], row[2][w], row[3][w]};
      const std::array<std::uint64_t, 4> high{bits.next(row[0], w), bits.next(row[1], w),
                                              bits.next(row[2], w), bits.next(row[3], w)};
      const std::uint64_t mixed =
          ((low[0] | low[1] | low[2] | low[3] | high[0] | high[1] | high[2] | high[3]) &
           ~(low[0] & low[1] & low[2] & low[3] & high[0] & high[1] & high[2] & high[3])) &
          bits.with_next(w);
      if (mixed != 0) out = write_signs(low, high, mixed, out);
    }
    return static_cast<std::size_t>(out - signs_.data());
  }

  /// Of the cells of a word that are mixed; bit n of low and high: the corners of cell n on its four edges in
  /// +x.
  static std::uint8_t* write_signs(const std::array<std::uint64_t, 4>& low,
                                   const std::array<std::uint64_t, 4>& high, std::uint64_t mixed,
                                   std::uint8_t* out) {
#if defined(__AVX512VBMI2__) && defined(__AVX512BW__)
    __m512i signs = _mm512_setzero_si512();
    for (unsigned r = 0; r < 4; ++r) {
      signs = _mm512_mask_add_epi8(signs, low[r], signs, _mm512_set1_epi8(static_cast<char>(1U << 2 * r)));
      signs = _mm512_mask_add_epi8(signs, high[r], signs, _mm512_set1_epi8(static_cast<char>(2U << 2 * r)));
    }
    _mm512_storeu_si512(out, _mm512_maskz_compress_epi8(mixed, signs));
    return out + bits_set(mixed);
#else
    for (; mixed != 0; mixed &= mixed - 1) {
      const auto n = static_cast<unsigned>(std::countr_zero(mixed));
      unsigned signs = 0;
      for (unsigned r = 0; r < 4; ++r)
        signs |= static_cast<unsigned>((low[r] >> n & 1U) | (high[r] >> n & 1U) << 1U) << 2 * r;
      *out++ = static_cast<std::uint8_t>(signs);
    }
    return out;
#endif
  }

  std::vector<std::uint8_t> signs_;  // and room for a word of cells
  std::unique_ptr<Index[]> in_row_;
  Index triangles_ = 0;
};

}  // namespace tunica::meshing::detail
