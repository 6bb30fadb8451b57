// SPDX-License-Identifier: MIT
// The dual mesh of a sign a node, bit by bit: which cells the surface passes, the vertices of each cell (one
// a sheet), and where each row of the grid has its quadrilaterals. [SCHAEFER07, 3]
#pragma once

#include "tunica/core/parallel.hpp"
#include "tunica/core/types.hpp"
#include "tunica/meshing/cell_loops.hpp"
#include "tunica/meshing/padded_bits.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tunica::meshing::detail {

/// What the signs of a cell's corners say by themselves: inside corners of ambiguous faces stay apart.
struct DualCase {
  CellLoops loops;
  std::uint8_t meeting = 0;  // faces on which both strands belong to one loop, a bit each
};

[[nodiscard]] inline const std::array<DualCase, 256>& dual_cases() {
  static const std::array<DualCase, 256> table = [] {
    std::array<DualCase, 256> t;
    for (unsigned signs = 0; signs < 256; ++signs) {
      t[signs].loops = cell_loops(signs, 0);
      for (std::size_t f = 0; f < 6; ++f)
        if (ambiguous(signs, f) && strands_meet(t[signs].loops, f))
          t[signs].meeting = static_cast<std::uint8_t>(t[signs].meeting | 1U << f);
    }
    return t;
  }();
  return table;
}

/// Cells are numbered by their lowest nodes, x fastest; vertices by cell and loop; quadrilaterals by the
/// edges that they cross, 3 * lower node + axis.
class DualTopology {
 public:
  explicit DualTopology(const PaddedBits& bits)
      : bits_(bits), nx_(bits.size(0)), ny_(bits.size(1)), nz_(bits.size(2)) {
    count();
    gather();
    separate();
    vertex_.resize(at_.size() + 1);
    Index vertex = 0;
    for (std::size_t c = 0; c < at_.size(); ++c) vertex_[c] = vertex, vertex += loops(c).count;
    vertex_[at_.size()] = vertex;
  }

  [[nodiscard]] Index vertex_count() const { return vertex_.back(); }
  [[nodiscard]] Index quad_count() const { return quad_.back(); }
  /// Ambiguous faces on which the strands are paired the other way: each adds two to the Euler number.
  [[nodiscard]] Index joined_faces() const { return joined_faces_; }

  /// The cells of row j between the slices k and k + 1: numbers first .. end - 1.
  struct Range {
    std::size_t first, end;
  };
  [[nodiscard]] Range cells(std::size_t j, std::size_t k) const {
    const std::size_t r = j + ny_ * k;
    return {cell_[r], cell_[r + 1]};
  }
  [[nodiscard]] Range cells(std::size_t k) const { return {cell_[ny_ * k], cell_[ny_ * (k + 1)]}; }
  [[nodiscard]] std::size_t i(std::size_t cell) const { return at_[cell]; }
  [[nodiscard]] const CellLoops& loops(std::size_t cell) const {
    return other_.empty() || other_[cell] == 0 ? cases_[signs_[cell]].loops : split_[other_[cell] - 1].loops;
  }
  [[nodiscard]] Index first_vertex(std::size_t cell) const { return vertex_[cell]; }
  /// Number of the first quadrilateral across an edge from row j of slice k of the nodes.
  [[nodiscard]] Index first_quad(std::size_t j, std::size_t k) const { return quad_[j + ny_ * k]; }
  [[nodiscard]] Index end_quad(std::size_t j, std::size_t k) const { return quad_[j + ny_ * k + 1]; }
  [[nodiscard]] bool any_quad(std::size_t j, std::size_t k) const {
    return first_quad(j, k) < end_quad(j, k);
  }
  /// The number of the cell with that lowest node; the surface must pass it.
  [[nodiscard]] std::size_t find(std::size_t i, std::size_t j, std::size_t k) const {
    return find(i, j + ny_ * k);
  }

  /// The crossed edges from word w of row j of slice k towards +x, +y and +z, a bit at the lower node of
  /// each.
  [[nodiscard]] std::array<std::uint64_t, 3> crossed(std::size_t w, std::size_t j, std::size_t k) const {
    const std::uint64_t* row = bits_.row(j, k);
    return {(row[w] ^ bits_.next(row, w)) & bits_.with_next(w),
            j + 1 < ny_ ? row[w] ^ bits_.row(j + 1, k)[w] : 0,
            k + 1 < nz_ ? row[w] ^ bits_.row(j, k + 1)[w] : 0};
  }

  /// What stands for each cell above slice k, at i + nx j: its vertex if there is one, else ~cell.
  void number(std::size_t k, Index* map) const {
    for (std::size_t j = 0; j + 1 < ny_; ++j) {
      const auto [first, end] = cells(j, k);
      for (std::size_t c = first; c < end; ++c)
        map[at_[c] + nx_ * j] = vertex_[c + 1] - vertex_[c] == 1 ? vertex_[c] : ~static_cast<Index>(c);
    }
  }
  /// The vertex of a cell, as it stands in the map, on the loop through that edge.
  [[nodiscard]] Index vertex(Index mapped, std::size_t edge) const {
    if (mapped >= 0) return mapped;
    const auto c = static_cast<std::size_t>(~mapped);
    return vertex_[c] + loops(c).loop[edge];
  }

 private:
  /// A bit for each cell of word w of a row that has corners of both signs.
  [[nodiscard]] std::uint64_t mixed(const std::array<const std::uint64_t*, 4>& row, std::size_t w) const {
    std::uint64_t any = 0, all = ~std::uint64_t{0};
    for (const std::uint64_t* r : row) {
      const std::uint64_t low = r[w], high = bits_.next(r, w);
      any |= low | high, all &= low & high;
    }
    return any & ~all & bits_.with_next(w);
  }
  [[nodiscard]] std::array<const std::uint64_t*, 4> rows(std::size_t j, std::size_t k) const {
    return {bits_.row(j, k), bits_.row(j + 1, k), bits_.row(j, k + 1), bits_.row(j + 1, k + 1)};
  }
  [[nodiscard]] bool quiet(std::size_t j, std::size_t k) const {
    return j + 1 >= ny_ || k + 1 >= nz_ ||
           !(bits_.any(j, k) || bits_.any(j + 1, k) || bits_.any(j, k + 1) || bits_.any(j + 1, k + 1));
  }

  void count() {
    cell_.assign(ny_ * nz_ + 1, 0);
    quad_.assign(ny_ * nz_ + 1, 0);
    parallel_chunks(static_cast<std::ptrdiff_t>(ny_ * nz_), rows_a_chunk,
                    [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
                      for (auto r = static_cast<std::size_t>(begin); r < static_cast<std::size_t>(end); ++r) {
                        const std::size_t j = r % ny_, k = r / ny_;
                        if (quiet(j, k)) continue;
                        const auto row = rows(j, k);
                        std::size_t cells = 0;
                        Index quads = 0;
                        for (std::size_t w = 0; w < bits_.words(); ++w) {
                          const std::uint64_t some = mixed(row, w);
                          if (some == 0) continue;  // an edge is crossed only beside the cell of its node
                          cells += static_cast<std::size_t>(std::popcount(some));
                          for (const std::uint64_t c : crossed(w, j, k))
                            if (c != 0) quads += std::popcount(c);
                        }
                        cell_[r + 1] = cells, quad_[r + 1] = quads;
                      }
                    });
    for (std::size_t r = 0; r < ny_ * nz_; ++r) cell_[r + 1] += cell_[r], quad_[r + 1] += quad_[r];
  }

  void gather() {
    at_.resize(cell_.back()), signs_.resize(cell_.back());
    parallel_chunks(
        static_cast<std::ptrdiff_t>(ny_ * nz_), rows_a_chunk, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
          for (auto r = static_cast<std::size_t>(begin); r < static_cast<std::size_t>(end); ++r) {
            if (cell_[r] == cell_[r + 1]) continue;
            const auto row = rows(r % ny_, r / ny_);
            std::size_t c = cell_[r];
            for (std::size_t w = 0; w < bits_.words(); ++w) {
              std::array<std::uint64_t, 4> high;
              for (std::size_t n = 0; n < 4; ++n) high[n] = bits_.next(row[n], w);
              for (std::uint64_t some = mixed(row, w); some != 0; some &= some - 1, ++c) {
                const auto n = static_cast<unsigned>(std::countr_zero(some));
                unsigned signs = 0;  // corner (x, y, z) is bit x + 2 y + 4 z
                for (unsigned q = 0; q < 4; ++q)
                  signs |= static_cast<unsigned>((row[q][w] >> n & 1U) | (high[q] >> n & 1U) << 1U) << 2 * q;
                at_[c] = static_cast<std::uint32_t>(word_bits * w + n);
                signs_[c] = static_cast<std::uint8_t>(signs);
              }
            }
          }
        });
  }

  /// An edge of the dual mesh would be shared by four quadrilaterals where all strands on an ambiguous face
  /// are one loop in both of its cells. There the strands are paired the other way: that splits an oriented
  /// loop in two, in both cells, and so never makes another such face.
  void separate() {
    constexpr unsigned high_faces = 0b101010;
    for (std::size_t r = 0; r < ny_ * nz_; ++r)
      for (std::size_t c = cell_[r]; c < cell_[r + 1]; ++c)
        if ((cases_[signs_[c]].meeting & high_faces) != 0)
          for (std::size_t a = 0; a < 3; ++a) {
            const std::size_t high = 2 * a + 1, low = 2 * a;
            if ((cases_[signs_[c]].meeting >> high & 1U) == 0 || !strands_meet(loops(c), high)) continue;
            const std::size_t d = a == 0 ? c + 1 : find(at_[c], r + (a == 1 ? 1 : ny_));
            if (!strands_meet(loops(d), low)) continue;
            split(c, high), split(d, low);
            ++joined_faces_;
          }
  }

  [[nodiscard]] std::size_t find(std::size_t i, std::size_t row) const {
    const auto from = at_.begin() + static_cast<std::ptrdiff_t>(cell_[row]),
               to = at_.begin() + static_cast<std::ptrdiff_t>(cell_[row + 1]);
    return static_cast<std::size_t>(std::lower_bound(from, to, static_cast<std::uint32_t>(i)) - at_.begin());
  }

  void split(std::size_t c, std::size_t face) {
    if (other_.empty()) other_.resize(at_.size(), 0);
    if (other_[c] == 0) split_.push_back({}), other_[c] = static_cast<std::uint32_t>(split_.size());
    Split& s = split_[other_[c] - 1];
    s.joined |= 1U << face;
    s.loops = cell_loops(signs_[c], s.joined);
  }

  struct Split {
    CellLoops loops;
    unsigned joined = 0;  // faces
  };

  const PaddedBits& bits_;
  const std::array<DualCase, 256>& cases_ = dual_cases();
  std::size_t nx_, ny_, nz_;
  std::vector<std::size_t> cell_;     // first cell of each row of nodes
  std::vector<Index> quad_;           // and its first quadrilateral
  std::vector<std::uint32_t> at_;     // i of each cell
  std::vector<std::uint8_t> signs_;   // a bit a corner
  std::vector<std::uint32_t> other_;  // 1 + number in split_, 0: as the signs say; empty: all of them
  std::vector<Split> split_;
  std::vector<Index> vertex_;  // first of each cell
  Index joined_faces_ = 0;
};

}  // namespace tunica::meshing::detail
