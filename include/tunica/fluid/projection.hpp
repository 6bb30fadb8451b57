// SPDX-License-Identifier: MIT
// Navier-Stokes on moving linear tetrahedra: rotational incremental projection, BDF2, stabilised by
// orthogonal projection. [PEREZ08, (1), (14), 6.1 c; ONATE06; GUERMOND06]
#pragma once

#include "tunica/core/expect.hpp"
#include "tunica/core/solve_report.hpp"
#include "tunica/fluid/bdf.hpp"
#include "tunica/fluid/conditions.hpp"
#include "tunica/fluid/interface_force.hpp"
#include "tunica/fluid/predictor.hpp"
#include "tunica/fluid/pressure_step.hpp"
#include "tunica/fluid/start.hpp"
#include "tunica/fluid/state.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tunica::fluid {

/// The nodes move by what move() is given, or never: then no geometry is computed twice.
struct MovingMesh {
  static constexpr bool moving = true;
};
struct FixedMesh {
  static constexpr bool moving = false;
};

struct ProjectionOptions {
  int passes = 1;                    // predictor-corrector passes a step; 2 or 3 for accuracy in time
  double rotational = 1;             // chi of p -= chi mu div u*; 0: the standard form, a larger error
  double momentum_tolerance = 1e-8;  // relative to the residual of the extrapolated velocity
  double pressure_tolerance = 1e-8;  // relative to the imbalance that the pressure has to remove
  int max_iterations = 1000;         // of each linear solver
};

/// Incompressible flow with equal order velocity and pressure. [m], [m/s], [Pa], [s].
///   Projection blood{lumen, Newtonian{.density = 1050, .viscosity = 0.0035}, Fic{}};
///   blood.velocity("inlet", inlet_profile(lumen, "inlet"), [](double t) { return 0.1; });
///   blood.pressure("outlet", 0.0);
///   for (...) if (const auto report = blood.step(1e-3); !report) ...
/// A step starts from the present state and replaces it; a step that failed leaves it as it was, and
/// restore() returns to the state of save(). The result of move() and step() is a function of the
/// present state and their arguments, to the last bit, on any number of threads.
template <Rheology R, Stabilization S = Fic, class Grid = MovingMesh>
class Projection {
 public:
  Projection(const mesh::TetMesh& mesh, const R& fluid, const S& stabilization = {}, Grid = {},
             ProjectionOptions options = {})
      : fluid_(fluid),
        stabilization_(stabilization),
        options_(options),
        reference_(mesh.nodes),
        cells_(mesh.cells),
        pattern_(mesh),
        conditions_(mesh),
        pressure_step_(pattern_, mesh.nodes, volume(mesh)),
        predictor_(pattern_) {
    state_.position = state_.position_old = next_ = mesh.nodes;
    state_.velocity = state_.velocity_old = w_ = Points<3>::Zero(3, mesh.nodes.cols());
    state_.pressure = state_.pressure_old = Eigen::VectorXd::Zero(mesh.nodes.cols());
    if (!tets_.update(next_, cells_))
      throw MeshError("the fluid's tetrahedron " + std::to_string(tets_.inverted()) + " is inverted");
    lump();
  }

  // What holds on a patch: a constant, f(t) or f(x, t). Patches without a condition are walls.
  void velocity(std::string_view patch, BoundaryFunction<Vec3> value) {  // [m/s]
    Condition& c = conditions_[patch];
    c.kind = Kind::velocity, c.velocity = std::move(value), c.profile.resize(3, 0);
    conditions_.flag();
  }
  void velocity(std::string_view patch, const Profile& profile, BoundaryFunction<double> mean) {  // [m/s]
    Condition& c = conditions_[patch];
    TUNICA_EXPECT(profile.nodes == c.nodes, "the profile belongs to another patch");
    c.kind = Kind::velocity, c.scalar = std::move(mean), c.profile = profile.velocity;
    conditions_.flag();
  }
  /// -p n + mu du/dn = -value n on the patch [Pa].
  void pressure(std::string_view patch, BoundaryFunction<double> value, Outlet outlet = {}) {
    Condition& c = conditions_[patch];
    c.kind = Kind::pressure, c.scalar = std::move(value), c.backflow = outlet.backflow;
    conditions_.flag();
  }
  /// Force a volume [N/m3].
  void body_force(BoundaryFunction<Vec3> value) { body_force_ = std::move(value), forced_ = true; }
  /// The wall on which interface_force() is computed: one of the patches without a condition.
  void interface(std::string_view patch) {
    interface_ = InterfaceForce(conditions_[patch], conditions_, cells_);
  }

  [[nodiscard]] double time() const { return state_.time; }                          // [s]
  [[nodiscard]] const Points<3>& velocity() const { return state_.velocity; }        // 3 x nodes [m/s]
  [[nodiscard]] const Eigen::VectorXd& pressure() const { return state_.pressure; }  // nodes [Pa]
  [[nodiscard]] const Points<3>& position() const { return state_.position; }        // 3 x nodes [m]
  [[nodiscard]] const Points<3>& grid_velocity() const { return w_; }                // of the last step [m/s]
  [[nodiscard]] const MassBalance& mass_balance() const { return state_.mass; }      // of the last step
  [[nodiscard]] const Conditions& conditions() const { return conditions_; }
  [[nodiscard]] const std::vector<Index>& interface_nodes() const { return interface_.nodes(); }  // ascending
  /// Consistent nodal forces of the fluid on the wall after the last step, 3 x interface nodes [N]. (12)
  [[nodiscard]] const Points<3>& interface_force() const { return state_.force; }
  /// The first cell that the last move() inverted, or -1.
  [[nodiscard]] Index inverted() const { return inverted_; }

  /// The fields at the present time, for a run that does not start from rest; p only counts after
  /// start(), or is found there. 3 x nodes [m/s], nodes [Pa].
  void set(const Points<3>& u, const Eigen::VectorXd& p) {
    state_.velocity = state_.velocity_old = u;
    state_.pressure = state_.pressure_old = p;
    state_.started = 1;
  }
  void set(const Points<3>& u) {
    state_.velocity = state_.velocity_old = u;
    state_.started = 0;
  }

  /// The shape at the end of the coming step of dt: displacement of all nodes from the reference, 3 x
  /// nodes [m]. Takes no step.
  void move(const Points<3>& displacement, [[maybe_unused]] double dt) requires(Grid::moving) {
    TUNICA_EXPECT(displacement.cols() == reference_.cols(), "one displacement a node");
    next_ = reference_ + displacement;
  }

  /// Finds the state at time 0 when none was given: the velocity made discretely divergence-free and the
  /// pressure that balances it. step() does it on its first call; dt [s] of that step.
  SolveReport start(double dt) {
    const double t = state_.time;
    if (!tets_.update(state_.position, cells_)) return {Status::diverged, 0, 0};
    lump();
    w_.setZero(3, reference_.cols());
    u_ = state_.velocity;
    conditions_.impose_velocity(state_.position, w_, t, u_);
    evaluate_force(t, state_.position);
    const Domain domain = this->domain(state_.position);
    la::KrylovOptions options = pressure_options();
    options.tolerance = 1e-12;  // once a run: what is wrong here would be seen as a motion
    Eigen::VectorXd zero = Eigen::VectorXd::Zero(reference_.cols());
    const Points<3> no_force(3, 0);
    pressure_step_.assemble_projection(domain, dt / fluid_.density);
    p_ = zero;
    SolveReport report = pressure_step_.correct(domain, no_force, 0, options, zero, zero, u_, p_);
    if (!report) return report;
    // (grad q, grad p0) = (grad q, f - rho u.grad u) - rho int q du/dt . n, p0 prescribed on its patches
    next_u_ = u_;
    conditions_.impose_velocity(state_.position, w_, t + dt, next_u_);
    pressure_step_.assemble_laplacian(domain);
    Points<3> rate;
    combine(1 / dt, next_u_, -1 / dt, u_, rate);
    conditions_.impose_pressure(state_.position, t, p_);
    const Eigen::VectorXd right =
        initial_source(domain, fluid_.density, u_, rate, force_) + pressure_step_.prescribe(domain, p_);
    report = pressure_step_.solve(domain, right, 0, options, p_);
    if (!report) return report;
    state_.velocity = state_.velocity_old = u_;
    state_.pressure = state_.pressure_old = p_;
    state_.started = 1;
    return report;
  }

  /// Advances by dt [s]. `diverged`: a NaN, or an inverted cell (see inverted()); the state then stays.
  /// iterations: of the pressure; residual: the worst of the linear solvers, relative.
  SolveReport step(double dt) {
    if (state_.started == 0)
      if (const SolveReport report = start(dt); !report) return report;
    const bool first = state_.dt_last == 0;
    const Bdf bdf = first ? bdf1(dt) : bdf2(dt, state_.dt_last);
    if constexpr (Grid::moving) {
      const bool sound = tets_.update(next_, cells_);
      inverted_ = tets_.inverted();
      if (!sound) return {Status::diverged, 0, 0};
      lump();
      // w: the difference that differentiates u too; with (x^{n+1} - x^n)/dt the scheme is of first order
      combine(bdf.last, state_.position, bdf.before, state_.position_old, w_);
      combine(bdf.now, next_, 1, w_, w_);
    }
    const double t = state_.time + dt;
    const Domain domain = this->domain(next_);
    combine(bdf.extrapolate_last, state_.velocity, bdf.extrapolate_before, state_.velocity_old, u_);
    conditions_.impose_velocity(next_, w_, t, u_);
    combine(bdf.last, state_.velocity, bdf.before, state_.velocity_old, history_);
    p_ = state_.pressure;
    evaluate_force(t, next_);
    // The first pass starts from p^n: the traction that goes with it is that of t^n. What the prescribed
    // pressure has changed since comes with the increment; a load at t^{n+1} would lag by a step.
    conditions_.impose_pressure(state_.position, state_.time, prescribed_);
    conditions_.impose_pressure(next_, t, prescribed_now_);
    change_ = prescribed_now_ - prescribed_;
    guess_ = first ? Eigen::VectorXd(change_) : Eigen::VectorXd(state_.pressure - state_.pressure_old);

    combine(1, u_, -1, w_, a_);
    pressure_step_.assemble(domain, fluid_, stabilization_, a_, u_, 1 / (fluid_.density * bdf.now));
    SolveReport report{Status::converged, 0, 0};
    for (int pass = 0; pass < options_.passes; ++pass) {
      if (pass > 0)
        combine(1, u_, -1, w_, a_), change_.setZero(), guess_.setZero(), prescribed_ = prescribed_now_;
      SolveReport solved = predictor_.solve(
          domain, fluid_, stabilization_, {a_, u_, history_, p_, force_, predictor_.smoothed(), bdf.now},
          prescribed_, {.tolerance = options_.momentum_tolerance, .max_iterations = options_.max_iterations},
          u_);
      if (solved) {
        solved = pressure_step_.correct(domain, force_, options_.rotational * thin_viscosity(),
                                        pressure_options(), guess_, change_, u_, p_);
        report.iterations += solved.iterations;
      }
      report.residual = std::max(report.residual, solved.residual);
      report.status = solved.status;
      if (!solved) return report;
    }
    if (!finite(u_.data(), u_.size()) || !finite(p_.data(), p_.size()))
      return {Status::diverged, report.iterations, report.residual};
    state_.mass = pressure_step_.balance(domain, u_, w_);
    if (!interface_.nodes().empty()) {
      combine(bdf.now, u_, 1, history_, next_u_);
      combine(1, u_, -1, w_, a_);
      state_.force = interface_.evaluate(domain, fluid_, stabilization_, prescribed_now_,
                                         ForceFields{.a = a_,
                                                     .u = u_,
                                                     .rate = next_u_,
                                                     .p = p_,
                                                     .force = force_,
                                                     .smoothed = predictor_.smoothed()});
    }
    state_.velocity_old.swap(state_.velocity), state_.velocity = u_;
    state_.pressure_old.swap(state_.pressure), state_.pressure = p_;
    if constexpr (Grid::moving) state_.position_old.swap(state_.position), state_.position = next_;
    state_.time = t, state_.dt_last = dt;
    return report;
  }

  /// One slot. A step is accepted by not going back.
  void save() { saved_ = state_; }
  void restore() { state_ = saved_, next_ = state_.position; }

  /// a("name", member) for all that a restart needs; the conditions are those of the program.
  template <class Archive>
  void archive(Archive& a) {
    state_.archive(a);
    next_ = state_.position;
  }

 private:
  [[nodiscard]] Domain domain(const Points<3>& x) const {
    return {pattern_, cells_, tets_, x, inverse_mass_, conditions_};
  }
  [[nodiscard]] la::KrylovOptions pressure_options() const {
    return {.tolerance = options_.pressure_tolerance, .max_iterations = options_.max_iterations};
  }
  /// The rotational update holds for one viscosity: the smallest, that of fast shear, is on the safe side.
  [[nodiscard]] double thin_viscosity() const { return fluid_.viscosity_at(1e9); }

  [[nodiscard]] static double volume(const mesh::TetMesh& mesh) {
    double sum = 0;
    for (Index e = 0; e < mesh.cell_count(); ++e) sum += fem::p1_tet(mesh.nodes, mesh.cells, e).volume;
    return sum;
  }

  void lump() {
    inverse_mass_.setZero(reference_.cols());
    for (Index e = 0; e < cells_.cols(); ++e)
      for (int i = 0; i < 4; ++i) inverse_mass_[cells_(i, e)] += tets_[e].volume / 4;
    inverse_mass_ = inverse_mass_.cwiseInverse();
  }

  void evaluate_force(double t, const Points<3>& x) {
    force_.resize(3, forced_ ? x.cols() : 0);
    for (Eigen::Index i = 0; i < force_.cols(); ++i)
      set_column(force_, static_cast<Index>(i), body_force_(column(x, static_cast<Index>(i)), t));
  }

  R fluid_;
  S stabilization_;
  ProjectionOptions options_;
  Points<3> reference_;
  Connectivity<4> cells_;
  Pattern pattern_;
  Conditions conditions_;
  InterfaceForce interface_;
  BoundaryFunction<Vec3> body_force_;
  bool forced_ = false;

  State state_, saved_;
  Points<3> next_;  // positions at the end of the coming step
  Index inverted_ = -1;

  fem::P1Tets tets_;
  Eigen::VectorXd inverse_mass_;
  PressureStep<> pressure_step_;
  Predictor predictor_;
  Points<3> u_, a_, w_, next_u_, history_, force_;
  Eigen::VectorXd p_, prescribed_, prescribed_now_, change_, guess_;
};

}  // namespace tunica::fluid
