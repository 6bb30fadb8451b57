// SPDX-License-Identifier: MIT
// Where the quadratic error of a cell is least, from sums over its planes, in closed form wherever the
// surface is smooth: thousands of cells a millisecond. [JU02, 2.3], the same minimum as that of Qef
#pragma once

#include "tunica/core/vec.hpp"
#include "tunica/meshing/qef.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <limits>

namespace tunica::meshing::detail {

/// Sums over the crossings p with unit normals n of one vertex, relative to the low corner of its cell.
struct PlaneSums {
  double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;  // A = sum n n^T, symmetric positive semidefinite
  double bx = 0, by = 0, bz = 0;                          // b = sum (n . p) n
  double px = 0, py = 0, pz = 0;                          // sum p

  void add(const Vec3& p, const Vec3& n) {
    const double d = vec::dot(n, p);
    xx += n[0] * n[0], xy += n[0] * n[1], xz += n[0] * n[2];
    yy += n[1] * n[1], yz += n[1] * n[2], zz += n[2] * n[2];
    bx += d * n[0], by += d * n[1], bz += d * n[2];
    px += p[0], py += p[1], pz += p[2];
  }
  [[nodiscard]] double trace() const { return xx + yy + zz; }
  [[nodiscard]] int count() const { return static_cast<int>(std::lround(trace())); }  // normals have length 1
  [[nodiscard]] Vec3 mass_point() const {
    const double share = 1.0 / count();
    return {share * px, share * py, share * pz};
  }
  [[nodiscard]] Vec3 applied(const Vec3& x) const {
    return {xx * x[0] + xy * x[1] + xz * x[2], xy * x[0] + yy * x[1] + yz * x[2],
            xz * x[0] + yz * x[1] + zz * x[2]};
  }
  /// b - A x: half the steepest descent of the error.
  [[nodiscard]] Vec3 descent(const Vec3& x) const {
    const Vec3 y = applied(x);
    return {bx - y[0], by - y[1], bz - y[2]};
  }
  /// E[x] less what does not depend on x.
  [[nodiscard]] double error(const Vec3& x) const {
    const Vec3 y = applied(x);
    return x[0] * (y[0] - 2 * bx) + x[1] * (y[1] - 2 * by) + x[2] * (y[2] - 2 * bz);
  }
  [[nodiscard]] Eigen::Matrix3d matrix() const {
    Eigen::Matrix3d A;
    A << xx, xy, xz, xy, yy, yz, xz, yz, zz;
    return A;
  }
};

/// Eigenvalues and vectors (columns) of A by cyclic Jacobi to the rounding of its trace, which is enough for
/// a cut; twice as fast as SymmetricEigen, which keeps the relative accuracy of small ones.
struct PlaneEigen {
  std::array<double, 3> value;
  std::array<std::array<double, 3>, 3> vector{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};  // one after the other

  explicit PlaneEigen(const PlaneSums& s) : value{s.xx, s.yy, s.zz} {
    std::array<double, 3> off{s.yz, s.xz, s.xy};  // opposite to each axis
    const double rounding = 1e-17 * s.trace();
    constexpr int most_sweeps = 12;
    for (int sweep = 0; sweep < most_sweeps; ++sweep) {
      if (!(std::abs(off[0]) + std::abs(off[1]) + std::abs(off[2]) > rounding)) break;
      turn<0, 1>(off), turn<0, 2>(off), turn<1, 2>(off);
    }
  }

 private:
  template <std::size_t P, std::size_t Q>
  void turn(std::array<double, 3>& off) {
    constexpr std::size_t R = 3 - P - Q;
    const double apq = off[R];
    if (apq == 0) return;
    const double theta = (value[Q] - value[P]) / (2 * apq);
    const double t = std::copysign(1.0, theta) / (std::abs(theta) + std::sqrt(theta * theta + 1));
    const double c = 1 / std::sqrt(t * t + 1), s = t * c;
    value[P] -= t * apq, value[Q] += t * apq;
    const double arp = off[Q], arq = off[P];
    off[R] = 0, off[Q] = c * arp - s * arq, off[P] = s * arp + c * arq;
    for (std::size_t i = 0; i < 3; ++i) {
      const double vp = vector[P][i], vq = vector[Q][i];
      vector[P][i] = c * vp - s * vq, vector[Q][i] = s * vp + c * vq;
    }
  }
};

struct LeastErrorOptions {
  double cut = 0.04;  // eigenvalues below this share of the largest are cut: the square of QefOptions::cut
  double smooth = 1;  // share of the step from the mass point where the surface is smooth: rank 1
};

struct LeastStep {
  double x = 0, y = 0;
  int rank = 0;
};

/// The least norm step in two axes (matrix {{p, o}, {o, q}}, descent r, s) above the cut.
[[nodiscard]] inline LeastStep least_step(double p, double q, double o, double r, double s, double cut) {
  const double mean = 0.5 * (p + q), off = std::sqrt(0.25 * (p - q) * (p - q) + o * o);
  const double low = mean - off, high = mean + off;
  if (low > cut && low > 0) {
    const double share = 1 / (p * q - o * o);
    return {share * (q * r - o * s), share * (p * s - o * r), 2};
  }
  if (!(high > cut && high > 0)) return {};
  const double share = 1 / (2 * off * high);  // projector (M - low) / (high - low)
  return {share * ((p - low) * r + o * s), share * (o * r + (q - low) * s), 1};
}

/// The minimum where the surface is an edge, a corner, or leaves the box: that over the box, or on some of
/// its sides, edges or corners. Axes whose bounds are equal stay there.
[[nodiscard]] inline Vec3 least_error_held(const PlaneSums& sums, const Box& box,
                                           const LeastErrorOptions& options) {
  const PlaneEigen eigen(sums);
  const double cut = options.cut * std::max({0.0, eigen.value[0], eigen.value[1], eigen.value[2]});
  Vec3 centre = sums.mass_point();
  for (int a = 0; a < 3; ++a) centre[a] = std::min(std::max(centre[a], box.lo[a]), box.hi[a]);
  const auto inside = [&](const Vec3& x) {
    return x[0] >= box.lo[0] && x[0] <= box.hi[0] && x[1] >= box.lo[1] && x[1] <= box.hi[1] &&
           x[2] >= box.lo[2] && x[2] <= box.hi[2];
  };
  int rank = 0;
  for (const double value : eigen.value) rank += value > cut;
  const auto smoothed = [&](const Vec3& x) {
    return rank == 1 ? vec::between(centre, x, options.smooth) : x;
  };
  unsigned fixed = 0;
  for (unsigned a = 0; a < 3; ++a)
    if (!(box.lo[static_cast<int>(a)] < box.hi[static_cast<int>(a)])) fixed |= 1U << a;
  if (fixed == 0) {
    const Vec3 r = sums.descent(centre);
    Vec3 x = centre;
    for (std::size_t i = 0; i < 3; ++i) {
      const double value = eigen.value[i];
      if (!(value > cut)) continue;
      const Vec3 axis(eigen.vector[i][0], eigen.vector[i][1], eigen.vector[i][2]);
      x = vec::along(x, (rank == 1 ? options.smooth : 1) * vec::dot(axis, r) / value, axis);
    }
    if (inside(x)) return x;
  }
  const std::array<double, 3> diagonal{sums.xx, sums.yy, sums.zz};
  const std::array<double, 3> beside{sums.yz, sums.xz, sums.xy};  // of the axes other than that
  Vec3 best = centre;
  double least = std::numeric_limits<double>::infinity();
  const auto keep = [&](const Vec3& x) {
    if (const double error = sums.error(x); error < least) least = error, best = x;
  };
  const auto in = [&](const Vec3& x, int a) { return x[a] >= box.lo[a] && x[a] <= box.hi[a]; };
  for (unsigned held = 1; held < 8; ++held) {  // a bit an axis at a bound
    if ((held & fixed) != fixed) continue;
    for (unsigned side = held;; side = (side - 1) & held) {  // at the upper one
      if ((side & fixed) == 0) {
        Vec3 x = centre;
        for (int a = 0; a < 3; ++a)
          if ((held >> a & 1U) != 0) x[a] = (side >> a & 1U) != 0 ? box.hi[a] : box.lo[a];
        const int a = std::countr_zero(held), free = std::countr_zero(7 ^ held);
        if (held == 7) {
          keep(x);
        } else if (std::popcount(held) == 2) {
          const double d = diagonal[static_cast<std::size_t>(free)];
          if (d > cut && d > 0) x[free] += sums.descent(x)[free] / d;
          if (in(x, free)) keep(x);
        } else {
          const int b = (a + 1) % 3, c = (a + 2) % 3;
          const Vec3 r = sums.descent(x);
          const LeastStep step =
              least_step(diagonal[static_cast<std::size_t>(b)], diagonal[static_cast<std::size_t>(c)],
                         beside[static_cast<std::size_t>(a)], r[b], r[c], cut);
          x[b] += step.x, x[c] += step.y;
          if (in(x, b) && in(x, c)) keep(x);
        }
      }
      if (side == 0) break;
    }
  }
  return smoothed(best);
}

/// The minimum within the box, relative to the low corner of the cell. Where one eigenvalue rules (the
/// surface is smooth there) it is found by Newton's method from the trace, which lies above it, and its
/// projector is the adjugate of A - lambda over the trace of that: no eigenvector is needed.
[[nodiscard]] inline Vec3 least_error(const PlaneSums& s, const Box& box, const LeastErrorOptions& options) {
  static constexpr std::array<double, 13> share{0,        1.0,      1.0 / 2, 1.0 / 3, 1.0 / 4,
                                                1.0 / 5,  1.0 / 6,  1.0 / 7, 1.0 / 8, 1.0 / 9,
                                                1.0 / 10, 1.0 / 11, 1.0 / 12};
  const double e1 = s.trace();
  const double e2 = s.xx * s.yy - s.xy * s.xy + s.xx * s.zz - s.xz * s.xz + s.yy * s.zz - s.yz * s.yz;
  const double e3 = s.xx * (s.yy * s.zz - s.yz * s.yz) - s.xy * (s.xy * s.zz - s.yz * s.xz) +
                    s.xz * (s.xy * s.yz - s.yy * s.xz);
  // lambda^3 - e1 lambda^2 + e2 lambda - e3 = 0
  double lambda = e1, step = e1;
  constexpr double done = 1e-10;  // the next step would be its square
  for (int n = 0; n < 6 && step > done * e1; ++n) {
    step = (((lambda - e1) * lambda + e2) * lambda - e3) / ((3 * lambda - 2 * e1) * lambda + e2);
    lambda -= step;
  }
  if (!(step <= done * e1 && e1 - lambda <= options.cut * lambda)) return least_error_held(s, box, options);
  const double w = share[static_cast<std::size_t>(std::min(s.count(), 12))];
  const Vec3 centre(std::min(std::max(w * s.px, box.lo[0]), box.hi[0]),
                    std::min(std::max(w * s.py, box.lo[1]), box.hi[1]),
                    std::min(std::max(w * s.pz, box.lo[2]), box.hi[2]));
  const Vec3 r = s.descent(centre);
  const double x = s.xx - lambda, y = s.yy - lambda, z = s.zz - lambda;
  const double xx = y * z - s.yz * s.yz, yy = x * z - s.xz * s.xz, zz = x * y - s.xy * s.xy,
               xy = s.xz * s.yz - s.xy * z, xz = s.xy * s.yz - y * s.xz, yz = s.xy * s.xz - x * s.yz;
  const double t = options.smooth / ((xx + yy + zz) * lambda);
  const Vec3 best(centre[0] + t * (xx * r[0] + xy * r[1] + xz * r[2]),
                  centre[1] + t * (xy * r[0] + yy * r[1] + yz * r[2]),
                  centre[2] + t * (xz * r[0] + yz * r[1] + zz * r[2]));
  if (best[0] >= box.lo[0] && best[0] <= box.hi[0] && best[1] >= box.lo[1] && best[1] <= box.hi[1] &&
      best[2] >= box.lo[2] && best[2] <= box.hi[2])
    return best;
  return least_error_held(s, box, options);
}

}  // namespace tunica::meshing::detail
