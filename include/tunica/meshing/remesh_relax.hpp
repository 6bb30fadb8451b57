// SPDX-License-Identifier: MIT
// Nodes move towards the means of their neighbours along the surface. [BOTSCH04]
#pragma once

#include "tunica/meshing/remesh_state.hpp"

namespace tunica::meshing::detail {

/// To the mean of its neighbours, weighted by area, along the surface; on a rim along the rim. Where the
/// target h varies areas count by 1/h^3 and sides of a rim by 1/h^2: then a node is at rest among triangles
/// of which each has its own target, since an area is as h^2 and its arm as h.
template <class Size>
void relax_node(RemeshState<Size>& w, Index n) {
  EditableSurface& s = w.edit;
  const NodeKind kind = kind_of(s, n);
  if (kind == NodeKind::corner) return;
  Vec3 to = Vec3::Zero();
  if (kind == NodeKind::rim) {
    const auto m = rim_neighbours(s, n);
    to = 0.5 * (s.x(m[0]) + s.x(m[1]));
    if constexpr (!RemeshState<Size>::constant) {
      const auto pull = [&](Index to_node) {
        const double h = w.size_of(n, to_node);
        return s.length(n, to_node) / (h * h);
      };
      const double p = pull(m[0]), q = pull(m[1]);
      to = 0.5 * (s.x(n) + (p * s.x(m[0]) + q * s.x(m[1])) / (p + q));
    }
  } else {
    double weight = 0;
    Vec3 normal = Vec3::Zero();
    for (const Index t : s.ring(n)) {
      const mesh::Triangle f = s.triangle(t);
      double area = f.area();
      if constexpr (!RemeshState<Size>::constant) {
        const auto& v = s.nodes(t);
        const double h = (w.size_of(v[0]) + w.size_of(v[1]) + w.size_of(v[2])) / 3;
        area /= h * h * h;
      }
      to += area * f.centroid(), weight += area, normal += f.area_vector();
    }
    normal.normalize();
    to /= weight;
    to += normal.dot(s.x(n) - to) * normal;
  }
  to = w.on_target(n, to);
  if (!s.move(n, to)) (void)s.move(n, w.on_target(n, 0.5 * (to + s.x(n))));
}

template <class Size>
void relax(RemeshState<Size>& w) {
  for (Index n = 0; n < w.edit.node_count(); ++n)
    if (w.edit.used(n)) relax_node(w, n);
}

}  // namespace tunica::meshing::detail
