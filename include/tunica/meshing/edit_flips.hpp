// SPDX-License-Identifier: MIT
// Edge flips over a whole editable surface: towards six triangles a node, or towards large smallest angles.
#pragma once

#include "tunica/meshing/editable_surface.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace tunica::meshing {

struct EditEdge {
  double length;
  Index a, b;
  [[nodiscard]] bool operator<(const EditEdge& o) const {
    return length != o.length ? length < o.length : a != o.a ? a < o.a : b < o.b;
  }
};

/// Edges whose length the caller wants, shortest first.
template <class Wanted>
[[nodiscard]] std::vector<EditEdge> edges_of(const EditableSurface& s, Wanted&& wanted) {
  std::vector<EditEdge> found;
  for (Index t = 0; t < s.triangle_count(); ++t) {
    if (!s.alive(t)) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = s.nodes(t)[k], b = s.nodes(t)[(k + 1) % 3];
      if (a > b) continue;  // the twin has it
      if (const double l = s.length(a, b); wanted(l)) found.push_back({l, a, b});
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

[[nodiscard]] inline bool has_edge(const EditableSurface& s, Index a, Index b) {
  return s.used(a) && s.used(b) && s.sides(a, b)[0] >= 0;
}

/// The two triangles of an edge ab with the corners c and d opposite to it, and what a flip makes of them.
struct FlipView {
  Index a, b, c, d;

  FlipView(const EditableSurface& s, Index from, Index to) : a(from), b(to) {
    const auto [p, q] = s.sides(a, b);
    c = s.opposite(p, a, b), d = s.opposite(q, a, b);
  }
  [[nodiscard]] double angle(const EditableSurface& s) const {
    return std::min(s.triangle({a, b, c}).smallest_angle(), s.triangle({b, a, d}).smallest_angle());
  }
  [[nodiscard]] double flipped_angle(const EditableSurface& s) const {
    return std::min(s.triangle({a, d, c}).smallest_angle(), s.triangle({d, b, c}).smallest_angle());
  }
};

/// Flips that bring the numbers of triangles at four nodes nearer to six, unless a thin triangle results.
inline void flip_to_valence(EditableSurface& s) {
  constexpr double thin = 0.35;  // [rad] 20 degrees
  const auto excess = [&](Index n, Index change) {
    const Index v = static_cast<Index>(s.ring(n).size()) + change - 6;
    return v * v;
  };
  for (const EditEdge& e : edges_of(s, [](double) { return true; })) {
    if (!has_edge(s, e.a, e.b) || s.on_rim(e.a, e.b)) continue;
    const FlipView f(s, e.a, e.b);
    const Index before = excess(f.a, 0) + excess(f.b, 0) + excess(f.c, 0) + excess(f.d, 0);
    const Index after = excess(f.a, -1) + excess(f.b, -1) + excess(f.c, 1) + excess(f.d, 1);
    if (after < before && f.flipped_angle(s) >= std::min(thin, f.angle(s))) (void)s.flip(e.a, e.b);
  }
}

/// Flips that raise the smaller of the smallest angles of two triangles, until none does.
inline void flip_to_angle(EditableSurface& s) {
  constexpr int most_rounds = 10;
  bool changed = true;
  for (int round = 0; changed && round < most_rounds; ++round) {
    changed = false;
    for (const EditEdge& e : edges_of(s, [](double) { return true; })) {
      if (!has_edge(s, e.a, e.b) || s.on_rim(e.a, e.b)) continue;
      const FlipView f(s, e.a, e.b);
      if (f.flipped_angle(s) > f.angle(s) * (1 + 1e-6) && s.flip(e.a, e.b)) changed = true;
    }
  }
}

}  // namespace tunica::meshing
