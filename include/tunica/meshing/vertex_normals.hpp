// SPDX-License-Identifier: MIT
// Unit normals at the vertices of a surface, weighted by angle, for each region by itself. [THUERMER98]
#pragma once

#include "tunica/mesh/mesh.hpp"
#include "tunica/meshing/cap_planes.hpp"
#include "tunica/meshing/vec.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace tunica::meshing {

/// The angle at p between q and r [rad].
[[nodiscard]] inline double corner_angle(const Vec3& p, const Vec3& q, const Vec3& r) {
  return std::atan2(vec::length(vec::cross(q - p, r - p)), vec::dot(q - p, r - p));
}

/// Normals by (region, node): where regions meet each has its own.
class RegionNormals {
 public:
  void add(Index region, Index node, const Vec3& n) { entries_.push_back({{region, node}, n}); }
  void finish() {
    std::stable_sort(entries_.begin(), entries_.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    std::size_t last = 0;
    for (std::size_t i = 1; i < entries_.size(); ++i) {
      if (entries_[i].first == entries_[last].first)
        entries_[last].second += entries_[i].second;
      else
        entries_[++last] = entries_[i];
    }
    if (!entries_.empty()) entries_.resize(last + 1);
    for (auto& [key, n] : entries_) n = vec::unit(n);
  }
  /// Zero where there is none.
  [[nodiscard]] Vec3 of(Index region, Index node) const {
    const auto at = std::lower_bound(entries_.begin(), entries_.end(), std::pair(region, node),
                                     [](const auto& e, const auto& key) { return e.first < key; });
    return at != entries_.end() && at->first == std::pair(region, node) ? at->second : Vec3::Zero();
  }

 private:
  std::vector<std::pair<std::pair<Index, Index>, Vec3>> entries_;
};

[[nodiscard]] inline RegionNormals region_vertex_normals(const mesh::Surface& surface) {
  RegionNormals normals;
  for (Index t = 0; t < surface.cell_count(); ++t) {
    const auto x = mesh::triangle(surface, t);
    const Vec3 area = x.area_vector();
    if (!(vec::length(area) > 0)) continue;
    const Vec3 n = vec::unit(area);
    const Index r = surface.region_of(t);
    normals.add(r, surface.cells(0, t), corner_angle(x.a, x.b, x.c) * n);
    normals.add(r, surface.cells(1, t), corner_angle(x.b, x.c, x.a) * n);
    normals.add(r, surface.cells(2, t), corner_angle(x.c, x.a, x.b) * n);
  }
  normals.finish();
  return normals;
}

}  // namespace tunica::meshing
