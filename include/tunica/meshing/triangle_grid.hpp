// SPDX-License-Identifier: MIT
// Triangles in the cells of a uniform grid, to be added and removed while a surface changes.
#pragma once

#include "tunica/core/types.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace tunica::meshing {

class TriangleGrid {
 public:
  TriangleGrid(const Box& box, double cell) : lo_(box.lo) {
    constexpr double most_cells = 1 << 22;
    Vec3 size(0, 0, 0);
    for (int a = 0; a < 3; ++a) size[a] = std::max(box.hi[a] - box.lo[a], cell);
    while (std::ceil(size[0] / cell) * std::ceil(size[1] / cell) * std::ceil(size[2] / cell) > most_cells)
      cell *= 1.26;
    cell_ = cell;
    for (std::size_t a = 0; a < 3; ++a)
      n_[a] = static_cast<Index>(std::ceil(size[static_cast<Eigen::Index>(a)] / cell)) + 1;
    items_.resize(static_cast<std::size_t>(n_[0]) * static_cast<std::size_t>(n_[1]) *
                  static_cast<std::size_t>(n_[2]));
  }

  void add(Index item, const Box& box) {
    if (static_cast<std::size_t>(item) >= boxes_.size())
      boxes_.resize(static_cast<std::size_t>(item) + 1), stamp_.resize(static_cast<std::size_t>(item) + 1);
    boxes_[static_cast<std::size_t>(item)] = box;
    cells_of(box, [&](std::vector<Index>& cell) { cell.push_back(item); });
  }

  void remove(Index item) {
    cells_of(boxes_[static_cast<std::size_t>(item)],
             [&](std::vector<Index>& cell) { cell.erase(std::find(cell.begin(), cell.end(), item)); });
  }

  /// Calls visit(item) once for every item whose box overlaps the box, until it returns true.
  template <class Visit>
  bool any(const Box& box, Visit&& visit) {
    ++now_;
    bool found = false;
    cells_of(box, [&](const std::vector<Index>& cell) {
      for (std::size_t i = 0; i < cell.size() && !found; ++i) {
        const auto item = static_cast<std::size_t>(cell[i]);
        if (stamp_[item] == now_) continue;
        stamp_[item] = now_;
        found = boxes_[item].overlaps(box) && visit(cell[i]);
      }
    });
    return found;
  }

 private:
  template <class Act>
  void cells_of(const Box& box, Act&& act) {
    std::array<Index, 3> from{}, to{};
    for (std::size_t a = 0; a < 3; ++a) {
      const auto e = static_cast<Eigen::Index>(a);
      const auto bounded = [&](double x) {
        return static_cast<Index>(std::clamp((x - lo_[e]) / cell_, 0.0, static_cast<double>(n_[a] - 1)));
      };
      from[a] = bounded(box.lo[e]), to[a] = bounded(box.hi[e]);
    }
    for (Index k = from[2]; k <= to[2]; ++k)
      for (Index j = from[1]; j <= to[1]; ++j)
        for (Index i = from[0]; i <= to[0]; ++i)
          act(items_[static_cast<std::size_t>(i) +
                     static_cast<std::size_t>(n_[0]) *
                         (static_cast<std::size_t>(j) +
                          static_cast<std::size_t>(n_[1]) * static_cast<std::size_t>(k))]);
  }

  Vec3 lo_;
  double cell_ = 1;
  std::array<Index, 3> n_{};
  std::vector<std::vector<Index>> items_;
  std::vector<Box> boxes_;
  std::vector<Index> stamp_;
  Index now_ = 0;
};

}  // namespace tunica::meshing
