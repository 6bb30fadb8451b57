// SPDX-License-Identifier: MIT
// What the passes of remeshing share: the surface that is edited, the one that it must follow, its wear.
#pragma once

#include "tunica/meshing/edit_kinds.hpp"
#include "tunica/meshing/surface_target.hpp"
#include "tunica/meshing/wear.hpp"

#include <cstddef>
#include <optional>

namespace tunica::meshing::detail {

struct RemeshState {
  double edge;  // target length
  Facets facets;
  SurfaceTarget target;
  EditableSurface edit;
  Wear wear{};
  Index kept_features = 0;  // collapses left out because they would have worn down a feature

  /// The surface stays alive and unchanged.
  RemeshState(const mesh::Surface& s, double edge_length, double sharp_angle)
      : edge(edge_length),
        facets(meshing::facets(s, sharp_angle)),
        target(s, facets),
        edit(s, facets, edge) {}
  RemeshState(const RemeshState&) = delete;
  RemeshState& operator=(const RemeshState&) = delete;

  [[nodiscard]] const std::optional<Plane>& plane(Index facet) const {
    return facets.planes[static_cast<std::size_t>(facet)];
  }

  /// x on the rim of two facets, and exactly in the plane of each that is flat.
  [[nodiscard]] Vec3 on_rim(const Vec3& x, Index p, Index q) const {
    Vec3 y = target.nearest_on_rim(x, p, q);
    for (const Index f : {p, q})
      if (const auto& flat = plane(f)) y = flat->projected(y);
    return y;
  }

  /// x on the facet or rim of node n.
  [[nodiscard]] Vec3 on_target(Index n, const Vec3& x) const {
    const auto f = facets_at(edit, n);
    if (f.size() == 1) return target.nearest(x, f[0]).point;
    return f.size() == 2 ? on_rim(x, f[0], f[1]) : x;
  }
};

}  // namespace tunica::meshing::detail
