// SPDX-License-Identifier: MIT
// The cells of a grid that its contour crosses, with their loops and the numbers of their vertices in the
// dual contour: by cell, in ascending order of the lowest nodes, and by loop. [SCHAEFER07, 3]
#pragma once

#include "tunica/meshing/cell_loops.hpp"
#include "tunica/meshing/hermite.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tunica::meshing::detail {

/// The cells that the surface crosses, in ascending order, each with its loops and its first vertex.
class LoopCells {
 public:
  explicit LoopCells(const HermiteGrid& grid) : grid_(grid), stride_(grid.strides()) {
    collect();
    for (std::size_t c = 0; c < cells_.size(); ++c) loops_[c] = cell_loops(signs_[c], 0);
    separate();
    vertex_.resize(cells_.size() + 1, 0);
    for (std::size_t c = 0; c < cells_.size(); ++c) vertex_[c + 1] = vertex_[c] + loops_[c].count;
  }

  [[nodiscard]] std::size_t count() const { return cells_.size(); }
  [[nodiscard]] Index vertex_count() const { return vertex_.back(); }
  [[nodiscard]] std::size_t node(std::size_t c) const { return cells_[c]; }
  [[nodiscard]] const CellLoops& loops(std::size_t c) const { return loops_[c]; }
  [[nodiscard]] Index vertex(std::size_t c, int edge) const {
    return vertex_[c] + loops_[c].loop[static_cast<std::size_t>(edge)];
  }

  /// The place in the list of the cell whose lowest node is that one; it must be there.
  [[nodiscard]] std::size_t find(std::size_t node) const {
    const std::size_t row = node / grid_.size(0);
    const auto from = cells_.begin() + row_[row], to = cells_.begin() + row_[row + 1];
    return static_cast<std::size_t>(std::lower_bound(from, to, node) - cells_.begin());
  }

 private:
  void collect() {
    const std::size_t nx = grid_.size(0), ny = grid_.size(1), nz = grid_.size(2);
    row_.assign(ny * nz + 1, 0);
    for (std::size_t k = 0; k < nz; ++k)
      for (std::size_t j = 0; j < ny; ++j) {
        if (j + 1 < ny && k + 1 < nz) {
          const std::uint8_t* at = grid_.inside.data() + nx * (j + ny * k);
          const auto column = [&](std::size_t i) {
            return unsigned(at[i] | at[i + stride_[1]] << 2 | at[i + stride_[2]] << 4 |
                            at[i + stride_[1] + stride_[2]] << 6);
          };
          unsigned low = column(0);
          for (std::size_t i = 0; i + 1 < nx; ++i) {
            const unsigned high = column(i + 1), signs = low | high << 1;
            low = high;
            if (signs == 0 || signs == 255) continue;
            cells_.push_back(i + nx * (j + ny * k));
            signs_.push_back(static_cast<std::uint8_t>(signs));
          }
        }
        row_[j + ny * k + 1] = static_cast<std::ptrdiff_t>(cells_.size());
      }
    loops_.resize(cells_.size());
  }

  /// An edge of the dual mesh would be shared by four quadrilaterals where all strands on an
  /// ambiguous face are one loop in both of its cells. There the strands are paired the other way:
  /// that splits an oriented loop in two, in both cells, and so never makes another such face.
  void separate() {
    std::vector<std::uint8_t> joined(cells_.size(), 0);
    for (std::size_t c = 0; c < cells_.size(); ++c)
      for (std::size_t a = 0; a < 3; ++a) {
        const std::size_t high = 2 * a + 1, low = 2 * a;
        if (!ambiguous(signs_[c], high) || !strands_meet(loops_[c], high)) continue;
        const std::size_t d = find(cells_[c] + stride_[a]);
        if (!strands_meet(loops_[d], low)) continue;
        joined[c] = static_cast<std::uint8_t>(joined[c] | 1U << high);
        joined[d] = static_cast<std::uint8_t>(joined[d] | 1U << low);
        loops_[c] = cell_loops(signs_[c], joined[c]);
        loops_[d] = cell_loops(signs_[d], joined[d]);
      }
  }

  const HermiteGrid& grid_;
  std::array<std::size_t, 3> stride_;
  std::vector<std::size_t> cells_;   // lowest nodes
  std::vector<std::uint8_t> signs_;  // a bit a corner
  std::vector<CellLoops> loops_;
  std::vector<std::ptrdiff_t> row_;  // range of cells_ of each row of nodes
  std::vector<Index> vertex_;        // first vertex of each cell
};

}  // namespace tunica::meshing::detail
