// SPDX-License-Identifier: MIT
// What the passes of remeshing share: the surface that is edited, the one that it must follow, its wear, and
// the target length at each node.
#pragma once

#include "tunica/meshing/edit_kinds.hpp"
#include "tunica/meshing/size_field.hpp"
#include "tunica/meshing/surface_target.hpp"
#include "tunica/meshing/wear.hpp"

#include <concepts>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

namespace tunica::meshing::detail {

template <SizeField Size>
struct RemeshState {
  static constexpr bool constant = std::same_as<Size, ConstantSize>;

  Size size;
  Facets facets;
  SurfaceTarget target;
  EditableSurface edit;
  Wear wear{};
  Index kept_features = 0;  // collapses left out because they would have worn down a feature

  /// The surface stays alive and unchanged. typical: a length in the middle of the targets.
  RemeshState(const mesh::Surface& s, Size target_size, double sharp_angle, double typical)
      : size(std::move(target_size)),
        facets(meshing::facets(s, sharp_angle)),
        target(s, facets),
        edit(s, facets, typical, EditableSurface::twenty_degrees) {}
  RemeshState(const mesh::Surface& s, ConstantSize constant_size, double sharp_angle)
      : RemeshState(s, constant_size, sharp_angle, constant_size.edge) {}
  RemeshState(const RemeshState&) = delete;
  RemeshState& operator=(const RemeshState&) = delete;

  /// Target length at a node; asked of the field once for each place of the node.
  [[nodiscard]] double size_of(Index n) {
    if constexpr (constant) {
      return size.edge;
    } else {
      const auto i = static_cast<std::size_t>(n);
      if (i >= known_.size()) known_.resize(i + 1);
      Known& k = known_[i];
      const Vec3& x = edit.x(n);
      if (!(k.size > 0) || k.x[0] != x[0] || k.x[1] != x[1] || k.x[2] != x[2]) k = {x, size(x)};
      return k.size;
    }
  }

  /// Target length of an edge between places with these.
  [[nodiscard]] static double between(double p, double q) {
    if constexpr (constant)
      return p;
    else
      return 0.5 * (p + q);
  }
  [[nodiscard]] double size_of(Index a, Index b) { return between(size_of(a), size_of(b)); }

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

 private:
  struct Known {
    Vec3 x{0, 0, 0};
    double size = 0;
  };
  std::vector<Known> known_;
};
RemeshState(const mesh::Surface&, ConstantSize, double)->RemeshState<ConstantSize>;

}  // namespace tunica::meshing::detail
