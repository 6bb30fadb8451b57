// SPDX-License-Identifier: MIT
// The loops in which a contour crosses the faces of a grid cell: one vertex of the dual mesh each.
// [SCHAEFER07, 3], with the choice on ambiguous faces made for the pair of cells that share them
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace tunica::meshing::detail {

/// Corner c of a cell is at (c & 1, c >> 1 & 1, c >> 2). Edge 4a + u + 2v runs along axis a, with
/// offset u along axis a+1 and v along axis a+2 (modulo 3). Face 2a + s is at offset s along axis a;
/// its corners and edges go round by axis a+1 first: edge n lies between corners n and n+1.
struct CellTables {
  std::array<std::array<int, 2>, 12> edge_corners{};
  std::array<std::array<int, 4>, 6> face_corners{}, face_edges{};

  constexpr CellTables() {
    const auto corner = [](int a, int s, int u, int v) {
      return s << a | u << ((a + 1) % 3) | v << ((a + 2) % 3);
    };
    for (int a = 0; a < 3; ++a) {
      for (int o = 0; o < 4; ++o)
        edge_corners[static_cast<std::size_t>(4 * a + o)] = {corner(a, 0, o & 1, o >> 1),
                                                             corner(a, 1, o & 1, o >> 1)};
      const int b = (a + 1) % 3, c = (a + 2) % 3;
      for (int s = 0; s < 2; ++s) {
        const auto f = static_cast<std::size_t>(2 * a + s);
        face_corners[f] = {corner(a, s, 0, 0), corner(a, s, 1, 0), corner(a, s, 1, 1), corner(a, s, 0, 1)};
        // along b the other offsets are (c, a), along c they are (a, b)
        face_edges[f] = {4 * b + 0 + 2 * s, 4 * c + s + 2, 4 * b + 1 + 2 * s, 4 * c + s + 0};
      }
    }
  }
};
inline constexpr CellTables cell_tables{};

/// Loop number of each of the 12 edges of a cell (-1: not crossed), and how many loops there are.
struct CellLoops {
  std::array<std::int8_t, 12> loop{};
  std::int8_t count = 0;
};

[[nodiscard]] constexpr bool corner_inside(unsigned signs, int corner) {
  return (signs >> corner & 1U) != 0;
}

/// The four corners alternate: the contour can pass the face in two ways.
[[nodiscard]] constexpr bool ambiguous(unsigned signs, std::size_t face) {
  const auto& c = cell_tables.face_corners[face];
  const bool first = corner_inside(signs, c[0]);
  return corner_inside(signs, c[2]) == first && corner_inside(signs, c[1]) != first &&
         corner_inside(signs, c[3]) != first;
}

/// On an ambiguous face the inside corners are kept apart; where its bit of `joined` is set they are
/// joined. Loops are numbered by their lowest edges.
[[nodiscard]] inline CellLoops cell_loops(unsigned signs, unsigned joined) {
  std::array<int, 12> root{};
  for (int e = 0; e < 12; ++e) root[static_cast<std::size_t>(e)] = e;
  const auto find = [&](int e) {
    while (root[static_cast<std::size_t>(e)] != e) e = root[static_cast<std::size_t>(e)];
    return e;
  };
  const auto join = [&](int e, int f) {
    e = find(e), f = find(f);
    root[static_cast<std::size_t>(e > f ? e : f)] = e > f ? f : e;
  };
  const auto crossed = [&](int e) {
    const auto& c = cell_tables.edge_corners[static_cast<std::size_t>(e)];
    return corner_inside(signs, c[0]) != corner_inside(signs, c[1]);
  };
  for (std::size_t f = 0; f < 6; ++f) {
    const auto& e = cell_tables.face_edges[f];
    if (ambiguous(signs, f)) {
      // corner n lies between edges n-1 and n: a pair of edges cuts off its corner
      const bool cut_even = corner_inside(signs, cell_tables.face_corners[f][0]) != ((joined >> f & 1U) != 0);
      if (cut_even)
        join(e[3], e[0]), join(e[1], e[2]);
      else
        join(e[0], e[1]), join(e[2], e[3]);
    } else {
      int first = -1;
      for (const int edge : e) {
        if (!crossed(edge)) continue;
        if (first >= 0) join(first, edge);
        first = edge;
      }
    }
  }
  CellLoops result;
  std::array<std::int8_t, 12> number{};
  for (int e = 0; e < 12; ++e) {
    const auto at = static_cast<std::size_t>(e);
    result.loop[at] = -1;
    if (!crossed(e)) continue;
    if (find(e) == e) number[at] = result.count++;
    result.loop[at] = number[static_cast<std::size_t>(find(e))];
  }
  return result;
}

/// Both strands of the contour on an ambiguous face belong to one loop.
[[nodiscard]] inline bool strands_meet(const CellLoops& loops, std::size_t face) {
  const auto& e = cell_tables.face_edges[face];
  for (const int edge : e)
    if (loops.loop[static_cast<std::size_t>(edge)] != loops.loop[static_cast<std::size_t>(e[0])])
      return false;
  return true;
}

}  // namespace tunica::meshing::detail
