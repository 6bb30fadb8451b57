// SPDX-License-Identifier: MIT
// Static equilibrium under a load that grows in steps; a step that fails is rolled back and halved.
#pragma once

#include "tunica/la/direct.hpp"
#include "tunica/la/newton.hpp"
#include "tunica/solid/body.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace tunica::solid {

struct StaticsOptions {
  double first_step = 1;        // of the load, whose end is 1
  double smallest_step = 1e-4;  // below it the solution is given up
  double growth = 2;            // of the step after an easy one (at most easy_iterations)
  int easy_iterations = 6;
  la::NewtonOptions newton{};
};

struct [[nodiscard]] StaticsReport {
  SolveReport solve;            // iterations: of Newton in all; residual: of the last step that held
  double load = 0;              // reached factor of the loads: 1 if it converged
  int steps = 0;                // that held
  int cuts = 0;                 // steps rolled back and halved
  Index inverted_cell = -1;     // where J <= 0 in the last failed step, -1 if nowhere
  std::vector<double> history;  // |r| / scale of the last Newton solve

  [[nodiscard]] explicit operator bool() const { return static_cast<bool>(solve); }
};

/// Loads (dead nodal forces, follower pressures, prescribed displacements) are given at their end
/// values; solve() goes from the state reached so far (at first: the reference) to them.
///   Statics wall{mesh, Hyperelastic{Yeoh{...}, Quadratic{...}}};
///   wall.fix(mesh.patch("ends"));  wall.pressure(mesh.patch("inner"), 16e3);  auto report = wall.solve();
template <mesh::Cell C, class Material, la::LinearSolver Solver = la::Ldlt>
class Statics {
 public:
  using Patch = mesh::Patch<typename C::Face>;

  Statics(const mesh::Mesh<C, 3>& mesh, const Material& material, StaticsOptions options = {})
      : body_(mesh, material, 0, Mass::lumped), options_(options), newton_(options.newton) {
    for (auto* v : {&u_, &dead_end_, &dead_start_, &prescribed_end_})
      *v = Eigen::VectorXd::Zero(body_.unknowns());
  }

  void fix(const Patch& patch) { fix(mesh::patch_nodes(patch)); }
  void fix(const std::vector<Index>& nodes) {
    for (const Index n : nodes)
      for (const Axis axis : {Axis::x, Axis::y, Axis::z}) body_.fix(n, axis);
  }
  void fix(const Patch& patch, Axis axis) { fix(mesh::patch_nodes(patch), axis); }
  void fix(const std::vector<Index>& nodes, Axis axis) {
    for (const Index n : nodes) body_.fix(n, axis);
  }
  /// Prescribes a component at its end value [m].
  void prescribe(Index node, Axis axis, double displacement) {
    body_.fix(node, axis);
    prescribed_end_[3 * node + static_cast<int>(axis)] = displacement;
  }
  /// Dead nodal force [N]; replaces the one there was.
  void force(Index node, const Vec3& f) { dead_end_.segment<3>(3 * node) = f; }
  /// Follower pressure [Pa] on a patch; returns its number, with which it can be changed.
  std::size_t pressure(const Patch& patch, double p) {
    const std::size_t number = body_.add_pressure(patch);
    for (auto* v : {&pressure_end_, &pressure_start_}) {
      v->conservativeResize(static_cast<Eigen::Index>(number) + 1);
      (*v)[static_cast<Eigen::Index>(number)] = 0;
    }
    pressure(number, p);
    return number;
  }
  void pressure(std::size_t number, double p) { pressure_end_[static_cast<Eigen::Index>(number)] = p; }

  /// Starts from another displacement, 3 x nodes [m].
  void start(const Points<3>& u) { u_ = u.reshaped(); }

  /// `diverged` with the load reached if the steps become too small; displacement() is then the last
  /// equilibrium that was found.
  StaticsReport solve() {
    StaticsReport report;
    const Eigen::VectorXd u_start = u_;
    double t = 0, step = std::min(1.0, options_.first_step);
    while (t < 1) {
      const double next = t + step > 1 - 1e-9 ? 1 : t + step;
      Problem problem{*this, next};
      Eigen::VectorXd u = u_;
      const la::NewtonReport newton = advance(problem, u_start, u);
      report.solve.iterations += newton.solve.iterations;
      report.history = newton.history;
      if (newton) {
        report.solve.residual = newton.solve.residual;
        report.load = t = next;
        u_ = u;
        ++report.steps;
        if (newton.solve.iterations <= options_.easy_iterations) step *= options_.growth;
        continue;
      }
      if (newton.inadmissible) report.inverted_cell = body_.inverted_cell();
      ++report.cuts;
      step = 0.5 * (next - t);
      if (step < options_.smallest_step) {
        report.solve.status = newton.solve.status;
        return report;
      }
    }
    dead_start_ = dead_end_;
    pressure_start_ = pressure_end_;
    report.solve.status = Status::converged;
    return report;
  }

  /// Displacements of all nodes, 3 x nodes [m].
  [[nodiscard]] Points<3> displacement() const { return u_.reshaped(3, body_.mesh().node_count()); }
  [[nodiscard]] const Body<C, Material>& body() const { return body_; }
  [[nodiscard]] const Eigen::VectorXd& unknowns() const { return u_; }

 private:
  struct Problem {
    Statics& statics;
    double t;  // between the loads at the start and at the end

    la::ResidualInfo residual(const Eigen::VectorXd& u, Eigen::VectorXd& r, double step) {
      Statics& s = statics;
      const bool admissible = s.body_.internal_forces(u, step, r, s.predicted_);
      s.external_ = (1 - t) * s.dead_start_ + t * s.dead_end_;
      s.body_.add_pressure_forces(u, pressures(), s.external_);
      const double scale = std::hypot(r.norm(), s.external_.norm());
      r -= s.external_;
      s.predicted_ -= s.external_;
      s.body_.clear_fixed(r);
      s.body_.clear_fixed(s.predicted_);
      return {.admissible = admissible,
              .scale = scale,
              .rounding = s.body_.rounding(),
              .merit = s.predicted_.norm()};
    }
    void direction(const Eigen::VectorXd& du) { statics.body_.direction(du); }
    void tangent(const Eigen::VectorXd& u, la::SparseMatrix& A) {
      statics.body_.tangent(u, pressures(), {.symmetric_load = Solver::symmetric}, A);
    }
    [[nodiscard]] la::SparseMatrix pattern() const { return statics.body_.pattern(); }
    [[nodiscard]] Eigen::VectorXd pressures() const {
      return (1 - t) * statics.pressure_start_ + t * statics.pressure_end_;
    }
  };

  /// One load step. Prescribed displacements move first, the rest following along the tangent at the
  /// old state: u += d with d = (their increment, -K_ff^-1 K_fp times it).
  la::NewtonReport advance(Problem& problem, const Eigen::VectorXd& u_start, Eigen::VectorXd& u) {
    Eigen::VectorXd d = Eigen::VectorXd::Zero(u.size());
    for (Index k = 0; k < body_.unknowns(); ++k)
      if (body_.fixed(k)) d[k] = (1 - problem.t) * u_start[k] + problem.t * prescribed_end_[k] - u[k];
    newton_.forget();
    if (d.squaredNorm() > 0 && !follow(problem, u, d)) {
      la::NewtonReport failed;
      failed.solve.status = Status::diverged;
      return failed;
    }
    return newton_.solve(problem, u);
  }

  bool follow(Problem& problem, Eigen::VectorXd& u, const Eigen::VectorXd& d) {
    // K d by a difference of the forces along d: a length of 1e-7 of it is exact enough for a start.
    constexpr double length = 1e-7;
    Eigen::VectorXd r0, r1, dx;
    if (!problem.residual(u, r0, la::no_step).admissible ||
        !problem.residual(u + length * d, r1, la::no_step).admissible)
      return false;
    la::SparseMatrix A = body_.pattern();
    problem.tangent(u, A);
    Solver solver;
    solver.analyse(A);
    if (!solver.factorise(A) || !solver.solve((r0 - r1) / length - r0, dx)) return false;
    u += d + dx;
    return true;
  }

  Body<C, Material> body_;
  StaticsOptions options_;
  la::Newton<Solver> newton_;
  Eigen::VectorXd u_, dead_end_, dead_start_, prescribed_end_, external_, predicted_;
  Eigen::VectorXd pressure_end_, pressure_start_;
};
template <mesh::Cell C, class Material>
Statics(const mesh::Mesh<C, 3>&, const Material&) -> Statics<C, Material>;
template <mesh::Cell C, class Material>
Statics(const mesh::Mesh<C, 3>&, const Material&, StaticsOptions) -> Statics<C, Material>;

}  // namespace tunica::solid
