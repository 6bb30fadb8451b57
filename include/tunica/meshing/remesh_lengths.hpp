// SPDX-License-Identifier: MIT
// Splits of long edges and collapses of short ones, on the surface that is followed. [BOTSCH04]
#pragma once

#include "tunica/meshing/edit_flips.hpp"
#include "tunica/meshing/remesh_state.hpp"

#include <algorithm>
#include <utility>

namespace tunica::meshing::detail {

// An edge is split above 4/3 and collapsed below 4/5 of the target length: then neither makes work for the
// other [BOTSCH04].
inline constexpr double long_edge = 4.0 / 3, short_edge = 4.0 / 5;

/// Of the target length: how far collapses may wear down the surface. It halves the rms distance at a thin
/// stub.
inline constexpr double most_wear = 0.3;

inline void split_long(RemeshState& w) {
  EditableSurface& s = w.edit;
  const double most = long_edge * w.edge;
  auto todo = edges_of(s, [&](double l) { return l > most; });
  for (auto e = todo.rbegin(); e != todo.rend(); ++e) {
    if (!has_edge(s, e->a, e->b)) continue;
    const auto [left, right] = s.sides(e->a, e->b);
    const Vec3 middle = 0.5 * (s.x(e->a) + s.x(e->b));
    const Index p = s.facet(left), q = s.facet(right);
    const Vec3 place =
        p == q ? w.target.nearest(middle, p).point : w.on_rim(middle, std::min(p, q), std::max(p, q));
    if (s.split(e->a, e->b, place) < 0) (void)s.split(e->a, e->b, middle);
  }
}

/// Merges an edge into its more strongly bound node or its middle, unless an edge longer than `most`
/// results.
inline bool collapse(RemeshState& w, Index a, Index b, double most) {
  EditableSurface& s = w.edit;
  NodeKind ka = kind_of(s, a), kb = kind_of(s, b);
  if (kb > ka) std::swap(a, b), std::swap(ka, kb);
  if (kb == NodeKind::corner) return false;
  if (kb == NodeKind::rim && !s.on_rim(a, b)) return false;
  Vec3 place = s.x(a);
  if (ka == kb) place = w.on_target(a, 0.5 * (s.x(a) + s.x(b)));
  const auto tried = [&](Index stays, Index goes, const Vec3& p) {
    for (const Index n : {a, b})
      for (const Index m : s.neighbours(n))
        if (m != a && m != b && (s.x(m) - p).norm() > most) return false;
    const double lost = w.wear.after(s, a, b, p);
    if (lost > most_wear * w.edge) {
      ++w.kept_features;
      return false;
    }
    if (!s.collapse(stays, goes, p)) return false;
    w.wear.set(stays, lost);
    return true;
  };
  if (tried(a, b, place)) return true;
  if (ka != kb) return false;
  return tried(a, b, s.x(a)) || tried(b, a, s.x(b));
}

inline void collapse_short(RemeshState& w) {
  const double least = short_edge * w.edge;
  for (const EditEdge& e : edges_of(w.edit, [&](double l) { return l < least; }))
    if (has_edge(w.edit, e.a, e.b) && w.edit.length(e.a, e.b) < least)
      (void)collapse(w, e.a, e.b, long_edge * w.edge);
}

}  // namespace tunica::meshing::detail
