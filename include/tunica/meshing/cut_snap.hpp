// SPDX-License-Identifier: MIT
// Nodes near a cutting plane are moved onto it before triangles are split: no sliver is made at the rim.
#pragma once

#include "tunica/meshing/flat_regions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

namespace tunica::meshing::detail {

/// Works on the places x, the distances from the plane and the signs (-1 behind, 0 in the plane, 1 in
/// front) of the nodes of s; the nodes of `avoided`, ascending, are kept off the plane.
class PlaneSnap {
 public:
  PlaneSnap(const mesh::Surface& s, const Plane& plane, const std::vector<Index>& avoided,
            std::vector<Vec3>& x, std::vector<double>& distance, std::vector<int>& sign)
      : s_(s),
        plane_(plane),
        avoided_(avoided),
        x_(x),
        distance_(distance),
        sign_(sign),
        around_(mesh::cells_of_nodes(s.cells, s.node_count())),
        planes_(flat_regions(s)),
        bonds_(bonds(s, planes_)),
        diagonal_(mesh::bounding_box(s.nodes).diagonal()) {}

  /// Moves nodes that are nearer to the plane than a tenth of a crossed edge onto it, unless a triangle would
  /// turn or become much thinner; their number. Nodes of flat regions stay in them.
  [[nodiscard]] Index run(const std::vector<char>& active) {
    for (const Index n : avoided_) keep_off(n);
    constexpr double reach = 0.1;
    for (Index t = 0; t < s_.cell_count(); ++t) {
      if (!active[at(t)]) continue;
      for (Index h = 3 * t; h < 3 * t + 3; ++h) {
        const auto e = mesh::half_edge(s_.cells, h);
        const double da = distance_[at(e.from)], db = distance_[at(e.to)];
        if (sign_[at(e.from)] * sign_[at(e.to)] >= 0) continue;
        const Index n = std::abs(da) <= std::abs(db) ? e.from : e.to;
        if (std::min(std::abs(da), std::abs(db)) <= reach * std::abs(da - db)) try_snap(n);
      }
    }
    return snapped_;
  }

 private:
  [[nodiscard]] static std::size_t at(Index i) { return static_cast<std::size_t>(i); }

  void keep_off(Index n) {
    double shortest = std::numeric_limits<double>::infinity();
    for (const Index t : around_[n])
      for (int k = 0; k < 3; ++k)
        if (const Index m = s_.cells(k, t); m != n)
          shortest = std::min(shortest, vec::distance(x_[at(m)], x_[at(n)]));
    const double off = 0.01 * shortest * sign_[at(n)] - distance_[at(n)];
    if (off * sign_[at(n)] <= 0) return;
    x_[at(n)] = vec::along(x_[at(n)], off, plane_.normal);
    distance_[at(n)] += off;
  }

  void try_snap(Index n) {
    if (std::binary_search(avoided_.begin(), avoided_.end(), n)) return;
    const double d = distance_[at(n)];
    constexpr double rounding = 1e-13;  // of the diagonal: such a node is in the plane
    Vec3 to = plane_.projected(x_[at(n)]);
    if (bonds_.of(n) != Bond::none && std::abs(d) > rounding * diagonal_) {
      if (bonds_.of(n) == Bond::corner) return;
      const Vec3& c = planes_[at(bonds_.region[at(n)])]->normal;
      const Vec3 m =
          vec::along(plane_.normal, -vec::dot(plane_.normal, c), c);  // slides within its own plane
      if (vec::squared(m) < 0.1) return;
      to = vec::along(x_[at(n)], -d / vec::squared(m), m);
    }
    const Vec3 from = x_[at(n)];
    for (const Index t : around_[n]) {
      const std::array<Index, 3> v{s_.cells(0, t), s_.cells(1, t), s_.cells(2, t)};
      const mesh::Triangle was{x_[at(v[0])], x_[at(v[1])], x_[at(v[2])]};
      x_[at(n)] = to;
      const mesh::Triangle is{x_[at(v[0])], x_[at(v[1])], x_[at(v[2])]};
      x_[at(n)] = from;
      const bool turned = vec::dot(was.area_vector(), is.area_vector()) <= 0.5 * was.area() * is.area();
      constexpr double thin = 0.02;  // [rad]
      if (turned || is.smallest_angle() < std::min(thin, 0.5 * was.smallest_angle())) return;
    }
    x_[at(n)] = to;
    sign_[at(n)] = 0;
    ++snapped_;
  }

  const mesh::Surface& s_;
  const Plane& plane_;
  const std::vector<Index>& avoided_;
  std::vector<Vec3>& x_;
  std::vector<double>& distance_;
  std::vector<int>& sign_;
  mesh::Rows around_;
  std::vector<std::optional<Plane>> planes_;
  Bonds bonds_;
  double diagonal_;
  Index snapped_ = 0;
};

}  // namespace tunica::meshing::detail
