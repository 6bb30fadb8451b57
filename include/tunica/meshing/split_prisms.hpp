// SPDX-License-Identifier: MIT
// A prism between two triangles of a column, split into three tetrahedra by the diagonals that start at the
// lower node number: neighbours agree [DOMPIERRE99]. Where a column has no height its tetrahedra vanish.
#pragma once

#include "tunica/core/vec.hpp"
#include "tunica/meshing/predicates.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace tunica::meshing {

/// Corners of a prism: 0-2 the base, 3-5 above them, the normal of (0, 1, 2) towards the top.
using Prism = std::array<Index, 6>;
using PrismCorners = std::array<Vec3, 6>;

/// Calls emit(tetrahedron) for the three of the prism, all of positive orientation where the prism is; those
/// with a node twice are left out. rank: an order of the three columns that all prisms share.
template <class Emit>
void split_prism(const Prism& p, const std::array<Index, 3>& rank, Emit&& emit) {
  std::size_t first = 0;  // turned so that the lowest column comes first
  for (std::size_t k = 1; k < 3; ++k)
    if (rank[k] < rank[first]) first = k;
  const std::size_t i = first, j = (first + 1) % 3, k = (first + 2) % 3;
  const Index a = p[i], b = p[j], c = p[k], d = p[3 + i], e = p[3 + j], f = p[3 + k];
  const auto send = [&](std::array<Index, 4> t) {
    if (t[0] != t[3] && t[1] != t[3] && t[2] != t[3] && t[0] != t[1] && t[1] != t[2] && t[0] != t[2]) emit(t);
  };
  // All diagonals at the lowest column start at its base, a; the face across has b-f or c-e.
  if (rank[j] < rank[k]) {
    send({a, b, c, f}), send({a, e, b, f}), send({a, e, f, d});
  } else {
    send({a, b, c, e}), send({a, e, c, f}), send({a, e, f, d});
  }
}

/// Calls emit(triangle) for the two of the side with base (a, b) and top (c above a, d above b), turned as
/// (a, b, d, c), split as the prisms beside it; degenerate ones are left out.
template <class Emit>
void split_side(Index a, Index b, Index c, Index d, bool a_first, Emit&& emit) {
  const auto send = [&](std::array<Index, 3> t) {
    if (t[0] != t[1] && t[1] != t[2] && t[0] != t[2]) emit(t);
  };
  if (a_first) {
    send({a, b, d}), send({a, d, c});
  } else {
    send({a, b, c}), send({b, d, c});
  }
}

namespace detail {

/// The twelve tetrahedra of all ways to split a prism: each holds one column wholly (`column`), and is
/// positive where the prism is.
struct PrismTet {
  std::array<std::size_t, 4> node;
  std::size_t column;
};
inline constexpr std::array<PrismTet, 12> prism_tets{{{{0, 1, 2, 3}, 0},
                                                      {{0, 1, 2, 4}, 1},
                                                      {{0, 1, 2, 5}, 2},
                                                      {{3, 5, 4, 0}, 0},
                                                      {{3, 5, 4, 1}, 1},
                                                      {{3, 5, 4, 2}, 2},
                                                      {{0, 4, 1, 5}, 1},
                                                      {{0, 2, 5, 4}, 2},
                                                      {{1, 5, 2, 3}, 2},
                                                      {{1, 0, 3, 5}, 0},
                                                      {{2, 3, 0, 4}, 0},
                                                      {{2, 1, 4, 3}, 1}}};

}  // namespace detail

/// Least over all ways to split of the volume of a tetrahedron, over that of a right prism's on the same base
/// with the same column: 1 for a right prism, <= 0 where some tetrahedron is inverted (the sign is exact).
/// base: twice the area of the triangle on the wall. Columns without height do not count.
[[nodiscard]] inline double prism_quality(const PrismCorners& x, double base) {
  double least = 1;
  for (const auto& t : detail::prism_tets) {
    const double height = vec::distance(x[t.column], x[t.column + 3]);
    if (!(height > 0)) continue;
    const double volume = orient3d(x[t.node[0]], x[t.node[1]], x[t.node[2]], x[t.node[3]]);
    least = std::min(least, volume / (base * height));
  }
  return least;
}

}  // namespace tunica::meshing
