// SPDX-License-Identifier: MIT
// Levels a sheet of quadrilaterals with the surface that it stands for: the faces, not their corners, follow
// it, so that the two bound the same volume and lie twice as near to each other.
#pragma once

#include "tunica/mesh/adjacency.hpp"
#include "tunica/meshing/surface_foot.hpp"
#include "tunica/meshing/vec.hpp"
#include "tunica/meshing/wall_quads.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace tunica::meshing {

/// Moves the nodes inside the rims along the normals until the mean distance of the faces around each is
/// nought; no node goes farther than the limit [length].
template <FootSurface S>
void fit_quads(WallQuads& wall, const S& surface, double limit) {
  constexpr int rounds = 4;
  const auto count = static_cast<Index>(wall.nodes.cols()), quads = static_cast<Index>(wall.cells.cols());
  const mesh::Rows around = mesh::cells_of_nodes(wall.cells, count);
  std::vector<char> fixed(static_cast<std::size_t>(count), 0);
  for (const auto& loop : wall.loops)
    for (const Index n : loop) fixed[static_cast<std::size_t>(n)] = 1;
  const Points<3> start = wall.nodes;
  std::vector<Vec3> normal;
  for (Index n = 0; n < count; ++n) normal.push_back(surface.nearest(vec::column(start, n)).normal);
  std::vector<double> offset(static_cast<std::size_t>(count), 0), level(static_cast<std::size_t>(quads));
  for (int round = 0; round < rounds; ++round) {
    for (Index q = 0; q < quads; ++q) {
      const auto x = [&](int k) { return vec::column(wall.nodes, wall.cells(k % 4, q)); };
      const Vec3 n = vec::unit(vec::cross(vec::minus(x(2), x(0)), vec::minus(x(3), x(1))));
      const auto height = [&](const Vec3& p) {
        const double h = vec::dot(vec::minus(surface.nearest_facing(p, n).point, p), n);
        return std::clamp(h, -limit, limit);
      };
      // Simpson's rule in both directions of the bilinear face: corners 1, sides 4, middle 16, of 36
      double sum =
          16 * height(vec::between(vec::between(x(0), x(2), 0.5), vec::between(x(1), x(3), 0.5), 0.5));
      for (int k = 0; k < 4; ++k) sum += height(x(k)) + 4 * height(vec::between(x(k), x(k + 1), 0.5));
      level[static_cast<std::size_t>(q)] = sum / 36;
    }
    for (Index n = 0; n < count; ++n) {
      if (fixed[static_cast<std::size_t>(n)] != 0) continue;
      double sum = 0;
      for (const Index q : around[n]) sum += level[static_cast<std::size_t>(q)];
      double& d = offset[static_cast<std::size_t>(n)];
      d = std::clamp(d + sum / static_cast<double>(around[n].size()), -limit, limit);
      vec::set_column(wall.nodes, n,
                      vec::along(vec::column(start, n), d, normal[static_cast<std::size_t>(n)]));
    }
  }
}

}  // namespace tunica::meshing
