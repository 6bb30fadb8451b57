// SPDX-License-Identifier: MIT
// Newton's method for r(x, y) = 0 with one more unknown y and one more equation g(x, y) = 0, by two
// solves with dr/dx [CRISFIELD81]: continuation past limit points, where the load alone has no next step.
#pragma once

#include "tunica/la/newton.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <utility>

namespace tunica::la {

/// g and its derivatives; |g| is measured by `scale`.
struct Border {
  double g = 0, scale = 1;
  Eigen::VectorXd in_x;  // dg/dx
  double in_y = 0;       // dg/dy
};

/// As NonlinearProblem, with y beside x. `slope` is dr/dy, zero for prescribed unknowns.
template <class P>
concept BorderedProblem = requires(P problem, const Eigen::VectorXd& x, double y, Eigen::VectorXd& r,
                                   SparseMatrix& A) {
  { problem.residual(x, y, r, 1.0) } -> std::same_as<ResidualInfo>;
  problem.direction(x);
  problem.tangent(x, y, A);
  { problem.slope(x, y) } -> std::convertible_to<Eigen::VectorXd>;
  { problem.border(x, y) } -> std::convertible_to<Border>;  // a problem says what fixes y
  { problem.pattern() } -> std::convertible_to<SparseMatrix>;
};

/// The solver of somebody else, with its options and what it keeps: no second one is made.
template <LinearSolver Solver>
class Borrowed {
 public:
  static constexpr bool symmetric = Solver::symmetric;

  explicit Borrowed(Solver& lent) : lent_(&lent) {}
  void analyse(const SparseMatrix& A) { lent_->analyse(A); }
  SolveReport factorise(const SparseMatrix& A) { return lent_->factorise(A); }
  SolveReport solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) { return lent_->solve(b, x); }

 private:
  Solver* lent_;
};

template <LinearSolver Solver>
class BorderedNewton {
 public:
  explicit BorderedNewton(NewtonOptions options = {}, Solver solver = {})
      : options_(options), solver_(std::move(solver)) {}

  /// dx/dy along r = 0: minus (dr/dx)^-1 dr/dy, at a state whose residual was the last one taken.
  /// Not `converged`: dx is of no use.
  template <BorderedProblem Problem>
  SolveReport rate(Problem& problem, const Eigen::VectorXd& x, double y, Eigen::VectorXd& dx) {
    if (!factorise(problem, x, y)) return {Status::diverged, 0, 0};
    return solver_.solve(-problem.slope(x, y), dx);
  }

  /// From (x, y), which lies `start` along the last direction (no_step: along none). Iterates until r
  /// and g are small; (x, y) is the last iterate whatever the status, see Newton::solve.
  template <BorderedProblem Problem>
  NewtonReport solve(Problem& problem, Eigen::VectorXd& x, double& y, double start) {
    NewtonReport report;
    const auto ended = [&](Status status, double residual) {
      report.solve.status = status;
      report.solve.residual = residual;
      return report;
    };
    ResidualInfo info = problem.residual(x, y, r_, start);
    Border border = problem.border(x, y);
    double relative = relative_of(info);
    report.history.push_back(relative);
    report.inadmissible = !info.admissible;
    if (!info.admissible || !std::isfinite(relative) || !std::isfinite(border.g))
      return ended(Status::diverged, relative);
    bool settled = false;  // no digit of x moves any more
    const auto solved = [&] {
      const bool on_path = relative <= options_.tolerance || r_.norm() <= info.rounding || settled;
      return on_path && std::abs(border.g) <= border_tolerance * border.scale;
    };
    for (int& k = report.solve.iterations; !solved();) {
      if (k == options_.max_iterations) return ended(Status::max_iterations, relative);
      if (!factorise(problem, x, y)) return ended(Status::diverged, relative);
      ++report.factorisations;
      dx_.setZero(x.size());  // the last step is no start for the next
      if (solver_.solve(-r_, dx_).status == Status::diverged ||
          solver_.solve(-problem.slope(x, y), rate_).status == Status::diverged)
        return ended(Status::diverged, relative);
      ++k;
      // r + A dx + r_y dy = 0 and g + g_x dx + g_y dy = 0
      const double dy = -(border.g + border.in_x.dot(dx_)) / (border.in_y + border.in_x.dot(rate_));
      dx_ += dy * rate_;
      problem.direction(dx_);
      const double old_merit = std::max(info.merit, info.rounding);
      double s = 1;
      for (int cut = 0;; ++cut, s *= 0.5) {
        trial_ = x + s * dx_;
        info = problem.residual(trial_, y + s * dy, r_, s);
        // The first step may be the way to a new g alone, from a residual of nought.
        if (info.admissible && std::isfinite(r_.norm()) &&
            (k == 1 || info.merit <= options_.growth * old_merit || info.merit <= free_merit * info.scale))
          break;
        if (cut == options_.max_cuts) {
          report.inadmissible = !info.admissible;
          return ended(Status::diverged, relative);
        }
      }
      x = trial_;
      y += s * dy;
      border = problem.border(x, y);
      relative = relative_of(info);
      report.history.push_back(relative);
      if (!std::isfinite(info.scale) || !std::isfinite(border.g)) return ended(Status::diverged, relative);
      settled = s == 1 &&
                dx_.lpNorm<Eigen::Infinity>() <= options_.increment_tolerance * x.lpNorm<Eigen::Infinity>();
    }
    return ended(Status::converged, relative);
  }

 private:
  static constexpr double border_tolerance = 1e-9;  // of g: it only says where on the path the point lies
  static constexpr double free_merit = 1e-3;        // residuals below it are no reason to cut a step

  [[nodiscard]] double relative_of(const ResidualInfo& info) const {
    const double size = r_.norm();
    return size > 0 ? size / info.scale : size;
  }
  template <class Problem>
  bool factorise(Problem& problem, const Eigen::VectorXd& x, double y) {
    if (A_.rows() != x.size()) {
      A_ = problem.pattern();
      solver_.analyse(A_);
    }
    problem.tangent(x, y, A_);
    return solver_.factorise(A_).status == Status::converged;
  }

  NewtonOptions options_;
  Solver solver_;
  SparseMatrix A_;
  Eigen::VectorXd r_, dx_, rate_, trial_;
};

}  // namespace tunica::la
