// SPDX-License-Identifier: MIT
// The points of a cubic grid that lie within a closed surface, with their distances to its wall, and the
// cheapest paths between them: the farther from the wall the cheaper.
#pragma once

#include "tunica/meshing/predicates.hpp"
#include "tunica/meshing/vessel_ends.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <queue>
#include <utility>
#include <vector>

namespace tunica::meshing::detail {

class InsideGrid {
 public:
  /// The spacing is made wider where the box would have more than 2^24 points.
  InsideGrid(const mesh::Surface& s, const WallDistance& wall, double spacing) : h_(spacing) {
    constexpr double most_points = 1 << 24;
    const Box box = mesh::bounding_box(s.nodes);
    const Vec3 size = vec::minus(box.hi, box.lo);
    const auto points = [&] { return (size[0] / h_ + 1) * (size[1] / h_ + 1) * (size[2] / h_ + 1); };
    while (points() > most_points) h_ *= 1.1;
    origin_ = vec::along(box.lo, 0.5 * h_, Vec3(1, 1, 1));
    for (std::size_t a = 0; a < 3; ++a)
      n_[a] = static_cast<Index>(size[static_cast<Eigen::Index>(a)] / h_) + 1;
    number_.assign(
        static_cast<std::size_t>(n_[0]) * static_cast<std::size_t>(n_[1]) * static_cast<std::size_t>(n_[2]),
        -1);
    const auto crossings = columns(s);
    double bound = std::numeric_limits<double>::infinity();
    for (Index j = 0; j < n_[1]; ++j)
      for (Index i = 0; i < n_[0]; ++i) {
        const auto& z = crossings[static_cast<std::size_t>(i + n_[0] * j)];
        for (std::size_t k = 0; k + 1 < z.size(); k += 2)
          for (auto m = static_cast<Index>(std::ceil((z[k] - origin_[2]) / h_));
               m < n_[2] && height(m) < z[k + 1]; ++m) {
            if (m < 0) continue;
            number_[index(i, j, m)] = static_cast<Index>(place_.size());
            cell_.push_back({i, j, m});
            place_.push_back({origin_[0] + i * h_, origin_[1] + j * h_, height(m)});
            // no farther than from the point before and the way between them
            const double way =
                place_.size() > 1 ? vec::distance(place_.back(), place_[place_.size() - 2]) : 0;
            bound = wall.nearest(place_.back(), (bound + way) * (1 + 1e-9)).distance;
            distance_.push_back(bound);
          }
      }
  }

  [[nodiscard]] Index size() const { return static_cast<Index>(place_.size()); }
  [[nodiscard]] double spacing() const { return h_; }
  [[nodiscard]] const Vec3& place(Index p) const { return place_[static_cast<std::size_t>(p)]; }

  /// The point nearest to x, of those that reach it within the vessel if there are any; -1 in an empty grid.
  [[nodiscard]] Index nearest(const Vec3& x) const {
    Index best = -1;
    std::pair<int, double> least{2, 0};
    for (Index p = 0; p < size(); ++p) {
      const double d = vec::distance(place(p), x);
      const std::pair<int, double> key{d <= distance_[static_cast<std::size_t>(p)] ? 0 : 1, d};
      if (key < least) least = key, best = p;
    }
    return best;
  }

  /// The point before each on the cheapest path from the root, -1 at the root, -2 where no path leads. A step
  /// is taken only where the balls that touch the wall around its ends meet; its cost is its length over the
  /// square of their mean radius.
  [[nodiscard]] std::vector<Index> paths_from(Index root) const {
    std::vector<double> cost(place_.size(), std::numeric_limits<double>::infinity());
    std::vector<Index> before(place_.size(), -2);
    using Entry = std::pair<double, Index>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    cost[static_cast<std::size_t>(root)] = 0, before[static_cast<std::size_t>(root)] = -1;
    queue.push({0, root});
    while (!queue.empty()) {
      const auto [c, p] = queue.top();
      queue.pop();
      if (c > cost[static_cast<std::size_t>(p)]) continue;
      const auto [i, j, k] = cell_[static_cast<std::size_t>(p)];
      for (Index n = 0; n < 27; ++n) {
        const std::array<Index, 3> at{i + n % 3 - 1, j + n / 3 % 3 - 1, k + n / 9 - 1};
        if (n == 13 || at[0] < 0 || at[1] < 0 || at[2] < 0 || at[0] >= n_[0] || at[1] >= n_[1] ||
            at[2] >= n_[2])
          continue;
        const Index q = number_[index(at[0], at[1], at[2])];
        if (q < 0) continue;
        const double l = vec::distance(place(p), place(q));
        const double sum = distance_[static_cast<std::size_t>(p)] + distance_[static_cast<std::size_t>(q)];
        if (l > sum) continue;
        const double next = c + l / (0.25 * sum * sum);
        if (next < cost[static_cast<std::size_t>(q)])
          cost[static_cast<std::size_t>(q)] = next, before[static_cast<std::size_t>(q)] = p,
          queue.push({next, q});
      }
    }
    return before;
  }

 private:
  [[nodiscard]] double height(Index k) const { return origin_[2] + k * h_; }
  [[nodiscard]] std::size_t index(Index i, Index j, Index k) const {
    return static_cast<std::size_t>(i) +
           static_cast<std::size_t>(n_[0]) *
               (static_cast<std::size_t>(j) + static_cast<std::size_t>(n_[1]) * static_cast<std::size_t>(k));
  }

  /// Heights at which the vertical through each point of the base crosses the surface, ascending: an even
  /// number, since neighbours decide alike whose side of their common edge it is on.
  [[nodiscard]] std::vector<std::vector<double>> columns(const mesh::Surface& s) const {
    std::vector<std::vector<double>> z(static_cast<std::size_t>(n_[0]) * static_cast<std::size_t>(n_[1]));
    for (Index t = 0; t < s.cell_count(); ++t) {
      const mesh::Triangle f = mesh::triangle(s, t);
      const Box box = f.box();
      const Vec3 normal = f.area_vector();
      const std::array<const Vec3*, 3> v{&f.a, &f.b, &f.c};
      const auto from = [&](int a) {
        return std::max(Index{0}, static_cast<Index>(std::floor((box.lo[a] - origin_[a]) / h_)));
      };
      const auto to = [&](int a) {
        return std::min(n_[static_cast<std::size_t>(a)] - 1,
                        static_cast<Index>(std::ceil((box.hi[a] - origin_[a]) / h_)));
      };
      for (Index j = from(1); j <= to(1); ++j)
        for (Index i = from(0); i <= to(0); ++i) {
          const Point<2> p(origin_[0] + i * h_, origin_[1] + j * h_);
          bool inside = false;
          for (std::size_t e = 0; e < 3; ++e) {
            const Vec3 &a = *v[e], &b = *v[(e + 1) % 3];
            if ((a[1] > p[1]) == (b[1] > p[1])) continue;
            const Vec3 &low = a[1] < b[1] ? a : b, &high = a[1] < b[1] ? b : a;
            inside ^= orient2d({low[0], low[1]}, {high[0], high[1]}, p) > 0;
          }
          if (!inside) continue;
          const double up =
              normal[2] == 0 ? 0 : ((p[0] - f.a[0]) * normal[0] + (p[1] - f.a[1]) * normal[1]) / normal[2];
          z[static_cast<std::size_t>(i + n_[0] * j)].push_back(std::clamp(f.a[2] - up, box.lo[2], box.hi[2]));
        }
    }
    for (auto& column : z) std::sort(column.begin(), column.end());
    return z;
  }

  double h_;
  Vec3 origin_{0, 0, 0};
  std::array<Index, 3> n_{};
  std::vector<Index> number_;               // of each point of the box, -1 outside
  std::vector<std::array<Index, 3>> cell_;  // of each point within
  std::vector<Vec3> place_;
  std::vector<double> distance_;  // to the wall
};

}  // namespace tunica::meshing::detail
