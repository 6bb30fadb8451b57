// SPDX-License-Identifier: MIT
// The pressures of nodes that belong to given displacements: the start of a body with NodalPressure.
#pragma once

#include "tunica/la/linear_solver.hpp"
#include "tunica/la/newton.hpp"

#include <Eigen/Core>

namespace tunica::solid {

/// Solves the pressures' own equations at the displacements in x, in which they are linear: r_q(u, q) =
/// r_q(u, 0) + C q = 0 with C < 0 [MixedTet]. x holds the displacements first and the pressures behind them,
/// which are replaced. `loads`: the pressures on patches [Pa], which do not count here.
template <class Body, la::LinearSolver Solver>
SolveReport nodal_pressures(Body& body, const Eigen::VectorXd& loads, Solver& solver, Eigen::VectorXd& x) {
  const Eigen::Index moved = 3 * body.mesh().node_count(), pressures = x.size() - moved;
  x.tail(pressures).setZero();
  Eigen::VectorXd r, predicted, q;
  if (!body.internal_forces(x, la::no_step, r, predicted)) return {Status::diverged, 0, 0};
  la::SparseMatrix A = body.pattern();
  body.tangent(x, loads, {}, A);
  for (Eigen::Index column = 0; column < A.outerSize(); ++column)  // (1, 0; 0, -C), which is definite
    for (la::SparseMatrix::InnerIterator entry(A, column); entry; ++entry)
      entry.valueRef() = entry.row() >= moved && column >= moved ? -entry.value()
                         : entry.row() == column                 ? 1.0
                                                                 : 0.0;
  r.head(moved).setZero();
  solver.analyse(A);
  if (const auto report = solver.factorise(A); !report) return report;
  q.setZero(x.size());
  const auto report = solver.solve(r, q);
  x.tail(pressures) = q.tail(pressures);
  return report;
}

}  // namespace tunica::solid
