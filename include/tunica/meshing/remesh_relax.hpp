// SPDX-License-Identifier: MIT
// Nodes move towards the means of their neighbours along the surface. [BOTSCH04]
#pragma once

#include "tunica/meshing/remesh_state.hpp"

namespace tunica::meshing::detail {

/// To the mean of its neighbours, weighted by area, along the surface; on a rim along the rim.
inline void relax_node(RemeshState& w, Index n) {
  EditableSurface& s = w.edit;
  const NodeKind kind = kind_of(s, n);
  if (kind == NodeKind::corner) return;
  Vec3 to = Vec3::Zero();
  if (kind == NodeKind::rim) {
    const auto m = rim_neighbours(s, n);
    to = 0.5 * (s.x(m[0]) + s.x(m[1]));
  } else {
    double weight = 0;
    Vec3 normal = Vec3::Zero();
    for (const Index t : s.ring(n)) {
      const mesh::Triangle f = s.triangle(t);
      const double area = f.area();
      to += area * f.centroid(), weight += area, normal += f.area_vector();
    }
    normal.normalize();
    to /= weight;
    to += normal.dot(s.x(n) - to) * normal;
  }
  to = w.on_target(n, to);
  if (!s.move(n, to)) (void)s.move(n, w.on_target(n, 0.5 * (to + s.x(n))));
}

inline void relax(RemeshState& w) {
  for (Index n = 0; n < w.edit.node_count(); ++n)
    if (w.edit.used(n)) relax_node(w, n);
}

}  // namespace tunica::meshing::detail
