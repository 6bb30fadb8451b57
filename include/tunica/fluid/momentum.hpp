// SPDX-License-Identifier: MIT
// The momentum predictor on linear tetrahedra: one scalar matrix for the three components. [PEREZ08, (1)]
#pragma once

#include "tunica/fluid/domain.hpp"
#include "tunica/fluid/rheology.hpp"
#include "tunica/fluid/stabilization.hpp"
#include "tunica/la/vector_ops.hpp"

#include <cmath>

namespace tunica::fluid {

/// What the predictor is linearised about and driven by; all 3 x nodes but p.
struct MomentumFields {
  const Points<3>& a;         // advecting velocity u - w [m/s]
  const Points<3>& u;         // for the shear rate only [m/s]
  const Points<3>& history;   // last u^n + before u^{n-1} [m/s2]
  const Eigen::VectorXd& p;   // [Pa]
  const Points<3>& force;     // of the volume [N/m3]; no columns: none
  const Points<3>& smoothed;  // projected (a . grad) u [m/s2]
  double rate;                // weight of u^{n+1} in its time derivative [1/s]
};

/// Viscosity and momentum stabilisation of one element.
struct ElementFlow {
  Vec3 a;                // mean advecting velocity [m/s]
  double viscosity;      // [Pa s]
  double stabilisation;  // t_m rho^2 [kg s/m3]
};

template <Rheology R, Stabilization S>
[[nodiscard]] ElementFlow element_flow(const R& fluid, const S& stabilization, const fem::P1Tet& tet,
                                       const Nodal3& a, const Nodal3& u) {
  ElementFlow flow;
  flow.a = mean(a);
  double shear = 0;
  if constexpr (!constant_viscosity<R>) {
    const Matrix3 g = gradient(u, tet.grad);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) shear += (g(i, j) + g(j, i)) * (g(i, j) + g(j, i));
    shear = std::sqrt(shear / 2);  // sqrt(2 eps:eps)
  }
  flow.viscosity = fluid.viscosity_at(shear);
  const double speed = length(flow.a);
  double ahead = 0;
  for (int i = 0; i < 4; ++i) ahead += std::abs(along(flow.a, tet.grad, i));
  const double h = tet.size(), h_a = ahead > 0 ? 2 * speed / ahead : h;  // along the velocity
  flow.stabilisation =
      fluid.density * fluid.density * stabilization.momentum(fluid.density, flow.viscosity, h, h_a, speed);
  return flow;
}

/// M_L^{-1} int N (a . grad) u: 3 x nodes [m/s2]; inverse_mass = 1 / M_L [1/m3].
inline void smooth_convection(const Domain& domain, const Points<3>& a, const Points<3>& u, Points<3>& out) {
  out.setZero(3, u.cols());
  domain.pattern.for_each_cell([&](Index e) {
    const fem::P1Tet& tet = domain.tets[e];
    const Nodal3 ae = nodal(a, domain.cells, e);
    const Matrix3 grad_u = gradient(nodal(u, domain.cells, e), tet.grad);
    const Vec3 all = sum(ae);
    for (int i = 0; i < 4; ++i)
      add(out, domain.cells(i, e), tet.volume / 20,
          product(grad_u, {all[0] + ae(0, i), all[1] + ae(1, i), all[2] + ae(2, i)}));
  });
  scale_columns(out, domain.inverse_mass);
}

/// (rho c0/dt M + C + mu K + S) u* = -rho M history + G p + f + R conv, without boundary terms.
/// matrix: nodes x nodes, not symmetric; right: 3 x nodes [N].
template <Rheology R, Stabilization S>
void assemble_momentum(const Domain& domain, const R& fluid, const S& stabilization,
                       const MomentumFields& fields, la::RowMatrix& matrix, Points<3>& right) {
  const Connectivity<4>& cells = domain.cells;
  domain.pattern.clear(matrix);
  right.setZero(3, fields.a.cols());
  const bool forced = fields.force.cols() > 0;
  domain.pattern.for_each_cell([&](Index e) {
    const fem::P1Tet& tet = domain.tets[e];
    const double V = tet.volume, rho = fluid.density;
    const Nodal3 a = nodal(fields.a, cells, e);
    const ElementFlow flow = element_flow(fluid, stabilization, tet, a, nodal(fields.u, cells, e));
    double advection[4][4], mean_advection[4];  // a_k . grad N_j, with their mean over k
    for (int j = 0; j < 4; ++j) {
      for (int k = 0; k < 4; ++k)
        advection[j][k] = a(0, k) * tet.grad(0, j) + a(1, k) * tet.grad(1, j) + a(2, k) * tet.grad(2, j);
      mean_advection[j] = (advection[j][0] + advection[j][1] + advection[j][2] + advection[j][3]) / 4;
    }
    const double mass = rho * fields.rate * V / 20, convection = rho * V / 20;
    const double diffusion = flow.viscosity * V, wiggle = flow.stabilisation * V;
    Eigen::Matrix4d Ke;
    for (int j = 0; j < 4; ++j)
      for (int i = 0; i < 4; ++i)
        Ke(i, j) = diffusion * (tet.grad(0, i) * tet.grad(0, j) + tet.grad(1, i) * tet.grad(1, j) +
                                tet.grad(2, i) * tet.grad(2, j)) +   // mu (grad N_i, grad N_j)
                   wiggle * mean_advection[i] * mean_advection[j] +  // t_m rho^2 (a.grad N_i, a.grad N_j)
                   convection * (4 * mean_advection[j] + advection[j][i]) +  // rho (N_i, a.grad N_j)
                   (i == j ? 2 * mass : mass);
    domain.pattern.add(e, Ke, matrix);

    Nodal3 source = nodal(fields.history, cells, e);
    for (int k = 0; k < 12; ++k) source.data()[k] *= -rho;
    if (forced) {
      const Nodal3 force = nodal(fields.force, cells, e);
      for (int k = 0; k < 12; ++k) source.data()[k] += force.data()[k];
    }
    const Vec3 total = sum(source), smooth = mean(nodal(fields.smoothed, cells, e));
    const double pressure = V * mean(nodal(fields.p, cells, e));
    for (int i = 0; i < 4; ++i)
      for (int c = 0; c < 3; ++c)
        right(c, cells(i, e)) += V / 20 * (total[c] + source(c, i)) + pressure * tet.grad(c, i) +
                                 wiggle * mean_advection[i] * smooth[c];
  });
}

}  // namespace tunica::fluid
