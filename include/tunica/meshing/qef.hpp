// SPDX-License-Identifier: MIT
// Quadratic error function of points and normals, minimised with a rank cut about the mass point.
// [JU02, 2.3]: E[x] = sum (n_i . (x - p_i))^2
#pragma once

#include "tunica/core/types.hpp"
#include "tunica/core/vec.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace tunica::meshing {

namespace detail {

/// Eigenvalues and the matrix of eigenvectors (columns) of a symmetric 3x3, by cyclic Jacobi:
/// small eigenvalues keep their relative accuracy, and the sweep order makes the bits reproducible.
struct SymmetricEigen {
  Vec3 values;
  Eigen::Matrix3d vectors = Eigen::Matrix3d::Identity();

  explicit SymmetricEigen(Eigen::Matrix3d A) {
    static constexpr std::array<std::array<int, 2>, 3> pairs{{{0, 1}, {0, 2}, {1, 2}}};
    for (int sweep = 0; sweep < 30; ++sweep) {
      const double off = std::abs(A(0, 1)) + std::abs(A(0, 2)) + std::abs(A(1, 2));
      if (!(off > std::numeric_limits<double>::min())) break;
      for (const auto& [p, q] : pairs) {
        if (A(p, q) == 0) continue;
        const double theta = (A(q, q) - A(p, p)) / (2 * A(p, q));
        const double t = std::copysign(1.0, theta) / (std::abs(theta) + std::hypot(theta, 1.0));
        const double c = 1 / std::hypot(t, 1.0), s = t * c, apq = A(p, q);
        A(p, p) -= t * apq, A(q, q) += t * apq;
        A(p, q) = A(q, p) = 0;
        const int r = 3 - p - q;
        const double arp = A(r, p), arq = A(r, q);
        A(r, p) = A(p, r) = c * arp - s * arq;
        A(r, q) = A(q, r) = s * arp + c * arq;
        for (int i = 0; i < 3; ++i) {
          const double vp = vectors(i, p), vq = vectors(i, q);
          vectors(i, p) = c * vp - s * vq, vectors(i, q) = s * vp + c * vq;
        }
      }
    }
    values = Vec3(A(0, 0), A(1, 1), A(2, 2));
  }
};

}  // namespace detail

/// Where the error is least; rank 1 on a plane, 2 on an edge, 3 at a corner.
struct QefMinimum {
  Vec3 position;
  int rank = 0;
  double error = 0;  // E [length^2]
};

/// Singular values of the normals below this share of the largest are cut [JU02, 2.3]: a surface that turns
/// by less than about 0.2 rad to either side in a cell is a plane there. Measured with vertices that may
/// leave their cells, spacing h: a turned cube and a plate of 1.5 h are exact for every cut from 0.03 to 0.4;
/// the rim of a cylinder of radius 4 h is met within 0.008 h at 0.05 and 0.017 h at 0.2; a sphere of radius 5
/// h with waves of 0.05 h in its level is missed by 0.79 h at 0.03, 0.45 h at 0.05, 0.23 h at 0.1 and 0.20 h
/// from 0.2 on.
struct QefOptions {
  double cut = 0.2;
};

/// Collects planes; the normals are unit vectors.
class Qef {
 public:
  void add(const Vec3& point, const Vec3& normal) {
    if (count_ == 0) origin_ = point;
    const Vec3 p = vec::minus(point, origin_);
    const double d = vec::dot(normal, p);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) A_(i, j) += normal[i] * normal[j];
    b_ = vec::along(b_, d, normal);
    c_ += d * d;
    sum_ = vec::along(sum_, 1, p);
    ++count_;
  }

  [[nodiscard]] int count() const { return count_; }
  [[nodiscard]] Vec3 mass_point() const { return vec::along(origin_, 1.0 / std::max(count_, 1), sum_); }

  [[nodiscard]] double error(const Vec3& x) const {
    const Vec3 y = vec::minus(x, origin_);
    return std::max(0.0, vec::dot(y, applied(y)) - 2 * vec::dot(y, b_) + c_);
  }

  /// The minimum that is nearest to the mass point (or to another centre).
  [[nodiscard]] QefMinimum minimum(const QefOptions& options = {}) const {
    return minimum(mass_point(), options);
  }
  [[nodiscard]] QefMinimum minimum(const Vec3& centre, const QefOptions& options = {}) const {
    return about(centre, {0, 0, 0}, options.cut * largest());
  }

  /// The minimum within a box: where the free one lies outside, the best of those on the sides,
  /// edges and corners of the box.
  [[nodiscard]] QefMinimum minimum_in(const Box& box, const QefOptions& options = {}) const {
    const double cut = options.cut * largest();
    Vec3 centre = mass_point();
    for (int a = 0; a < 3; ++a) centre[a] = std::min(std::max(centre[a], box.lo[a]), box.hi[a]);
    const auto inside = [&](const Vec3& x) {
      for (int a = 0; a < 3; ++a)
        if (!(x[a] >= box.lo[a] && x[a] <= box.hi[a])) return false;
      return true;
    };
    QefMinimum best = about(centre, {0, 0, 0}, cut);
    if (inside(best.position)) return best;
    best.error = std::numeric_limits<double>::infinity();
    for (int code = 1; code < 27; ++code) {  // base 3: an axis is free, at lo or at hi
      const std::array<int, 3> held{code % 3, code / 3 % 3, code / 9};
      Vec3 start = centre;
      for (int a = 0; a < 3; ++a) {
        const int side = held[static_cast<std::size_t>(a)];
        if (side != 0) start[a] = side == 1 ? box.lo[a] : box.hi[a];
      }
      const QefMinimum trial = about(start, held, cut);
      if (inside(trial.position) && trial.error < best.error) best = trial;
    }
    return best;
  }

 private:
  [[nodiscard]] Vec3 applied(const Vec3& y) const {
    Vec3 z(0, 0, 0);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) z[i] += A_(i, j) * y[j];
    return z;
  }

  [[nodiscard]] double largest() const {
    const Vec3 values = detail::SymmetricEigen(A_).values;
    return std::sqrt(std::max({0.0, values[0], values[1], values[2]}));
  }

  /// Least norm step from the centre that minimises E with the held axes fixed.
  [[nodiscard]] QefMinimum about(const Vec3& centre, const std::array<int, 3>& held, double cut) const {
    Vec3 r = vec::minus(b_, applied(vec::minus(centre, origin_)));
    Eigen::Matrix3d A = A_;
    for (int a = 0; a < 3; ++a)
      if (held[static_cast<std::size_t>(a)] != 0) {
        for (int i = 0; i < 3; ++i) A(a, i) = A(i, a) = 0;
        r[a] = 0;
      }
    const detail::SymmetricEigen eigen(A);
    QefMinimum best{centre, 0, 0};
    for (int i = 0; i < 3; ++i) {
      const double value = eigen.values[i];  // a singular value squared
      if (!(value > cut * cut) || !(value > 0)) continue;
      const Vec3 axis(eigen.vectors(0, i), eigen.vectors(1, i), eigen.vectors(2, i));
      best.position = vec::along(best.position, vec::dot(axis, r) / value, axis);
      ++best.rank;
    }
    for (int a = 0; a < 3; ++a)
      if (held[static_cast<std::size_t>(a)] != 0) best.position[a] = centre[a];
    best.error = error(best.position);
    return best;
  }

  Eigen::Matrix3d A_ = Eigen::Matrix3d::Zero();  // sum n n^T, symmetric positive semidefinite
  Vec3 b_ = Vec3::Zero(), sum_ = Vec3::Zero(), origin_ = Vec3::Zero();
  double c_ = 0;
  int count_ = 0;
};

}  // namespace tunica::meshing
