// SPDX-License-Identifier: MIT
// Who touches whom in a complex of hexahedra: cells of nodes, neighbours along edges, nodes near the border.
#pragma once

#include "tunica/mesh/adjacency.hpp"
#include "tunica/mesh/quality.hpp"
#include "tunica/meshing/hex_complex.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace tunica::meshing::detail {

class HexGraph {
 public:
  /// depth: in cells from the border, of the nodes that are near it.
  HexGraph(const HexComplex& hexes, int depth) : hexes_(hexes) {
    find_cells();
    find_near(depth);
    find_neighbours();
  }

  [[nodiscard]] std::span<const Index> cells(Index node) const { return cells_[node]; }
  [[nodiscard]] const std::vector<Index>& near() const { return near_; }  // ascending
  /// Of a node near the border: all that an edge joins to it, of one on the surface those on the surface.
  [[nodiscard]] std::span<const Index> neighbours(Index node) const { return neighbours_[node]; }

 private:
  static std::size_t at(Index i) { return static_cast<std::size_t>(i); }

  void find_cells() {
    cells_.offset.assign(hexes_.nodes.size() + 1, 0);
    for (const auto& c : hexes_.cells)
      for (const Index n : c) ++cells_.offset[at(n) + 1];
    for (std::size_t n = 1; n < cells_.offset.size(); ++n) cells_.offset[n] += cells_.offset[n - 1];
    cells_.item.resize(8 * hexes_.cells.size());
    std::vector<Index> next(cells_.offset.begin(), cells_.offset.end() - 1);
    for (std::size_t c = 0; c < hexes_.cells.size(); ++c)
      for (const Index n : hexes_.cells[c]) cells_.item[at(next[at(n)]++)] = static_cast<Index>(c);
  }

  void find_near(int depth) {
    std::vector<char> seen(hexes_.nodes.size(), 0);
    std::vector<Index> front, next;
    for (std::size_t n = 0; n < seen.size(); ++n)
      if (!hexes_.sites[n].inside()) seen[n] = 1, front.push_back(static_cast<Index>(n));
    for (; depth > 0; --depth) {
      next.clear();
      for (const Index n : front)
        for (const Index c : cells_[n])
          for (const Index m : hexes_.cells[at(c)])
            if (seen[at(m)] == 0) seen[at(m)] = 1, next.push_back(m);
      std::swap(front, next);
    }
    for (std::size_t n = 0; n < seen.size(); ++n)
      if (seen[n] != 0) near_.push_back(static_cast<Index>(n));
  }

  void find_neighbours() {
    mesh::Rows faces;  // of the border, by node
    faces.offset.assign(hexes_.nodes.size() + 1, 0);
    for (const auto& q : hexes_.border)
      for (const Index n : q) ++faces.offset[at(n) + 1];
    for (std::size_t n = 1; n < faces.offset.size(); ++n) faces.offset[n] += faces.offset[n - 1];
    faces.item.resize(4 * hexes_.border.size());
    std::vector<Index> next(faces.offset.begin(), faces.offset.end() - 1);
    for (std::size_t f = 0; f < hexes_.border.size(); ++f)
      for (const Index n : hexes_.border[f]) faces.item[at(next[at(n)]++)] = static_cast<Index>(f);

    neighbours_.offset.assign(hexes_.nodes.size() + 1, 0);
    Index last = 0;
    for (const Index n : near_) {
      for (; last <= n; ++last) neighbours_.offset[at(last)] = static_cast<Index>(neighbours_.item.size());
      const std::size_t first = neighbours_.item.size();
      const auto add = [&](Index m) {
        if (std::find(neighbours_.item.begin() + static_cast<std::ptrdiff_t>(first), neighbours_.item.end(),
                      m) == neighbours_.item.end())
          neighbours_.item.push_back(m);
      };
      if (hexes_.sites[at(n)].inside()) {
        for (const Index c : cells_[n]) {
          const auto& cell = hexes_.cells[at(c)];
          const auto k = static_cast<std::size_t>(std::find(cell.begin(), cell.end(), n) - cell.begin());
          for (const int m : mesh::hex_corner_axes[k]) add(cell[static_cast<std::size_t>(m)]);
        }
      } else {
        for (const Index f : faces[n]) {
          const auto& q = hexes_.border[at(f)];
          const auto k = static_cast<std::size_t>(std::find(q.begin(), q.end(), n) - q.begin());
          add(q[(k + 1) % 4]), add(q[(k + 3) % 4]);
        }
      }
    }
    for (; last <= static_cast<Index>(hexes_.nodes.size()); ++last)
      neighbours_.offset[at(last)] = static_cast<Index>(neighbours_.item.size());
  }

  const HexComplex& hexes_;
  mesh::Rows cells_, neighbours_;
  std::vector<Index> near_;
};

}  // namespace tunica::meshing::detail
