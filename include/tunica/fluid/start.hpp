// SPDX-License-Identifier: MIT
// The pressure that goes with a velocity at the start of a run. [GUERMOND06]
#pragma once

#include "tunica/fluid/boundary_terms.hpp"
#include "tunica/fluid/momentum.hpp"

namespace tunica::fluid {

/// Right-hand side of (grad q, grad p) = (grad q, f - rho u.grad u) - rho int q du/dt . n, the divergence
/// of the momentum equation. u, rate of the prescribed velocities: 3 x nodes; force: [N/m3] or no columns.
[[nodiscard]] inline Eigen::VectorXd initial_source(const Domain& domain, double density, const Points<3>& u,
                                                    const Points<3>& rate, const Points<3>& force) {
  Eigen::VectorXd right = Eigen::VectorXd::Zero(u.cols());
  for (Index e = 0; e < domain.cells.cols(); ++e) {
    const fem::P1Tet& tet = domain.tets[e];
    const Eigen::Matrix<double, 3, 4> ue = nodal<3>(u, domain.cells, e);
    Vec3 f = -density * (ue * tet.grad.transpose()) * ue.rowwise().mean();
    if (force.cols() > 0) f += nodal<3>(force, domain.cells, e).rowwise().mean();
    for (int i = 0; i < 4; ++i) right[domain.cells(i, e)] += tet.volume * tet.grad.col(i).dot(f);
  }
  for (const Condition& c : domain.conditions.list()) {
    if (c.kind != Kind::velocity) continue;
    for (Eigen::Index k = 0; k < c.faces.cols(); ++k) {
      const Vec3 n = Conditions::area_vector(domain.position, c.faces, k);
      const Vec3 normal(n.dot(rate.col(c.faces(0, k))), n.dot(rate.col(c.faces(1, k))),
                        n.dot(rate.col(c.faces(2, k))));
      const Vec3 load = density * face_load(1, normal);
      for (int i = 0; i < 3; ++i) right[c.faces(i, k)] -= load[i];
    }
  }
  return right;
}

}  // namespace tunica::fluid
