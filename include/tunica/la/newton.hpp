// SPDX-License-Identifier: MIT
// Newton's method with a line search, which may keep its factorised tangent while it contracts well.
#pragma once

#include "tunica/core/types.hpp"
#include "tunica/la/linear_solver.hpp"
#include "tunica/la/step_search.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace tunica::la {

/// The `step` of a residual that lies on no step: a start.
inline constexpr double no_step = -1;

/// A residual's side information.
struct ResidualInfo {
  bool admissible = true;  // false where the problem is not defined (a cell with J <= 0)
  double scale = 0;        // size of the forces that balance, in the unit of the residual
  double rounding = 0;     // what of |r| is rounding: below it the problem is solved
  double merit = 0;        // what the line search wants to fall; |r| in most problems
};

/// r(x) = 0 with r = 0 kept for prescribed unknowns; `tangent` fills A = dr/dx at x, the rows and
/// columns of prescribed unknowns being those of a diagonal matrix; `pattern` is a matrix of A's
/// pattern. `direction` announces the step dx that leaves the x of the last residual, and `residual` is
/// told how far along it x is (or no_step), so that a problem with condensed unknowns can carry them along.
/// A problem may also give its tangent as it is assembled, tangent_blocks(x): a solver that reads such
/// matrices gets that one.
template <class P>
concept NonlinearProblem = requires(P problem, const Eigen::VectorXd& x, Eigen::VectorXd& r,
                                    SparseMatrix& A) {
  { problem.residual(x, r, 1.0) } -> std::same_as<ResidualInfo>;  // a residual with its scale
  problem.direction(x);                                           // a problem is told the step that is tried
  problem.tangent(x, A);                                          // a problem has a tangent
  { problem.pattern() } -> std::convertible_to<SparseMatrix>;     // a problem has a pattern of its tangent
};

struct NewtonOptions {
  double tolerance = 1e-10;            // on |r| / scale
  double increment_tolerance = 1e-12;  // on max |dx| / max |x| of a full step: no digit of x moves any more
  int max_iterations = 30;             // linear solves
  int max_cuts = 12;                   // of one step by the line search
  double growth = 2;                   // of the merit in one step, above which the step is cut
  double refresh_above = 0;  // contraction of the merit above which the tangent is made anew; 0: always
};

struct [[nodiscard]] NewtonReport {
  SolveReport solve;            // residual: |r| / scale at the end
  std::vector<double> history;  // |r| / scale at the start and after each iteration
  double rounding = 0;          // what of |r| / scale is rounding, at the end
  int factorisations = 0;
  Index negative_pivots = -1;  // of the last tangent; -1 where the solver does not count them
  bool inadmissible = false;   // it ended because no step led back to where the problem is defined

  [[nodiscard]] explicit operator bool() const { return static_cast<bool>(solve); }
};

/// Slope of the last ratios, log(e3/e2) / log(e2/e1), of the last three residuals of the history that lie
/// above `floor`: 2 for Newton with a consistent tangent once e3 ~ C e2^2. 0 if there are not three.
[[nodiscard]] inline double observed_order(const std::vector<double>& history, double floor) {
  std::vector<double> e;
  for (const double h : history)
    if (h > floor) e.push_back(h);
  if (e.size() < 3) return 0;
  const std::size_t n = e.size();
  return std::log(e[n - 1] / e[n - 2]) / std::log(e[n - 2] / e[n - 3]);
}
/// The same above ten times what a report says is rounding: a tenth of a residual bends the slope by 1 %.
template <class Report>
[[nodiscard]] double observed_order(const Report& report) {
  return observed_order(report.history, 10 * report.rounding);
}

/// Keeps the solver, its analysis and its factors from one call to the next: what a solver can reuse of
/// one tangent for the next (an order of elimination, the hierarchy of a multigrid) it reuses.
template <LinearSolver Solver>
class Newton {
 public:
  explicit Newton(NewtonOptions options = {}, Solver solver = {})
      : options_(options), solver_(std::move(solver)) {}

  [[nodiscard]] const Solver& solver() const { return solver_; }
  /// For other matrices of the same pattern: the next tangent is analysed and made anew.
  [[nodiscard]] Solver& borrow_solver() {
    analysed_ = false;
    forget();
    return solver_;
  }

  /// The tangent is made anew in the next iteration (the matrix changed: a new step length, a new time).
  void forget() { fresh_enough_ = false; }

  /// Solves r(x) = 0 from x; x is the last iterate at the end, whatever the status. `diverged`: a
  /// NaN, a singular tangent, or no admissible step (`inadmissible`); else `max_iterations`.
  template <NonlinearProblem Problem>
  NewtonReport solve(Problem& problem, Eigen::VectorXd& x) {
    NewtonReport report;
    ResidualInfo info = problem.residual(x, r_, no_step);
    const auto ended = [&](Status status, double residual) {
      report.solve.status = status;
      report.solve.residual = residual;
      report.rounding = std::max(info.rounding / info.scale, rounding_of_sums);
      if (status != Status::converged) forget();
      return report;
    };
    double size = r_.norm();
    double relative = size > 0 ? size / info.scale : size;
    report.history.push_back(relative);
    report.inadmissible = !info.admissible;
    if (!info.admissible || !std::isfinite(relative) || !std::isfinite(info.scale))
      return ended(Status::diverged, relative);

    for (int& k = report.solve.iterations; !(relative <= options_.tolerance || size <= info.rounding);) {
      if (k == options_.max_iterations) return ended(Status::max_iterations, relative);
      const bool made_now = !fresh_enough_;
      if (made_now) {
        if (!factorise(problem, x)) return ended(Status::diverged, relative);
        ++report.factorisations;
        if constexpr (requires { solver_.negative_pivots(); })
          report.negative_pivots = static_cast<Index>(solver_.negative_pivots());
      }
      dx_.setZero(x.size());  // the last step is no start for the next
      if (solver_.solve(-r_, dx_).status == Status::diverged) return ended(Status::diverged, relative);
      ++k;
      problem.direction(dx_);
      const double old_merit = info.merit;
      StepSearch search(work(problem));
      double s = 1;
      bool refused = false;  // by the line search, on account of an old tangent
      for (int cut = 0;; ++cut) {
        trial_ = x + s * dx_;
        info = problem.residual(trial_, r_, s);
        size = r_.norm();
        const bool usable = info.admissible && std::isfinite(size);
        const bool calm = usable && info.merit <= options_.growth * old_merit;
        const double g = usable ? work(problem) : std::numeric_limits<double>::quiet_NaN();
        if (search.goes_down() ? (cut == 0 && calm) || search.takes(g) || (cut >= options_.max_cuts && g < 0)
                               : calm)
          break;
        if (!made_now) {
          refused = true;
          break;
        }
        if (cut > options_.max_cuts || (cut == options_.max_cuts && !(search.safe() > 0))) {
          report.inadmissible = !info.admissible;
          return ended(Status::diverged, relative);
        }
        if (!search.goes_down())
          s *= 0.5;
        else
          s = cut == options_.max_cuts ? search.safe() : search.next(s, g);
      }
      if (refused) {
        forget();
        info = problem.residual(x, r_, 0);
        size = r_.norm();
        continue;
      }
      x = trial_;
      relative = size > 0 ? size / info.scale : size;
      report.history.push_back(relative);
      if (!std::isfinite(info.scale)) return ended(Status::diverged, relative);
      const double moved = s * dx_.lpNorm<Eigen::Infinity>();
      if (s == 1 && moved <= options_.increment_tolerance * x.lpNorm<Eigen::Infinity>()) break;
      if (!(info.merit <= options_.refresh_above * old_merit)) forget();
    }
    return ended(Status::converged, relative);
  }

  /// Solves A(x) dx = b with the tangent made anew at x, which must be where the last residual was taken.
  template <NonlinearProblem Problem>
  SolveReport linear(Problem& problem, const Eigen::VectorXd& x, const Eigen::VectorXd& b,
                     Eigen::VectorXd& dx) {
    if (!factorise(problem, x)) return {Status::diverged, 0, 0};
    forget();
    dx.setZero(x.size());
    return solver_.solve(b, dx);
  }

 private:
  static constexpr double rounding_of_sums = 32 * std::numeric_limits<double>::epsilon();

  /// Of the last residual along the step; 0 where a problem has none.
  template <class Problem>
  [[nodiscard]] double work(const Problem& problem) const {
    if constexpr (requires { problem.work(dx_); }) return problem.work(dx_);
    return 0;
  }
  template <class Problem>
  bool factorise(Problem& problem, const Eigen::VectorXd& x) {
    if constexpr (requires { solver_.factorise(problem.tangent_blocks(x)); }) {
      const auto& A = problem.tangent_blocks(x);  // as it is assembled
      if (!analysed_) solver_.analyse(A);
      analysed_ = true;
      fresh_enough_ = solver_.factorise(A).status == Status::converged;
    } else {
      if (!analysed_ || A_.rows() != x.size()) {
        A_ = problem.pattern();
        solver_.analyse(A_);
        analysed_ = true;
      }
      problem.tangent(x, A_);
      fresh_enough_ = solver_.factorise(A_).status == Status::converged;
    }
    return fresh_enough_;
  }

  NewtonOptions options_;
  Solver solver_;
  SparseMatrix A_;
  Eigen::VectorXd r_, dx_, trial_;
  bool analysed_ = false, fresh_enough_ = false;
};

}  // namespace tunica::la
