// SPDX-License-Identifier: MIT
// Which nodes of a grid are inside, a bit each, with a layer of outside nodes around it: what is inside ends
// within the layer, and every surface is closed.
#pragma once

#include "tunica/core/parallel.hpp"
#include "tunica/meshing/sign_bits.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tunica::meshing::detail {

/// Node (i, j, k) of the grid is (i + 1, j + 1, k + 1) here.
class PaddedBits {
 public:
  PaddedBits(const SignBits& bits, const std::array<std::size_t, 3>& size)
      : size_{size[0] + 2, size[1] + 2, size[2] + 2},
        words_((size_[0] + word_bits - 1) / word_bits),
        bits_(words_ * size_[1] * size_[2], 0),
        any_(size_[1] * size_[2], 0) {
    parallel_chunks(static_cast<std::ptrdiff_t>(size[1] * size[2]), rows_a_chunk,
                    [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
                      for (auto r = static_cast<std::size_t>(begin); r < static_cast<std::size_t>(end); ++r) {
                        const std::size_t j = r % size[1], k = r / size[1];
                        if (!bits.any(j, k)) continue;
                        const std::uint64_t* from = bits.row(j, k);
                        const std::size_t row = j + 1 + size_[1] * (k + 1);
                        std::uint64_t carried = 0;
                        for (std::size_t w = 0; w < words_; ++w) {
                          const std::uint64_t word = w < bits.words() ? from[w] : 0;
                          bits_[words_ * row + w] = word << 1U | carried;
                          carried = word >> (word_bits - 1);
                        }
                        any_[row] = 1;
                      }
                    });
  }

  /// A byte a node, other than 0 inside; the layer is there already.
  PaddedBits(const std::vector<std::uint8_t>& inside, const std::array<std::size_t, 3>& size)
      : size_(size),
        words_((size[0] + word_bits - 1) / word_bits),
        bits_(words_ * size[1] * size[2], 0),
        any_(size[1] * size[2], 0) {
    for (std::size_t r = 0; r < size[1] * size[2]; ++r)
      for (std::size_t i = 0; i < size[0]; ++i) {
        if (inside[i + size[0] * r] == 0) continue;
        bits_[words_ * r + i / word_bits] |= std::uint64_t{1} << i % word_bits;
        any_[r] = 1;
      }
  }

  [[nodiscard]] std::size_t size(std::size_t axis) const { return size_[axis]; }
  [[nodiscard]] std::size_t words() const { return words_; }  // a row
  [[nodiscard]] const std::uint64_t* row(std::size_t j, std::size_t k) const {
    return bits_.data() + words_ * (j + size_[1] * k);
  }
  /// Some node of the row may be inside.
  [[nodiscard]] bool any(std::size_t j, std::size_t k) const { return any_[j + size_[1] * k] != 0; }
  [[nodiscard]] bool inside(std::size_t i, std::size_t j, std::size_t k) const {
    return (row(j, k)[i / word_bits] >> i % word_bits & 1U) != 0;
  }
  /// All nodes of the grid are inside, or none.
  [[nodiscard]] bool alike() const {
    std::size_t count = 0;
    for (const std::uint64_t word : bits_) count += static_cast<std::size_t>(std::popcount(word));
    return count == 0 || count == (size_[0] - 2) * (size_[1] - 2) * (size_[2] - 2);
  }
  void drop(std::size_t i, std::size_t j, std::size_t k) {
    bits_[words_ * (j + size_[1] * k) + i / word_bits] &= ~(std::uint64_t{1} << i % word_bits);
  }

  /// Word w of a row moved down by a node: bit n is that of node n + 1.
  [[nodiscard]] std::uint64_t next(const std::uint64_t* row, std::size_t w) const {
    return row[w] >> 1U | (w + 1 < words_ ? row[w + 1] << (word_bits - 1) : 0U);
  }
  /// The nodes of word w that have a neighbour in +x.
  [[nodiscard]] std::uint64_t with_next(std::size_t w) const {
    const std::size_t count = size_[0] - 1 - std::min(size_[0] - 1, word_bits * w);
    return count >= word_bits ? ~std::uint64_t{0} : (std::uint64_t{1} << count) - 1;
  }

 private:
  std::array<std::size_t, 3> size_;
  std::size_t words_;
  std::vector<std::uint64_t> bits_;
  std::vector<std::uint8_t> any_;  // of a row
};

}  // namespace tunica::meshing::detail
