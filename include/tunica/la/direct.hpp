// SPDX-License-Identifier: MIT
// Direct solvers over Eigen's sparse factorisations, with one step of refinement when it is needed.
#pragma once

#include "tunica/la/linear_solver.hpp"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseLU>

#include <cmath>
#include <memory>

namespace tunica::la {

namespace detail {

/// Keeps a copy of A for the residual; Factor is one of Eigen's sparse factorisations.
template <class Factor, bool Symmetric>
class Direct {
 public:
  static constexpr bool symmetric = Symmetric;

  void analyse(const SparseMatrix& A) { factor_->analyzePattern(A); }

  /// `diverged` for a zero pivot or a NaN.
  SolveReport factorise(const SparseMatrix& A) {
    A_ = A;
    usable_ = std::isfinite(A.coeffs().sum());
    if (usable_) factor_->factorize(A);
    usable_ = usable_ && factor_->info() == Eigen::Success;
    return {usable_ ? Status::converged : Status::diverged, 0, 0};
  }

  /// The residual is measured; above 1e-12 one step of iterative refinement is made. `diverged` if it
  /// is not finite, `stalled` if it stays above 1e-6: the factors are then worthless.
  SolveReport solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) {
    constexpr double refine_above = 1e-12;  // some hundred roundings of a backward stable solve
    constexpr double worthless_above = 1e-6;
    const double size = b.norm();
    if (!usable_ || !std::isfinite(size)) return {Status::diverged, 0, size};
    if (size == 0) {
      x = Eigen::VectorXd::Zero(b.size());
      return {Status::converged, 0, 0};
    }
    x = factor_->solve(b);
    Eigen::VectorXd r = b - product(x);
    double residual = r.norm() / size;
    int iterations = 1;
    if (residual > refine_above && std::isfinite(residual)) {
      x += factor_->solve(r);
      r = b - product(x);
      residual = r.norm() / size;
      ++iterations;
    }
    if (!std::isfinite(residual)) return {Status::diverged, iterations, residual};
    return {residual < worthless_above ? Status::converged : Status::stalled, iterations, residual};
  }

  /// Of D in the last factors: how many independent directions there are in which A is negative (Sylvester).
  [[nodiscard]] Eigen::Index negative_pivots() const requires Symmetric {
    return (factor_->vectorD().array() < 0).count();
  }

 private:
  [[nodiscard]] Eigen::VectorXd product(const Eigen::VectorXd& x) const {
    if constexpr (Symmetric)
      return A_.selfadjointView<Eigen::Lower>() * x;
    else
      return A_ * x;
  }

  std::unique_ptr<Factor> factor_ = std::make_unique<Factor>();  // of fixed address: Eigen cannot move it
  SparseMatrix A_;
  bool usable_ = false;
};

}  // namespace detail

/// A = L D L^T with approximate minimum degree, for symmetric matrices; reads the lower triangle.
/// It does not pivot: sure for definite (and quasi-definite) matrices. An indefinite tangent, as past
/// a limit point, usually factorises too, and a zero pivot or lost digits come back as a status;
/// `Lu` is the safe choice there. Fill grows fast in 3-D: for walls, not for blocks above 2e4 unknowns.
using Ldlt = detail::Direct<Eigen::SimplicialLDLT<SparseMatrix, Eigen::Lower>, true>;

/// A = L U with partial pivoting and COLAMD, for any regular matrix; 3 to 10 times the cost of Ldlt.
using Lu = detail::Direct<Eigen::SparseLU<SparseMatrix>, false>;

static_assert(LinearSolver<Ldlt> && LinearSolver<Lu>);

}  // namespace tunica::la
