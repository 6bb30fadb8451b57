// SPDX-License-Identifier: MIT
// Index, points and point lists: the types that every module shares.
#pragma once

#include <Eigen/Core>

#include <cmath>
#include <cstdint>
#include <limits>

namespace tunica {

using Index = std::int32_t;  // of nodes, cells and voxels along one axis

// Spacings and sizes from files lie between these, in any unit: products of five neither overflow nor vanish.
inline constexpr double least_length = 1e-30, most_length = 1e30;

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
  static constexpr double far = std::numeric_limits<double>::infinity();
  Vec3 lo{far, far, far}, hi{-far, -far, -far};

  void extend(const Vec3& x) {
    for (int a = 0; a < 3; ++a) lo[a] = x[a] < lo[a] ? x[a] : lo[a], hi[a] = x[a] > hi[a] ? x[a] : hi[a];
  }
  void extend(const Box& b) {
    for (int a = 0; a < 3; ++a)
      lo[a] = b.lo[a] < lo[a] ? b.lo[a] : lo[a], hi[a] = b.hi[a] > hi[a] ? b.hi[a] : hi[a];
  }
  [[nodiscard]] Vec3 centre() const {
    return {0.5 * (lo[0] + hi[0]), 0.5 * (lo[1] + hi[1]), 0.5 * (lo[2] + hi[2])};
  }
  [[nodiscard]] double diagonal() const {
    const double x = hi[0] - lo[0], y = hi[1] - lo[1], z = hi[2] - lo[2];
    return std::sqrt(x * x + y * y + z * z);
  }
  [[nodiscard]] bool overlaps(const Box& b) const {
    return lo[0] <= b.hi[0] && lo[1] <= b.hi[1] && lo[2] <= b.hi[2] &&  //
           b.lo[0] <= hi[0] && b.lo[1] <= hi[1] && b.lo[2] <= hi[2];
  }
  /// Squared distance from x to the box, 0 inside.
  [[nodiscard]] double squared_distance(const Vec3& x) const {
    const auto out = [&](int a) { return x[a] < lo[a] ? lo[a] - x[a] : x[a] > hi[a] ? x[a] - hi[a] : 0.0; };
    const double d = out(0), e = out(1), f = out(2);
    return d * d + e * e + f * f;
  }
};

}  // namespace tunica
