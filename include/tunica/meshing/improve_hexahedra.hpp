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
    raise({.jacobian = above, .side = side, .centres = true}, options_.rescues);
    raise({.jacobian = options_.target, .side = side}, options_.passes);
    if (!all_sound()) raise({options_.target, side, true, true}, options_.rescues);
    for (int round = 1; round <= releases && !all_sound(); ++round) {
      release(round);
      raise({above, side, true, true}, options_.rescues);
    }
    return report_;
  }

 private:
  static constexpr double margin = 0.1;   // beyond what is sound, so that it is passed
  static constexpr double farthest = 2;   // that a node goes from where it was laid [edge]
  static constexpr double longest = 0.3;  // step [edge]
  static constexpr int releases = 3;

  static std::size_t at(Index i) { return static_cast<std::size_t>(i); }

  void average() {
    const double reach = options_.reach * edge_;
    for (const Index n : graph_.near()) {
      const auto near = graph_.neighbours(n);
      if (near.empty()) continue;
      Vec3 sum(0, 0, 0);
      for (const Index m : near) sum = vec::plus(sum, x_[at(m)]);
      Vec3 way = vec::minus(vec::divided(sum, static_cast<double>(near.size())), start_[at(n)]);
      const double far = vec::squared(way);
      if (far > reach * reach) way = vec::scaled(reach / std::sqrt(far), way);
      x_[at(n)] = guide_.placed(n, vec::plus(start_[at(n)], way));
    }
  }

  /// Leaves in suspects_ all cells that fall short.
  void find_suspects() {
    suspects_.resize(hexes_.cells.size());
    std::iota(suspects_.begin(), suspects_.end(), Index{0});
    sift();
  }
  void sift() {
    std::erase_if(suspects_, [&](Index c) { return !shortfall_.falls_short(c); });
  }

  [[nodiscard]] bool all_sound() {
    shortfall_.goal = {.jacobian = options_.sound, .centres = true};
    find_suspects();
    return suspects_.empty();
  }

  /// Passes over the nodes of the cells below the goal until there are none, or nothing moves. After the
  /// first pass cells are looked at again only if they fell short or a node of theirs has moved.
  void raise(const HexGoal& goal, int passes) {
    shortfall_.goal = goal;
    std::vector<char> wanted(x_.size(), 0), suspect(hexes_.cells.size(), 0);
    std::vector<Index> nodes;
    find_suspects();
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

  /// The surface's nodes of the suspects, in the last rounds of the cells around them too, may leave it.
  void release(int round) {
    std::vector<Index> nodes;
    std::vector<char> seen(x_.size(), 0);
    const auto take = [&](Index c) {
      for (const Index n : hexes_.cells[at(c)])
        if (seen[at(n)] == 0) seen[at(n)] = 1, nodes.push_back(n);
    };
    for (const Index c : suspects_) take(c);
    std::size_t from = 0;
    for (int ring = 1; ring < round; ++ring)
      for (const std::size_t to = nodes.size(); from < to; ++from)
        for (const Index c : graph_.cells(nodes[from])) take(c);
    for (const Index n : nodes)
      if (!hexes_.sites[at(n)].inside() && guide_.release(n, round * options_.release * edge_))
        ++report_.released;
  }

  std::vector<Vec3>& x_;
  const HexComplex& hexes_;
  Guide& guide_;
  const HexImproveOptions options_;
  const double edge_;
  const HexGraph graph_;
  HexShortfall<Guide> shortfall_;
  std::vector<Vec3> start_;
  std::vector<Index> suspects_;
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
