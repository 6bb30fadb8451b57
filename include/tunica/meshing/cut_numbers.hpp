// SPDX-License-Identifier: MIT
// The cut edges of a grid, numbered slice by slice and row by row: the number of an edge is its rank.
#pragma once

#include "tunica/core/parallel.hpp"
#include "tunica/core/types.hpp"
#include "tunica/meshing/sign_bits.hpp"

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tunica::meshing {

/// The cut edges of word w of a row, towards +x, +y and +z, a bit at the lower node of each.
struct CutWords {
  std::uint64_t x, y, z;
};

/// Order: the flat edges (x before y at a node) of slice 0; then for each slice k > 0 its flat edges and the
/// upright ones from slice k - 1.
class CutNumbers {
 public:
  CutNumbers(const SignBits& bits, std::size_t ny, std::size_t nz)
      : bits_(bits),
        ny_(ny),
        nz_(nz),
        flat_(ny * nz, 0),
        upright_(ny * nz, 0),
        flat_end_(nz),
        upright_end_(nz) {
    const auto rows = static_cast<std::ptrdiff_t>(ny * nz);
    parallel_chunks(rows, detail::rows_a_chunk, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      for (auto r = static_cast<std::size_t>(begin); r < static_cast<std::size_t>(end); ++r) {
        const std::size_t j = r % ny_, k = r / ny_;
        const bool here = bits_.any(j, k);
        if (!here && !(j + 1 < ny_ && bits_.any(j + 1, k)) && !(k + 1 < nz_ && bits_.any(j, k + 1))) continue;
        int flat = 0, upright = 0;
        for (std::size_t w = 0; w < bits_.words(); ++w) {
          const CutWords cuts = words(w, j, k);
          if (cuts.x != 0) flat += std::popcount(cuts.x);
          if (cuts.y != 0) flat += std::popcount(cuts.y);
          if (cuts.z != 0) upright += std::popcount(cuts.z);
        }
        flat_[r] = flat, upright_[r] = upright;
      }
    });
    const auto rank = [&](std::vector<Index>& of, std::vector<Index>& end, std::size_t k) {
      for (std::size_t r = ny_ * k; r < ny_ * (k + 1); ++r) {
        const Index n = of[r];
        of[r] = count_;
        count_ += n;
      }
      end[k] = count_;
    };
    rank(flat_, flat_end_, 0);
    for (std::size_t k = 1; k < nz_; ++k) rank(flat_, flat_end_, k), rank(upright_, upright_end_, k - 1);
  }

  [[nodiscard]] Index count() const { return count_; }
  /// The cut edges of a row: numbers first .. end - 1.
  struct Range {
    Index first, end;
  };
  [[nodiscard]] Range flat(std::size_t j, std::size_t k) const { return range(flat_, flat_end_, j, k); }
  [[nodiscard]] Range upright(std::size_t j, std::size_t k) const {
    return range(upright_, upright_end_, j, k);
  }

  [[nodiscard]] CutWords words(std::size_t w, std::size_t j, std::size_t k) const {
    const std::uint64_t* row = bits_.row(j, k);
    return {.x = (row[w] ^ bits_.next(row, w)) & bits_.with_next(w),
            .y = j + 1 < ny_ ? row[w] ^ bits_.row(j + 1, k)[w] : 0,
            .z = k + 1 < nz_ ? row[w] ^ bits_.row(j, k + 1)[w] : 0};
  }

  /// Of one cut edge, from node (i, j, k) in +axis.
  [[nodiscard]] Index number(std::size_t axis, std::size_t i, std::size_t j, std::size_t k) const {
    Index n = axis == 2 ? upright(j, k).first : flat(j, k).first;
    for (std::size_t w = 0; w <= i / detail::word_bits; ++w) {
      CutWords cuts = words(w, j, k);
      if (w == i / detail::word_bits) {
        const std::uint64_t bit = std::uint64_t{1} << i % detail::word_bits, below = bit - 1;
        if (axis == 1 && (cuts.x & bit) != 0) ++n;
        cuts.x &= below, cuts.y &= below, cuts.z &= below;
      }
      n += axis == 2 ? std::popcount(cuts.z) : std::popcount(cuts.x) + std::popcount(cuts.y);
    }
    return n;
  }

 private:
  [[nodiscard]] Range range(const std::vector<Index>& first, const std::vector<Index>& end, std::size_t j,
                            std::size_t k) const {
    const std::size_t r = j + ny_ * k;
    return {first[r], j + 1 < ny_ ? first[r + 1] : end[k]};
  }

  const SignBits& bits_;
  std::size_t ny_, nz_;
  Index count_ = 0;
  std::vector<Index> flat_, upright_;          // number of the first cut edge of a row
  std::vector<Index> flat_end_, upright_end_;  // beyond the last of a slice
};

}  // namespace tunica::meshing
