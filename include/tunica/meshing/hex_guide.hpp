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
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

namespace tunica::meshing {

/// What nodes are held to while hexahedra are improved.
///   struct Free { Vec3 placed(Index, const Vec3& x) { return x; }  Vec3 way(Index, const Vec3& d) { return
///   d; } };
template <class G>
concept HexGuide = requires(G& g, Index n, const Vec3& x) {
  { g.placed(n, x) } -> std::convertible_to<Vec3>;     // the place nearest to x where node n may be
  { g.way(n, x) } -> std::convertible_to<Vec3>;        // the part of a direction along which it may go
  { g.release(n, 1.0) } -> std::convertible_to<bool>;  // it may go so far from where it belongs
};

/// The nodes of a complex on the facets of a closed surface.
class SurfaceGuide {
 public:
  SurfaceGuide(const mesh::Surface& surface, const Facets& facets, std::vector<HexSite> sites)
      : surface_(surface),
        facets_(facets),
        walk_(surface, facets.of),
        sites_(std::move(sites)),
        loose_(sites_.size(), 0),
        triangle_(sites_.size(), -1),
        rims_from_(facets.region.size()) {
    const auto twin = mesh::twins(surface.cells, surface.node_count());
    for (Index h = 0; h < static_cast<Index>(twin.size()); ++h) {
      const Index p = facets.of[at(h / 3)], q = facets.of[at(twin[at(h)] / 3)];
      if (p >= q) continue;
      const auto e = mesh::half_edge(surface.cells, h);
      rim(p, q).segments.push_back({vec::column(surface.nodes, e.from), vec::column(surface.nodes, e.to)});
    }
    for (Rim& rim : rims_) {
      std::vector<Box> boxes;
      for (const auto& s : rim.segments) {
        boxes.emplace_back();
        boxes.back().extend(s.a), boxes.back().extend(s.b);
      }
      rim.tree = search::Octree(boxes);
    }
    for (HexSite& s : sites_)
      if (s.rim() && !rim_of(s)) s.corner = true;  // the facets meet nowhere
  }

  [[nodiscard]] const HexSite& site(Index n) const { return sites_[at(n)]; }

  /// The node may leave its place by that length; those of flat facets stay in their planes.
  bool release(Index n, double reach) {
    if (sites_[at(n)].inside() || (facets_.planes[at(sites_[at(n)].facet)] && !sites_[at(n)].rim()))
      return false;
    const bool first = !loose(n);
    loose_[at(n)] = reach;
    return first;
  }

  [[nodiscard]] Vec3 placed(Index n, const Vec3& x) {
    const HexSite& s = sites_[at(n)];
    if (s.inside() || s.corner) return x;
    if (loose(n)) {
      const Vec3 y = in_planes(n, x);
      const Vec3 foot = bound(n, y), off = vec::minus(y, foot);
      const double far = vec::length(off);
      return far <= loose_[at(n)] ? y : vec::along(foot, loose_[at(n)] / far, off);
    }
    return bound(n, x);
  }

  /// Where the node belongs.
  [[nodiscard]] Vec3 bound(Index n, const Vec3& x) {
    const HexSite& s = sites_[at(n)];
    if (s.rim()) return rim_of(s)->nearest(x);
    if (const auto& plane = facets_.planes[at(s.facet)]) return plane->projected(x);
    Index& t = triangle_[at(n)];
    const SurfacePoint p = t < 0 ? walk_.nearest(x, s.facet) : walk_.slide(t, x);
    t = p.triangle;
    return p.point;
  }

  [[nodiscard]] Vec3 way(Index n, const Vec3& d) const {
    const HexSite& s = sites_[at(n)];
    if (s.inside() || loose(n)) return d;
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

  /// What leads from x to the surface, or the rim, beside the node.
  [[nodiscard]] Vec3 lack(Index n, const Vec3& x) const {
    const HexSite& s = sites_[at(n)];
    if (s.corner) return {0, 0, 0};
    if (s.rim()) return vec::minus(rim_of(s)->nearest(x), x);
    if (const auto& plane = facets_.planes[at(s.facet)])
      return vec::scaled(-plane->distance(x), plane->normal);
    return vec::minus(walk_.slide(triangle_[at(n)], x).point, x);
  }

  /// A node of the face that is on the facet alone; -1 if there is none.
  [[nodiscard]] Index node_on(const std::array<Index, 4>& face, Index facet) const {
    for (const Index n : face)
      if (sites_[at(n)].facet == facet && !sites_[at(n)].rim() && (flat(facet) || triangle_[at(n)] >= 0))
        return n;
    return -1;
  }

  /// x in the planes of the flat facets of the node.
  [[nodiscard]] Vec3 in_planes(Index n, Vec3 x) const {
    for (const Index f : {sites_[at(n)].facet, sites_[at(n)].other})
      if (f >= 0 && flat(f)) x = facets_.planes[at(f)]->projected(x);
    return x;
  }

  [[nodiscard]] bool flat(Index facet) const { return facets_.planes[at(facet)].has_value(); }
  [[nodiscard]] bool loose(Index n) const { return loose_[at(n)] > 0; }
  [[nodiscard]] const SurfaceWalk& walk() const { return walk_; }

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
    Index other;  // the facet of the higher number
    std::vector<Segment> segments;
    search::Octree tree;
    [[nodiscard]] Vec3 nearest(const Vec3& x) const {
      const auto found =
          tree.nearest(x, [&](Index i) { return vec::squared(vec::minus(segments[at(i)].nearest(x), x)); });
      return segments[at(found.item)].nearest(x);
    }
  };

  [[nodiscard]] Rim& rim(Index facet, Index other) {
    for (const Index r : rims_from_[at(facet)])
      if (rims_[at(r)].other == other) return rims_[at(r)];
    rims_from_[at(facet)].push_back(static_cast<Index>(rims_.size()));
    rims_.push_back({other, {}, {}});
    return rims_.back();
  }
  [[nodiscard]] const Rim* rim_of(const HexSite& s) const {
    for (const Index r : rims_from_[at(s.facet)])
      if (rims_[at(r)].other == s.other) return &rims_[at(r)];
    return nullptr;
  }

  const mesh::Surface& surface_;
  const Facets& facets_;
  SurfaceWalk walk_;
  std::vector<HexSite> sites_;
  std::vector<double> loose_;    // how far a node may leave its place
  std::vector<Index> triangle_;  // where a node of a curved facet is
  std::vector<Rim> rims_;
  std::vector<std::vector<Index>> rims_from_;  // of each facet, to those of higher numbers
};

}  // namespace tunica::meshing
