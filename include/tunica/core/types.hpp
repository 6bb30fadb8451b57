// SPDX-License-Identifier: MIT
// Index, points and point lists: the types that every module shares.
#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <limits>

namespace tunica {

using Index = std::int32_t;  // of nodes, cells and voxels along one axis

template <int Dim>
using Point = Eigen::Matrix<double, Dim, 1>;
using Vec3 = Point<3>;

/// One column a point: Dim x n.
template <int Dim>
using Points = Eigen::Matrix<double, Dim, Eigen::Dynamic>;

/// One column a cell (or face): Nodes x n.
template <int Nodes>
using Connectivity = Eigen::Matrix<Index, Nodes, Eigen::Dynamic>;

/// An axis-aligned box; empty until it is extended.
struct Box {
  Vec3 lo = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 hi = Vec3::Constant(-std::numeric_limits<double>::infinity());

  void extend(const Vec3& x) { lo = lo.cwiseMin(x), hi = hi.cwiseMax(x); }
  void extend(const Box& b) { lo = lo.cwiseMin(b.lo), hi = hi.cwiseMax(b.hi); }
  [[nodiscard]] Vec3 centre() const { return 0.5 * (lo + hi); }
  [[nodiscard]] double diagonal() const { return (hi - lo).norm(); }
  [[nodiscard]] bool overlaps(const Box& b) const {
    return (lo.array() <= b.hi.array()).all() && (b.lo.array() <= hi.array()).all();
  }
  /// Squared distance from x to the box, 0 inside.
  [[nodiscard]] double squared_distance(const Vec3& x) const {
    return (lo - x).cwiseMax(x - hi).cwiseMax(0.0).squaredNorm();
  }
};

}  // namespace tunica
