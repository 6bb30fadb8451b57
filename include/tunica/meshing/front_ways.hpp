// SPDX-License-Identifier: MIT
// Ways to fill a surface, tried until one succeeds: orders of recovery, spaces stretched along the axes,
// nodes shaken by a hair and put back afterwards.
#pragma once

#include "tunica/core/vec.hpp"
#include "tunica/mesh/triangle.hpp"
#include "tunica/meshing/front_recovery.hpp"
#include "tunica/meshing/front_surface.hpp"
#include "tunica/meshing/hilbert.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace tunica::meshing::detail {

/// A linear map of space and its inverse, by rows.
struct Stretch {
  std::array<Vec3, 3> to{Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}, back = to;
  bool even = true;  // hardly any stretch
};
[[nodiscard]] inline std::vector<Vec3> mapped(std::vector<Vec3> points, const std::array<Vec3, 3>& rows) {
  for (Vec3& x : points) x = Vec3(vec::dot(rows[0], x), vec::dot(rows[1], x), vec::dot(rows[2], x));
  return points;
}

/// Powers of two, one an axis, that make the edges of the surface about as long in each direction.
/// Coordinates times them are exact and so are the signs of volumes: what is triangulated in the stretched
/// space is valid in the other.
[[nodiscard]] inline Stretch along_axes(const FrontSurface& s, const std::vector<Vec3>& nodes) {
  Vec3 sum(0, 0, 0);
  for (const auto& e : s.edges) {
    const Vec3 d = vec::minus(nodes[static_cast<std::size_t>(e.a)], nodes[static_cast<std::size_t>(e.b)]);
    for (int k = 0; k < 3; ++k) sum[k] += std::abs(d[k]);
  }
  const double most = std::max({sum[0], sum[1], sum[2]});
  Stretch result;
  for (int k = 0; k < 3; ++k) {  // a surface in one plane, which nothing fills, is not stretched out of it
    const double by = sum[k] > 0 ? std::exp2(std::round(std::log2(most / sum[k]))) : 1;
    const auto i = static_cast<std::size_t>(k);
    result.to[i][k] = by, result.back[i][k] = 1 / by;
    result.even = result.even && by == 1;
  }
  return result;
}

/// The inverse of L where L L^T is the mean of d d^T over the edges d: in its space they are about as long in
/// every direction, however the surface lies. Places there are rounded, so signs are to be tested here again.
[[nodiscard]] inline Stretch in_all_directions(const FrontSurface& s, const std::vector<Vec3>& nodes) {
  double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
  for (const auto& e : s.edges) {
    const Vec3 d = vec::minus(nodes[static_cast<std::size_t>(e.a)], nodes[static_cast<std::size_t>(e.b)]);
    xx += d[0] * d[0], xy += d[0] * d[1], xz += d[0] * d[2];
    yy += d[1] * d[1], yz += d[1] * d[2], zz += d[2] * d[2];
  }
  const double scale = (xx + yy + zz) / 3;
  xx /= scale, xy /= scale, xz /= scale, yy /= scale, yz /= scale, zz /= scale;
  const double a = std::sqrt(xx), b = xy / a, c = xz / a;  // Cholesky: the columns (a, b, c), (d, e), (f)
  const double d = std::sqrt(yy - b * b), e = (yz - b * c) / d, f = std::sqrt(zz - c * c - e * e);
  constexpr double noticeable = 4, flattest = 1e-7;
  Stretch result;
  if (!(a > flattest && d > flattest && f > flattest)) return result;
  result.even = std::max({a, d, f}) < noticeable * std::min({a, d, f});
  result.back = {Vec3(a, 0, 0), Vec3(b, d, 0), Vec3(c, e, f)};
  result.to = {Vec3(1 / a, 0, 0), Vec3(-b / (a * d), 1 / d, 0),
               Vec3((b * e - c * d) / (a * d * f), -e / (d * f), 1 / f)};
  return result;
}

/// Ways to fill, in the order in which they are tried until one succeeds.
enum class Space { own, axes, all_directions };
struct FillWay {
  FrontRecovery::Way way;
  Space space;
  bool with_inner;  // points of the lattice; other ones for each way
  int lattice;
  double shake = 0;  // of the nodes, over the shortest edge there
};
using enum FrontRecovery::Way;
using enum Space;
inline constexpr std::array<FillWay, 18> fill_ways{{{forward, own, true, 0},
                                                    {backward, own, true, 1},
                                                    {forward, axes, true, 0},
                                                    {backward, axes, true, 1},
                                                    {forward, own, true, 0, 1e-6},
                                                    {backward, own, true, 1, 1e-8},
                                                    {forward, all_directions, true, 0},
                                                    {backward, all_directions, true, 1},
                                                    {halving, axes, true, 2},
                                                    {halving, axes, false, 0},
                                                    {halving, all_directions, true, 2},
                                                    {halving, all_directions, false, 0},
                                                    {halving, own, true, 2},
                                                    {halving, own, false, 0},
                                                    {halving, axes, true, 3, 1e-5},
                                                    {halving, own, true, 3, 1e-5},
                                                    {halving, axes, true, 4, 1e-8},
                                                    {halving, own, true, 4, 1e-8}}};

/// The nodes, each moved at random by at most that share of the shortest edge at it: what was flat to
/// rounding is so no longer.
[[nodiscard]] inline std::vector<Vec3> shaken(const FrontSurface& s, std::vector<Vec3> nodes, double share) {
  std::vector<double> shortest(nodes.size(), std::numeric_limits<double>::infinity());
  const auto at = [](Index n) { return static_cast<std::size_t>(n); };
  for (const auto& e : s.edges)
    for (const Index n : {e.a, e.b})
      shortest[at(n)] = std::min(shortest[at(n)], vec::distance(nodes[at(e.a)], nodes[at(e.b)]));
  for (std::size_t n = 0; n < nodes.size(); ++n)
    for (std::size_t k = 0; k < 3; ++k) {
      const double random = std::ldexp(static_cast<double>(mixed(3 * n + k) >> 11), -52) - 1;
      nodes[n][static_cast<Eigen::Index>(k)] += 0.5 * share * shortest[n] * random;
    }
  return nodes;
}

/// For each node of the surface the sine that a tetrahedron with an edge there can be asked for:
/// that of the smallest angle of the triangles at the node.
[[nodiscard]] inline std::vector<double> surface_limits(const FrontSurface& s,
                                                        const std::vector<Vec3>& nodes) {
  std::vector<double> limit(nodes.size(), 1.0);
  for (const Triple& t : s.triangles) {
    const auto p = [&](std::size_t i) { return nodes[static_cast<std::size_t>(t[i])]; };
    const double sine = std::sin(mesh::Triangle{p(0), p(1), p(2)}.smallest_angle());
    for (const Index n : t)
      limit[static_cast<std::size_t>(n)] = std::min(limit[static_cast<std::size_t>(n)], sine);
  }
  return limit;
}

}  // namespace tunica::meshing::detail
