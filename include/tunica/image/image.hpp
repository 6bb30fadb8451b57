// SPDX-License-Identifier: MIT
// Image<T>: samples on a rectilinear grid, with trilinear value and gradient. [PEREZ08, 3.2]
#pragma once

#include "tunica/core/expect.hpp"
#include "tunica/core/types.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace tunica::image {

/// Grid position of a voxel.
struct Voxel {
  Index i = 0, j = 0, k = 0;
  friend bool operator==(const Voxel&, const Voxel&) = default;
};

/// Samples at (x_i, y_j, z_k), x fastest; the spacing may be uneven along each axis.
template <class T>
struct Image {
  std::array<std::vector<double>, 3> axes;  // strictly increasing coordinates, unit of the source
  std::vector<T> values;                    // nx*ny*nz, x fastest

  [[nodiscard]] Index size(int axis) const {
    return static_cast<Index>(axes[static_cast<std::size_t>(axis)].size());
  }
  [[nodiscard]] std::size_t offset(Voxel v) const {
    return static_cast<std::size_t>(v.i) +
           axes[0].size() * (static_cast<std::size_t>(v.j) + axes[1].size() * static_cast<std::size_t>(v.k));
  }
  [[nodiscard]] T operator()(Voxel v) const { return values[offset(v)]; }
  [[nodiscard]] Vec3 position(Voxel v) const {
    return {axes[0][static_cast<std::size_t>(v.i)], axes[1][static_cast<std::size_t>(v.j)],
            axes[2][static_cast<std::size_t>(v.k)]};
  }
  [[nodiscard]] bool contains(Voxel v) const {
    return v.i >= 0 && v.j >= 0 && v.k >= 0 && v.i < size(0) && v.j < size(1) && v.k < size(2);
  }

  /// Trilinear interpolation; a point outside takes the value of the nearest point of the grid.
  [[nodiscard]] double value(const Vec3& x) const {
    const Local l = locate(x);
    double sum = 0;
    for (int c = 0; c < 8; ++c) sum += l.weight(c) * sample(l, c);
    return sum;
  }

  /// Gradient of the trilinear interpolant of the cell that holds x, per unit of length.
  [[nodiscard]] Vec3 gradient(const Vec3& x) const {
    const Local l = locate(x);
    Vec3 g{0, 0, 0};
    for (int c = 0; c < 8; ++c)
      for (int a = 0; a < 3; ++a) g[a] += l.derivative(c, a) * sample(l, c);
    return g;
  }

 private:
  /// The cell that holds a point, the local coordinates in it and its edge lengths.
  struct Local {
    Voxel cell;
    Vec3 t, h;

    [[nodiscard]] double factor(int corner, int a) const { return (corner >> a & 1) != 0 ? t[a] : 1 - t[a]; }
    [[nodiscard]] double weight(int corner) const {
      return factor(corner, 0) * factor(corner, 1) * factor(corner, 2);
    }
    [[nodiscard]] double derivative(int corner, int a) const {
      const double sign = (corner >> a & 1) != 0 ? 1 : -1;
      return sign / h[a] * factor(corner, (a + 1) % 3) * factor(corner, (a + 2) % 3);
    }
  };

  [[nodiscard]] Local locate(const Vec3& x) const {
    Local l;
    std::array<Index, 3> cell{};
    for (int a = 0; a < 3; ++a) {
      const auto& axis = axes[static_cast<std::size_t>(a)];
      TUNICA_EXPECT(axis.size() >= 2, "interpolation needs two samples along each axis");
      const auto above = std::upper_bound(axis.begin(), axis.end(), x[a]) - axis.begin();
      const auto i = std::clamp<std::ptrdiff_t>(above - 1, 0, static_cast<std::ptrdiff_t>(axis.size()) - 2);
      const double lo = axis[static_cast<std::size_t>(i)], hi = axis[static_cast<std::size_t>(i + 1)];
      cell[static_cast<std::size_t>(a)] = static_cast<Index>(i);
      l.h[a] = hi - lo;
      l.t[a] = std::clamp((x[a] - lo) / (hi - lo), 0.0, 1.0);
    }
    l.cell = {cell[0], cell[1], cell[2]};
    return l;
  }

  [[nodiscard]] double sample(const Local& l, int corner) const {
    return static_cast<double>(
        (*this)({l.cell.i + (corner & 1), l.cell.j + (corner >> 1 & 1), l.cell.k + (corner >> 2)}));
  }
};

}  // namespace tunica::image
