// SPDX-License-Identifier: MIT
// The trilinear map of a hexahedron at the corners and the middles of its edges, faces and itself; whether
// its determinant is positive everywhere, by its Bezier coefficients. [JOHNEN17]
#pragma once

#include "tunica/core/vec.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace tunica::meshing::detail {

/// Derivatives of the shape functions at 27 points, (i, j, k) / 2 with i + 3 j + 9 k their number:
/// by[point][axis][node].
struct HexPointTable {
  std::array<std::array<std::array<double, 8>, 3>, 27> by{};

  HexPointTable() {
    constexpr int side[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
    for (std::size_t p = 0; p < 27; ++p) {
      const std::array<std::size_t, 3> at{p % 3, p / 3 % 3, p / 9};
      std::array<double, 3> t{};
      for (std::size_t a = 0; a < 3; ++a) t[a] = 0.5 * static_cast<double>(at[a]);
      for (std::size_t a = 0; a < 3; ++a)
        for (std::size_t n = 0; n < 8; ++n) {
          double w = side[n][a] != 0 ? 1 : -1;
          for (std::size_t b = 0; b < 3; ++b)
            if (b != a) w *= side[n][b] != 0 ? t[b] : 1 - t[b];
          by[p][a][n] = w;
        }
    }
  }
};
inline const HexPointTable hex_points{};
inline constexpr std::size_t hex_centre = 13;

[[nodiscard]] constexpr bool is_hex_corner(std::size_t p) {
  return p % 3 != 1 && p / 3 % 3 != 1 && p / 9 != 1;
}

/// Derivatives of the map at a point.
[[nodiscard]] inline std::array<Vec3, 3> point_edges(const std::vector<Vec3>& x,
                                                     const std::array<Index, 8>& cell, std::size_t point) {
  std::array<Vec3, 3> e{Vec3(0, 0, 0), Vec3(0, 0, 0), Vec3(0, 0, 0)};
  for (std::size_t n = 0; n < 8; ++n) {
    const Vec3& at = x[static_cast<std::size_t>(cell[n])];
    for (std::size_t a = 0; a < 3; ++a) {
      const double w = hex_points.by[point][a][n];
      if (w != 0) e[a] = vec::along(e[a], w, at);
    }
  }
  return e;
}

[[nodiscard]] inline double determinant(const std::array<Vec3, 3>& e) {
  return vec::dot(vec::cross(e[0], e[1]), e[2]);
}

/// The edges along each axis hardly differ: det >= det of their means less what their deviations can take.
[[nodiscard]] inline bool nearly_parallel(const std::vector<Vec3>& x, const std::array<Index, 8>& cell) {
  constexpr std::size_t ends[3][4][2] = {
      {{0, 1}, {3, 2}, {4, 5}, {7, 6}}, {{0, 3}, {1, 2}, {4, 7}, {5, 6}}, {{0, 4}, {1, 5}, {2, 6}, {3, 7}}};
  const auto mean = point_edges(x, cell, hex_centre);
  double length[3], off[3] = {0, 0, 0};
  for (std::size_t a = 0; a < 3; ++a) {
    length[a] = vec::length(mean[a]);
    for (const auto& e : ends[a])
      off[a] = std::max(off[a], vec::squared(vec::minus(vec::minus(x[static_cast<std::size_t>(cell[e[1]])],
                                                                   x[static_cast<std::size_t>(cell[e[0]])]),
                                                        mean[a])));
    off[a] = std::sqrt(off[a]);
  }
  const double most = (length[0] + off[0]) * (length[1] + off[1]) * (length[2] + off[2]);
  return determinant(mean) > most - length[0] * length[1] * length[2];
}

/// det J > 0 in the whole cell. It is quadratic along each axis: its Bezier coefficients bound it, and those
/// of the halves of the cell do so more closely; what `depth` halvings leave open counts as not positive.
[[nodiscard]] inline bool positive_everywhere(std::array<double, 27> bezier, int depth) {
  bool all = true;
  for (std::size_t p = 0; p < 27; ++p) {
    if (bezier[p] > 0) continue;
    if (is_hex_corner(p)) return false;  // a value of the determinant
    all = false;
  }
  if (all) return true;
  if (depth == 0) return false;
  const std::size_t axis = static_cast<std::size_t>(depth % 3);
  const std::size_t step = axis == 0 ? 1 : axis == 1 ? 3 : 9;
  std::array<double, 27> low = bezier, high = bezier;  // de Casteljau at the middle
  for (std::size_t p = 0; p < 27; ++p) {
    if (p / step % 3 != 0) continue;
    const double a = bezier[p], b = bezier[p + step], c = bezier[p + 2 * step];
    const double ab = 0.5 * (a + b), bc = 0.5 * (b + c), middle = 0.5 * (ab + bc);
    low[p + step] = ab, low[p + 2 * step] = middle;
    high[p] = middle, high[p + step] = bc;
  }
  return positive_everywhere(low, depth - 1) && positive_everywhere(high, depth - 1);
}

[[nodiscard]] inline bool positive_everywhere(const std::vector<Vec3>& x, const std::array<Index, 8>& cell) {
  constexpr int halvings = 9;
  if (nearly_parallel(x, cell)) return true;
  std::array<double, 27> f{};
  for (std::size_t p = 0; p < 27; ++p) {
    f[p] = determinant(point_edges(x, cell, p));
    if (!(f[p] > 0)) return false;
  }
  for (const std::size_t step : {1, 3, 9})  // values to coefficients: b1 = 2 f(1/2) - (f(0) + f(1)) / 2
    for (std::size_t p = 0; p < 27; ++p)
      if (p / step % 3 == 1) f[p] = 2 * f[p] - 0.5 * (f[p - step] + f[p + step]);
  return positive_everywhere(f, halvings);
}

}  // namespace tunica::meshing::detail
