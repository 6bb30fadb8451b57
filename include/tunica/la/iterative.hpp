// SPDX-License-Identifier: MIT
// The Krylov solvers as models of LinearSolver: a preconditioner is set up when the values are read.
#pragma once

#include "tunica/la/bicgstab.hpp"
#include "tunica/la/cg.hpp"
#include "tunica/la/linear_solver.hpp"
#include "tunica/la/preconditioner.hpp"

#include <cmath>

namespace tunica::la {

namespace detail {

template <class Precond, bool Symmetric>
class Iterative {
 public:
  static constexpr bool symmetric = Symmetric;

  explicit Iterative(KrylovOptions options = {}) : options_(options) {}

  void analyse(const SparseMatrix&) {}

  /// `diverged` for a matrix with a NaN.
  SolveReport factorise(const SparseMatrix& A) {
    A_ = A;
    if constexpr (requires { preconditioner_.compute(A_); }) preconditioner_.compute(A_);
    const bool finite = std::isfinite(A.coeffs().sum());
    return {finite ? Status::converged : Status::diverged, 0, 0};
  }

  /// x: the start if it has the size of b, zero otherwise.
  SolveReport solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) {
    if (x.size() != b.size()) x = Eigen::VectorXd::Zero(b.size());
    if constexpr (Symmetric)
      return cg(ApplyMatrix<>{A_}, preconditioner_, b, x, options_);
    else
      return bicgstab(ApplyMatrix<>{A_}, preconditioner_, b, x, options_);
  }

 private:
  KrylovOptions options_;
  RowMatrix A_;
  Precond preconditioner_;
};

}  // namespace detail

/// Conjugate gradients for symmetric positive definite matrices, both triangles stored.
template <class Precond = IncompleteCholesky>
using Cg = detail::Iterative<Precond, true>;

/// BiCGStab for any regular matrix.
template <class Precond = Ilu0<>>
using BiCgStab = detail::Iterative<Precond, false>;

static_assert(LinearSolver<Cg<>> && LinearSolver<BiCgStab<>>);

}  // namespace tunica::la
