// SPDX-License-Identifier: MIT
// Hexahedra made better by moving their nodes: means of the neighbours, then steps that raise the scaled
// Jacobians [KNUPP00] of the corners that fall short of a target.
#pragma once

#include "tunica/core/vec.hpp"
#include "tunica/meshing/hex_graph.hpp"
#include "tunica/meshing/hex_guide.hpp"
#include "tunica/meshing/hex_shortfall.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

namespace tunica::meshing {

struct HexImproveOptions {
  int sweeps = 10;        // of averaging
  int depth = 4;          // cells from the border in which nodes are averaged
  double reach = 0.5;     // that averaging moves a node at most [edge]
  double shortest = 0.1;  // below which sides are lengthened [edge]
  double target = 0.6;    // scaled Jacobian of a corner below which its nodes are moved,
  int passes = 12;        // in as many passes at most
  double sound = 0.2;     // scaled Jacobian that a cell must have: those below it are mended first,
  int rescues = 40;       // in as many passes at most; where it takes that, nodes may leave the surface
  double release = 0.5;   // by so much [edge], by twice and three times that at last
};

struct [[nodiscard]] HexImproveReport {
  Index released = 0;  // nodes that were allowed to leave the surface
};

namespace detail {

template <HexGuide Guide>
class HexImprover {
 public:
  HexImprover(HexComplex& hexes, Guide& guide, double edge, const HexImproveOptions& options)
      : x_(hexes.nodes),
        hexes_(hexes),
        guide_(guide),
        options_(options),
        edge_(edge),
        graph_(hexes, options.depth),
        shortfall_(hexes.nodes, hexes.cells, graph_, guide) {}

  HexImproveReport run() {
    for (std::size_t n = 0; n < x_.size(); ++n)
      if (!hexes_.sites[n].inside()) x_[n] = guide_.placed(static_cast<Index>(n), x_[n]);
    start_ = x_;
    for (int sweep = 0; sweep < options_.sweeps; ++sweep) average();
    const double above = options_.sound + margin, side = options_.shortest * edge_;
    raise_all({.jacobian = above, .side = side, .places = HexPlaces::centre}, options_.rescues);
    raise_all({.jacobian = options_.target, .side = side}, options_.passes);
    if (!all_sound()) raise_all({options_.target, side, HexPlaces::centre, true}, options_.rescues);
    for (int round = 1; round <= releases && !all_sound(); ++round) {
      release(round);
      for (int sweep = 0; sweep < relaxing; ++sweep)
        for (const Index n : loosened_) average(n);
      for (const double jacobian : {loosened, above}) {
        suspect_loosened();
        raise({jacobian, side, HexPlaces::all, true}, options_.rescues);
      }
    }
    return report_;
  }

 private:
  static constexpr double margin = 0.1;   // beyond what is sound, so that it is passed
  static constexpr double farthest = 2;   // that a node goes from where it was laid [edge]
  static constexpr double longest = 0.3;  // step [edge]
  // Where nodes leave the surface all around are drawn to their neighbours' means before they are moved
  // again, towards more than is wanted: the cells get out of where they were stuck.
  static constexpr int releases = 6, relaxing = 3;
  static constexpr double loosened = 0.5;

  static std::size_t at(Index i) { return static_cast<std::size_t>(i); }

  void average() {
    const double reach = options_.reach * edge_;
    for (const Index n : graph_.near()) {
      const Vec3 way = vec::minus(mean(n), start_[at(n)]);
      const double far = vec::squared(way), part = far > reach * reach ? reach / std::sqrt(far) : 1;
      x_[at(n)] = guide_.placed(n, vec::along(start_[at(n)], part, way));
    }
  }
  void average(Index n) { x_[at(n)] = guide_.placed(n, mean(n)); }

  /// Of the neighbours; far from the border the node itself.
  [[nodiscard]] Vec3 mean(Index n) const {
    const auto near = graph_.neighbours(n);
    if (near.empty()) return x_[at(n)];
    Vec3 sum(0, 0, 0);
    for (const Index m : near) sum = vec::plus(sum, x_[at(m)]);
    return vec::divided(sum, static_cast<double>(near.size()));
  }

  void raise_all(const HexGoal& goal, int passes) {
    suspects_.resize(hexes_.cells.size());
    std::iota(suspects_.begin(), suspects_.end(), Index{0});
    raise(goal, passes);
  }

  /// The cells that have a loosened node.
  void suspect_loosened() {
    suspects_.clear();
    for (const Index n : loosened_)
      suspects_.insert(suspects_.end(), graph_.cells(n).begin(), graph_.cells(n).end());
    std::sort(suspects_.begin(), suspects_.end());
    suspects_.erase(std::unique(suspects_.begin(), suspects_.end()), suspects_.end());
  }

  void sift() {
    std::erase_if(suspects_, [&](Index c) { return !shortfall_.falls_short(c); });
  }

  /// Suspects are cells that are not sound, or whose determinant is not positive everywhere.
  [[nodiscard]] bool all_sound() {
    shortfall_.goal = {.jacobian = options_.sound, .places = HexPlaces::centre};
    suspects_.clear();
    for (std::size_t c = 0; c < hexes_.cells.size(); ++c)
      if (shortfall_.falls_short(static_cast<Index>(c)) || !positive_everywhere(x_, hexes_.cells[c]))
        suspects_.push_back(static_cast<Index>(c));
    return suspects_.empty();
  }

  /// Passes over the nodes of the suspects below the goal until there are none, or nothing moves. After the
  /// first pass cells are looked at again only if they fell short or a node of theirs has moved.
  void raise(const HexGoal& goal, int passes) {
    shortfall_.goal = goal;
    std::vector<char> wanted(x_.size(), 0), suspect(hexes_.cells.size(), 0);
    std::vector<Index> nodes;
    sift();
    for (int pass = 0; pass < passes && !suspects_.empty(); ++pass, sift()) {
      nodes.clear();
      for (const Index c : suspects_) {
        suspect[at(c)] = 1;
        for (const Index n : hexes_.cells[at(c)])
          if (wanted[at(n)] == 0) wanted[at(n)] = 1, nodes.push_back(n);
      }
      std::sort(nodes.begin(), nodes.end());
      bool moved = false;
      for (const Index n : nodes) {
        wanted[at(n)] = 0;
        if (!shortfall_.step(n, longest * edge_, start_[at(n)], farthest * edge_)) continue;
        moved = true;
        for (const Index c : graph_.cells(n))
          if (suspect[at(c)] == 0) suspect[at(c)] = 1, suspects_.push_back(c);
      }
      std::sort(suspects_.begin(), suspects_.end());
      for (const Index c : suspects_) suspect[at(c)] = 0;
      if (!moved) break;
    }
  }

  /// The surface's nodes of the suspects, in later rounds of the cells around them too, may leave it. All
  /// nodes up to two cells away are loosened.
  void release(int round) {
    std::vector<char> seen(x_.size(), 0);
    loosened_.clear();
    const auto take = [&](Index c) {
      for (const Index n : hexes_.cells[at(c)])
        if (seen[at(n)] == 0) seen[at(n)] = 1, loosened_.push_back(n);
    };
    for (const Index c : suspects_) take(c);
    const double reach = std::min(round, 3) * options_.release * edge_;
    std::size_t from = 0;
    for (int ring = 0; ring < std::max(round, 2); ++ring) {
      const std::size_t to = loosened_.size();
      if (ring < round)
        for (std::size_t i = from; i < to; ++i)
          if (!hexes_.sites[at(loosened_[i])].inside() && guide_.release(loosened_[i], reach))
            ++report_.released;
      for (; from < to; ++from)
        for (const Index c : graph_.cells(loosened_[from])) take(c);
    }
  }

  std::vector<Vec3>& x_;
  const HexComplex& hexes_;
  Guide& guide_;
  const HexImproveOptions options_;
  const double edge_;
  const HexGraph graph_;
  HexShortfall<Guide> shortfall_;
  std::vector<Vec3> start_;
  std::vector<Index> suspects_, loosened_;
  HexImproveReport report_;
};

}  // namespace detail

/// Moves the nodes of a complex of that edge length. Those of the surface stay on it while cells can be made
/// sound so.
template <HexGuide Guide>
HexImproveReport improve_hexahedra(HexComplex& hexes, Guide& guide, double edge,
                                   const HexImproveOptions& options = {}) {
  return detail::HexImprover<Guide>(hexes, guide, edge, options).run();
}

}  // namespace tunica::meshing
