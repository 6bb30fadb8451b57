// SPDX-License-Identifier: MIT
// Nodes of a grid that hang together with few others of their sign: what is left of parts and of gaps that
// are thinner than the spacing.
#pragma once

#include "tunica/meshing/hermite.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tunica::meshing {

struct [[nodiscard]] GridSpecks {
  std::size_t dropped = 0, filled = 0;  // parts of inside nodes, and of outside ones
  std::vector<Vec3> places;             // a node of each, in that order
};

namespace detail {

/// The sets of nodes of one sign that edges join, where they have less than `least` nodes; `rest` tells
/// whether there are others.
[[nodiscard]] inline std::vector<std::vector<std::size_t>> small_parts(const HermiteGrid& grid,
                                                                       std::uint8_t sign, std::size_t least,
                                                                       bool& rest) {
  const auto stride = grid.strides();
  std::vector<std::vector<std::size_t>> small;
  std::vector<std::uint8_t> seen(grid.inside.size(), 0);
  std::vector<std::size_t> part;
  rest = false;
  // a small part has a crossed edge at some node: seeds are taken there
  for (const std::size_t e : grid.edges)
    for (const std::size_t seed : {e / 3, e / 3 + stride[e % 3]}) {
      if (grid.inside[seed] != sign || seen[seed] != 0) continue;
      part.assign(1, seed), seen[seed] = 1;
      bool large = false;
      for (std::size_t i = 0; i < part.size() && !large; ++i)
        for (const std::size_t s : stride)
          for (const bool up : {false, true}) {
            if (!up && part[i] < s) continue;
            const std::size_t m = up ? part[i] + s : part[i] - s;
            if (m >= seen.size() || grid.inside[m] != sign) continue;
            if (seen[m] == 2) large = true;  // it belongs to a large part
            if (seen[m] != 0) continue;
            seen[m] = 1, part.push_back(m);
            large = large || part.size() >= least;
          }
      if (large)
        for (const std::size_t n : part) seen[n] = 2;
      else
        small.push_back(part);
      rest = rest || large;
    }
  return small;
}

}  // namespace detail

/// Gives parts of less than `least` nodes the other sign; the largest of the inside ones stays if all are so.
inline GridSpecks remove_specks(HermiteGrid& grid, std::size_t least) {
  GridSpecks specks;
  const auto remove = [&](std::uint8_t sign) {
    bool rest = false;
    const auto small = detail::small_parts(grid, sign, least, rest);
    const auto largest = std::max_element(small.begin(), small.end(),
                                          [](const auto& p, const auto& q) { return p.size() < q.size(); }) -
                         small.begin();
    for (std::size_t p = 0; p < small.size(); ++p) {
      if (sign != 0 && !rest && static_cast<std::ptrdiff_t>(p) == largest) continue;
      ++(sign != 0 ? specks.dropped : specks.filled);
      specks.places.push_back(grid.point(small[p].front()));
      for (const std::size_t n : small[p]) grid.inside[n] = sign != 0 ? 0 : 1;
    }
  };
  remove(1);
  remove(0);
  if (specks.places.empty()) return specks;
  const auto stride = grid.strides();
  std::size_t left = 0;
  for (std::size_t e = 0; e < grid.edges.size(); ++e) {
    const std::size_t node = grid.edges[e] / 3;
    if (grid.inside[node] == grid.inside[node + stride[grid.edges[e] % 3]]) continue;
    grid.edges[left] = grid.edges[e], grid.crossings[left] = grid.crossings[e], ++left;
  }
  grid.edges.resize(left), grid.crossings.resize(left);
  return specks;
}

}  // namespace tunica::meshing
