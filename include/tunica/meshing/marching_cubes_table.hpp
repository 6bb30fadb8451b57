// SPDX-License-Identifier: MIT
// The 256 cases of marching cubes [LORENSEN87], generated: loops by one rule for all faces, then the best
// triangulation of each loop without a chord in a face of the cell.
#pragma once

#include "tunica/meshing/cell_loops.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

namespace tunica::meshing::detail {

/// Triangles of one case: edges of the cell (numbered as in CellTables), normals from inside to outside.
struct MarchingCase {
  static constexpr std::size_t capacity = 8;
  std::array<std::array<std::int8_t, 3>, capacity> triangle{};
  std::int8_t count = 0;
};

/// The two edges lie in one face of the cell: the neighbour beyond it could use the same chord.
[[nodiscard]] constexpr bool share_face(int e, int f) {
  for (const auto& face : cell_tables.face_edges) {
    int found = 0;
    for (const int edge : face) found += (edge == e) + (edge == f);
    if (found == 2) return true;
  }
  return false;
}

/// The edge that follows edge e on the contour, -1 where e is not crossed. Seen from outside the cell, going
/// round a face counter-clockwise, a strand runs from where the walk enters the inside to where it
/// next leaves it: inside corners of an ambiguous face stay apart, the same in both cells of the face.
[[nodiscard]] constexpr std::array<int, 12> strands(unsigned signs) {
  std::array<int, 12> next{};
  for (int& e : next) e = -1;
  for (std::size_t f = 0; f < 6; ++f) {
    const bool reversed = f % 2 == 0;  // tables go round the +axis: clockwise from outside on the low faces
    const auto corner = [&](std::size_t n) {
      return corner_inside(signs, cell_tables.face_corners[f][reversed ? (4 - n % 4) % 4 : n % 4]);
    };
    const auto edge = [&](std::size_t n) { return cell_tables.face_edges[f][reversed ? 3 - n % 4 : n % 4]; };
    for (std::size_t n = 0; n < 4; ++n) {
      if (corner(n) || !corner(n + 1)) continue;
      std::size_t m = n + 1;
      while (corner(m + 1)) ++m;
      next[static_cast<std::size_t>(edge(n))] = edge(m);
    }
  }
  return next;
}

/// Quality (area squared over the sum of squared edges squared) of a triangle of edge midpoints.
[[nodiscard]] constexpr double midpoint_quality(int e, int f, int g) {
  const auto mid = [](int edge) {
    const auto& c = cell_tables.edge_corners[static_cast<std::size_t>(edge)];
    std::array<double, 3> x{};
    for (int a = 0; a < 3; ++a) x[static_cast<std::size_t>(a)] = 0.5 * ((c[0] >> a & 1) + (c[1] >> a & 1));
    return x;
  };
  const auto p = mid(e), q = mid(f), r = mid(g);
  double uu = 0, vv = 0, uv = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    const double u = q[a] - p[a], v = r[a] - p[a];
    uu += u * u, vv += v * v, uv += u * v;
  }
  const double sum = uu + vv + (uu + vv - 2 * uv);
  return (uu * vv - uv * uv) / (sum * sum);
}

/// Adds the triangulation of the loop whose worst triangle is best, by dynamic programming over its
/// sub-polygons; chords in a face of the cell are forbidden.
inline void triangulate_loop(const std::array<int, 12>& loop, std::size_t n, MarchingCase& out) {
  constexpr double forbidden = -1;
  std::array<std::array<double, 12>, 12> best{};  // of the sub-polygon i..j
  std::array<std::array<std::size_t, 12>, 12> apex{};
  const auto open = [&](std::size_t i, std::size_t j) {
    return j - i == 1 || (i == 0 && j == n - 1) || !share_face(loop[i], loop[j]);
  };
  for (std::size_t width = 1; width < n; ++width)
    for (std::size_t i = 0; i + width < n; ++i) {
      const std::size_t j = i + width;
      best[i][j] = width == 1 ? 1.0 : forbidden;
      if (width == 1 || !open(i, j)) continue;
      for (std::size_t m = i + 1; m < j; ++m) {
        double q = midpoint_quality(loop[i], loop[m], loop[j]);
        if (best[i][m] < q) q = best[i][m];
        if (best[m][j] < q) q = best[m][j];
        if (q > best[i][j]) best[i][j] = q, apex[i][j] = m;
      }
    }
  std::array<std::array<std::size_t, 2>, 24> todo{};
  std::size_t size = 0;
  todo[size++] = {0, n - 1};
  while (size > 0) {
    const auto [i, j] = todo[--size];
    if (j - i < 2) continue;
    const std::size_t m = apex[i][j];
    out.triangle[static_cast<std::size_t>(out.count++)] = {static_cast<std::int8_t>(loop[i]),
                                                           static_cast<std::int8_t>(loop[m]),
                                                           static_cast<std::int8_t>(loop[j])};
    todo[size++] = {i, m};
    todo[size++] = {m, j};
  }
}

[[nodiscard]] inline MarchingCase marching_case(unsigned signs) {
  MarchingCase result;
  const auto next = strands(signs);
  std::array<bool, 12> done{};
  for (int first = 0; first < 12; ++first) {
    if (next[static_cast<std::size_t>(first)] < 0 || done[static_cast<std::size_t>(first)]) continue;
    std::array<int, 12> loop{};
    std::size_t n = 0;
    for (int e = first; !done[static_cast<std::size_t>(e)]; e = next[static_cast<std::size_t>(e)])
      done[static_cast<std::size_t>(e)] = true, loop[n++] = e;
    triangulate_loop(loop, n, result);
  }
  return result;
}

/// Case number: bit c is set where corner c is inside.
[[nodiscard]] inline const std::array<MarchingCase, 256>& marching_table() {
  static const auto table = [] {
    std::array<MarchingCase, 256> t;
    for (unsigned signs = 0; signs < 256; ++signs) t[signs] = marching_case(signs);
    return t;
  }();
  return table;
}

}  // namespace tunica::meshing::detail
