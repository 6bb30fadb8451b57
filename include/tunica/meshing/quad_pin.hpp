// SPDX-License-Identifier: MIT
// Which nodes of a sheet of quadrilaterals should lie on points of the surface that it misses: tips and
// ridges between its nodes.
#pragma once

#include "tunica/core/vec.hpp"
#include "tunica/meshing/quad_fans.hpp"
#include "tunica/meshing/surface_foot.hpp"
#include "tunica/meshing/wall_quads.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace tunica::meshing {

struct QuadPin {
  Index node;
  Vec3 place;
};

/// For each target farther than `away` from the sheet, the worst first and none within `apart` of another
/// [length]: the node that has most to do with it, unless it is held.
[[nodiscard]] inline std::vector<QuadPin> quad_pins(const WallQuads& wall, const std::vector<char>& held,
                                                    const std::vector<Vec3>& targets, double away,
                                                    double apart) {
  struct Miss {
    double distance;
    std::size_t target;
    QuadFoot foot;
  };
  const mesh::Surface fans = fans_of_quads(wall.nodes, wall.cells);
  const TriangleFinder sheet(fans);
  std::vector<Miss> misses;
  for (std::size_t i = 0; i < targets.size(); ++i) {
    const QuadFoot foot = quad_foot(sheet, targets[i]);
    const double distance = vec::distance(foot.point, targets[i]);
    if (distance > away) misses.push_back({distance, i, foot});
  }
  std::sort(misses.begin(), misses.end(), [](const Miss& a, const Miss& b) {
    return a.distance != b.distance ? a.distance > b.distance : a.target < b.target;
  });
  std::vector<QuadPin> pins;
  std::vector<Vec3> done;
  for (const Miss& miss : misses) {
    const Vec3& x = targets[miss.target];
    const bool near =
        std::any_of(done.begin(), done.end(), [&](const Vec3& y) { return vec::distance(x, y) < apart; });
    if (near) continue;
    done.push_back(x);
    Index best = -1;
    double most = -1;
    for (std::size_t k = 0; k < 4; ++k) {
      const Index n = wall.cells(static_cast<Eigen::Index>(k), miss.foot.quad);
      if (held[static_cast<std::size_t>(n)] == 0 && miss.foot.weights[k] > most)
        best = n, most = miss.foot.weights[k];
    }
    if (best >= 0) pins.push_back({best, x});
  }
  return pins;
}

}  // namespace tunica::meshing
