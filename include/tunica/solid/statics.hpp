// SPDX-License-Identifier: MIT
// Static equilibrium under a load that grows in steps; a step that fails is rolled back and halved.
#pragma once

#include "tunica/la/direct.hpp"
#include "tunica/la/newton.hpp"
#include "tunica/solid/body.hpp"
#include "tunica/solid/follow.hpp"
#include "tunica/solid/statics_report.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace tunica::solid {

/// Loads (dead nodal forces, follower pressures, prescribed displacements) are given at their end
/// values; solve() goes from the state reached so far (at first: the reference) to them.
///   Statics wall{mesh, Hyperelastic{Yeoh{...}, Quadratic{...}}};
///   wall.fix(mesh.patch("ends"));  wall.pressure(mesh.patch("inner"), 16e3);  auto report = wall.solve();
/// or step by step: while (!wall.done()) { if (!wall.step()) break;  frames.add(wall.displacement()); }
template <mesh::Cell C, class Material, la::LinearSolver Solver = DefaultSolver<C, Material>>
class Statics {
  static_assert(Body<C, Material>::symmetric || !Solver::symmetric,
                "this tangent is not symmetric: it wants a solver such as la::Lu");

 public:
  using Patch = mesh::Patch<typename C::Face>;
  using linear_solver = Solver;
  using Cell = C;
  using Element = typename Body<C, Material>::Element;

  /// `solver`: one with options of its own, such as a la::Cg whose multigrid keeps rigid_body_modes().
  Statics(const mesh::Mesh<C, 3>& mesh, const Material& material, StaticsOptions options = {},
          Solver solver = {})
      : body_(mesh, material, 0, Mass::lumped),
        options_(options),
        step_(options.first_step),
        newton_(options.newton, std::move(solver)) {
    for (auto* v : {&u_, &u_start_, &dead_end_, &dead_start_, &prescribed_end_})
      *v = Eigen::VectorXd::Zero(body_.unknowns());
    body_.fix_loose_nodes();
  }

  void fix(const Patch& patch) { fix(mesh::patch_nodes(patch)); }
  void fix(const std::vector<Index>& nodes) {
    for (const Axis axis : {Axis::x, Axis::y, Axis::z}) fix(nodes, axis);
  }
  void fix(const Patch& patch, Axis axis) { fix(mesh::patch_nodes(patch), axis); }
  void fix(const std::vector<Index>& nodes, Axis axis) {
    for (const Index n : nodes) body_.fix(n, axis);
  }
  /// Laws of regions, fibres, a stored prestress: laws().material(region, law) and so on.
  [[nodiscard]] auto& laws() { return body_.laws(); }
  template <class Field>
  void point_field(const Field& field) {
    body_.point_field(field);
  }
  /// Springs on a patch, relaxed in the reference; dashpots do not count in statics.
  void support(const Patch& patch, const Support& support) { body_.add_support(patch, support); }
  /// Prescribes a component at its end value [m].
  void prescribe(Index node, Axis axis, double displacement) {
    leave_path();
    body_.fix(node, axis);
    prescribed_end_[3 * node + static_cast<int>(axis)] = displacement;
  }
  /// Dead nodal force [N]; replaces the one there was.
  void force(Index node, const Vec3& f) {
    leave_path();
    dead_end_.segment<3>(3 * body_.known(node)) = f;
  }
  /// Follower pressure [Pa] on a patch; returns its number, with which it can be changed.
  std::size_t pressure(const Patch& patch, double p) {
    leave_path();
    const std::size_t number = body_.add_pressure(patch);
    for (auto* v : {&pressure_end_, &pressure_start_}) {
      v->conservativeResize(static_cast<Eigen::Index>(number) + 1);
      (*v)[static_cast<Eigen::Index>(number)] = 0;
    }
    pressure(number, p);
    return number;
  }
  void pressure(std::size_t number, double p) {
    leave_path();
    pressure_end_[static_cast<Eigen::Index>(number)] = p;
  }

  /// Starts from another displacement, 3 x nodes [m].
  void start(const Points<3>& u) {
    u_.head(u.size()) = u.reshaped();
    leave_path();
    u_start_ = u_;
  }

  /// Whether the loads are reached.
  [[nodiscard]] bool done() const { return load_ >= 1; }

  /// The next load step that holds, with as many cuts as it takes; not beyond the load `limit`. `diverged`
  /// (or Newton's status) if the steps become too small; displacement() is then the last equilibrium found.
  StaticsStep step(double limit = 1) {
    StaticsStep report{.load = load_};
    double length = std::min(1.0, step_);
    while (load_ < limit) {
      const double next = load_ + length > limit - 1e-9 ? limit : load_ + length;
      Problem problem{*this, next};
      Eigen::VectorXd u = u_;
      const la::NewtonReport newton = advance(problem, u);
      tell(newton, body_.unknowns() - 3 * body_.mesh().node_count(), report);
      if (newton) {
        step_ = newton.solve.iterations <= options_.easy_iterations ? length * options_.growth : length;
        accept(u, next);
        report.load = load_;
        return report;
      }
      if (newton.inadmissible) report.inverted_cell = body_.inverted_cell();
      ++report.cuts;
      length = 0.5 * (next - load_);
      if (length < options_.smallest_step) {
        step_ = options_.first_step;
        return report;
      }
    }
    report.solve.status = Status::converged;
    return report;
  }

  /// Steps until the loads are reached or a step is given up.
  StaticsReport solve() {
    StaticsReport report{.load = load_};
    if (done()) leave_path();
    while (!done()) {
      report.path.push_back(step());
      tell(report.path.back(), report);
      if (!report.path.back()) return report;
    }
    report.solve.status = Status::converged;
    return report;
  }

  /// Stores the deformation reached, F_p <- (1 + du/dX) F_p, and puts the displacement back to zero; the
  /// loads reached stay, and the mesh, which now carries the stresses [GEE10].
  void absorb() {
    auto stored = body_.laws().prestress();
    stored.resize(static_cast<std::size_t>(body_.mesh().cell_count()) * Element::points,
                  Eigen::Matrix3d::Identity());
    auto at = stored.begin();
    for (Index e = 0; e < body_.mesh().cell_count(); ++e)
      for (const auto& F : Element::deformation(body_.reference(e), body_.gather(e, u_))) {
        *at = (F * *at).eval();
        ++at;
      }
    body_.laws().prestress(std::move(stored));
    leave_path();
    u_.head(3 * body_.mesh().node_count()).setZero();  // pressures of nodes stay
    u_start_ = u_;
  }

  /// The pressures reached hold the volumes of the cells from now on, see Interior; largest |v/V - 1|.
  double augment() { return body_.inside().augment(); }

  /// Displacements of all nodes, 3 x nodes [m].
  [[nodiscard]] Points<3> displacement() const { return body_.at_nodes(u_); }
  [[nodiscard]] const Body<C, Material>& body() const { return body_; }
  [[nodiscard]] const Eigen::VectorXd& unknowns() const { return u_; }
  [[nodiscard]] const StaticsOptions& options() const { return options_; }
  [[nodiscard]] const Solver& solver() const { return newton_.solver(); }
  /// Of unknown k at the end of the path [m]; 0 where none is prescribed.
  [[nodiscard]] double prescribed(Index k) const { return prescribed_end_[k]; }

  // What follows is for other ways along the path of loads: ArcLength, VolumeControl.

  [[nodiscard]] Solver& borrow_solver() { return newton_.borrow_solver(); }
  /// The load reached: 0 where the path starts, 1 at its end; beyond both for ArcLength.
  [[nodiscard]] double load() const { return load_; }
  /// Takes u, in equilibrium at that load, for the state reached.
  void accept(const Eigen::VectorXd& u, double load) {
    u_ = u;
    load_ = load;
  }
  /// The state and the loads reached become the start of a new path, which ends there too.
  void hold() {
    leave_path();
    dead_end_ = dead_start_;
    pressure_end_ = pressure_start_;
    for (Index k = 0; k < body_.unknowns(); ++k)
      if (body_.fixed(k)) prescribed_end_[k] = u_[k];
  }
  [[nodiscard]] Eigen::VectorXd pressures(double load) const {
    return (1 - load) * pressure_start_ + load * pressure_end_;
  }
  /// f_ext [N] at u: dead forces and follower pressures.
  [[nodiscard]] Eigen::VectorXd external(const Eigen::VectorXd& u, double load) const {
    Eigen::VectorXd f = (1 - load) * dead_start_ + load * dead_end_;
    body_.add_pressure_forces(u, pressures(load), f);
    return f;
  }
  /// r = f_int + f_supports - f_ext [N], zero at prescribed unknowns.
  la::ResidualInfo residual(const Eigen::VectorXd& u, double load, Eigen::VectorXd& r, double step) {
    const bool admissible = body_.internal_forces(u, step, r, predicted_);
    Eigen::VectorXd outer = external(u, load);
    const double scale = std::hypot(r.norm(), outer.norm());
    if (body_.supported()) {
      Eigen::VectorXd held = Eigen::VectorXd::Zero(u.size());
      body_.add_support_forces(u, Eigen::VectorXd::Zero(u.size()), held);
      outer -= held;
    }
    for (auto* v : {&r, &predicted_}) {
      *v -= outer;
      body_.clear_fixed(*v);
    }
    return {
        .admissible = admissible, .scale = scale, .rounding = body_.rounding(), .merit = predicted_.norm()};
  }
  void direction(const Eigen::VectorXd& du) { body_.direction(du); }
  /// Of the last residual along du, with the pressures predicted for it [J].
  [[nodiscard]] double work(const Eigen::VectorXd& du) const {
    const Eigen::Index moved = 3 * body_.mesh().node_count();
    return predicted_.head(moved).dot(du.head(moved));
  }
  void tangent(const Eigen::VectorXd& u, double load, la::SparseMatrix& A) const {
    body_.tangent(u, pressures(load), {.symmetric_load = Solver::symmetric}, A);
  }
  /// d external forces / d load at u, zero at prescribed unknowns.
  [[nodiscard]] Eigen::VectorXd load_slope(const Eigen::VectorXd& u) const {
    Eigen::VectorXd slope = dead_end_ - dead_start_;
    body_.add_pressure_forces(u, pressure_end_ - pressure_start_, slope);
    body_.clear_fixed(slope);
    return slope;
  }

 private:
  struct Problem {
    Statics& statics;
    double load;

    la::ResidualInfo residual(const Eigen::VectorXd& u, Eigen::VectorXd& r, double step) {
      return statics.residual(u, load, r, step);
    }
    void direction(const Eigen::VectorXd& du) { statics.direction(du); }
    [[nodiscard]] double work(const Eigen::VectorXd& du) const { return statics.work(du); }
    void tangent(const Eigen::VectorXd& u, la::SparseMatrix& A) { statics.tangent(u, load, A); }
    [[nodiscard]] const auto& tangent_blocks(const Eigen::VectorXd& u) {
      return statics.body_.tangent_blocks(u, statics.pressures(load), {.symmetric_load = Solver::symmetric});
    }
    [[nodiscard]] la::SparseMatrix pattern() const { return statics.body_.pattern(); }
  };

  /// A new path starts at the state and the loads that were reached.
  void leave_path() {
    if (load_ == 0) return;
    dead_start_ = (1 - load_) * dead_start_ + load_ * dead_end_;
    pressure_start_ = pressures(load_);
    u_start_ = u_;
    load_ = 0;
    step_ = options_.first_step;
  }

  /// One load step. Prescribed displacements move first, the rest following along the tangent at the
  /// old state: u += d with d = (their increment, -K_ff^-1 K_fp times it).
  la::NewtonReport advance(Problem& problem, Eigen::VectorXd& u) {
    Eigen::VectorXd d = Eigen::VectorXd::Zero(u.size());
    const double t = problem.load;
    for (Index k = 0; k < body_.unknowns(); ++k)
      if (body_.fixed(k)) d[k] = (1 - t) * u_start_[k] + t * prescribed_end_[k] - u[k];
    newton_.forget();
    if (!(d.squaredNorm() == 0) && !follow(newton_, problem, u, d)) {
      la::NewtonReport failed;
      failed.solve.status = Status::diverged;
      failed.inadmissible = body_.inverted_cell() >= 0;
      return failed;
    }
    return newton_.solve(problem, u);
  }

  Body<C, Material> body_;
  StaticsOptions options_;
  double load_ = 0, step_;
  la::Newton<Solver> newton_;
  Eigen::VectorXd u_, u_start_, dead_end_, dead_start_, prescribed_end_, predicted_;
  Eigen::VectorXd pressure_end_, pressure_start_;
};
template <mesh::Cell C, class Material>
Statics(const mesh::Mesh<C, 3>&, const Material&, StaticsOptions = {}) -> Statics<C, Material>;

}  // namespace tunica::solid
