// SPDX-License-Identifier: MIT
// Quality of triangles, tetrahedra and hexahedra: angles, mean ratio, scaled Jacobian, worst cells by place.
// Mean ratio after [LIUJOE94], scaled Jacobian after [KNUPP00].
#pragma once

#include "tunica/mesh/measures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <vector>

namespace tunica::mesh {

[[nodiscard]] constexpr double degrees(double radians) {
  return radians * (180 / std::numbers::pi);
}

/// Shape of a triangle, 4 sqrt(3) A / sum l^2: 1 equilateral, 0 degenerate.
[[nodiscard]] inline double mean_ratio(const Triangle& t) {
  const double l2 = vec::squared(vec::minus(t.b, t.a)) + vec::squared(vec::minus(t.c, t.b)) +
                    vec::squared(vec::minus(t.a, t.c));
  return l2 > 0 ? 4 * std::numbers::sqrt3 * t.area() / l2 : 0;
}

using TetCorners = std::array<Vec3, 4>;
using HexCorners = std::array<Vec3, 8>;

[[nodiscard]] inline TetCorners corners(const TetMesh& m, Index c) {
  return {vec::column(m.nodes, m.cells(0, c)), vec::column(m.nodes, m.cells(1, c)),
          vec::column(m.nodes, m.cells(2, c)), vec::column(m.nodes, m.cells(3, c))};
}

[[nodiscard]] inline HexCorners corners(const HexMesh& m, Index c) {
  HexCorners x;
  for (std::size_t n = 0; n < 8; ++n) x[n] = vec::column(m.nodes, m.cells(static_cast<Eigen::Index>(n), c));
  return x;
}

/// Inner dihedral angles [rad] at the edges of Tet4::edges, in their order; of an inverted cell those of
/// its mirror image.
[[nodiscard]] inline std::array<double, 6> dihedral_angles(const TetCorners& x) {
  std::array<Vec3, 4> n;  // outward normals of the faces, face i opposite to node i
  for (std::size_t f = 0; f < 4; ++f) {
    const auto& v = Tet4::faces[f];
    const Vec3 &a = x[static_cast<std::size_t>(v[0])], &b = x[static_cast<std::size_t>(v[1])];
    n[f] = vec::cross(vec::minus(b, a), vec::minus(x[static_cast<std::size_t>(v[2])], a));
  }
  std::array<double, 6> angle{};
  for (std::size_t e = 0; e < 6; ++e) {
    // the two faces that hold an edge are those opposite to the nodes of the opposite edge, number 5 - e
    const auto& far = Tet4::edges[5 - e];
    const Vec3 &p = n[static_cast<std::size_t>(far[0])], &q = n[static_cast<std::size_t>(far[1])];
    angle[e] = std::numbers::pi - std::atan2(vec::length(vec::cross(p, q)), vec::dot(p, q));
  }
  return angle;
}

/// Mean ratio 12 (3 V)^(2/3) / sum l^2 [LIUJOE94]: 1 regular, 0 flat, negative inverted.
[[nodiscard]] inline double mean_ratio(const TetCorners& x) {
  double l2 = 0;
  for (const auto& e : Tet4::edges)
    l2 += vec::squared(vec::minus(x[static_cast<std::size_t>(e[1])], x[static_cast<std::size_t>(e[0])]));
  const double c = std::cbrt(3 * tet_volume(x[0], x[1], x[2], x[3]));
  return l2 > 0 ? std::copysign(12 * c * c / l2, c) : 0;
}

/// The edges that leave a corner of Hex8, ordered so that the corner of a cube is right-handed.
inline constexpr std::array<std::array<int, 3>, 8> hex_corner_axes{
    {{1, 3, 4}, {2, 0, 5}, {3, 1, 6}, {0, 2, 7}, {7, 5, 0}, {4, 6, 1}, {5, 7, 2}, {6, 4, 3}}};

/// Scaled Jacobian [KNUPP00]: least over corners and centre of det of the unit edge vectors; 1 for a brick,
/// <= 0 inverted.
[[nodiscard]] inline double scaled_jacobian(const HexCorners& x) {
  const auto scaled = [](const Vec3& u, const Vec3& v, const Vec3& w) {
    const double l = vec::length(u) * vec::length(v) * vec::length(w);
    return l > 0 ? vec::dot(vec::cross(u, v), w) / l : 0.0;
  };
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t c = 0; c < 8; ++c) {
    const auto edge = [&](std::size_t a) {
      return vec::minus(x[static_cast<std::size_t>(hex_corner_axes[c][a])], x[c]);
    };
    least = std::min(least, scaled(edge(0), edge(1), edge(2)));
  }
  Vec3 u, v, w;  // through the centre
  for (int a = 0; a < 3; ++a) {
    u[a] = x[1][a] + x[2][a] + x[5][a] + x[6][a] - x[0][a] - x[3][a] - x[4][a] - x[7][a];
    v[a] = x[2][a] + x[3][a] + x[6][a] + x[7][a] - x[0][a] - x[1][a] - x[4][a] - x[5][a];
    w[a] = x[4][a] + x[5][a] + x[6][a] + x[7][a] - x[0][a] - x[1][a] - x[2][a] - x[3][a];
  }
  return std::min(least, scaled(u, v, w));
}

/// Scaled Jacobian of a tetrahedron [KNUPP00]: least over corners of sqrt(2) det of the unit edge vectors; 1
/// regular, <= 0 inverted.
[[nodiscard]] inline double scaled_jacobian(const TetCorners& x) {
  const auto edge = [&](std::size_t a, std::size_t b) { return vec::distance(x[a], x[b]); };
  double longest = 0;  // product of the three edges at a corner
  for (std::size_t c = 0; c < 4; ++c)
    longest = std::max(longest, edge(c, (c + 1) % 4) * edge(c, (c + 2) % 4) * edge(c, (c + 3) % 4));
  return longest > 0 ? std::numbers::sqrt2 * 6 * tet_volume(x[0], x[1], x[2], x[3]) / longest : 0;
}

/// Scaled Jacobian of a triangle: least over corners of the sine of the angle, over that of 60 degrees.
[[nodiscard]] inline double scaled_jacobian(const Triangle& t) {
  const double p = vec::distance(t.a, t.b), q = vec::distance(t.b, t.c), r = vec::distance(t.c, t.a);
  const double longest = std::max({p * q, q * r, r * p});
  return longest > 0 ? 2 / std::numbers::sqrt3 * 2 * t.area() / longest : 0;
}

/// Least over corners of the mean ratio 3 det^(2/3) / sum l^2 of its three edges [KNUPP00]: 1 for a cube,
/// <= 0 inverted.
[[nodiscard]] inline double mean_ratio(const HexCorners& x) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t c = 0; c < 8; ++c) {
    std::array<Vec3, 3> e;
    for (std::size_t a = 0; a < 3; ++a)
      e[a] = vec::minus(x[static_cast<std::size_t>(hex_corner_axes[c][a])], x[c]);
    const double l2 = vec::squared(e[0]) + vec::squared(e[1]) + vec::squared(e[2]);
    const double d = std::cbrt(vec::dot(vec::cross(e[0], e[1]), e[2]));
    least = std::min(least, l2 > 0 ? std::copysign(3 * d * d / l2, d) : 0);
  }
  return least;
}

/// Spread of one figure over the cells of a mesh, with the cells where it is worst (least).
struct [[nodiscard]] Spread {
  double least = std::numeric_limits<double>::infinity();
  double greatest = -std::numeric_limits<double>::infinity();
  double mean = 0;
  Index worst_cell = -1;
  std::vector<double> sorted;  // ascending, one value a cell
  std::vector<Index> worst;    // the worst cells, at most `most_worst`, the worst first

  static constexpr std::size_t most_worst = 10;

  /// The value below which the fraction q of the cells lies, 0 <= q <= 1.
  [[nodiscard]] double quantile(double q) const {
    if (sorted.empty()) return 0;
    return sorted[static_cast<std::size_t>(q * static_cast<double>(sorted.size() - 1))];
  }
  [[nodiscard]] double share_below(double value) const {
    const auto n = std::lower_bound(sorted.begin(), sorted.end(), value) - sorted.begin();
    return sorted.empty() ? 0 : static_cast<double>(n) / static_cast<double>(sorted.size());
  }
};

/// Spread of figure(cell) over the cells 0 .. count-1.
template <class Figure>
[[nodiscard]] Spread spread(Index count, Figure&& figure) {
  Spread s;
  s.sorted.reserve(static_cast<std::size_t>(count));
  for (Index c = 0; c < count; ++c) {
    const double q = figure(c);
    std::size_t at = s.worst.size();
    for (; at > 0 && q < s.sorted[static_cast<std::size_t>(s.worst[at - 1])]; --at) {
    }
    if (at < Spread::most_worst) {
      if (s.worst.size() == Spread::most_worst) s.worst.pop_back();
      s.worst.insert(s.worst.begin() + static_cast<std::ptrdiff_t>(at), c);
    }
    if (q < s.least || s.worst_cell < 0) s.least = q, s.worst_cell = c;
    s.greatest = std::max(s.greatest, q);
    s.mean += q;
    s.sorted.push_back(q);
  }
  if (count > 0) s.mean /= count;
  std::sort(s.sorted.begin(), s.sorted.end());
  return s;
}

struct [[nodiscard]] SurfaceQuality {
  Spread angle;                                // smallest angle of each triangle [degrees]
  Spread mean_ratio;                           // 1 equilateral
  Vec3 worst_place{0, 0, 0};                   // centroid of the triangle with the smallest angle
  double shortest_edge = 0, longest_edge = 0;  // in the unit of the nodes
};

[[nodiscard]] inline SurfaceQuality quality(const Surface& s) {
  SurfaceQuality q;
  q.angle = spread(s.cell_count(), [&](Index t) { return degrees(triangle(s, t).smallest_angle()); });
  q.mean_ratio = spread(s.cell_count(), [&](Index t) { return mean_ratio(triangle(s, t)); });
  if (q.angle.worst_cell >= 0) q.worst_place = triangle(s, q.angle.worst_cell).centroid();
  double lo = std::numeric_limits<double>::infinity(), hi = 0;
  for (Index t = 0; t < s.cell_count(); ++t)
    for (const auto& e : Tri3::edges) {
      const double l2 = vec::squared(vec::minus(node(s, s.cells(e[1], t)), node(s, s.cells(e[0], t))));
      lo = std::min(lo, l2), hi = std::max(hi, l2);
    }
  if (hi > 0) q.shortest_edge = std::sqrt(lo), q.longest_edge = std::sqrt(hi);
  return q;
}

struct [[nodiscard]] TetQuality {
  Spread dihedral;              // smallest dihedral angle of each cell [degrees]
  Spread mean_ratio;            // 1 regular, negative inverted
  double largest_dihedral = 0;  // [degrees]
  Index inverted = 0;           // cells with volume <= 0
  Vec3 worst_place{0, 0, 0};    // centroid of the cell with the smallest dihedral angle
};

[[nodiscard]] inline TetQuality quality(const TetMesh& m) {
  TetQuality q;
  q.dihedral = spread(m.cell_count(), [&](Index c) {
    const auto angle = dihedral_angles(corners(m, c));
    const auto [lo, hi] = std::minmax_element(angle.begin(), angle.end());
    q.largest_dihedral = std::max(q.largest_dihedral, degrees(*hi));
    return degrees(*lo);
  });
  q.mean_ratio = spread(m.cell_count(), [&](Index c) { return mean_ratio(corners(m, c)); });
  q.inverted =
      static_cast<Index>(std::upper_bound(q.mean_ratio.sorted.begin(), q.mean_ratio.sorted.end(), 0.0) -
                         q.mean_ratio.sorted.begin());
  if (q.dihedral.worst_cell >= 0) {
    const TetCorners x = corners(m, q.dihedral.worst_cell);
    q.worst_place = vec::scaled(0.25, vec::plus(vec::plus(vec::plus(x[0], x[1]), x[2]), x[3]));
  }
  return q;
}

struct [[nodiscard]] HexQuality {
  Spread scaled_jacobian;     // 1 brick, <= 0 inverted
  Index inverted = 0;         // cells with scaled Jacobian <= 0
  Vec3 worst_place{0, 0, 0};  // centre of the worst cell
};

[[nodiscard]] inline HexQuality quality(const HexMesh& m) {
  HexQuality q;
  q.scaled_jacobian = spread(m.cell_count(), [&](Index c) { return scaled_jacobian(corners(m, c)); });
  const auto& sorted = q.scaled_jacobian.sorted;
  q.inverted = static_cast<Index>(std::upper_bound(sorted.begin(), sorted.end(), 0.0) - sorted.begin());
  if (q.scaled_jacobian.worst_cell >= 0)
    for (const Vec3& x : corners(m, q.scaled_jacobian.worst_cell))
      q.worst_place = vec::along(q.worst_place, 1.0 / 8, x);
  return q;
}

}  // namespace tunica::mesh
