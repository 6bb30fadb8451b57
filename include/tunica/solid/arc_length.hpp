// SPDX-License-Identifier: MIT
// Equilibria past limit points: the load is an unknown, the length of the step is given [CRISFIELD81].
#pragma once

#include "tunica/core/expect.hpp"
#include "tunica/la/bordered_newton.hpp"
#include "tunica/solid/statics.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>

namespace tunica::solid {

struct ArcLengthOptions {
  double first_step;        // rms of the nodal displacement increments [m]
  double largest_step;      // [m]
  double smallest_step;     // below it the path is given up [m]
  int easy_iterations = 4;  // the next step is longer after fewer, shorter after more
};

struct [[nodiscard]] ArcLengthStep {
  SolveReport solve{};
  double load = 0;           // factor of the loads, may fall and be beyond 1
  double length = 0;         // of the step that held [m]
  int cuts = 0;              // attempts with steps halved after
  Index inverted_cell = -1;  // where J <= 0 in the last failed attempt, -1 if nowhere

  [[nodiscard]] explicit operator bool() const { return static_cast<bool>(solve); }
};

/// Walks along the equilibria of a Statics whose loads are all multiplied by one factor, which is 1 at
/// their end values: |du|^2 / nodes = length^2, linearised in each iteration with the rest.
///   ArcLength path{wall, {.first_step = 1e-4, .largest_step = 1e-3, .smallest_step = 1e-6}};
///   while (const auto at = path.step()) { ... at.load, wall.displacement() ... }
/// Prescribed displacements must not change on the way.
template <class Wall>
class ArcLength {
 public:
  ArcLength(Wall& wall, const ArcLengthOptions& options)
      : wall_(wall),
        options_(options),
        length_(options.first_step),
        newton_(wall.options().newton, la::Borrowed(wall.borrow_solver())) {
    TUNICA_EXPECT(options.first_step > 0 && options.largest_step >= options.first_step &&
                      options.smallest_step <= options.first_step && options.smallest_step > 0,
                  "steps of an arc are positive, the first between the smallest and the largest");
    previous_ = Eigen::VectorXd::Zero(3 * wall.body().mesh().node_count());
  }

  /// The next equilibrium. The first step goes where the load grows, each other one goes on as the last.
  /// On failure the wall stays where it was.
  ArcLengthStep step() {
    ArcLengthStep report{.load = wall_.load()};
    Problem problem{wall_, wall_.unknowns(), 0};
    Eigen::VectorXd rate, r;
    const auto info = problem.residual(problem.from, wall_.load(), r, la::no_step);
    if (!info.admissible) {
      report.inverted_cell = wall_.body().inverted_cell();
      return report;
    }
    if (report.solve = newton_.rate(problem, problem.from, wall_.load(), rate);
        report.solve.status != Status::converged || !(problem.moved(rate).norm() > 0))
      return report;
    const double sign = previous_.dot(problem.moved(rate)) < 0 ? -1 : 1;
    for (double length = length_; length >= options_.smallest_step; length *= 0.5, ++report.cuts) {
      problem.squared = length * length * static_cast<double>(wall_.body().mesh().node_count());
      const double d_load = sign * std::sqrt(problem.squared) / problem.moved(rate).norm();
      (void)problem.residual(problem.from, wall_.load(), r, la::no_step);
      problem.direction(d_load * rate);
      Eigen::VectorXd u = problem.from + d_load * rate;
      double load = wall_.load() + d_load;
      const la::NewtonReport newton = newton_.solve(problem, u, load, 1);
      report.solve = newton.solve;
      if (!newton) {
        if (newton.inadmissible) report.inverted_cell = wall_.body().inverted_cell();
        continue;
      }
      previous_ = problem.moved(u - problem.from);
      wall_.accept(u, load);
      report.load = load;
      report.length = length;
      const double change =
          std::sqrt(options_.easy_iterations / std::max(1.0, static_cast<double>(newton.solve.iterations)));
      length_ = std::min(length * std::clamp(change, 0.5, 2.0), options_.largest_step);
      return report;
    }
    return report;
  }

 private:
  struct Problem {
    Wall& wall;
    Eigen::VectorXd from;
    double squared;  // |u - from|^2 of the step [m2]

    la::ResidualInfo residual(const Eigen::VectorXd& u, double load, Eigen::VectorXd& r, double step) {
      return wall.residual(u, load, r, step);
    }
    void direction(const Eigen::VectorXd& du) { wall.direction(du); }
    void tangent(const Eigen::VectorXd& u, double load, la::SparseMatrix& A) { wall.tangent(u, load, A); }
    [[nodiscard]] Eigen::VectorXd slope(const Eigen::VectorXd& u, double) const {
      return -wall.load_slope(u);
    }
    [[nodiscard]] la::Border border(const Eigen::VectorXd& u, double) const {
      la::Border border{.scale = squared, .in_x = Eigen::VectorXd::Zero(u.size())};
      const Eigen::VectorXd du = moved(u - from);
      border.g = du.squaredNorm() - squared;
      border.in_x.head(du.size()) = 2 * du;
      return border;
    }
    [[nodiscard]] la::SparseMatrix pattern() const { return wall.body().pattern(); }
    // The displacements alone, if there are other unknowns after them.
    [[nodiscard]] Eigen::VectorXd moved(const Eigen::VectorXd& du) const {
      return du.head(3 * wall.body().mesh().node_count());
    }
  };

  Wall& wall_;
  ArcLengthOptions options_;
  double length_;
  la::BorderedNewton<la::Borrowed<typename Wall::linear_solver>> newton_;
  Eigen::VectorXd previous_;  // increment of the last step
};

}  // namespace tunica::solid
