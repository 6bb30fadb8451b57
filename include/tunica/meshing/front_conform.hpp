// SPDX-License-Identifier: MIT
// Edges of the surface brought in by Delaunay insertion alone: what is missing is halved until all
// pieces are edges of the triangulation. More points than flips need, but nothing gets flat.
#pragma once

#include "tunica/core/error.hpp"
#include "tunica/core/vec.hpp"
#include "tunica/meshing/delaunay.hpp"
#include "tunica/meshing/front_edges.hpp"
#include "tunica/meshing/front_surface.hpp"

#include <cmath>
#include <cstddef>
#include <vector>

namespace tunica::meshing {

class FrontConform {
 public:
  FrontConform(TetComplex& complex, FrontSurface& surface, Delaunay& delaunay)
      : c_(complex), s_(surface), delaunay_(delaunay) {}

  /// Returns the number of points; RecoveryFailure when there is no end to it.
  Index run() {
    for (int pass = 0; pass < most_passes; ++pass)
      if (!sweep()) {
        for (std::size_t e = 0; e < s_.edges.size(); ++e) {
          if (!s_.chained(static_cast<Index>(e))) continue;
          Index u = s_.edges[e].a;
          for (const Index n : s_.chain(static_cast<Index>(e))) s_.lock_piece(u, n), u = n;
          s_.lock_piece(u, s_.edges[e].b);
        }
        return steiner_;
      }
    throw RecoveryFailure{c_.point(0), "halving the edges of the surface does not end"};
  }

 private:
  static constexpr int most_passes = 200;
  static constexpr Index most_points =
      6;  // an edge: beyond it two edges almost touch and drive each other on

  template <class I>
  [[nodiscard]] static std::size_t at(I i) {
    return static_cast<std::size_t>(i);
  }

  /// True when a piece was missing.
  bool sweep() {
    std::vector<char> found(s_.edges.size(), 0);
    for (Index t = 0; t < c_.size(); ++t) {
      if (!c_.alive(t)) continue;
      for (const auto& [i, j] : mesh::Tet4::edges)
        if (const Index e = s_.edge_between(c_.nodes(t)[at(i)], c_.nodes(t)[at(j)]); e >= 0) found[at(e)] = 1;
    }
    bool changed = false;
    for (std::size_t e = 0; e < found.size(); ++e)
      if (found[e] == 0) changed = halve_missing(static_cast<Index>(e)) || changed;
    return changed;
  }

  bool halve_missing(Index e) {
    std::vector<Index>& inner = s_.chain(e);
    const auto node = [&](std::size_t i) {
      return i == 0 ? s_.edges[at(e)].a : i == inner.size() + 1 ? s_.edges[at(e)].b : inner[i - 1];
    };
    bool changed = false;
    for (std::size_t i = 0; i < inner.size() + 1; ++i) {
      const Index u = node(i), v = node(i + 1);
      if (c_.tet_with(u, v, star_) >= 0) continue;
      if (++steiner_ > most_points * static_cast<Index>(s_.edges.size()))
        throw RecoveryFailure{c_.point(u), "halving the edges of the surface does not end"};
      const Index p = c_.add_point(middle(u, v));
      try {
        delaunay_.insert(p);
      } catch (const MeshError&) {
        throw RecoveryFailure{c_.point(u), "an edge cannot be halved any more"};
      }
      s_.own(p, {e, -1});
      inner.insert(inner.begin() + static_cast<std::ptrdiff_t>(i), p);
      ++i;
      changed = true;
    }
    return changed;
  }

  /// About half-way; at a node of the surface on spheres with radii 2^k, so that the edges of a
  /// small angle are cut at equal distances and do not drive each other on.
  [[nodiscard]] Vec3 middle(Index u, Index v) const {
    if (u >= s_.nodes && v >= s_.nodes) return vec::scaled(0.5, vec::plus(c_.point(u), c_.point(v)));
    if (u >= s_.nodes) return middle(v, u);
    const Vec3 d = vec::minus(c_.point(v), c_.point(u));
    const double length = vec::length(d), shell = std::exp2(std::round(std::log2(0.5 * length)));
    return vec::along(c_.point(u), shell / length, d);
  }

  TetComplex& c_;
  FrontSurface& s_;
  Delaunay& delaunay_;
  Index steiner_ = 0;
  std::vector<Index> star_;
};

}  // namespace tunica::meshing
