// SPDX-License-Identifier: MIT
// The closed curve in which the wall of a lumen meets a flat cap, measured by its length.
#pragma once

#include "tunica/core/error.hpp"
#include "tunica/core/vec.hpp"
#include "tunica/mesh/adjacency.hpp"
#include "tunica/mesh/mesh.hpp"
#include "tunica/meshing/flat_regions.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace tunica::meshing {

/// A closed polygon in the plane of a cap, run with the wall on its left.
class RimCurve {
 public:
  RimCurve(std::string name, const Plane& plane, const std::vector<Vec3>& points)
      : name_(std::move(name)), plane_(plane) {
    length_.push_back(0);
    for (const Vec3& x : points) points_.push_back(plane.projected(x));
    for (std::size_t i = 0; i < points.size(); ++i)
      length_.push_back(length_.back() + vec::distance(points_[(i + 1) % points.size()], points_[i]));
  }

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const Plane& plane() const { return plane_; }
  [[nodiscard]] double length() const { return length_.back(); }

  /// Where on the curve the point nearest to x is [length], in [0, length()).
  [[nodiscard]] double nearest(const Vec3& x) const {
    double best = std::numeric_limits<double>::infinity(), where = 0;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const Vec3 &a = points_[i], &b = points_[(i + 1) % points_.size()];
      const double square = vec::dot(vec::minus(b, a), vec::minus(b, a));
      const double t =
          square > 0 ? std::clamp(vec::dot(vec::minus(x, a), vec::minus(b, a)) / square, 0.0, 1.0) : 0.0;
      const double d = vec::distance(vec::between(a, b, t), x);
      if (d < best) best = d, where = length_[i] + t * (length_[i + 1] - length_[i]);
    }
    return wrapped(where);
  }

  /// The point at a length along the curve (any real number: it is closed).
  [[nodiscard]] Vec3 at(double s) const {
    s = wrapped(s);
    const auto above = std::upper_bound(length_.begin(), length_.end(), s) - length_.begin();
    const auto i = std::min(static_cast<std::size_t>(above) - 1, points_.size() - 1);
    const double step = length_[i + 1] - length_[i];
    const double t = step > 0 ? (s - length_[i]) / step : 0;
    return vec::between(points_[i], points_[(i + 1) % points_.size()], t);
  }

  /// The difference b - a along the shorter way round.
  [[nodiscard]] double way(double a, double b) const { return std::remainder(b - a, length()); }

 private:
  [[nodiscard]] double wrapped(double s) const {
    s = std::fmod(s, length());
    return s < 0 ? s + length() : s;
  }

  std::string name_;
  Plane plane_;
  std::vector<Vec3> points_;
  std::vector<double> length_;  // up to each point, and of the whole
};

/// One curve for each flat region, in their order; `region` of the surface each belongs to. MeshError if
/// the wall (region 0) does not meet a flat region in exactly one closed curve.
struct Rims {
  std::vector<RimCurve> curves;
  std::vector<Index> regions;
};

namespace detail {

/// The wall's edges that a cap shares: for each node the next one as the wall runs, and the cap's region.
struct RimEdges {
  std::vector<Index> next, region;  // -1, 0: no rim leaves the node
  std::vector<Index> count;         // of edges, by region
};

[[nodiscard]] inline RimEdges rim_edges(const mesh::Surface& surface, std::size_t regions) {
  const mesh::Rows around = mesh::cells_of_nodes(surface.cells, surface.node_count());
  RimEdges rim{std::vector<Index>(static_cast<std::size_t>(surface.node_count()), -1),
               std::vector<Index>(static_cast<std::size_t>(surface.node_count()), 0),
               std::vector<Index>(regions, 0)};
  for (Index t = 0; t < surface.cell_count(); ++t) {
    if (surface.region_of(t) != 0) continue;
    for (int k = 0; k < 3; ++k) {
      const Index a = surface.cells(k, t), b = surface.cells((k + 1) % 3, t);
      for (const Index other : around[a])
        for (int j = 0; j < 3; ++j) {
          if (surface.cells(j, other) != b || surface.cells((j + 1) % 3, other) != a) continue;
          const Index region = surface.region_of(other);
          if (region == 0) continue;
          rim.next[static_cast<std::size_t>(a)] = b;
          rim.region[static_cast<std::size_t>(a)] = region;
          ++rim.count[static_cast<std::size_t>(region)];
        }
    }
  }
  return rim;
}

}  // namespace detail

[[nodiscard]] inline Rims rims_of(const mesh::Surface& surface) {
  const auto flat = flat_regions(surface);
  const detail::RimEdges edges = detail::rim_edges(surface, flat.size());
  Rims rims;
  for (std::size_t r = 1; r < flat.size(); ++r) {
    const std::string name =
        r < surface.region_names.size() ? surface.region_names[r] : "region " + std::to_string(r);
    if (!flat[r] && edges.count[r] == 0) continue;  // a region without triangles
    if (!flat[r]) throw MeshError("the cap \"" + name + "\" is not flat: the wall cannot end in its plane");
    std::vector<Vec3> points;
    Index first = 0;
    while (first < surface.node_count() &&
           edges.region[static_cast<std::size_t>(first)] != static_cast<Index>(r))
      ++first;
    for (Index at = first; at < surface.node_count() && at >= 0;) {
      if (edges.region[static_cast<std::size_t>(at)] != static_cast<Index>(r)) break;
      points.push_back(vec::column(surface.nodes, at));
      at = edges.next[static_cast<std::size_t>(at)];
      if (at == first || static_cast<Index>(points.size()) > edges.count[r]) break;
    }
    if (points.size() < 3 || static_cast<Index>(points.size()) != edges.count[r])
      throw MeshError("the wall does not meet the cap \"" + name + "\" in one closed curve");
    rims.curves.emplace_back(name, *flat[r], points);
    rims.regions.push_back(static_cast<Index>(r));
  }
  return rims;
}

}  // namespace tunica::meshing
