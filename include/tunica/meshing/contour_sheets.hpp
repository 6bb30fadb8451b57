// SPDX-License-Identifier: MIT
// Which faces of a contour get a layer of cells together: each flat end one of its own, so that at its rim a
// cell has a face on either side, all the others one.
#pragma once

#include "tunica/mesh/mesh.hpp"
#include "tunica/meshing/quad_adjacency.hpp"

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

namespace tunica::meshing::detail {

/// Sheet 0 holds all but the flat ends. Where an end meets another facet, two edges of its rim meet at each
/// node of it; facets of faces are changed where that was not so.
class ContourSheets {
 public:
  /// flat: which facets are.
  ContourSheets(const mesh::QuadSurface& contour, const std::vector<char>& flat)
      : cells_(contour.cells), facet_(contour.region), own_(flat) {
    twin_ = quad_twins(cells_, contour.node_count());
    leaving_.assign(static_cast<std::size_t>(contour.node_count()), -1);
    for (Index h = 0; h < static_cast<Index>(twin_.size()); ++h) leaving_[at(from(h))] = h;
    for (int round = 0; round < 20 && mend(); ++round) {
    }
    withdraw();
  }

  [[nodiscard]] Index facet(Index quad) const { return facet_[at(quad)]; }
  [[nodiscard]] Index sheet(Index quad) const { return own_[at(facet(quad))] != 0 ? 1 + facet(quad) : 0; }
  [[nodiscard]] Index twin(Index half_edge) const { return twin_[at(half_edge)]; }

  /// Calls visit(quad) round the node, against the clock.
  template <class Visit>
  void around(Index node, Visit&& visit) const {
    const Index first = leaving_[at(node)];
    if (first < 0) return;
    Index h = first;
    do {
      visit(h / 4);
      h = twin_[at(previous(h))];
    } while (h != first && h >= 0);
  }

 private:
  static std::size_t at(Index i) { return static_cast<std::size_t>(i); }
  static Index previous(Index h) { return h % 4 == 0 ? h + 3 : h - 1; }
  [[nodiscard]] Index from(Index h) const { return cells_(h % 4, h / 4); }

  /// The runs of one facet round the node: (facet, quads).
  [[nodiscard]] std::vector<std::pair<Index, std::vector<Index>>> runs(Index node) const {
    std::vector<std::pair<Index, std::vector<Index>>> list;
    around(node, [&](Index q) {
      if (list.empty() || list.back().first != facet(q)) list.push_back({facet(q), {}});
      list.back().second.push_back(q);
    });
    if (list.size() > 1 && list.front().first == list.back().first) {
      auto& front = list.front().second;
      front.insert(front.end(), list.back().second.begin(), list.back().second.end());
      list.pop_back();
    }
    return list;
  }

  /// Where two facets alternate round a node the shorter run goes to the other one.
  bool mend() {
    bool changed = false;
    for (Index n = 0; n < static_cast<Index>(leaving_.size()); ++n) {
      if (!parted(n)) continue;
      const auto list = runs(n);
      if (list.size() < 4) continue;
      std::size_t least = 0;
      for (std::size_t r = 1; r < list.size(); ++r)
        if (list[r].second.size() < list[least].second.size()) least = r;
      for (const Index q : list[least].second) facet_[at(q)] = list[(least + 1) % list.size()].first;
      changed = true;
    }
    return changed;
  }

  [[nodiscard]] bool parted(Index node) const {
    Index first = -1;
    bool several = false;
    around(node, [&](Index q) {
      if (first >= 0 && facet(q) != first) several = true;
      first = facet(q);
    });
    return several;
  }

  /// Flat facets that meet each other, or that do not end in simple curves, go to sheet 0.
  void withdraw() {
    for (Index n = 0; n < static_cast<Index>(leaving_.size()); ++n) {
      if (!parted(n)) continue;
      const auto list = runs(n);
      std::size_t flats = 0;
      for (const auto& run : list) flats += own_[at(run.first)] != 0 ? 1 : 0;
      if (list.size() != 2 || flats > 1)
        for (const auto& run : list) clear_.push_back(run.first);
    }
    for (const Index f : clear_) own_[at(f)] = 0;
  }

  const Connectivity<4>& cells_;
  std::vector<Index> facet_, twin_, leaving_, clear_;
  std::vector<char> own_;  // the facets with a sheet of their own
};

}  // namespace tunica::meshing::detail
