// SPDX-License-Identifier: MIT
// How far collapses have worn down a surface at each node: a bound that grows along with the merged nodes.
#pragma once

#include "tunica/meshing/editable_surface.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace tunica::meshing {

class Wear {
 public:
  [[nodiscard]] double at(Index n) const {
    return static_cast<std::size_t>(n) < lost_.size() ? lost_[static_cast<std::size_t>(n)] : 0;
  }

  void set(Index n, double lost) {
    if (static_cast<std::size_t>(n) >= lost_.size()) lost_.resize(static_cast<std::size_t>(n) + 1, 0);
    lost_[static_cast<std::size_t>(n)] = lost;
  }

  /// The wear if edge ab were merged into a place: that of its ends, and their distance from the new
  /// triangles.
  [[nodiscard]] double after(const EditableSurface& s, Index a, Index b, const Vec3& place) const {
    double farthest = 0;
    for (const Index end : {a, b}) {
      const Vec3& x = s.x(end);
      double nearest = (x - place).squaredNorm();
      for (const Index n : {a, b})
        for (const Index t : s.ring(n)) {
          const auto& v = s.nodes(t);
          const Index other = n == a ? b : a;
          if (std::find(v.begin(), v.end(), other) != v.end()) continue;  // vanishes
          mesh::Triangle f = s.triangle(t);
          (v[0] == n ? f.a : v[1] == n ? f.b : f.c) = place;
          nearest = std::min(nearest, (f.at(f.nearest(x)) - x).squaredNorm());
        }
      farthest = std::max(farthest, nearest);
    }
    return std::max(at(a), at(b)) + std::sqrt(farthest);
  }

 private:
  std::vector<double> lost_;
};

}  // namespace tunica::meshing
