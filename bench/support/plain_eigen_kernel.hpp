// SPDX-License-Identifier: MIT
// What a user writes with Eigen: the tangent of a Hex8 as B^T D B plus the geometric part, an element at a
// time.
#pragma once

#include "tunica/fem/geometry.hpp"
#include "tunica/mesh/cell.hpp"

#include <Eigen/Core>
#include <Eigen/LU>

#include <cmath>
#include <cstddef>

namespace tunica::bench {

/// Compressible neo-Hooke, total Lagrangian: S = mu (1 - C^-1) + lambda ln J C^-1 and
/// D_IJKL = lambda C^-1_IJ C^-1_KL + (mu - lambda ln J)(C^-1_IK C^-1_JL + C^-1_IL C^-1_JK), B of the strain E
/// with doubled shears (xx yy zz xy yz xz). f and K are filled; unknown i of node a is number 3 a + i.
inline void plain_eigen_kernel(double mu, double lambda, const Eigen::Matrix<double, 3, 8>& X,
                               const Eigen::Matrix<double, 3, 8>& u, Eigen::Matrix<double, 24, 1>& f,
                               Eigen::Matrix<double, 24, 24>& K) {
  using Rule = fem::Gauss<mesh::Hex8, 3>;
  using Tables = fem::Tables<fem::Lagrange<mesh::Hex8>, Rule>;
  constexpr int voigt[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {0, 2}};
  f.setZero();
  K.setZero();
  for (std::size_t q = 0; q < Rule::size; ++q) {
    const auto map = fem::map_point<double, 3>(X, Tables::gradients[q]);
    const double w = map.det * Rule::weights[q];
    const Eigen::Matrix3d F = Eigen::Matrix3d::Identity() + u * map.gradient.transpose();
    const Eigen::Matrix3d inverse = (F.transpose() * F).inverse();
    const double ln_J = std::log(F.determinant());
    const Eigen::Matrix3d S = mu * (Eigen::Matrix3d::Identity() - inverse) + lambda * ln_J * inverse;
    Eigen::Matrix<double, 6, 6> D;
    for (int p = 0; p < 6; ++p)
      for (int r = 0; r < 6; ++r) {
        const int i = voigt[p][0], j = voigt[p][1], k = voigt[r][0], l = voigt[r][1];
        D(p, r) = lambda * inverse(i, j) * inverse(k, l) +
                  (mu - lambda * ln_J) * (inverse(i, k) * inverse(j, l) + inverse(i, l) * inverse(j, k));
      }
    Eigen::Matrix<double, 6, 24> B;
    for (int a = 0; a < 8; ++a) {
      const Eigen::Vector3d G = map.gradient.col(a);
      for (int p = 0; p < 6; ++p) {
        const int i = voigt[p][0], j = voigt[p][1];
        for (int c = 0; c < 3; ++c)
          B(p, 3 * a + c) = p < 3 ? F(c, i) * G[i] : F(c, i) * G[j] + F(c, j) * G[i];
      }
    }
    Eigen::Matrix<double, 6, 1> stress;
    for (int p = 0; p < 6; ++p) stress[p] = S(voigt[p][0], voigt[p][1]);
    f += w * B.transpose() * stress;
    K += w * B.transpose() * D * B;
    const Eigen::Matrix<double, 8, 8> geometric = w * map.gradient.transpose() * S * map.gradient;
    for (int a = 0; a < 8; ++a)
      for (int b = 0; b < 8; ++b)
        for (int i = 0; i < 3; ++i) K(3 * a + i, 3 * b + i) += geometric(a, b);
  }
}

}  // namespace tunica::bench
