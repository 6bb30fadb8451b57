// SPDX-License-Identifier: MIT
// The seam between a discretisation and whatever solves its linear systems.
#pragma once

#include "tunica/core/solve_report.hpp"

#include <Eigen/SparseCore>

#include <concepts>

namespace tunica::la {

using SparseMatrix = Eigen::SparseMatrix<double>;  // compressed columns

/// Solves A x = b: `analyse` reads the pattern alone and lasts as long as that; `factorise` reads the
/// values (a preconditioner is set up there); `solve` takes x as its start if it iterates, and
/// reports the relative residual |b - A x| / |b|. A singular matrix or a NaN is a status.
/// `symmetric` says that it takes A for symmetric and reads perhaps one triangle only.
///   struct Mine { static constexpr bool symmetric = true; void analyse(const SparseMatrix&); ... };
template <class S, class Matrix = SparseMatrix>
concept LinearSolver = requires(S solver, const Matrix& A, const Eigen::VectorXd& b, Eigen::VectorXd& x) {
  { S::symmetric } -> std::convertible_to<bool>;         // a solver says whether it takes A for symmetric
  solver.analyse(A);                                     // a solver reads the pattern of A first
  { solver.factorise(A) } -> std::same_as<SolveReport>;  // a solver reports on the values of A
  { solver.solve(b, x) } -> std::same_as<SolveReport>;   // a solver reports on its solution
};

}  // namespace tunica::la
