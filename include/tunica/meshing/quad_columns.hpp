// SPDX-License-Identifier: MIT
// What an extrusion can make of the nodes of a sheet of quadrilaterals: how sound the cells are at the foot
// of each column, before the sheet is extruded.
#pragma once

#include "tunica/core/vec.hpp"
#include "tunica/mesh/adjacency.hpp"
#include "tunica/meshing/most_normal.hpp"
#include "tunica/meshing/rim_curve.hpp"
#include "tunica/meshing/wall_quads.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace tunica::meshing {

/// The sheet may move while this looks at it; its cells stay.
class QuadColumns {
 public:
  QuadColumns(const WallQuads& wall, const Rims& rims)
      : wall_(wall),
        around_(mesh::cells_of_nodes(wall.cells, static_cast<Index>(wall.nodes.cols()))),
        plane_(static_cast<std::size_t>(wall.nodes.cols()), Vec3::Zero()) {
    for (std::size_t r = 0; r < wall.loops.size(); ++r)
      for (const Index n : wall.loops[r]) plane_[static_cast<std::size_t>(n)] = rims.curves[r].plane().normal;
  }

  /// Least scaled Jacobian at the foot of the column that stands on a node, and least cosine between it and
  /// the faces' normals: along their mean, where that is as good as `sound`, or along the most normal
  /// direction; in the plane of the end for nodes on rims. <= 0 where no direction sees all faces.
  [[nodiscard]] double quality(Index n, double sound) const {
    feet_.clear();
    normals_.clear();
    Vec3 sum = Vec3::Zero();
    for (const Index q : around_[n]) {
      const auto x = [&](int k) { return vec::column(wall_.nodes, wall_.cells(k % 4, q)); };
      const Vec3 face = vec::unit(vec::cross(vec::minus(x(2), x(0)), vec::minus(x(3), x(1))));
      normals_.push_back(face);
      for (int k = 0; k < 4; ++k) {
        if (wall_.cells(k, q) != n) continue;
        const Vec3 u = vec::minus(x(k + 1), x(k)), v = vec::minus(x(k + 3), x(k)), w = vec::cross(u, v);
        const double size = vec::length(u) * vec::length(v);
        feet_.push_back(size > 0 ? vec::divided(w, size) : Vec3(0, 0, 0));
        normals_.push_back(vec::unit(w));
        sum = vec::plus(sum, vec::plus(face, normals_.back()));
      }
    }
    const double plain = quality(n, sum);
    return plain >= sound ? plain : std::max(plain, quality(n, most_normal(normals_).direction));
  }

 private:
  [[nodiscard]] double quality(Index n, const Vec3& direction) const {
    const Vec3& p = plane_[static_cast<std::size_t>(n)];
    const Vec3 way = vec::unit(vec::along(direction, -vec::dot(direction, p), p));
    double least = 1;
    for (const Vec3& foot : feet_) least = std::min(least, vec::dot(foot, way));
    for (const Vec3& normal : normals_) least = std::min(least, vec::dot(normal, way));
    return least;
  }

  const WallQuads& wall_;
  mesh::Rows around_;
  std::vector<Vec3> plane_;                   // normal of the end's plane of a node on a rim, else zero
  mutable std::vector<Vec3> feet_, normals_;  // of one node at a time
};

}  // namespace tunica::meshing
