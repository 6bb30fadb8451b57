// SPDX-License-Identifier: MIT
// Where the surface of an image crosses an edge of its grid, with the normal there: linear along the edge,
// central differences at its ends. [JU02, 2]
#pragma once

#include "tunica/image/image.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace tunica::meshing::detail {

using GridNode = std::array<std::size_t, 3>;  // i, j, k in the image

/// The crossing of the edge from a node towards its next along an axis.
struct GridCrossing {
  double at;    // share of the edge from its lower node
  Vec3 normal;  // outward, of length 1
  Index region = 0;
};

/// Crossings keep this share of an edge from its nodes where they are those of the image.
inline constexpr double grid_margin = 1e-4;

template <class T>
class GridCrossings {
 public:
  GridCrossings(const image::Image<T>& image, double iso)
      : values_(image.values.data()),
        iso_(iso),
        stride_{1, image.axes[0].size(), image.axes[0].size() * image.axes[1].size()} {
    for (std::size_t a = 0; a < 3; ++a) {
      const auto& x = image.axes[a];
      for (std::size_t i = 0; i < x.size(); ++i) {
        const std::size_t below = i > 0 ? 1 : 0, above = i + 1 < x.size() ? 1 : 0;
        stencil_[a].push_back({below * stride_[a], above * stride_[a], 1 / (x[i + above] - x[i - below])});
      }
    }
  }

  [[nodiscard]] bool reaches(std::size_t offset) const { return value(offset) >= iso_; }
  [[nodiscard]] std::size_t offset(const GridNode& n) const {
    return n[0] + n[1] * stride_[1] + n[2] * stride_[2];
  }

  /// first_inside: the lower node is inside, the next is not; else the other way round.
  template <std::size_t Axis>
  [[nodiscard]] GridCrossing cross(const GridNode& node, bool first_inside) const {
    const std::size_t p = offset(node), q = p + stride_[Axis];
    const std::size_t in = first_inside ? p : q, out = first_inside ? q : p;
    const double f = value(in) - iso_, g = value(out) - iso_;
    double t = 0.5;  // half-way where the choice of voxels alone parts them
    if (g < 0 && f > g) t = f / (f - g);
    t = t > grid_margin ? t : grid_margin;  // NaN too
    t = t < 1 - grid_margin ? t : 1 - grid_margin;
    const double at = first_inside ? t : 1 - t;
    std::array<const Stencil*, 3> here{&stencil_[0][node[0]], &stencil_[1][node[1]], &stencil_[2][node[2]]};
    const Vec3 low = gradient(p, here);
    ++here[Axis];
    const Vec3 high = gradient(q, here);
    const double x = low[0] + at * (high[0] - low[0]), y = low[1] + at * (high[1] - low[1]),
                 z = low[2] + at * (high[2] - low[2]);
    const double squared = x * x + y * y + z * z;
    if (squared > least_squared && squared < most_squared) {
      const double share = -1 / std::sqrt(squared);
      return {at, {share * x, share * y, share * z}, 0};
    }
    return {at, along(Axis, first_inside), 0};
  }

  [[nodiscard]] static Vec3 along(std::size_t axis, bool up) {
    Vec3 n(0, 0, 0);
    n[static_cast<int>(axis)] = up ? 1 : -1;
    return n;
  }

 private:
  struct Stencil {
    std::size_t below, above;  // offsets of the neighbours along an axis
    double inverse;            // of their distance
  };

  [[nodiscard]] double value(std::size_t offset) const { return static_cast<double>(values_[offset]); }
  [[nodiscard]] Vec3 gradient(std::size_t v, const std::array<const Stencil*, 3>& s) const {
    return {(value(v + s[0]->above) - value(v - s[0]->below)) * s[0]->inverse,
            (value(v + s[1]->above) - value(v - s[1]->below)) * s[1]->inverse,
            (value(v + s[2]->above) - value(v - s[2]->below)) * s[2]->inverse};
  }

  static constexpr double least_squared = 1e-280, most_squared = 1e280;  // roots of them are exact
  const T* values_;
  double iso_;
  std::array<std::size_t, 3> stride_;
  std::array<std::vector<Stencil>, 3> stencil_;
};

}  // namespace tunica::meshing::detail
