// SPDX-License-Identifier: MIT
// Directions in which the columns of layers grow: most normal [AUBRY08], within the planes of flat ends, then
// smoothed as far as each still sees the triangles around its foot.
#pragma once

#include "tunica/core/vec.hpp"
#include "tunica/meshing/layer_sheet.hpp"
#include "tunica/meshing/most_normal.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace tunica::meshing {

/// One direction a node of the sheet, and the least cosine with the normals of the triangles at its foot.
struct LayerDirections {
  std::vector<Vec3> way;       // unit; zero where no column grows
  std::vector<double> cosine;  // positive where a column grows
  Index blind = 0;             // nodes from which no direction sees all triangles
};

namespace detail {

[[nodiscard]] inline double least_cosine(const LayerSheet& sheet, Index n, const Vec3& way) {
  double least = 1;
  for (const Index t : sheet.around[n])
    least = std::min(least, vec::dot(sheet.inward[static_cast<std::size_t>(t)], way));
  return least;
}

/// The part of a direction that the node's foot allows, of length 1.
[[nodiscard]] inline Vec3 allowed(const LayerSheet& sheet, Index n, const Vec3& way) {
  const auto i = static_cast<std::size_t>(n);
  const double part = vec::dot(sheet.axis[i], way);
  if (sheet.foot[i] == ColumnFoot::plane) return vec::unit(vec::along(way, -part, sheet.axis[i]));
  if (sheet.foot[i] == ColumnFoot::line) return vec::scaled(part < 0 ? -1 : 1, sheet.axis[i]);
  return way;
}

struct FirstDirection {
  Vec3 way;
  double cosine;
};

/// The best direction at a node: the most normal one, or within a plane that of the normals' shadows if it
/// sees more.
[[nodiscard]] inline FirstDirection first_direction(const LayerSheet& sheet, Index n) {
  std::vector<Vec3> normals, shadows;
  for (const Index t : sheet.around[n]) normals.push_back(sheet.inward[static_cast<std::size_t>(t)]);
  const Vec3 way = allowed(sheet, n, most_normal(normals).direction);
  const double cosine = least_cosine(sheet, n, way);
  if (sheet.foot[static_cast<std::size_t>(n)] != ColumnFoot::plane) return {way, cosine};
  for (const Vec3& normal : normals) {
    const Vec3 shadow = allowed(sheet, n, normal);
    if (vec::squared(shadow) > 0) shadows.push_back(shadow);
  }
  const Vec3 other = allowed(sheet, n, most_normal(shadows).direction);
  const double seen = least_cosine(sheet, n, other);
  return seen > cosine ? FirstDirection{other, seen} : FirstDirection{way, cosine};
}

/// Weights of a node's neighbours that give the value of a linear field at the node by least squares: means
/// with them do not drift where neighbours lie to one side. All alike where they tell no plane.
[[nodiscard]] inline std::vector<double> linear_weights(const LayerSheet& sheet, Index n, const Vec3& up) {
  const auto near = sheet.neighbours[n];
  const auto count = static_cast<double>(near.size());
  const Vec3 u = vec::orthogonal(up), v = vec::cross(up, u);
  std::vector<std::array<double, 2>> at;
  double size = 0;
  for (const Index m : near) {
    const Vec3 d = vec::minus(sheet.node(m), sheet.node(n));
    at.push_back({vec::dot(d, u), vec::dot(d, v)});
    size += vec::squared(d) / count;
  }
  double x = 0, y = 0, xx = 0, xy = 0, yy = 0;
  for (auto& [a, b] : at) {
    a /= std::sqrt(size), b /= std::sqrt(size);
    x += a / count, y += b / count, xx += a * a / count, xy += a * b / count, yy += b * b / count;
  }
  // Rows (1 x y), (x xx xy), (y xy yy) times (p, q, r) = (1, 0, 0).
  const double p = xx * yy - xy * xy, q = xy * y - x * yy, r = x * xy - xx * y;
  const double det = p + x * q + y * r;
  std::vector<double> weights(near.size(), 1 / count);
  constexpr double flat = 0.02, most = 1;
  if (!(det > flat)) return weights;
  std::vector<double> linear;
  for (const auto& [a, b] : at) {
    linear.push_back((p + q * a + r * b) / det / count);
    if (!(std::abs(linear.back()) < most)) return weights;
  }
  return linear;
}

}  // namespace detail

/// Nodes that see their triangles at less than asin(0.2) grow no column: their foot becomes fixed. A sweep
/// turns each direction half-way to the mean of those around it unless it would see less than 0.8 of what
/// the most normal one does, or 0.7.
[[nodiscard]] inline LayerDirections layer_directions(LayerSheet& sheet, int sweeps) {
  constexpr double blind = 0.2, keep = 0.8, enough = 0.7;
  const auto at = [](Index i) { return static_cast<std::size_t>(i); };
  const Index count = sheet.surface.node_count();
  LayerDirections d{std::vector<Vec3>(at(count), Vec3(0, 0, 0)), std::vector<double>(at(count), 0)};
  std::vector<double> bound(at(count), 0), weights;
  for (Index n = 0; n < count; ++n) {
    if (!sheet.grows(n)) {
      weights.resize(weights.size() + sheet.neighbours[n].size(), 0);
      continue;
    }
    const auto [way, cosine] = detail::first_direction(sheet, n);
    const auto some = detail::linear_weights(sheet, n, way);
    weights.insert(weights.end(), some.begin(), some.end());
    if (!(cosine > blind)) {
      sheet.foot[at(n)] = ColumnFoot::fixed;
      ++d.blind;
      continue;
    }
    d.way[at(n)] = way, d.cosine[at(n)] = cosine;
    bound[at(n)] = std::min(keep * cosine, enough);
  }
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    const std::vector<Vec3> old = d.way;
    for (Index n = 0; n < count; ++n) {
      if (!sheet.grows(n)) continue;
      Vec3 mean(0, 0, 0);
      const Index first = sheet.neighbours.offset[at(n)], last = sheet.neighbours.offset[at(n) + 1];
      for (Index e = first; e < last; ++e)
        mean = vec::along(mean, weights[at(e)], old[at(sheet.neighbours.item[at(e)])]);
      const Vec3 way = detail::allowed(sheet, n, vec::unit(vec::plus(vec::unit(mean), old[at(n)])));
      const double cosine = detail::least_cosine(sheet, n, way);
      if (!(cosine >= std::min(bound[at(n)], d.cosine[at(n)]))) continue;
      d.way[at(n)] = way, d.cosine[at(n)] = cosine;
    }
  }
  return d;
}

}  // namespace tunica::meshing
