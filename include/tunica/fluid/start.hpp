// SPDX-License-Identifier: MIT
// The pressure that goes with a velocity at the start of a run. [GUERMOND06]
#pragma once

#include "tunica/fluid/boundary_terms.hpp"
#include "tunica/fluid/momentum.hpp"

namespace tunica::fluid {

/// Right-hand side of (grad q, grad p) - <q, dp/dn> = (grad q, f - rho u.grad u) - rho int q du/dt . n - <q,
/// (f - rho u.grad u) . n>, the divergence of the momentum equation; <> over pressure patches. u, rate of the
/// prescribed velocities: 3 x nodes; force: [N/m3] or no columns.
[[nodiscard]] inline Eigen::VectorXd initial_source(const Domain& domain, double density, const Points<3>& u,
                                                    const Points<3>& rate, const Points<3>& force) {
  Eigen::VectorXd right = Eigen::VectorXd::Zero(u.cols());
  const auto load = [&](Index e) {
    const Nodal3 ue = nodal(u, domain.cells, e);
    Vec3 f = product(gradient(ue, domain.tets[e].grad), mean(ue));
    for (int c = 0; c < 3; ++c) f[c] *= -density;
    if (force.cols() > 0) {
      const Vec3 volume_force = mean(nodal(force, domain.cells, e));
      for (int c = 0; c < 3; ++c) f[c] += volume_force[c];
    }
    return f;
  };
  for (Index e = 0; e < domain.cells.cols(); ++e) {
    const fem::P1Tet& tet = domain.tets[e];
    const Vec3 f = load(e);
    for (int i = 0; i < 4; ++i) right[domain.cells(i, e)] += tet.volume * along(f, tet.grad, i);
  }
  for (const Condition& c : domain.conditions.list())
    for (Eigen::Index k = 0; k < c.faces.cols(); ++k) {
      const Vec3 n = Conditions::area_vector(domain.position, c.faces, k);
      Vec3 normal(0, 0, 0);
      if (c.kind == Kind::velocity)
        for (int i = 0; i < 3; ++i) normal[i] = density * dot(n, column(rate, c.faces(i, k)));
      if (c.kind == Kind::pressure) normal.setConstant(dot(n, load(c.cells[static_cast<std::size_t>(k)])));
      const Vec3 flux = face_load(1, normal);
      for (int i = 0; i < 3; ++i) right[c.faces(i, k)] -= flux[i];
    }
  return right;
}

}  // namespace tunica::fluid
