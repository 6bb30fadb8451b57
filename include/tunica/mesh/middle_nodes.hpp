// SPDX-License-Identifier: MIT
// Numbers of the edges and of the quadrilateral faces of a mesh, in the order of their sorted corners.
#pragma once

#include "tunica/core/error.hpp"
#include "tunica/core/types.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace tunica::mesh::detail {

/// Sets of `Corners` nodes, each numbered once: sorted by their lowest node first, then by the next ones.
template <std::size_t Corners>
class SetNumbers {
 public:
  using Key = std::array<Index, Corners>;

  /// One set for each row of `table` (local nodes) and column of `cells`. No nodes: no sets.
  template <int Nodes, std::size_t Rows>
  SetNumbers(const Connectivity<Nodes>& cells, const std::array<std::array<int, Corners>, Rows>& table,
             Index node_count)
      : start_(static_cast<std::size_t>(node_count) + 1, 0) {
    if (node_count == 0) return;
    const auto each = [&](auto&& body) {
      for (Eigen::Index c = 0; c < cells.cols(); ++c)
        for (const auto& row : table) {
          Key key;
          for (std::size_t k = 0; k < Corners; ++k) key[k] = cells(row[k], c);
          std::sort(key.begin(), key.end());
          body(key);
        }
    };
    each([&](const Key& key) { ++start_[at(key[0]) + 1]; });
    for (std::size_t n = 0; n + 1 < start_.size(); ++n) start_[n + 1] += start_[n];
    std::vector<Rest> all(at(start_.back()));
    std::vector<Index> fill(start_.begin(), start_.end() - 1);
    each([&](const Key& key) { all[at(fill[at(key[0])]++)] = rest(key); });
    rest_.reserve(all.size() / 2);
    for (std::size_t n = 0; n + 1 < start_.size(); ++n) {
      const auto begin = all.begin() + start_[n], end = all.begin() + start_[n + 1];
      std::sort(begin, end);
      const auto last = std::unique(begin, end);
      start_[n] = static_cast<Index>(rest_.size());
      rest_.insert(rest_.end(), begin, last);
    }
    start_.back() = static_cast<Index>(rest_.size());
  }

  [[nodiscard]] Index count() const { return static_cast<Index>(rest_.size()); }

  /// The number of a set, its nodes in any order; MeshError if no cell has it.
  [[nodiscard]] Index find(Key key) const {
    std::sort(key.begin(), key.end());
    const auto begin = rest_.begin() + start_[at(key[0])], end = rest_.begin() + start_[at(key[0]) + 1];
    const auto it = std::lower_bound(begin, end, rest(key));
    if (it == end || *it != rest(key)) {
      std::string nodes;
      for (const Index n : key) nodes.append(" ").append(std::to_string(n));
      throw MeshError("no cell has an edge or face of the nodes" + nodes);
    }
    return static_cast<Index>(it - rest_.begin());
  }
  [[nodiscard]] Index find(Index a, Index b) const requires(Corners == 2) { return find(Key{a, b}); }

 private:
  using Rest = std::array<Index, Corners - 1>;  // all but the lowest
  static std::size_t at(Index i) { return static_cast<std::size_t>(i); }
  static Rest rest(const Key& key) {
    Rest r;
    std::copy(key.begin() + 1, key.end(), r.begin());
    return r;
  }

  std::vector<Index> start_;  // of the sets with that lowest node
  std::vector<Rest> rest_;
};

using EdgeNumbers = SetNumbers<2>;

}  // namespace tunica::mesh::detail
