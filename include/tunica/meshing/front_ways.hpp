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

/// Powers of two, one an axis, that make the edges of the surface about as long in each direction.
/// Coordinates times them are exact and so are the signs of volumes: what is triangulated in the stretched
/// space is valid in the other.
[[nodiscard]] inline Vec3 stretch_of(const FrontSurface& s, const std::vector<Vec3>& nodes) {
  Vec3 sum(0, 0, 0);
  for (const auto& e : s.edges) {
    const Vec3 d = vec::minus(nodes[static_cast<std::size_t>(e.a)], nodes[static_cast<std::size_t>(e.b)]);
    for (int k = 0; k < 3; ++k) sum[k] += std::abs(d[k]);
  }
  const double most = std::max({sum[0], sum[1], sum[2]});
  for (int k = 0; k < 3; ++k)  // a surface in one plane, which nothing fills, is not stretched out of it
    sum[k] = sum[k] > 0 ? std::exp2(std::round(std::log2(most / sum[k]))) : 1;
  return sum;
}

/// Ways to fill, in the order in which they are tried until one succeeds.
struct FillWay {
  FrontRecovery::Way way;
  bool stretched;   // in a space where the edges of the surface are about as long in each direction
  bool with_inner;  // points of the lattice; other ones for each way
  int lattice;
  double shake = 0;  // of the nodes, over the shortest edge there
};
using enum FrontRecovery::Way;
inline constexpr std::array<FillWay, 14> fill_ways{{{forward, false, true, 0},
                                                    {backward, false, true, 1},
                                                    {forward, true, true, 0},
                                                    {backward, true, true, 1},
                                                    {forward, false, true, 0, 1e-6},
                                                    {backward, false, true, 1, 1e-8},
                                                    {halving, true, true, 2},
                                                    {halving, true, false, 0},
                                                    {halving, false, true, 2},
                                                    {halving, false, false, 0},
                                                    {halving, true, true, 3, 1e-5},
                                                    {halving, false, true, 3, 1e-5},
                                                    {halving, true, true, 4, 1e-8},
                                                    {halving, false, true, 4, 1e-8}}};

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
