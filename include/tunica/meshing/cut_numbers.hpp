// SPDX-License-Identifier: MIT
// The cut edges of a grid, numbered slice by slice and row by row: the number of an edge is its rank.
#pragma once

#include "tunica/core/parallel.hpp"
#include "tunica/core/types.hpp"
#include "tunica/meshing/sign_bits.hpp"

#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace tunica::meshing {

/// The cut edges of word w of a row, towards +x, +y and +z, a bit at the lower node of each.
struct CutWords {
  std::uint64_t x, y, z;
};

/// Order: the flat edges of slice 0; then for each slice k > 0 its flat edges and the upright ones from slice
/// k - 1. Flat edges row by row, those along x before those along y.
class CutNumbers {
 public:
  CutNumbers(const SignBits& bits, std::size_t ny, std::size_t nz)
      : bits_(bits),
        ny_(ny),
        nz_(nz),
        rows_(std::make_unique_for_overwrite<Starts[]>((ny + 1) * nz)),
        slice_(nz + 1) {
    parallel_chunks(static_cast<std::ptrdiff_t>(nz), slices_a_chunk,
                    [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
                      for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k)
                        count_slice(k);
                    });
    for (std::size_t k = 0; k < nz; ++k) {
      slice_[k].flat = count_;
      count_ += rows_[(ny_ + 1) * k + ny_].x;
      slice_[k].upright = count_;  // of the slice before
      if (k > 0) count_ += rows_[(ny_ + 1) * (k - 1) + ny_].z;
    }
  }

  [[nodiscard]] Index count() const { return count_; }

  /// Numbers of the first cut edges of a row in +x, +y and +z; those of row ny are beyond the slice.
  struct Starts {
    Index x, y, z;
  };
  [[nodiscard]] Starts starts(std::size_t j, std::size_t k) const {
    const Starts& r = rows_[j + (ny_ + 1) * k];
    const Index flat = slice_[k].flat, upright = k + 1 < nz_ ? slice_[k + 1].upright : count_;
    return {flat + r.x, flat + r.y, upright + r.z};
  }

  [[nodiscard]] CutWords words(std::size_t w, std::size_t j, std::size_t k) const {
    const std::uint64_t* row = bits_.row(j, k);
    return {.x = (row[w] ^ bits_.next(row, w)) & bits_.with_next(w),
            .y = j + 1 < ny_ ? row[w] ^ bits_.row(j + 1, k)[w] : 0,
            .z = k + 1 < nz_ ? row[w] ^ bits_.row(j, k + 1)[w] : 0};
  }

  /// Of one cut edge, from node (i, j, k) in +axis.
  [[nodiscard]] Index number(std::size_t axis, std::size_t i, std::size_t j, std::size_t k) const {
    const Starts s = starts(j, k);
    Index n = axis == 0 ? s.x : axis == 1 ? s.y : s.z;
    const std::uint64_t* row = bits_.row(j, k);
    const std::uint64_t* other = axis == 1 ? bits_.row(j + 1, k) : axis == 2 ? bits_.row(j, k + 1) : nullptr;
    const auto cuts = [&](std::size_t w) {
      return row[w] ^ (axis == 0 ? bits_.next(row, w) : other[w]);  // i has a neighbour: so has all before
    };
    const std::size_t last = i / detail::word_bits;
    for (std::size_t w = 0; w < last; ++w) n += detail::bits_set(cuts(w));
    n += detail::bits_set(cuts(last) & detail::first_bits(i % detail::word_bits));
    return n;
  }

 private:
  static constexpr std::ptrdiff_t slices_a_chunk = 4;

  struct SliceStarts {
    Index flat, upright;
  };

  /// Starts of the rows of a slice as if it were the first.
  void count_slice(std::size_t k) {
    Starts* row = rows_.get() + (ny_ + 1) * k;
    Index flat = 0, upright = 0;
    for (std::size_t j = 0; j < ny_; ++j) {
      unsigned sides = bits_.sides(j, k);
      if (j + 1 < ny_) sides |= bits_.sides(j + 1, k);
      if (k + 1 < nz_) sides |= bits_.sides(j, k + 1);
      int x = 0, y = 0, z = 0;
      if (sides == SignBits::both_sides)
        for (std::size_t w = 0; w < bits_.words(); ++w) {
          const CutWords cuts = words(w, j, k);
          if ((cuts.x | cuts.y | cuts.z) == 0) continue;
          x += detail::bits_set(cuts.x), y += detail::bits_set(cuts.y), z += detail::bits_set(cuts.z);
        }
      row[j] = {flat, flat + x, upright};
      flat += x + y, upright += z;
    }
    row[ny_] = {flat, flat, upright};
  }

  const SignBits& bits_;
  std::size_t ny_, nz_;
  Index count_ = 0;
  std::unique_ptr<Starts[]> rows_;  // ny + 1 a slice, without what comes before the slice
  std::vector<SliceStarts> slice_;  // flat: of the slice; upright: of the slice before
};

}  // namespace tunica::meshing
