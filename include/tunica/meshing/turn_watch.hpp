// SPDX-License-Identifier: MIT
// Which triangles a sweep has turned by a right angle or more. A block of triangles is looked at only once
// its nodes may have gone far enough for it.
#pragma once

#include "tunica/mesh/mesh.hpp"
#include "tunica/meshing/lanes.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace tunica::meshing::detail {

/// Of a triangle of double area A and edges no longer than l the vector of area A changes by at most
/// 3 r l + 3 r^2 while none of its nodes goes further than r. With r = 0.26 A/l, and A <= sqrt(3)/2 l^2, that
/// is less than A itself: then no part of the way changes the vector by more than the rest leaves of it, and
/// its directions before and after make an acute angle. The way may have led here as well as lead on from
/// here.
inline constexpr double safe_share = 0.26;

class TurnWatch {
 public:
  TurnWatch(const Connectivity<3>& cells, const std::vector<std::uint32_t>& slot)
      : triangles_(static_cast<std::size_t>(cells.cols())),
        blocks_((triangles_ + block_size - 1) / block_size),
        corners_(3 * blocks_ * block_size),
        limit_(blocks_, -1.0) {
    for (std::size_t t = 0; t < blocks_ * block_size && triangles_ > 0; ++t) {
      const auto c = static_cast<Eigen::Index>(std::min(t, triangles_ - 1));  // the last one fills the block
      for (Eigen::Index k = 0; k < 3; ++k)
        corners_[corner(t, static_cast<std::size_t>(k))] =
            lane_stride * slot[static_cast<std::size_t>(cells(k, c))];
    }
  }

  /// Calls turned(t) for the triangles whose normals `before` and now make no acute angle. No node has moved
  /// further than `travel` in the last sweep.
  template <class Turned>
  void look(const Place* places, const Place* before, double travel, Turned&& turned) {
    travelled_ += travel;
    for (std::size_t b = 0; b < blocks_; ++b) {
      if (travelled_ <= limit_[b]) continue;
      const double free = reach(b, places);
      if (!(travel <= free)) compare(b, places, before, turned);
      limit_[b] = travelled_ + free;
    }
  }

  /// To be told when nodes have moved other than by a sweep.
  void forget() { std::fill(limit_.begin(), limit_.end(), -1.0); }

 private:
  using L = Lanes<widest>;
  using V = L::V;
  static constexpr std::size_t block_size = 32;

  /// Corners lie pack by pack.
  [[nodiscard]] static std::size_t corner(std::size_t t, std::size_t k) {
    return 3 * widest * (t / widest) + k * widest + t % widest;
  }

  /// How far the nodes of the block may go from here, or have come.
  [[nodiscard]] double reach(std::size_t block, const Place* places) const {
    constexpr double tiny = std::numeric_limits<double>::min();
    V least = L::all(std::numeric_limits<double>::infinity());
    for (std::size_t t = block * block_size; t < (block + 1) * block_size; t += widest) {
      const Places<widest> now = double_area(places, corners_.data() + corner(t, 0));
      const V square = now.x * now.x + now.y * now.y + now.z * now.z;
      least = L::smaller(least, square / L::larger(now.w, L::all(tiny)));
    }
    double all = std::numeric_limits<double>::infinity();
    for (int lane = 0; lane < widest; ++lane) all = std::min(all, L::at(least, lane));
    return safe_share * std::sqrt(all);
  }

  template <class Turned>
  void compare(std::size_t block, const Place* places, const Place* before, Turned& turned) const {
    for (std::size_t t = block * block_size; t < (block + 1) * block_size; t += widest) {
      const std::uint32_t* c = corners_.data() + corner(t, 0);
      const Places<widest> now = double_area(places, c), was = double_area(before, c);
      const V same = now.x * was.x + now.y * was.y + now.z * was.z;
      if (!L::any_not_above(same, 0)) continue;
      for (int lane = 0; lane < widest; ++lane) {
        const std::size_t u = t + static_cast<std::size_t>(lane);
        if (u < triangles_ && !(L::at(same, lane) > 0)) turned(static_cast<Index>(u));
      }
    }
  }

  /// Cross products of two edges and, as w, the square of the longest edge.
  [[nodiscard]] static Places<widest> double_area(const Place* places, const std::uint32_t* c) {
    const Places<widest> p = L::at(places, c), q = L::at(places, c + widest),
                         r = L::at(places, c + 2 * widest);
    const V ux = q.x - p.x, uy = q.y - p.y, uz = q.z - p.z, vx = r.x - p.x, vy = r.y - p.y, vz = r.z - p.z;
    const V wx = vx - ux, wy = vy - uy, wz = vz - uz;
    const V longest = L::larger(ux * ux + uy * uy + uz * uz,
                                L::larger(vx * vx + vy * vy + vz * vz, wx * wx + wy * wy + wz * wz));
    return {uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx, longest};
  }

  std::size_t triangles_, blocks_;
  std::vector<std::uint32_t> corners_;
  std::vector<double> limit_;  // the length of all ways at which a block is to be looked at again
  double travelled_ = 0;
};

}  // namespace tunica::meshing::detail
