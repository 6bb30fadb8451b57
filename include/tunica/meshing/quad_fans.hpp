// SPDX-License-Identifier: MIT
// A sheet of quadrilaterals as triangles around their middles, and the quadrilateral nearest to a point.
#pragma once

#include "tunica/core/vec.hpp"
#include "tunica/mesh/mesh.hpp"
#include "tunica/meshing/surface_foot.hpp"

#include <array>
#include <cstddef>

namespace tunica::meshing {

/// Four triangles around the middle of each quadrilateral: 4q + k lies at its edge k. Nodes: those of the
/// sheet, then the middles.
[[nodiscard]] inline mesh::Surface fans_of_quads(const Points<3>& nodes, const Connectivity<4>& cells) {
  const auto count = static_cast<Index>(nodes.cols()), quads = static_cast<Index>(cells.cols());
  mesh::Surface fans;
  fans.nodes.resize(3, count + quads);
  fans.cells.resize(3, 4 * quads);
  for (Index n = 0; n < count; ++n) vec::set_column(fans.nodes, n, vec::column(nodes, n));
  for (Index q = 0; q < quads; ++q) {
    const auto x = [&](int k) { return vec::column(nodes, cells(k, q)); };
    vec::set_column(fans.nodes, count + q,
                    vec::between(vec::between(x(0), x(2), 0.5), vec::between(x(1), x(3), 0.5), 0.5));
    for (int k = 0; k < 4; ++k) {
      fans.cells(0, 4 * q + k) = cells(k, q), fans.cells(1, 4 * q + k) = cells((k + 1) % 4, q);
      fans.cells(2, 4 * q + k) = count + q;
    }
  }
  return fans;
}

/// The place of the sheet nearest to a point, as weights of the corners of its quadrilateral.
struct QuadFoot {
  Index quad = -1;
  std::array<double, 4> weights{};
  Vec3 point;
};

/// sheet: of fans_of_quads.
[[nodiscard]] inline QuadFoot quad_foot(const TriangleFinder& sheet, const Vec3& x) {
  const FootWeights foot = sheet.nearest_weights(x);
  QuadFoot q{foot.triangle / 4, {}, foot.point};
  const auto k = static_cast<std::size_t>(foot.triangle % 4);
  q.weights.fill(0.25 * foot.weights[2]);
  q.weights[k] += foot.weights[0], q.weights[(k + 1) % 4] += foot.weights[1];
  return q;
}

}  // namespace tunica::meshing
