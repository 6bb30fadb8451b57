// SPDX-License-Identifier: MIT
// The best triangulation of a polygon whose triangles carry a quality: the dynamic programme behind
// edge removal and behind the faces that close over a released point.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace tunica::meshing {

class CavityPolygon {
 public:
  std::vector<std::array<int, 3>> triangles;  // (i, k, j) with i < k < j: they turn as the polygon

  /// Finds the triangulation of the corners 0 .. corners-1 whose worst triangle is best;
  /// quality(i, k, j) < 0 forbids a triangle. Returns that worst quality, or -1 if none exceeds
  /// the floor (then `triangles` is empty). corners^3 / 6 evaluations at most.
  template <class Quality>
  double triangulate(int corners, double floor, Quality&& quality) {
    triangles.clear();
    n_ = static_cast<std::size_t>(corners);
    best_.assign(n_ * n_, 2.0);  // chords of neighbours cost nothing; a sine is at most 1
    split_.assign(n_ * n_, -1);
    for (int span = 2; span < corners; ++span)
      for (int i = 0; i + span < corners; ++i) {
        const int j = i + span;
        double& best = best_[at(i, j)];
        best = floor;
        for (int k = i + 1; k < j; ++k) {
          const double bound = std::min(best_[at(i, k)], best_[at(k, j)]);
          if (!(bound > best)) continue;
          const double q = std::min(bound, quality(i, k, j));
          if (q > best) best = q, split_[at(i, j)] = k;
        }
      }
    if (split_[at(0, corners - 1)] < 0) return -1;
    collect(0, corners - 1);
    return best_[at(0, corners - 1)];
  }

 private:
  [[nodiscard]] std::size_t at(int i, int j) const {
    return static_cast<std::size_t>(i) * n_ + static_cast<std::size_t>(j);
  }
  void collect(int i, int j) {
    if (j - i < 2) return;
    const int k = split_[at(i, j)];
    triangles.push_back({i, k, j});
    collect(i, k);
    collect(k, j);
  }

  std::size_t n_ = 0;
  std::vector<double> best_;
  std::vector<int> split_;
};

}  // namespace tunica::meshing
