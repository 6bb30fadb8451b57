// SPDX-License-Identifier: MIT
// The momentum predictor on linear tetrahedra: one scalar matrix for the three components. [PEREZ08, (1)]
#pragma once

#include "tunica/fluid/domain.hpp"
#include "tunica/fluid/rheology.hpp"
#include "tunica/fluid/stabilization.hpp"
#include "tunica/la/vector_ops.hpp"

#include <algorithm>
#include <cmath>

namespace tunica::fluid {

/// The nodal fields of a cell as columns.
template <int Rows, class Field>
[[nodiscard]] Eigen::Matrix<double, Rows, 4> nodal(const Field& field, const Connectivity<4>& cells,
                                                   Index e) {
  Eigen::Matrix<double, Rows, 4> values;
  for (int a = 0; a < 4; ++a) values.col(a) = field.col(cells(a, e));
  return values;
}

[[nodiscard]] inline Eigen::Vector4d nodal(const Eigen::VectorXd& p, const Connectivity<4>& cells, Index e) {
  return {p[cells(0, e)], p[cells(1, e)], p[cells(2, e)], p[cells(3, e)]};
}

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

template <Rheology R, Stabilization S, class Tet, class Nodal>
[[nodiscard]] ElementFlow element_flow(const R& fluid, const S& stabilization, const Tet& tet, const Nodal& a,
                                       const Nodal& u) {
  ElementFlow flow;
  flow.a = a.rowwise().mean();
  double shear = 0;
  if constexpr (!constant_viscosity<R>) {
    const Eigen::Matrix3d grad_u = u * tet.grad.transpose();
    shear = (grad_u + grad_u.transpose()).norm() / std::sqrt(2.0);  // sqrt(2 eps:eps)
  }
  flow.viscosity = fluid.viscosity_at(shear);
  const double speed = flow.a.norm();
  const double along = (flow.a.transpose() * tet.grad).cwiseAbs().sum();
  const double h = tet.size(), h_a = along > 0 ? 2 * speed / along : h;  // along the velocity
  flow.stabilisation =
      fluid.density * fluid.density * stabilization.momentum(fluid.density, flow.viscosity, h, h_a, speed);
  return flow;
}

/// M_L^{-1} int N (a . grad) u: 3 x nodes [m/s2]; inverse_mass = 1 / M_L [1/m3].
template <class Tets, class Field>
void smooth_convection(const Pattern& pattern, const Connectivity<4>& cells, const Tets& tets, const Field& a,
                       const Field& u, const Eigen::VectorXd& inverse_mass, Field& out) {
  out.setZero(3, u.cols());
  pattern.for_each_cell([&](Index e) {
    const auto& tet = tets[e];
    const Eigen::Matrix<double, 3, 4> ae = nodal<3>(a, cells, e);
    const Eigen::Matrix3d grad_u = nodal<3>(u, cells, e) * tet.grad.transpose() * (tet.volume / 20);
    const Vec3 sum = ae.rowwise().sum();
    for (int i = 0; i < 4; ++i) out.col(cells(i, e)) += grad_u * (sum + ae.col(i));
  });
  out.array().rowwise() *= inverse_mass.transpose().array();
}

/// (rho c0/dt M + C + mu K + S) u* = -rho M history + G p + f + R conv, without boundary terms.
/// fields: MomentumFields. matrix: nodes x nodes, not symmetric; right: 3 x nodes [N].
template <Rheology R, Stabilization S, class Tets, class Fields>
void assemble_momentum(const Pattern& pattern, const Connectivity<4>& cells, const Tets& tets, const R& fluid,
                       const S& stabilization, const Fields& fields, la::RowMatrix& matrix,
                       Points<3>& right) {
  pattern.clear(matrix);
  right.setZero(3, fields.a.cols());
  const bool forced = fields.force.cols() > 0;
  pattern.for_each_cell([&](Index e) {
    const auto& tet = tets[e];
    const double V = tet.volume, rho = fluid.density;
    const Eigen::Matrix<double, 3, 4> a = nodal<3>(fields.a, cells, e);
    const ElementFlow flow = element_flow(fluid, stabilization, tet, a, nodal<3>(fields.u, cells, e));
    const Eigen::Matrix4d along = tet.grad.transpose() * a;  // (j, k): grad N_j . a_k
    const Eigen::Vector4d advection = along.rowwise().sum(), mean = advection / 4;
    const double mass = rho * fields.rate * V / 20;
    Eigen::Matrix4d Ke = flow.viscosity * V * (tet.grad.transpose() * tet.grad);  // mu (grad N_i, grad N_j)
    Ke += flow.stabilisation * V * (mean * mean.transpose());  // t_m rho^2 (a.grad N_i, a.grad N_j)
    Ke += rho * V / 20 * along.transpose();                    // rho (N_i, a.grad N_j)
    Ke.rowwise() += (rho * V / 20 * advection).transpose();
    Ke.array() += mass;
    Ke.diagonal().array() += mass;
    pattern.add(e, Ke, matrix);

    Eigen::Matrix<double, 3, 4> source = -rho * nodal<3>(fields.history, cells, e);
    if (forced) source += nodal<3>(fields.force, cells, e);
    const Vec3 total = source.rowwise().sum();
    const double pressure = V * nodal(fields.p, cells, e).mean();
    const Vec3 smooth = flow.stabilisation * V * nodal<3>(fields.smoothed, cells, e).rowwise().mean();
    for (int i = 0; i < 4; ++i)
      right.col(cells(i, e)) +=
          V / 20 * (total + source.col(i)) + pressure * tet.grad.col(i) + mean[i] * smooth;
  });
}

}  // namespace tunica::fluid
