// SPDX-License-Identifier: MIT
// Chunks of cells in colours: no two chunks of a colour share a node, so they may add to the same matrix at
// once.
#pragma once

#include "tunica/core/parallel.hpp"
#include "tunica/core/types.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tunica::fem {

/// Chunks and colours depend on the mesh alone; so do the order of every sum at a node and its bits.
class CellChunks {
 public:
  /// Chunks are a multiple of `lanes` cells long; the last one may be shorter.
  template <int Nodes>
  CellChunks(const Connectivity<Nodes>& cells, Index node_count, Index lanes = 1)
      : cells_(static_cast<Index>(cells.cols())) {
    constexpr int colours = 64;  // a chunk that finds none of them free gets a colour of its own
    // 64 chunks or more where the mesh allows: each colour has work for several threads.
    size_ = (std::clamp<Index>(cells_ / 64, 16, 1024) + lanes - 1) / lanes * lanes;
    const Index chunks = (cells_ + size_ - 1) / size_;
    std::vector<std::uint64_t> used(static_cast<std::size_t>(node_count), 0);
    std::array<std::vector<Index>, colours> of_colour;
    std::vector<Index> alone;
    for (Index k = 0; k < chunks; ++k) {
      const Index end = std::min(cells_, (k + 1) * size_);
      std::uint64_t taken = 0;
      for (Index e = k * size_; e < end; ++e)
        for (int a = 0; a < Nodes; ++a) taken |= used[static_cast<std::size_t>(cells(a, e))];
      const int colour = std::countr_one(taken);
      if (colour == colours) {
        alone.push_back(k);
        continue;
      }
      for (Index e = k * size_; e < end; ++e)
        for (int a = 0; a < Nodes; ++a)
          used[static_cast<std::size_t>(cells(a, e))] |= std::uint64_t{1} << colour;
      of_colour[static_cast<std::size_t>(colour)].push_back(k);
    }
    colour_start_.assign(1, 0);
    for (const auto& list : of_colour) {
      if (list.empty()) continue;
      chunk_.insert(chunk_.end(), list.begin(), list.end());
      colour_start_.push_back(chunk_.size());
    }
    for (const Index k : alone) {
      chunk_.push_back(k);
      colour_start_.push_back(chunk_.size());
    }
  }

  /// body(begin, end) for every chunk of cells, colour by colour.
  template <class Body>
  void for_each(Body&& body) const {
    for (std::size_t colour = 0; colour + 1 < colour_start_.size(); ++colour) {
      const std::size_t first = colour_start_[colour];
      const auto chunks = static_cast<std::ptrdiff_t>(colour_start_[colour + 1] - first);
      parallel_chunks(chunks, 1, [&](std::ptrdiff_t b, std::ptrdiff_t) {
        const Index begin = chunk_[first + static_cast<std::size_t>(b)] * size_;
        body(begin, std::min(begin + size_, cells_));
      });
    }
  }

 private:
  Index cells_, size_ = 1;
  std::vector<Index> chunk_;               // chunk numbers, colour by colour
  std::vector<std::size_t> colour_start_;  // in chunk_
};

}  // namespace tunica::fem
