// SPDX-License-Identifier: MIT
// Nodes of a curved border set off from the surface until its faces lie level with it, so that they hold its
// volume: inscribed faces of edge h in a vessel of radius r lose some h^2 / (6 r^2) of it.
#pragma once

#include "tunica/core/vec.hpp"
#include "tunica/meshing/hex_complex.hpp"
#include "tunica/meshing/hex_guide.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace tunica::meshing {

struct HexLevelOptions {
  int rounds = 2;
  double most = 0.1;  // that a node is set off [edge]
};

/// Each node is set off by the mean of what the faces, or the rim's sides, around it still lack: over a face
/// the distance from a curved surface is on the average two thirds of that in the middle above that of the
/// corners. Rims stay in the planes of flat facets. Returns where the nodes should be.
[[nodiscard]] inline std::vector<Vec3> level_places(const HexComplex& hexes, SurfaceGuide& guide, double edge,
                                                    const HexLevelOptions& options = {}) {
  const auto at = [](Index i) { return static_cast<std::size_t>(i); };
  std::vector<Vec3> x = hexes.nodes, offset(x.size(), Vec3(0, 0, 0)), sum;
  std::vector<int> count;
  for (int round = 0; round < options.rounds; ++round) {
    sum.assign(x.size(), Vec3(0, 0, 0)), count.assign(x.size(), 0);
    for (std::size_t f = 0; f < hexes.border.size(); ++f) {
      const auto& q = hexes.border[f];
      const bool flat = guide.flat(hexes.facet[f]);
      for (std::size_t k = 0; k < 4; ++k) {  // sides of rims, once from the face of the curved facet
        const Index a = q[k], b = q[(k + 1) % 4];
        const HexSite &p = guide.site(a), &r = guide.site(b);
        if (flat || !p.rim() || !r.rim() || p.facet != r.facet || p.other != r.other) continue;
        const Vec3 middle = vec::between(x[at(a)], x[at(b)], 0.5);
        const Vec3 ends = vec::plus(guide.lack(a, x[at(a)]), guide.lack(b, x[at(b)]));
        const Vec3 lack = vec::plus(vec::scaled(2.0 / 3, guide.lack(a, middle)), vec::scaled(1.0 / 6, ends));
        for (const Index n : {a, b}) sum[at(n)] = vec::plus(sum[at(n)], lack), ++count[at(n)];
      }
      if (flat) continue;
      const Index start = guide.node_on(q, hexes.facet[f]);
      if (start < 0) continue;
      Vec3 middle(0, 0, 0), corners(0, 0, 0);
      for (const Index n : q) {
        middle = vec::along(middle, 0.25, x[at(n)]);
        if (!guide.site(n).rim() && !guide.site(n).corner)
          corners = vec::along(corners, 0.25, guide.lack(n, x[at(n)]));
      }
      const Vec3 lack =
          vec::plus(vec::scaled(2.0 / 3, guide.lack(start, middle)), vec::scaled(1.0 / 3, corners));
      for (const Index n : q)
        if (!guide.site(n).rim()) sum[at(n)] = vec::plus(sum[at(n)], lack), ++count[at(n)];
    }
    for (std::size_t n = 0; n < x.size(); ++n) {
      const auto node = static_cast<Index>(n);
      if (count[n] == 0 || guide.site(node).corner || guide.loose(node)) continue;
      Vec3 way = vec::divided(sum[n], count[n]);
      if (!guide.site(node).rim()) {
        const Vec3 normal = guide.outward(node);
        way = vec::scaled(vec::dot(way, normal), normal);
      }
      offset[n] = vec::plus(offset[n], way);
      const double far = vec::length(offset[n]), most = options.most * edge;
      if (far > most) offset[n] = vec::scaled(most / far, offset[n]);
      x[n] = guide.in_planes(node, vec::plus(hexes.nodes[n], offset[n]));
    }
  }
  return x;
}

}  // namespace tunica::meshing
