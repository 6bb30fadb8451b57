// SPDX-License-Identifier: MIT
// An offset along given directions that gives a surface an exact volume: the cubic V(d) is solved, not only
// its linear part. [PEREZ08, 3.2.1]
#pragma once

#include "tunica/core/vec.hpp"
#include "tunica/mesh/measures.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace tunica::meshing {

/// Six times the volume of the parts of a surface as cubics of an offset d along fixed directions:
/// 6 V(d) = c0 + c1 d + c2 d^2 + c3 d^3, from det(a + d p, b + d q, c + d r) summed over the triangles.
struct VolumeCubic {
  std::array<double, 4> c{};

  [[nodiscard]] double at(double d) const { return c[0] + d * (c[1] + d * (c[2] + d * c[3])); }
  [[nodiscard]] double slope(double d) const { return c[1] + d * (2 * c[2] + d * 3 * c[3]); }

  /// The offset next to 0 at which 6 V is `target`; 0 when there is none within `reach`.
  [[nodiscard]] double offset(double target, double reach) const {
    double d = 0;
    constexpr int most_steps = 50;
    for (int n = 0; n < most_steps; ++n) {
      const double s = slope(d);
      if (!(std::abs(s) > 0)) return 0;
      const double step = (target - at(d)) / s;
      d += step;
      if (!(std::abs(d) <= reach)) return 0;
      if (std::abs(step) <= 1e-16 * reach) break;
    }
    return d;
  }
};

/// Part of each triangle -> one cubic a part. `origin` lies near the surface, so that the sums do not cancel.
[[nodiscard]] inline std::vector<VolumeCubic> volume_cubics(const Connectivity<3>& cells,
                                                            const Points<3>& nodes,
                                                            const Points<3>& directions,
                                                            const std::vector<Index>& part_of, Index parts,
                                                            const Vec3& origin) {
  std::vector<VolumeCubic> sum(static_cast<std::size_t>(parts)), carry(static_cast<std::size_t>(parts));
  for (Eigen::Index t = 0; t < cells.cols(); ++t) {
    std::array<Vec3, 3> x, d;
    for (std::size_t k = 0; k < 3; ++k) {
      const Index n = cells(static_cast<Eigen::Index>(k), t);
      x[k] = vec::minus(vec::column(nodes, n), origin), d[k] = vec::column(directions, n);
    }
    const auto& [a, b, c] = x;
    const auto& [p, q, r] = d;
    const Vec3 bc = vec::cross(b, c), qr = vec::cross(q, r),
               mixed = vec::plus(vec::cross(b, r), vec::cross(q, c));
    const std::array<double, 4> term{vec::dot(a, bc), vec::dot(p, bc) + vec::dot(a, mixed),
                                     vec::dot(p, mixed) + vec::dot(a, qr), vec::dot(p, qr)};
    const auto part = static_cast<std::size_t>(part_of[static_cast<std::size_t>(t)]);
    for (std::size_t k = 0; k < 4; ++k) {  // compensated sums
      const double y = term[k] - carry[part].c[k], next = sum[part].c[k] + y;
      carry[part].c[k] = (next - sum[part].c[k]) - y;
      sum[part].c[k] = next;
    }
  }
  return sum;
}

}  // namespace tunica::meshing
