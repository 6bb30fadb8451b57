// SPDX-License-Identifier: MIT
// The pressures of nodes that belong to given displacements: the start of a body with NodalPressure.
#pragma once

#include "tunica/la/linear_solver.hpp"
#include "tunica/la/newton.hpp"

#include <Eigen/Core>

namespace tunica::solid {

/// Solves the pressures' own equations at the displacements in x: r_q(u, q) = 0, whose slope C in q is
/// negative [MixedTet], linear in q where U* is a square. x holds the displacements first and the pressures
/// behind them, which are replaced. `loads`: the pressures on patches [Pa], which do not count here.
template <class Body, la::LinearSolver Solver>
SolveReport nodal_pressures(Body& body, const Eigen::VectorXd& loads, Solver& solver, Eigen::VectorXd& x) {
  constexpr int steps = 30;  // of Newton from p = 0: one and its check where U* is a square
  const Eigen::Index moved = 3 * body.mesh().node_count(), pressures = x.size() - moved;
  x.tail(pressures).setZero();
  Eigen::VectorXd r, predicted, q;
  la::SparseMatrix A = body.pattern();
  SolveReport report;
  for (int step = 0; step < steps; ++step) {
    if (!body.internal_forces(x, la::no_step, r, predicted)) return {Status::diverged, step, 0};
    body.tangent(x, loads, {}, A);
    for (Eigen::Index column = 0; column < A.outerSize(); ++column)  // (1, 0; 0, -C), which is definite
      for (la::SparseMatrix::InnerIterator entry(A, column); entry; ++entry)
        entry.valueRef() = entry.row() >= moved && column >= moved ? -entry.value()
                           : entry.row() == column                 ? 1.0
                                                                   : 0.0;
    r.head(moved).setZero();
    if (step == 0) solver.analyse(A);
    if (report = solver.factorise(A); !report) return report;
    q.setZero(x.size());
    report = solver.solve(r, q);
    x.tail(pressures) += q.tail(pressures);
    if (!report || q.tail(pressures).norm() <= 1e-12 * x.tail(pressures).norm()) break;
  }
  return report;
}

}  // namespace tunica::solid
