// SPDX-License-Identifier: MIT
// The visit of a sweep to a node that needs a look at its triangles: on a flat region, on a rim, or where
// the surface is no single fan. Formulas of ring_sweep.hpp, one node at a time.
#pragma once

#include "tunica/mesh/mesh.hpp"
#include "tunica/meshing/flat_regions.hpp"
#include "tunica/meshing/ring_sweep.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

namespace tunica::meshing::detail {

class NodeVisits {
 public:
  NodeVisits(const mesh::Surface& s, const std::vector<std::optional<Plane>>& planes, const Bonds& bonds,
             const Vec3& origin)
      : s_(s), planes_(planes), bonds_(bonds), origin_(origin) {}

  [[nodiscard]] Bond bond(Index n) const { return bonds_.bond.empty() ? Bond::none : bonds_.of(n); }

  [[nodiscard]] static Vec3 place(const Place& p) { return {p.x, p.y, p.z}; }

  /// Derivative of six times the volume by the place of node n; of its curved regions alone where asked.
  [[nodiscard]] Vec3 area(const SmoothGraph& g, const Place* places, Index n, bool curved_only) const {
    Vec3 sum(0, 0, 0);
    for (const Index t : g.around[n]) {
      if (curved_only && planes_[static_cast<std::size_t>(s_.region_of(t))]) continue;
      const auto [p, q] = opposite(g, places, n, t);
      sum = vec::plus(sum, curved_only ? vec::cross(vec::minus(p, place(places[g.slot[at(n)]])),
                                                    vec::minus(q, place(places[g.slot[at(n)]])))
                                       : vec::cross(vec::minus(p, origin_), vec::minus(q, origin_)));
    }
    return sum;
  }

  /// Unit normal of the curved regions, in the plane for a node on a rim; 0 where there is none.
  [[nodiscard]] Vec3 normal(const SmoothGraph& g, const Place* places, Index n) const {
    return vec::unit(bound(n, area(g, places, n, true)));
  }

  /// The visit; `only_rise` leaves the node where it is.
  void visit(const SmoothGraph& g, Place* places, Place* before, Index n, const Step& step, bool only_rise,
             Tally& tally) const {
    Place& own = places[g.slot[at(n)]];
    const Place mean = mean_of_neighbours(g, places, n);
    const Vec3 x = place(own), area_all = area(g, places, n, false), unit = normal(g, places, n);
    const Vec3 move = bound(n, vec::scaled(step.factor, vec::minus(place(mean), x)));
    const double rise = vec::dot(move, unit);
    tally.slope += vec::dot(unit, area_all);
    if (!only_rise) {
      const Vec3 to = vec::plus(x, vec::along(move, step.offset - 0.5 * (rise + mean.w), unit));
      const Vec3 moved = vec::minus(to, x);
      tally.volume += vec::dot(moved, area_all);
      tally.longest = std::max(tally.longest, vec::squared(moved));
      before[g.slot[at(n)]] = own;
      own = {to[0], to[1], to[2], rise};
    }
    own.w = rise;
  }

  /// What a unit of offset along the normal of the node takes in of six times the volume.
  [[nodiscard]] double slope(const SmoothGraph& g, const Place* places, Index n) const {
    return vec::dot(normal(g, places, n), area(g, places, n, false));
  }

  /// Moves a node along its normal; six times the volume that this takes in.
  double offset(const SmoothGraph& g, Place* places, Index n, double d) const {
    const Vec3 all = area(g, places, n, false), unit = normal(g, places, n);
    Place& own = places[g.slot[at(n)]];
    const Vec3 x = place(own), to = vec::along(x, d, unit);
    own = {to[0], to[1], to[2], own.w};
    return vec::dot(vec::minus(to, x), all);
  }

 private:
  [[nodiscard]] static std::size_t at(Index i) { return static_cast<std::size_t>(i); }

  struct Pair {
    Vec3 p, q;
  };
  /// The two other nodes of triangle t, in its order.
  [[nodiscard]] Pair opposite(const SmoothGraph& g, const Place* places, Index n, Index t) const {
    const int k = s_.cells(0, t) == n ? 0 : s_.cells(1, t) == n ? 1 : 2;
    return {place(places[g.slot[at(s_.cells((k + 1) % 3, t))]]),
            place(places[g.slot[at(s_.cells((k + 2) % 3, t))]])};
  }

  [[nodiscard]] Vec3 bound(Index n, const Vec3& v) const {
    switch (bond(n)) {
      case Bond::none: return v;
      case Bond::corner: return {0, 0, 0};
      case Bond::plane:
      case Bond::rim: break;
    }
    const Vec3& m = planes_[at(bonds_.region[at(n)])]->normal;
    return vec::along(v, -vec::dot(m, v), m);
  }

  [[nodiscard]] Place mean_of_neighbours(const SmoothGraph& g, const Place* places, Index n) const {
    Place sum;
    const auto add = [&](Index m, double share) {
      const Place& p = places[g.slot[at(m)]];
      sum.x += share * p.x, sum.y += share * p.y, sum.z += share * p.z, sum.w += share * p.w;
    };
    if (bond(n) == Bond::rim) {
      for (const Index m : bonds_.along[at(n)]) add(m, 0.5);
      return sum;
    }
    const double share = 0.5 / static_cast<double>(g.around[n].size());  // each is met by two triangles
    for (const Index t : g.around[n])
      for (int k = 0; k < 3; ++k)
        if (s_.cells(k, t) != n) add(s_.cells(k, t), share);
    return sum;
  }

  const mesh::Surface& s_;
  const std::vector<std::optional<Plane>>& planes_;
  const Bonds& bonds_;
  Vec3 origin_;
};

}  // namespace tunica::meshing::detail
