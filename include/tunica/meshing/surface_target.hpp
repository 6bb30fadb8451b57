// SPDX-License-Identifier: MIT
// The surface that a remeshed one must follow: nearest points on its facets and on their rims.
#pragma once

#include "tunica/meshing/facets.hpp"
#include "tunica/search/octree.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace tunica::meshing {

class SurfaceTarget {
 public:
  SurfaceTarget(const mesh::Surface& s, const Facets& facets) : s_(s), facets_(facets) {
    std::vector<Box> boxes;
    for (Index t = 0; t < s.cell_count(); ++t) boxes.push_back(mesh::triangle(s, t).box());
    triangles_ = search::Octree(boxes);
    boxes.clear();
    const auto twin = mesh::twins(s.cells, s.node_count());
    for (Index h = 0; h < static_cast<Index>(twin.size()); ++h) {
      const Index p = facets.of[static_cast<std::size_t>(h / 3)],
                  q = facets.of[static_cast<std::size_t>(twin[static_cast<std::size_t>(h)] / 3)];
      if (p >= q) continue;  // once an edge
      const auto e = mesh::half_edge(s.cells, h);
      rims_.push_back({s.nodes.col(e.from), s.nodes.col(e.to), p, q});
      Box box;
      box.extend(rims_.back().a), box.extend(rims_.back().b);
      boxes.push_back(box);
    }
    segments_ = search::Octree(boxes);
  }

  struct Hit {
    Vec3 point = Vec3::Zero();
    Vec3 normal = Vec3::Zero();  // unit, outward, of the triangle hit
  };

  /// The point of a facet nearest to x.
  [[nodiscard]] Hit nearest(const Vec3& x, Index facet) const {
    if (const auto& plane = facets_.planes[static_cast<std::size_t>(facet)])
      return {plane->projected(x), plane->normal};
    const auto found = triangles_.nearest(x, [&](Index t) {
      if (facets_.of[static_cast<std::size_t>(t)] != facet) return std::numeric_limits<double>::infinity();
      const mesh::Triangle f = mesh::triangle(s_, t);
      return (f.at(f.nearest(x)) - x).squaredNorm();
    });
    const mesh::Triangle f = mesh::triangle(s_, found.item);
    return {f.at(f.nearest(x)), f.area_vector().normalized()};
  }

  /// The point nearest to x of the rim between two facets (the lower number first).
  [[nodiscard]] Vec3 nearest_on_rim(const Vec3& x, Index p, Index q) const {
    const auto on = [&](Index i) {
      const Rim& r = rims_[static_cast<std::size_t>(i)];
      const Vec3 e = r.b - r.a;
      const double l2 = e.squaredNorm();
      return (r.a + (l2 > 0 ? std::clamp((x - r.a).dot(e) / l2, 0.0, 1.0) : 0.0) * e).eval();
    };
    const auto found = segments_.nearest(x, [&](Index i) {
      const Rim& r = rims_[static_cast<std::size_t>(i)];
      return r.p == p && r.q == q ? (on(i) - x).squaredNorm() : std::numeric_limits<double>::infinity();
    });
    return std::isfinite(found.squared_distance) ? on(found.item) : x;
  }

 private:
  struct Rim {
    Vec3 a, b;
    Index p, q;
  };
  const mesh::Surface& s_;
  const Facets& facets_;
  search::Octree triangles_, segments_;
  std::vector<Rim> rims_;
};

}  // namespace tunica::meshing
