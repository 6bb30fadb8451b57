// SPDX-License-Identifier: MIT
// The closed curve in which the wall of a lumen meets a flat cap, measured by its length.
#pragma once

#include "tunica/core/error.hpp"
#include "tunica/mesh/mesh.hpp"
#include "tunica/meshing/cap_planes.hpp"
#include "tunica/meshing/vec.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace tunica::meshing {

/// A closed polygon in the plane of a cap, run with the wall on its left.
class RimCurve {
 public:
  RimCurve(std::string name, const CapPlane& plane, const std::vector<Vec3>& points)
      : name_(std::move(name)), plane_(plane) {
    length_.push_back(0);
    for (const Vec3& x : points)
      points_.push_back(x - plane.normal * vec::dot(plane.normal, x - plane.point));
    for (std::size_t i = 0; i < points.size(); ++i)
      length_.push_back(length_.back() + vec::distance(points_[(i + 1) % points.size()], points_[i]));
  }

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const CapPlane& plane() const { return plane_; }
  [[nodiscard]] double length() const { return length_.back(); }

  /// Where on the curve the point nearest to x is [length], in [0, length()).
  [[nodiscard]] double nearest(const Vec3& x) const {
    double best = std::numeric_limits<double>::infinity(), where = 0;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const Vec3 &a = points_[i], &b = points_[(i + 1) % points_.size()];
      const double square = vec::dot(b - a, b - a);
      const double t = square > 0 ? std::clamp(vec::dot(x - a, b - a) / square, 0.0, 1.0) : 0.0;
      const double d = vec::distance(a + t * (b - a), x);
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
    return points_[i] + t * (points_[(i + 1) % points_.size()] - points_[i]);
  }

  /// The difference b - a along the shorter way round.
  [[nodiscard]] double way(double a, double b) const { return std::remainder(b - a, length()); }

 private:
  [[nodiscard]] double wrapped(double s) const {
    s = std::fmod(s, length());
    return s < 0 ? s + length() : s;
  }

  std::string name_;
  CapPlane plane_;
  std::vector<Vec3> points_;
  std::vector<double> length_;  // up to each point, and of the whole
};

/// One curve for each flat region, in their order; `region` of the surface each belongs to. MeshError if
/// the wall (region 0) does not meet a flat region in exactly one closed curve.
struct Rims {
  std::vector<RimCurve> curves;
  std::vector<Index> regions;
};

[[nodiscard]] inline Rims rims_of(const mesh::Surface& surface) {
  std::map<std::pair<Index, Index>, Index> cap_edges;  // as the wall runs them
  for (Index t = 0; t < surface.cell_count(); ++t)
    if (surface.region_of(t) != 0)
      for (int k = 0; k < 3; ++k)
        cap_edges[{surface.cells((k + 1) % 3, t), surface.cells(k, t)}] = surface.region_of(t);
  const auto flat = cap_planes(surface);
  std::vector<std::map<Index, Index>> next(flat.size());
  for (Index t = 0; t < surface.cell_count(); ++t)
    if (surface.region_of(t) == 0)
      for (int k = 0; k < 3; ++k) {
        const Index a = surface.cells(k, t), b = surface.cells((k + 1) % 3, t);
        if (const auto cap = cap_edges.find({a, b}); cap != cap_edges.end())
          next[static_cast<std::size_t>(cap->second)][a] = b;
      }
  Rims rims;
  for (std::size_t r = 1; r < flat.size(); ++r) {
    const std::string name =
        r < surface.region_names.size() ? surface.region_names[r] : "region " + std::to_string(r);
    if (!flat[r] && next[r].empty()) continue;  // a region without triangles
    if (!flat[r]) throw MeshError("the cap \"" + name + "\" is not flat: the wall cannot end in its plane");
    std::vector<Vec3> points;
    if (!next[r].empty()) {
      Index at = next[r].begin()->first;
      do {
        points.push_back(vec::column(surface.nodes, at));
        const auto step = next[r].find(at);
        if (step == next[r].end() || points.size() > next[r].size()) break;
        at = step->second;
      } while (at != next[r].begin()->first);
    }
    if (points.size() < 3 || points.size() != next[r].size())
      throw MeshError("the wall does not meet the cap \"" + name + "\" in one closed curve");
    rims.curves.emplace_back(name, *flat[r], points);
    rims.regions.push_back(static_cast<Index>(r));
  }
  return rims;
}

}  // namespace tunica::meshing
