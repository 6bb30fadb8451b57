// SPDX-License-Identifier: MIT
// The eight voxels round a corner of the lattice: which of them hang together by faces, and where they touch
// by an edge or by the corner alone.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace tunica::meshing::detail {

/// Octant o lies at (o & 1, o >> 1 & 1, o >> 2) of the corner.
struct Octants {
  std::array<std::int8_t, 8> part{};  // of each inside octant, numbered by their lowest ones; -1 outside
  std::int8_t parts = 0;              // that faces join
  std::int8_t outside_parts = 0;
  std::uint8_t edges = 0;  // bit 2a + s: on the lattice edge from the corner along +-a two voxels touch
                           // by that edge alone (s = 1 upward)
};

/// The octants that share a face with one of the set, and the set.
[[nodiscard]] constexpr unsigned grown(unsigned set) {
  return set | (set & 0x55U) << 1 | (set & 0xAAU) >> 1 | (set & 0x33U) << 2 | (set & 0xCCU) >> 2 |
         (set & 0x0FU) << 4 | (set & 0xF0U) >> 4;
}

[[nodiscard]] constexpr std::int8_t octant_parts(unsigned set, std::array<std::int8_t, 8>& part) {
  part = {-1, -1, -1, -1, -1, -1, -1, -1};
  std::int8_t count = 0;
  for (unsigned left = set; left != 0; ++count) {
    unsigned one = left & (~left + 1);
    for (unsigned before = 0; before != one;) before = one, one = grown(one) & set;
    for (unsigned o = 0; o < 8; ++o)
      if ((one >> o & 1U) != 0) part[o] = count;
    left &= ~one;
  }
  return count;
}

[[nodiscard]] constexpr std::array<Octants, 256> make_octants() {
  std::array<Octants, 256> all{};
  for (unsigned set = 0; set < 256; ++set) {
    Octants& o = all[set];
    std::array<std::int8_t, 8> other{};
    o.parts = octant_parts(set, o.part);
    o.outside_parts = octant_parts(~set & 255U, other);
    for (unsigned a = 0; a < 3; ++a)
      for (unsigned s = 0; s < 2; ++s) {
        const unsigned b = (a + 1) % 3, c = (a + 2) % 3, at = s << a;
        const auto in = [&](unsigned u, unsigned v) { return (set >> (at | u << b | v << c) & 1U) != 0; };
        if (in(0, 0) == in(1, 1) && in(1, 0) == in(0, 1) && in(0, 0) != in(1, 0))
          o.edges = static_cast<std::uint8_t>(o.edges | 1U << (2 * a + s));
      }
  }
  return all;
}

inline constexpr std::array<Octants, 256> octants = make_octants();

/// Neither the inside nor the outside falls apart at the corner, and no two voxels touch by an edge alone:
/// the border of the voxels is a surface there.
[[nodiscard]] constexpr bool surface_at(unsigned set) {
  const Octants& o = octants[set];
  return o.parts <= 1 && o.outside_parts <= 1 && o.edges == 0;
}

}  // namespace tunica::meshing::detail
