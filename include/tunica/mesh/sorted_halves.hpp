// SPDX-License-Identifier: MIT
// The edges of triangles with what lies at them: half-edges in an order in which those of one edge follow
// each other.
#pragma once

#include "tunica/core/types.hpp"

#include <cstddef>
#include <vector>

namespace tunica::mesh {

/// An edge of a triangle, from its corner to the next one.
struct SortedHalf {
  Index a, b;  // its ends, a < b
  Index triangle;
  Index corner;  // 0, 1, 2
  bool forward;  // it runs from a to b
};

/// The half-edges of `triangles` triangles on `nodes` nodes by (a, b, triangle, corner); node(t, i) is the
/// number of corner i of triangle t. Counted out by b, then by a: in linear time.
template <class Node>
[[nodiscard]] std::vector<SortedHalf> sorted_halves(Index triangles, Index nodes, Node&& node) {
  const auto at = [](Index i) { return static_cast<std::size_t>(i); };
  const auto half = [&](Index h) {
    const Index t = h / 3, i = h % 3, from = node(t, i), to = node(t, (i + 1) % 3);
    return from < to ? SortedHalf{from, to, t, i, true} : SortedHalf{to, from, t, i, false};
  };
  std::vector<Index> next_a(at(nodes) + 1, 0), next_b(at(nodes) + 1, 0);  // place of the next one
  for (Index h = 0; h < 3 * triangles; ++h) {
    const SortedHalf s = half(h);
    ++next_a[at(s.a) + 1], ++next_b[at(s.b) + 1];
  }
  for (std::size_t n = 0; n < at(nodes); ++n) next_a[n + 1] += next_a[n], next_b[n + 1] += next_b[n];
  std::vector<Index> by_b(3 * at(triangles));
  for (Index h = 0; h < 3 * triangles; ++h) by_b[at(next_b[at(half(h).b)]++)] = h;
  std::vector<SortedHalf> sorted(by_b.size());
  for (const Index h : by_b) {
    const SortedHalf s = half(h);
    sorted[at(next_a[at(s.a)]++)] = s;
  }
  return sorted;
}

}  // namespace tunica::mesh
