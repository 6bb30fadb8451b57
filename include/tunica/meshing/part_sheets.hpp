// SPDX-License-Identifier: MIT
// Keeps the vertices of one cell apart: sheets whose errors are least outside of it can be held at one
// corner.
#pragma once

#include "tunica/core/vec.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace tunica::meshing::detail {

/// A cell has at most so many sheets: twelve edges, three for a loop.
inline constexpr std::size_t most_sheets = 4;

/// The vertices of a cell, each with the mean of its own crossings, held in the cell: these are apart.
struct Sheets {
  std::size_t count = 0;
  std::array<Vec3, most_sheets> place, mean;
};

[[nodiscard]] inline Vec3 held_in(const Box& box, Vec3 x) {
  for (int a = 0; a < 3; ++a) x[a] = std::min(std::max(x[a], box.lo[a]), box.hi[a]);
  return x;
}

/// Vertices nearer to each other than a thousandth of that size go an eighth of the way back to their means,
/// until they are not.
inline void part(Sheets& s, double size) {
  constexpr double closest = 1e-3, back = 0.125;
  constexpr int most_steps = 40;  // then they are at their means
  bool again = true;
  for (int step = 0; again && step < most_steps; ++step) {
    again = false;
    for (std::size_t v = 0; v < s.count; ++v)
      for (std::size_t w = v + 1; w < s.count; ++w) {
        if (!(vec::distance(s.place[v], s.place[w]) < closest * size)) continue;
        again = true;
        s.place[v] = vec::between(s.place[v], s.mean[v], back);
        s.place[w] = vec::between(s.place[w], s.mean[w], back);
      }
  }
}

}  // namespace tunica::meshing::detail
