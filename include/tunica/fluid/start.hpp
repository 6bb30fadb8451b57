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
    const Nodal3 ue = nodal(u, domain.cells, e);
    Vec3 f = product(gradient(ue, tet.grad), mean(ue));
    for (int c = 0; c < 3; ++c) f[c] *= -density;
    if (force.cols() > 0) {
      const Vec3 volume_force = mean(nodal(force, domain.cells, e));
      for (int c = 0; c < 3; ++c) f[c] += volume_force[c];
    }
    for (int i = 0; i < 4; ++i) right[domain.cells(i, e)] += tet.volume * along(f, tet.grad, i);
  }
  for (const Condition& c : domain.conditions.list()) {
    if (c.kind != Kind::velocity) continue;
    for (Eigen::Index k = 0; k < c.faces.cols(); ++k) {
      const Vec3 n = Conditions::area_vector(domain.position, c.faces, k);
      Vec3 normal;
      for (int i = 0; i < 3; ++i) normal[i] = dot(n, column(rate, c.faces(i, k)));
      const Vec3 load = face_load(density, normal);
      for (int i = 0; i < 3; ++i) right[c.faces(i, k)] -= load[i];
    }
  }
  return right;
}

}  // namespace tunica::fluid
