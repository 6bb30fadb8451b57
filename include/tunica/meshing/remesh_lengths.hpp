// SPDX-License-Identifier: MIT
// Splits of long edges and collapses of short ones, on the surface that is followed. [BOTSCH04]
#pragma once

#include "tunica/meshing/edit_flips.hpp"
#include "tunica/meshing/remesh_state.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace tunica::meshing::detail {

// An edge is split above 4/3 and collapsed below 4/5 of the target length: then neither makes work for the
// other [BOTSCH04].
inline constexpr double long_edge = 4.0 / 3, short_edge = 4.0 / 5;

/// Of the target length: how far collapses may wear down the surface. It halves the rms distance at a thin
/// stub.
inline constexpr double most_wear = 0.3;

/// Edges that wanted(length, target) picks, the shortest first: by length over target where that varies.
template <class Size, class Wanted>
[[nodiscard]] std::vector<EditEdge> edges_by_target(RemeshState<Size>& w, Wanted&& wanted) {
  if constexpr (RemeshState<Size>::constant) {
    return edges_of(w.edit, [&](double l) { return wanted(l, w.size.edge); });
  } else {
    std::vector<EditEdge> found;
    for (const EditEdge& e : edges_of(w.edit, [](double) { return true; }))
      if (const double target = w.size_of(e.a, e.b); wanted(e.length, target))
        found.push_back({e.length / target, e.a, e.b});
    std::sort(found.begin(), found.end());
    return found;
  }
}

template <class Size>
void split_long(RemeshState<Size>& w) {
  EditableSurface& s = w.edit;
  auto todo = edges_by_target(w, [](double l, double target) { return l > long_edge * target; });
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

/// Merges an edge into its more strongly bound node or its middle, unless an edge longer than `most` times
/// its target results.
template <class Size>
bool collapse(RemeshState<Size>& w, Index a, Index b, double most) {
  EditableSurface& s = w.edit;
  NodeKind ka = kind_of(s, a), kb = kind_of(s, b);
  if (kb > ka) std::swap(a, b), std::swap(ka, kb);
  if (kb == NodeKind::corner) return false;
  if (kb == NodeKind::rim && !s.on_rim(a, b)) return false;
  Vec3 place = s.x(a);
  if (ka == kb) place = w.on_target(a, 0.5 * (s.x(a) + s.x(b)));
  const auto tried = [&](Index stays, Index goes, const Vec3& p) {
    const double here = w.size(p);
    for (const Index n : {a, b})
      for (const Index m : s.neighbours(n))
        if (m != a && m != b && (s.x(m) - p).norm() > most * w.between(w.size_of(m), here)) return false;
    const double lost = w.wear.after(s, a, b, p);
    if (lost > most_wear * here) {
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

template <class Size>
void collapse_short(RemeshState<Size>& w) {
  const auto is_short = [](double l, double target) { return l < short_edge * target; };
  for (const EditEdge& e : edges_by_target(w, is_short))
    if (has_edge(w.edit, e.a, e.b) && is_short(w.edit.length(e.a, e.b), w.size_of(e.a, e.b)))
      (void)collapse(w, e.a, e.b, long_edge);
}

}  // namespace tunica::meshing::detail
