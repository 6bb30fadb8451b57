// SPDX-License-Identifier: MIT
// Linear tetrahedra in closed form: gradients of the shape functions and volumes, refilled when nodes move.
#pragma once

#include "tunica/core/parallel.hpp"
#include "tunica/core/types.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cmath>
#include <limits>
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
  const Vec3 x0 = x.col(cells(0, e));
  const Vec3 e1 = x.col(cells(1, e)) - x0, e2 = x.col(cells(2, e)) - x0, e3 = x.col(cells(3, e)) - x0;
  P1Tet tet;
  tet.grad.col(1) = e2.cross(e3);
  tet.grad.col(2) = e3.cross(e1);
  tet.grad.col(3) = e1.cross(e2);
  const double six_volume = e1.dot(tet.grad.col(1));
  tet.grad.rightCols<3>() /= six_volume;
  tet.grad.col(0) = -(tet.grad.col(1) + tet.grad.col(2) + tet.grad.col(3));
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
