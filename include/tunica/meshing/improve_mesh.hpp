// SPDX-License-Identifier: MIT
// What the improvement works on: tetrahedra with their cached qualities, fixed nodes on the surface.
#pragma once

#include "tunica/meshing/tet_complex.hpp"
#include "tunica/meshing/tet_quality.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace tunica::meshing {

/// Quality is sine_quality: the smallest sine of the dihedral angles.
class ImproveMesh {
 public:
  TetComplex& c;
  Index fixed;             // nodes below it lie on the surface and never move
  std::vector<char> held;  // 1: a node that does not move either; may be shorter than the nodes are many

  ImproveMesh(TetComplex& complex, Index fixed_nodes) : c(complex), fixed(fixed_nodes) {
    quality_.assign(static_cast<std::size_t>(c.size()), -1.0);
    for (Index t = 0; t < c.size(); ++t)
      if (c.alive(t)) update(t);
  }

  [[nodiscard]] bool free(Index node) const {
    const auto n = static_cast<std::size_t>(node);
    return node >= fixed && (n >= held.size() || held[n] == 0);
  }
  [[nodiscard]] double quality(Index t) const { return quality_[static_cast<std::size_t>(t)]; }
  [[nodiscard]] double quality(const Quad& q) const {
    return sine_quality(c.point(q[0]), c.point(q[1]), c.point(q[2]), c.point(q[3]));
  }
  [[nodiscard]] double worst(std::span<const Index> tets) const {
    double least = std::numeric_limits<double>::infinity();
    for (const Index t : tets) least = std::min(least, quality(t));
    return least;
  }
  void update(Index t) {
    quality_[static_cast<std::size_t>(t)] = quality(c.nodes(t));
    for (const Index n : c.nodes(t)) touch(n);
  }

  /// A moment in the history of changes: what is tried in vain need not be tried again before a change.
  using Moment = std::uint32_t;
  [[nodiscard]] Moment moment() { return ++now_; }
  /// Has a tetrahedron at the node changed since?
  [[nodiscard]] bool changed(Index node, Moment since) const {
    return changed_[static_cast<std::size_t>(node)] >= since;
  }

  /// TetComplex::replace with the qualities of the new ones.
  void replace(std::span<const Index> old, std::span<const Quad> fresh) {
    const auto& created = c.replace(old, fresh, open_);
    quality_.resize(static_cast<std::size_t>(c.size()));
    for (const Index t : created) update(t);
  }

 private:
  void touch(Index node) {
    const auto n = static_cast<std::size_t>(node);
    if (n >= changed_.size()) changed_.resize(c.points.size());
    changed_[n] = now_;
  }

  std::vector<double> quality_;
  std::vector<Moment> changed_;
  Moment now_ = 0;
  std::vector<Side> open_;
};

}  // namespace tunica::meshing
