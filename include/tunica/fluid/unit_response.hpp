// SPDX-License-Identifier: MIT
// What of a unit gradient and of a unit load arrives at the velocity: by these two the weak form of the
// pressure stands for D M^-1 D^T.
#pragma once

#include "tunica/core/types.hpp"

#include <Eigen/Core>

#include <algorithm>

namespace tunica::fluid {

/// P: the L2 projection on the free velocities, with the consistent mass.
struct UnitResponse {
  Eigen::VectorXd gradient;  // P 1: 0 at prescribed velocities, near 1 far from them: nodes [-]
  Points<3> load;            // P <N n> over the pressure patches: 3 x nodes [1/m]
  double least = 0.8;  // sigma of a face over the one that is enough for its tetrahedron, see WeakFace [-]

  /// Of the Laplacian itself, where every gradient counts whole.
  [[nodiscard]] static UnitResponse whole(Eigen::Index nodes) {
    return {Eigen::VectorXd::Ones(nodes), Points<3>::Zero(3, nodes), 1.2};
  }

  /// The part of a gradient in a tetrahedron (4 nodes) that arrives. Between prescribed velocities alone
  /// nothing does; the tenth keeps the pressure of its nodes determined without stabilisation.
  [[nodiscard]] double arriving(const Index* node) const {
    return std::max((gradient[node[0]] + gradient[node[1]] + gradient[node[2]] + gradient[node[3]]) / 4, 0.1);
  }
};

}  // namespace tunica::fluid
