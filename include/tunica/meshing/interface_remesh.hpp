// SPDX-License-Identifier: MIT
// Remeshing of interfaces to an edge length [BOTSCH04]: long edges are split, short ones collapsed, thin
// triangles flipped away; junction curves stay curves and corners stay.
#pragma once

#include "tunica/meshing/editable_interfaces.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>
#include <vector>

namespace tunica::meshing {

namespace detail {

inline constexpr double least_angle = 0.35;  // [rad] 20 degrees: no collapse makes thinner triangles

struct InterfaceLength {
  double length;
  Index a, b;
  [[nodiscard]] bool operator<(const InterfaceLength& o) const {
    return length != o.length ? length < o.length : a != o.a ? a < o.a : b < o.b;
  }
};

/// Edges whose length is wanted, shortest first, each once.
template <class Wanted>
[[nodiscard]] std::vector<InterfaceLength> lengths(const EditableInterfaces& s, Wanted&& wanted) {
  std::vector<InterfaceLength> list;
  for (Index t = 0; t < s.triangle_count(); ++t) {
    if (!s.alive(t)) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = s.nodes(t)[k], b = s.nodes(t)[(k + 1) % 3];
      if (const double l = s.length(a, b); wanted(l)) list.push_back({l, std::min(a, b), std::max(a, b)});
    }
  }
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end(),
                         [](const auto& p, const auto& q) { return p.a == q.a && p.b == q.b; }),
             list.end());
  return list;
}

/// Flips as long as they make thin triangles less thin: edges of all triangles from `first` on, then of those
/// that the round before has made.
inline void flip_thin(EditableInterfaces& s, Index first = 0) {
  constexpr int rounds = 6;
  for (int round = 0; round < rounds; ++round) {
    const Index end = s.triangle_count();
    for (Index t = first; t < end; ++t)
      for (std::size_t k = 0; k < 3 && s.alive(t); ++k) (void)s.flip(s.nodes(t)[k], s.nodes(t)[(k + 1) % 3]);
    if (s.triangle_count() == end) return;
    first = end;
  }
}

inline void split_long(EditableInterfaces& s, double edge) {
  auto list = lengths(s, [&](double l) { return l > 4.0 / 3 * edge; });
  std::reverse(list.begin(), list.end());
  for (const auto& e : list) (void)s.split(e.a, e.b);
}

/// Edges below the length that are still there are merged, unless a triangle below the least angle results.
inline Index collapse_short(EditableInterfaces& s, double below) {
  Index done = 0;
  for (const auto& e : lengths(s, [&](double l) { return l < below; }))
    if (s.used(e.a) && s.used(e.b) && s.length(e.a, e.b) < below) done += s.collapse(e.a, e.b, least_angle);
  return done;
}

/// The shortest edges of triangles thinner than the angle [rad] are merged.
inline void collapse_thin(EditableInterfaces& s, double angle) {
  for (Index t = 0, end = s.triangle_count(); t < end; ++t) {
    if (!s.alive(t) || !(s.triangle(s.nodes(t)).smallest_angle() < angle)) continue;
    std::array<InterfaceLength, 3> e{};
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = s.nodes(t)[k], b = s.nodes(t)[(k + 1) % 3];
      e[k] = {s.length(a, b), std::min(a, b), std::max(a, b)};
    }
    const InterfaceLength& least = e[1] < e[0] ? (e[2] < e[1] ? e[2] : e[1]) : e[2] < e[0] ? e[2] : e[0];
    (void)s.collapse(least.a, least.b, angle);
  }
}

}  // namespace detail

/// Flips and collapses of thin triangles alone.
[[nodiscard]] inline Interfaces tidied(Interfaces s, double edge) {
  EditableInterfaces work(std::move(s), edge);
  detail::flip_thin(work);
  detail::collapse_thin(work, detail::least_angle);
  detail::flip_thin(work);
  return work.interfaces();
}

/// Edits the interfaces towards edges of the given length (unit of the image).
[[nodiscard]] inline Interfaces remeshed(Interfaces s, double edge) {
  constexpr int passes = 4;
  EditableInterfaces work(std::move(s), edge);
  for (int pass = 0; pass < passes; ++pass) {
    const Index first = pass == 0 ? 0 : work.triangle_count();
    detail::split_long(work, edge);
    const Index done = detail::collapse_short(work, 0.8 * edge);
    detail::flip_thin(work, first);
    if (done == 0) break;
  }
  detail::collapse_thin(work, detail::least_angle);
  detail::flip_thin(work);
  return work.interfaces();
}

}  // namespace tunica::meshing
