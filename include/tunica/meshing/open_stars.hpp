// SPDX-License-Identifier: MIT
// Nodes whose triangles lie side by side: seen along one axis none of them covers another, so that no two of
// them have a point in common but the node and their common edges.
#pragma once

#include "tunica/mesh/mesh.hpp"
#include "tunica/meshing/predicates.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tunica::meshing::detail {

/// What is known of the triangles around a node; bit a belongs to the view along axis a.
struct Star {
  std::uint8_t left = 7, right = 7;  // all of them turn that way, by less than half a turn each
  std::uint8_t rises = 0, rises_again = 0;
  std::uint64_t balance = 0;  // numbers of the first ends of their far edges minus those of the last ones

  /// They are closed fans if each node is as often a first as a last one, and go round once if one of them
  /// rises through the height of the node.
  [[nodiscard]] bool open() const { return ((left | right) & rises & ~rises_again) != 0 && balance == 0; }
};

/// Another number of 64 bits for each node, without a pattern: sums of different nodes are different.
[[nodiscard]] constexpr std::uint64_t scattered(Index node) {
  auto n = static_cast<std::uint64_t>(node) + 0x9E3779B97F4A7C15U;
  n = (n ^ n >> 30U) * 0xBF58476D1CE4E5B9U;
  n = (n ^ n >> 27U) * 0x94D049BB133111EBU;
  return n ^ n >> 31U;
}

/// Bit a: the triangle turns left (the first number) or right (the second) seen along axis a, for certain
/// [SHEWCHUK97, table 3]; bit a is in neither where rounding leaves it open.
[[nodiscard]] inline std::array<unsigned, 2> turns_of(const double* p, const double* q, const double* r) {
  std::array<unsigned, 2> turns{};
  for (unsigned a = 0; a < 3; ++a) {
    const unsigned u = (a + 1) % 3, v = (a + 2) % 3;
    const double one = (q[u] - p[u]) * (r[v] - p[v]), other = (q[v] - p[v]) * (r[u] - p[u]);
    const double det = one - other, bound = orient2d_bound * (std::abs(one) + std::abs(other));
    turns[0] |= unsigned{det > bound} << a, turns[1] |= unsigned{-det > bound} << a;
  }
  return turns;
}

/// Bit a: seen along axis a, q lies below v and r does not.
[[nodiscard]] inline unsigned rises_of(const double* v, const double* q, const double* r) {
  unsigned rises = 0;
  for (unsigned a = 0; a < 3; ++a) {
    const unsigned height = (a + 2) % 3;
    rises |= (unsigned{q[height] < v[height]} & unsigned{r[height] >= v[height]}) << a;
  }
  return rises;
}

struct OpenStars {
  std::vector<std::uint8_t> open;     // of a node: its triangles meet in nothing but it and their edges
  std::vector<std::uint8_t> unknown;  // of a triangle: no view shows for certain that it has an area
};

[[nodiscard]] inline OpenStars open_stars(const mesh::Surface& s) {
  OpenStars result;
  result.open.resize(static_cast<std::size_t>(s.node_count()));
  result.unknown.resize(static_cast<std::size_t>(s.cell_count()));
  std::vector<Star> stars(result.open.size());
  std::vector<std::uint64_t> number(stars.size());
  for (std::size_t n = 0; n < number.size(); ++n) number[n] = scattered(static_cast<Index>(n));
  for (std::size_t t = 0; t < result.unknown.size(); ++t) {
    const Index* corner = s.cells.data() + 3 * t;
    const std::array<const double*, 3> x{s.nodes.data() + 3 * std::ptrdiff_t{corner[0]},
                                         s.nodes.data() + 3 * std::ptrdiff_t{corner[1]},
                                         s.nodes.data() + 3 * std::ptrdiff_t{corner[2]}};
    const auto [left, right] = turns_of(x[0], x[1], x[2]);
    result.unknown[t] = (left | right) == 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
      Star& star = stars[static_cast<std::size_t>(corner[i])];
      const unsigned rises = rises_of(x[i], x[j], x[k]);
      star.left = static_cast<std::uint8_t>(star.left & left);
      star.right = static_cast<std::uint8_t>(star.right & right);
      star.rises_again = static_cast<std::uint8_t>(star.rises_again | (star.rises & rises));
      star.rises = static_cast<std::uint8_t>(star.rises | rises);
      star.balance +=
          number[static_cast<std::size_t>(corner[j])] - number[static_cast<std::size_t>(corner[k])];
    }
  }
  for (std::size_t n = 0; n < stars.size(); ++n) result.open[n] = stars[n].open();
  return result;
}

}  // namespace tunica::meshing::detail
