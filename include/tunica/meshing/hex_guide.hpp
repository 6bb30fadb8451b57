// SPDX-License-Identifier: MIT
// Where the nodes of hexahedra may go: those of the wall on its triangles, those of flat ends in their
// planes, those of rims along them.
#pragma once

#include "tunica/core/vec.hpp"
#include "tunica/meshing/facets.hpp"
#include "tunica/meshing/hex_complex.hpp"
#include "tunica/meshing/surface_walk.hpp"
#include "tunica/search/octree.hpp"

#include <algorithm>
#include <cstddef>
#include <map>
#include <utility>
#include <vector>

namespace tunica::meshing {

/// What nodes are held to while hexahedra are improved.
///   struct Free { Vec3 placed(Index, const Vec3& x) { return x; }  Vec3 way(Index, const Vec3& d) { return
///   d; } };
template <class G>
concept HexGuide = requires(G& g, Index n, const Vec3& x) {
  { g.placed(n, x) } -> std::convertible_to<Vec3>;  // the place nearest to x where node n may be
  { g.way(n, x) } -> std::convertible_to<Vec3>;     // the part of a direction along which it may go
};

/// The nodes of a complex on the facets of a closed surface.
class SurfaceGuide {
 public:
  SurfaceGuide(const mesh::Surface& surface, const Facets& facets, std::vector<HexSite> sites)
      : surface_(surface),
        facets_(facets),
        walk_(surface, facets.of),
        sites_(std::move(sites)),
        triangle_(sites_.size(), -1) {
    const auto twin = mesh::twins(surface.cells, surface.node_count());
    for (Index h = 0; h < static_cast<Index>(twin.size()); ++h) {
      const Index p = facets.of[at(h / 3)], q = facets.of[at(twin[at(h)] / 3)];
      if (p >= q) continue;
      const auto e = mesh::half_edge(surface.cells, h);
      rims_[{p, q}].segments.push_back(
          {vec::column(surface.nodes, e.from), vec::column(surface.nodes, e.to)});
    }
    for (auto& [pair, rim] : rims_) {
      std::vector<Box> boxes;
      for (const auto& s : rim.segments) {
        boxes.emplace_back();
        boxes.back().extend(s.a), boxes.back().extend(s.b);
      }
      rim.tree = search::Octree(boxes);
    }
    for (HexSite& s : sites_)
      if (s.rim() && rims_.count({s.facet, s.other}) == 0) s.corner = true;  // the facets meet nowhere
  }

  [[nodiscard]] const HexSite& site(Index n) const { return sites_[at(n)]; }

  [[nodiscard]] Vec3 placed(Index n, const Vec3& x) {
    const HexSite& s = sites_[at(n)];
    if (s.inside() || s.corner) return x;
    if (s.rim()) return rims_.at({s.facet, s.other}).nearest(x).point;
    if (const auto& plane = facets_.planes[at(s.facet)]) return plane->projected(x);
    Index& t = triangle_[at(n)];
    const SurfacePoint p = t < 0 ? walk_.nearest(x, s.facet) : walk_.slide(t, x);
    t = p.triangle;
    return p.point;
  }

  [[nodiscard]] Vec3 way(Index n, const Vec3& d) const {
    const HexSite& s = sites_[at(n)];
    if (s.inside()) return d;
    if (s.corner) return {0, 0, 0};
    if (s.rim()) return d;  // placed() brings it back
    const Vec3 normal = outward(n);
    return vec::along(d, -vec::dot(d, normal), normal);
  }

  /// Unit normal of the surface at a node of one facet.
  [[nodiscard]] Vec3 outward(Index n) const {
    const HexSite& s = sites_[at(n)];
    if (const auto& plane = facets_.planes[at(s.facet)]) return plane->normal;
    return triangle_[at(n)] < 0 ? Vec3(0, 0, 0) : vec::unit(walk_.normal(triangle_[at(n)]));
  }

  [[nodiscard]] const SurfaceWalk& walk() const { return walk_; }
  [[nodiscard]] Index triangle(Index n) const { return triangle_[at(n)]; }

 private:
  static std::size_t at(Index i) { return static_cast<std::size_t>(i); }

  struct Segment {
    Vec3 a, b;
    [[nodiscard]] Vec3 nearest(const Vec3& x) const {
      const Vec3 e = vec::minus(b, a);
      const double l2 = vec::squared(e);
      return vec::along(a, l2 > 0 ? std::clamp(vec::dot(vec::minus(x, a), e) / l2, 0.0, 1.0) : 0.0, e);
    }
  };
  struct Rim {
    std::vector<Segment> segments;
    search::Octree tree;
    struct Hit {
      Vec3 point;
    };
    [[nodiscard]] Hit nearest(const Vec3& x) const {
      const auto found =
          tree.nearest(x, [&](Index i) { return vec::squared(vec::minus(segments[at(i)].nearest(x), x)); });
      return {segments[at(found.item)].nearest(x)};
    }
  };

  const mesh::Surface& surface_;
  const Facets& facets_;
  SurfaceWalk walk_;
  std::vector<HexSite> sites_;
  std::vector<Index> triangle_;  // where a node of a curved facet is
  std::map<std::pair<Index, Index>, Rim> rims_;
};

}  // namespace tunica::meshing
