// SPDX-License-Identifier: MIT
// Lines from one root as a tree: a line leaves another where it leaves a tenth of the radius around it; what
// they have in common is kept once.
#pragma once

#include "tunica/core/vec.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace tunica::meshing::detail {

/// Points first .. last of a line: a branch of the tree.
struct LinePiece {
  std::size_t line = 0, first = 0, last = 0;
  Index parent = -1;  // a piece before this one; its last point is where this one begins
};

class LineTree {
 public:
  /// Lines and radii from the root, each with two points or more.
  LineTree(const std::vector<std::vector<Vec3>>& lines, const std::vector<std::vector<double>>& radius)
      : lines_(lines), start_(lines.size(), 0), forks_(lines.size()) {
    for (std::size_t j = 1; j < lines.size(); ++j) {
      std::size_t longest = 0, host = 0;
      for (std::size_t i = 0; i < j; ++i)
        if (const std::size_t k = common(j, i, radius[j]); k > longest) longest = k, host = i;
      start_[j] = std::clamp<std::size_t>(longest, 1, lines[j].size() - 1);
      const std::size_t at = std::clamp<std::size_t>(nearest(lines[j][start_[j] - 1], host),
                                                     std::max<std::size_t>(start_[host], 1),
                                                     std::max<std::size_t>(lines[host].size() - 2, 1));
      forks_[host].emplace_back(at, j);
    }
    for (auto& f : forks_) std::sort(f.begin(), f.end());
    add(0, -1);
  }

  std::vector<LinePiece> pieces;  // parents before their children

 private:
  /// How many points of line j lie within a tenth of the radius from line i, from the root on.
  [[nodiscard]] std::size_t common(std::size_t j, std::size_t i, const std::vector<double>& radius) const {
    constexpr double share = 0.1;
    std::size_t k = 0;
    while (k < lines_[j].size() && distance(lines_[j][k], i) <= share * radius[k]) ++k;
    return k;
  }

  [[nodiscard]] double distance(const Vec3& x, std::size_t i) const {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k + 1 < lines_[i].size(); ++k) {
      const Vec3 &a = lines_[i][k], way = vec::minus(lines_[i][k + 1], a);
      const double l2 = vec::squared(way);
      const double t = l2 > 0 ? std::clamp(vec::dot(vec::minus(x, a), way) / l2, 0.0, 1.0) : 0;
      least = std::min(least, vec::distance(x, vec::along(a, t, way)));
    }
    return least;
  }

  [[nodiscard]] std::size_t nearest(const Vec3& x, std::size_t i) const {
    std::size_t best = 0;
    for (std::size_t k = 1; k < lines_[i].size(); ++k)
      if (vec::distance(x, lines_[i][k]) < vec::distance(x, lines_[i][best])) best = k;
    return best;
  }

  /// The pieces of a line between the forks on it, and of the lines that leave it there.
  void add(std::size_t line, Index parent) {
    std::size_t first = start_[line];
    for (std::size_t f = 0; f < forks_[line].size();) {
      const std::size_t at = forks_[line][f].first;
      pieces.push_back({line, first, at, parent});
      parent = static_cast<Index>(pieces.size()) - 1;
      first = at + 1;
      for (; f < forks_[line].size() && forks_[line][f].first == at; ++f) add(forks_[line][f].second, parent);
    }
    pieces.push_back({line, first, lines_[line].size() - 1, parent});
  }

  const std::vector<std::vector<Vec3>>& lines_;
  std::vector<std::size_t> start_;                                       // first point of its own
  std::vector<std::vector<std::pair<std::size_t, std::size_t>>> forks_;  // (point, line that leaves)
};

}  // namespace tunica::meshing::detail
