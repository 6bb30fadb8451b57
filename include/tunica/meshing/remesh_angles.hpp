// SPDX-License-Identifier: MIT
// Triangles with small angles: a short edge is collapsed, or a corner moved to raise the worst angle there.
#pragma once

#include "tunica/meshing/remesh_lengths.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <numbers>
#include <utility>
#include <vector>

namespace tunica::meshing::detail {

[[nodiscard]] inline double worst_about(const EditableSurface& s, Index n) {
  double worst = std::numbers::pi;
  for (const Index t : s.ring(n)) worst = std::min(worst, s.triangle(t).smallest_angle());
  return worst;
}

/// Tries a few places about a node and keeps the one with the largest smallest angle.
template <class Size>
void raise(RemeshState<Size>& w, Index n) {
  EditableSurface& s = w.edit;
  const NodeKind kind = kind_of(s, n);
  if (kind == NodeKind::corner) return;
  // of the way to a neighbour, about half each time
  constexpr std::array<double, 4> steps{0.3, 0.15, 0.07, 0.03};
  double best = worst_about(s, n);
  for (const double step : steps) {
    const auto m = kind == NodeKind::rim ? rim_neighbours(s, n) : s.neighbours(n);
    for (const Index to : m) {
      const Vec3 from = s.x(n);
      const Vec3 place = w.on_target(n, from + step * (s.x(to) - from));
      if (!s.move(n, place)) continue;
      const double now = worst_about(s, n);
      if (now > best)
        best = now;
      else
        (void)s.move(n, from);
    }
  }
}

// A triangle whose edges are between 4/5 and 4/3 of the target has 33 degrees or more. What has less than 25
// needs help, which may take edges a little outside of that range.
inline constexpr double wanted_angle = 0.44;  // [rad]

/// Works on the triangles below the wanted angle, the worst first.
template <class Size>
void repair_angles(RemeshState<Size>& w, double wanted = wanted_angle) {
  // Of the target length, on either side of 4/5 and 4/3: a side that collapses and the longest edge that it
  // may leave.
  constexpr double collapsed = 0.7, longest_made = 1.5;
  EditableSurface& s = w.edit;
  std::vector<std::pair<double, Index>> bad;
  for (Index t = 0; t < s.triangle_count(); ++t)
    if (s.alive(t))
      if (const double a = s.triangle(t).smallest_angle(); a < wanted) bad.emplace_back(a, t);
  std::sort(bad.begin(), bad.end());
  for (const auto& [a, t] : bad) {
    if (!s.alive(t) || s.triangle(t).smallest_angle() >= wanted) continue;
    const auto v = s.nodes(t);
    std::size_t shortest = 0;
    for (std::size_t k = 1; k < 3; ++k)
      if (s.length(v[k], v[(k + 1) % 3]) < s.length(v[shortest], v[(shortest + 1) % 3])) shortest = k;
    const Index p = v[shortest], q = v[(shortest + 1) % 3];
    if (s.length(p, q) < collapsed * w.size_of(p, q) && collapse(w, p, q, longest_made)) continue;
    for (const Index n : v) raise(w, n);
  }
}

}  // namespace tunica::meshing::detail
