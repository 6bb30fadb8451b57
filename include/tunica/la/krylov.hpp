// SPDX-License-Identifier: MIT
// What the Krylov solvers share: operators, options, and how a residual history becomes a status.
#pragma once

#include "tunica/core/solve_report.hpp"
#include "tunica/la/vector_ops.hpp"

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>

namespace tunica::la {

/// y = A x, matrix or not: apply(x, y). A RowMatrix is turned into one by ApplyMatrix.
template <class A>
concept LinearOperator = requires(const A& a, const Eigen::VectorXd& x, Eigen::VectorXd& y) {
  a.apply(x, y);  // an operator applies itself to x: y = A x
};

/// z ~ A^-1 r: apply(r, z).
///   struct Identity { void apply(const Eigen::VectorXd& r, Eigen::VectorXd& z) const { z = r; } };
template <class P>
concept Preconditioner = LinearOperator<P>;

template <int Components = 1>
struct ApplyMatrix {
  const RowMatrix& A;
  void apply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const { multiply<Components>(A, x, y); }
};

struct KrylovOptions {
  double tolerance = 1e-8;  // on |b - A x| / |b|, the true residual
  double absolute = 0;      // on |b - A x|; for a right-hand side that is itself round-off
  int max_iterations = 1000;
  int stall = 200;   // iterations without a new smallest residual (to one part in a hundred)
  int restart = 50;  // vectors that GMRES keeps before it starts again
};

namespace detail {

/// Follows the norm of the residual and says when and how to stop.
class Watch {
 public:
  Watch(double scale, const KrylovOptions& options)
      : goal_(std::max(options.tolerance * scale, options.absolute)), scale_(scale), options_(options) {}

  [[nodiscard]] double goal() const { return goal_; }
  /// A method that minimises something else than the residual got on with that.
  void advances(int iteration) { since_ = iteration; }
  /// True when the iteration must end; report then holds how.
  [[nodiscard]] bool done(double residual, int iteration, SolveReport& report) {
    report.iterations = iteration;
    report.residual = scale_ > 0 ? residual / scale_ : residual;
    if (iteration == 0) start_ = residual;
    if (!std::isfinite(residual) || residual > 1e8 * std::max(scale_, start_)) {
      report.status = Status::diverged;
      return true;
    }
    if (residual <= goal_) {
      report.status = Status::converged;
      return true;
    }
    if (residual < 0.99 * best_) best_ = residual, since_ = iteration;
    if (iteration - since_ >= options_.stall) {
      report.status = Status::stalled;
      return true;
    }
    if (iteration >= options_.max_iterations) {
      report.status = Status::max_iterations;
      return true;
    }
    return false;
  }

 private:
  double goal_, scale_;
  double start_ = 0, best_ = std::numeric_limits<double>::infinity();
  int since_ = 0;
  KrylovOptions options_;
};

}  // namespace detail

}  // namespace tunica::la
