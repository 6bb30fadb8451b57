// SPDX-License-Identifier: MIT
// The six rigid body modes of points: the near-null space of an elastic solid's matrix.
#pragma once

#include "tunica/core/types.hpp"

#include <Eigen/Core>

namespace tunica::la {

/// 3 n x 6 for points x (3 x n): three translations, then rotations about the axes through the centre,
/// scaled by the size of the whole so that all columns are of one size.
[[nodiscard]] inline Eigen::MatrixXd rigid_body_modes(const Points<3>& x) {
  Eigen::MatrixXd modes = Eigen::MatrixXd::Zero(3 * x.cols(), 6);
  if (x.cols() == 0) return modes;
  Vec3 centre = Vec3::Zero();
  for (Eigen::Index n = 0; n < x.cols(); ++n) centre += x.col(n);
  centre /= static_cast<double>(x.cols());
  double size = 0;
  for (Eigen::Index n = 0; n < x.cols(); ++n) size += (x.col(n) - centre).squaredNorm();
  size = size > 0 ? std::sqrt(size / static_cast<double>(x.cols())) : 1.0;
  for (Eigen::Index n = 0; n < x.cols(); ++n)
    for (Eigen::Index a = 0; a < 3; ++a) {
      const Eigen::Index b = (a + 1) % 3, c = (a + 2) % 3;
      modes(3 * n + a, a) = 1;
      modes(3 * n + b, 3 + a) = -(x(c, n) - centre[c]) / size;  // e_a x (x - centre)
      modes(3 * n + c, 3 + a) = (x(b, n) - centre[b]) / size;
    }
  return modes;
}

}  // namespace tunica::la
