// SPDX-License-Identifier: MIT
// Linear tetrahedra in closed form: gradients of the shape functions and volumes, refilled when nodes move.
#pragma once

#include "tunica/core/parallel.hpp"
#include "tunica/core/types.hpp"

#include <Eigen/Core>

#include <cmath>
#include <cstddef>
#include <vector>

namespace tunica::fem {

/// Gradients of N_0..N_3 as columns [1/m] and the signed volume [m3]: grad N_a = c_a / (6 V) with c_a
/// the (inward) area vectors, twice their size.
struct P1Tet {
  Eigen::Matrix<double, 3, 4> grad;
  double volume;

  /// Edge of the regular tetrahedron of the same volume: (6 sqrt(2) V)^(1/3) [m].
  [[nodiscard]] double size() const { return std::cbrt(8.48528137423857 * volume); }
};

/// x: 3 x nodes; the four columns of cell e of `cells`.
[[nodiscard]] inline P1Tet p1_tet(const Points<3>& x, const Connectivity<4>& cells, Index e) {
  const auto node = [&](int a) { return x.data() + 3 * std::ptrdiff_t{cells(a, e)}; };
  const double *x0 = node(0), *x1 = node(1), *x2 = node(2), *x3 = node(3);
  const double p[3] = {x1[0] - x0[0], x1[1] - x0[1], x1[2] - x0[2]};
  const double q[3] = {x2[0] - x0[0], x2[1] - x0[1], x2[2] - x0[2]};
  const double r[3] = {x3[0] - x0[0], x3[1] - x0[1], x3[2] - x0[2]};
  const double pq[3] = {p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]};
  const double qr[3] = {q[1] * r[2] - q[2] * r[1], q[2] * r[0] - q[0] * r[2], q[0] * r[1] - q[1] * r[0]};
  const double rp[3] = {r[1] * p[2] - r[2] * p[1], r[2] * p[0] - r[0] * p[2], r[0] * p[1] - r[1] * p[0]};
  const double six_volume = p[0] * qr[0] + p[1] * qr[1] + p[2] * qr[2], scale = 1 / six_volume;
  P1Tet tet;
  for (int c = 0; c < 3; ++c) {
    tet.grad(c, 1) = qr[c] * scale, tet.grad(c, 2) = rp[c] * scale, tet.grad(c, 3) = pq[c] * scale;
    tet.grad(c, 0) = -(tet.grad(c, 1) + tet.grad(c, 2) + tet.grad(c, 3));
  }
  tet.volume = six_volume / 6;
  return tet;
}

/// The geometry of all cells for one position of the nodes.
class P1Tets {
 public:
  /// Computes all cells; false when one is inverted, flat or not finite: see inverted().
  bool update(const Points<3>& x, const Connectivity<4>& cells) {
    tets_.resize(static_cast<std::size_t>(cells.cols()));
    const double bad = parallel_sum(cells.cols(), 4096, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      double count = 0;
      for (std::ptrdiff_t e = begin; e < end; ++e) {
        P1Tet& tet = tets_[static_cast<std::size_t>(e)] = p1_tet(x, cells, static_cast<Index>(e));
        if (!(tet.volume > 0)) ++count;
      }
      return count;
    });
    inverted_ = -1;
    if (bad > 0)
      for (std::size_t e = 0; e < tets_.size() && inverted_ < 0; ++e)
        if (!(tets_[e].volume > 0)) inverted_ = static_cast<Index>(e);
    return inverted_ < 0;
  }

  [[nodiscard]] const P1Tet& operator[](Index e) const { return tets_[static_cast<std::size_t>(e)]; }
  /// The first cell whose volume is not positive, or -1.
  [[nodiscard]] Index inverted() const { return inverted_; }

 private:
  std::vector<P1Tet> tets_;
  Index inverted_ = -1;
};

}  // namespace tunica::fem
