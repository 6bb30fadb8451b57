// SPDX-License-Identifier: MIT
// Implicit dynamics of a hyperelastic body by generalised-alpha [CHUNG93]: the structure of a coupled run.
#pragma once

#include "tunica/core/expect.hpp"
#include "tunica/la/direct.hpp"
#include "tunica/la/newton.hpp"
#include "tunica/la/time_scheme.hpp"
#include "tunica/solid/archive_whole.hpp"
#include "tunica/solid/dynamics_options.hpp"
#include "tunica/solid/energy_balance.hpp"
#include "tunica/solid/history.hpp"
#include "tunica/solid/nodal_pressures.hpp"
#include "tunica/solid/stress.hpp"

#include <Eigen/Core>

#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace tunica::solid {

/// M a + f_int(u) + supports = f, from t^n to t^{n+1} with any dt. Loads are those at t^{n+1}.
///   Dynamics wall{mesh, Hyperelastic{Yeoh{...}, Quadratic{...}}, 1100.0};
///   wall.fix(mesh.patch("ends"));  wall.interface(mesh.patch("inner"));
///   wall.save();                                     // t^n
///   for (...) { wall.restore(); wall.load(f); if (!wall.step(dt)) ...; wall.displacement(); }
template <mesh::Cell C, class Material, la::LinearSolver Solver = DefaultSolver<C, Material>>
class Dynamics {
  static_assert(Body<C, Material>::symmetric || !Solver::symmetric,
                "this tangent is not symmetric: it wants a solver such as la::Lu");

 public:
  using Patch = mesh::Patch<typename C::Face>;

  /// Nodes in [m], density in [kg/m3]; at rest, unloaded. A linear solver may be given: see Statics.
  Dynamics(const mesh::Mesh<C, 3>& mesh, const Material& material, double density,
           DynamicsOptions options = {}, Solver solver = {})
      : Dynamics(mesh, material, density, options.scheme, options, std::move(solver)) {}
  /// With another scheme than that of the options: la::Newmark{}.
  template <la::SecondOrderScheme Scheme>
  Dynamics(const mesh::Mesh<C, 3>& mesh, const Material& material, double density, const Scheme& scheme,
           DynamicsOptions options = {}, Solver solver = {})
      : body_(mesh, material, density, options.mass),
        scheme_(scheme.second_order()),
        newton_(options.newton, std::move(solver)) {
    TUNICA_EXPECT(density > 0, "dynamics needs a mass");
    for (auto* v : {&state_.u, &state_.v, &state_.a, &state_.f, &load_})
      *v = Eigen::VectorXd::Zero(body_.unknowns());
    body_.fix_loose_nodes();
    save();
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
  /// Springs and dashpots on a patch, relaxed in the reference.
  void support(const Patch& patch, const Support& support) { body_.add_support(patch, support); }

  /// The patch that meets the fluid; its nodes, ascending, are the columns of load and displacement.
  void interface(const Patch& patch) { interface_nodes_ = mesh::patch_nodes(patch); }
  [[nodiscard]] const std::vector<Index>& interface_nodes() const { return interface_nodes_; }

  /// Dead forces at the interface nodes at t^{n+1}, 3 x interface nodes [N]; they stay until changed.
  void load(const Points<3>& force) {
    TUNICA_EXPECT(force.cols() == static_cast<Eigen::Index>(interface_nodes_.size()),
                  "one force an interface node");
    for (std::size_t k = 0; k < interface_nodes_.size(); ++k)
      load_.segment<3>(3 * interface_nodes_[k]) = force.col(static_cast<Eigen::Index>(k));
  }
  /// Dead force on any node at t^{n+1} [N].
  void force(Index node, const Vec3& f) { load_.segment<3>(3 * body_.known(node)) = f; }
  /// Adds a follower pressure [Pa] on a patch; returns its number, with which it is changed.
  std::size_t pressure(const Patch& patch, double p) {
    const std::size_t number = body_.add_pressure(patch);
    for (auto* v : {&pressure_, &state_.p, &saved_.p}) {
      v->conservativeResize(static_cast<Eigen::Index>(number) + 1);
      (*v)[static_cast<Eigen::Index>(number)] = 0;
    }
    pressure(number, p);
    return number;
  }
  void pressure(std::size_t number, double p) { pressure_[static_cast<Eigen::Index>(number)] = p; }

  /// Starts at displacement and velocity (3 x nodes, [m], [m/s]) with the present loads; the
  /// acceleration follows from the equation of motion. Then save()s. `diverged` if a cell has J <= 0.
  SolveReport start(const Points<3>& u, const Points<3>& v) {
    state_.u.head(u.size()) = u.reshaped();
    state_.v.head(v.size()) = v.reshaped();
    state_.f = load_;
    state_.p = pressure_;
    body_.clear_fixed(state_.v);
    Solver& solver = newton_.borrow_solver();
    if constexpr (Body<C, Material>::per_node == 4)  // the pressures that belong to u
      if (const auto report = nodal_pressures(body_, pressure_, solver, state_.u);
          !report && body_.inverted_cell() < 0)
        return report;
    Eigen::VectorXd f, predicted, external = load_;
    const bool admissible = body_.internal_forces(state_.u, la::no_step, f, predicted);
    inverted_cell_ = body_.inverted_cell();
    if (!admissible) return {Status::diverged, 0, 0};
    body_.add_pressure_forces(state_.u, pressure_, external);
    body_.add_support_forces(state_.u, state_.v, f);
    external -= f;
    body_.clear_fixed(external);
    la::SparseMatrix M = body_.pattern();
    body_.tangent(state_.u, pressure_, {.stiffness = 0, .mass = 1}, M);
    solver.analyse(M);
    if (const auto report = solver.factorise(M); !report) return report;
    const auto report = solver.solve(external, state_.a);
    save();
    return report;
  }

  /// One step; on failure the state stays at t^n. `diverged`: a NaN, or no way round J <= 0 (then
  /// inverted_cell() names the cell). Residual: |r| over the largest of the forces that balance.
  SolveReport step(double dt) {
    TUNICA_EXPECT(dt > 0, "time goes forward");
    Problem problem{*this, dt};
    const bool again = restored_ && dt == iterate_dt_;
    if (dt != iterate_dt_) newton_.forget();
    Eigen::VectorXd u = again ? iterate_ : state_.u;
    if constexpr (has_history<Body<C, Material>>) solid::begin_step(body_.laws(), scheme_.af * dt);  // n+af
    const la::NewtonReport report = newton_.solve(problem, u);
    if constexpr (has_history<Body<C, Material>>) solid::begin_step(body_.laws(), 0);
    last_ = report;
    inverted_cell_ = report.inadmissible ? body_.inverted_cell() : -1;
    restored_ = false;
    iterate_dt_ = 0;
    if (!report) return report.solve;
    if constexpr (has_history<Body<C, Material>>) {
      solid::begin_step(body_.laws(), dt);
      advance(body_.laws(), body_, u);
    }
    before_ = {.u = state_.u, .v = state_.v};
    state_ = {u, problem.velocity(u), problem.acceleration(u), load_, pressure_, state_.history};
    iterate_ = u;
    iterate_dt_ = dt;
    return report.solve;
  }

  /// Keeps the present state as t^n. The tangent is made anew in the next step, so what follows
  /// depends on the state alone: a restarted run has the bits of the unbroken one.
  void save() {
    if constexpr (has_history<Body<C, Material>>) state_.history = remembered(body_.laws());
    saved_ = state_;
    restored_ = false;
    newton_.forget();
  }
  /// Back to t^n; the next step(dt) starts its iteration from the displacement reached before.
  void restore() {
    state_ = saved_;
    if constexpr (has_history<Body<C, Material>>) remember(body_.laws(), state_.history);
    restored_ = iterate_dt_ > 0;
  }

  /// Interface nodes: 3 x interface nodes [m], [m/s].
  [[nodiscard]] Points<3> displacement() const { return at_interface(state_.u); }
  [[nodiscard]] Points<3> velocity() const { return at_interface(state_.v); }
  /// All nodes: 3 x nodes [m], [m/s], [m/s2].
  [[nodiscard]] Points<3> nodal_displacement() const { return body_.at_nodes(state_.u); }
  [[nodiscard]] Points<3> nodal_velocity() const { return body_.at_nodes(state_.v); }
  [[nodiscard]] Points<3> nodal_acceleration() const { return body_.at_nodes(state_.a); }

  /// Von Mises stress of the Cauchy stress, one number a cell or node [Pa].
  [[nodiscard]] Eigen::VectorXd cell_von_mises() const { return von_mises(cell_stress(body_, state_.u)); }
  [[nodiscard]] Eigen::VectorXd nodal_von_mises() const { return von_mises(nodal_stress(body_, state_.u)); }

  [[nodiscard]] double strain_energy() const { return body_.strain_energy(state_.u); }    // [J]
  [[nodiscard]] double kinetic_energy() const { return body_.kinetic_energy(state_.v); }  // [J]
  /// Of the last step that held.
  [[nodiscard]] EnergyBalance energy_balance() const {
    return before_.u.size() == 0 ? EnergyBalance{}
                                 : solid::energy_balance(body_, before_, state_, external_, scheme_.af);
  }

  /// Of the last step: Newton's history; the cell with J <= 0 on which it failed, else -1.
  [[nodiscard]] const la::NewtonReport& last() const { return last_; }
  [[nodiscard]] Index inverted_cell() const { return inverted_cell_; }
  [[nodiscard]] const Body<C, Material>& body() const { return body_; }

  /// Hands its state to a checkpoint, or takes it from there: a(name, vector) for each part. The state is
  /// then also the saved one. InputError if it is that of another body.
  template <class A>
  void archive(A& a) {
    archive_whole(a, "displacement", state_.u);
    archive_whole(a, "velocity", state_.v);
    archive_whole(a, "acceleration", state_.a);
    archive_whole(a, "force", state_.f);
    archive_whole(a, "pressure", state_.p);
    archive_whole(a, "load", load_);
    archive_whole(a, "load_pressure", pressure_);
    if constexpr (has_history<Body<C, Material>>) {
      state_.history = remembered(body_.laws());
      archive_whole(a, "history", state_.history);
      remember(body_.laws(), state_.history);
    }
    iterate_dt_ = 0;
    save();
  }

 private:
  struct State {
    Eigen::VectorXd u, v, a{}, f{}, p{};  // f, p: loads at t^n
    Eigen::VectorXd history{};            // of laws that have one
  };

  struct Problem {
    Dynamics& d;
    double dt;
    typename Body<C, Material>::TangentParts parts{
        .stiffness = d.scheme_.af,
        .mass = d.scheme_.am / (d.scheme_.beta * dt * dt),
        .damping = d.scheme_.af * d.scheme_.gamma / (d.scheme_.beta * dt),
        .symmetric_load = Solver::symmetric};

    [[nodiscard]] Eigen::VectorXd acceleration(const Eigen::VectorXd& u) const {
      const State& n = d.state_;
      const double beta = d.scheme_.beta;
      return (u - n.u - dt * n.v) / (beta * dt * dt) - (0.5 - beta) / beta * n.a;
    }
    [[nodiscard]] Eigen::VectorXd velocity(const Eigen::VectorXd& u) const {
      const State& n = d.state_;
      return n.v + dt * ((1 - d.scheme_.gamma) * n.a + d.scheme_.gamma * acceleration(u));
    }
    [[nodiscard]] Eigen::VectorXd between(const Eigen::VectorXd& old, const Eigen::VectorXd& now) const {
      return old + d.scheme_.af * (now - old);
    }

    // r = M a^{n+am} + f_int(u^{n+af}) + S(u^{n+af}, v^{n+af}) - f^{n+af}
    la::ResidualInfo residual(const Eigen::VectorXd& u, Eigen::VectorXd& r, double step) {
      const State& n = d.state_;
      const Eigen::VectorXd u_af = between(n.u, u), a_am = n.a + d.scheme_.am * (acceleration(u) - n.a);
      const bool admissible = d.body_.internal_forces(u_af, step, r, d.predicted_);
      d.external_ = between(n.f, d.load_);
      d.body_.add_pressure_forces(u_af, between(n.p, d.pressure_), d.external_);
      d.inertia_.setZero(r.size());
      d.body_.add_inertia(a_am, 1, d.inertia_);
      const double scale = std::hypot(r.norm(), d.external_.norm(), d.inertia_.norm());
      if (d.body_.supported()) d.body_.add_support_forces(u_af, between(n.v, velocity(u)), d.inertia_);
      for (auto* v : {&r, &d.predicted_}) {
        *v += d.inertia_ - d.external_;
        d.body_.clear_fixed(*v);
      }
      return {.admissible = admissible,
              .scale = scale,
              .rounding = d.body_.rounding(),
              .merit = d.predicted_.norm()};
    }
    void direction(const Eigen::VectorXd& du) { d.body_.direction(d.scheme_.af * du); }
    void tangent(const Eigen::VectorXd& u, la::SparseMatrix& A) {
      d.body_.tangent(between(d.state_.u, u), between(d.state_.p, d.pressure_), parts, A);
    }
    [[nodiscard]] const auto& tangent_blocks(const Eigen::VectorXd& u) {
      return d.body_.tangent_blocks(between(d.state_.u, u), between(d.state_.p, d.pressure_), parts);
    }
    [[nodiscard]] la::SparseMatrix pattern() const { return d.body_.pattern(); }
  };

  [[nodiscard]] Points<3> at_interface(const Eigen::VectorXd& x) const {
    Points<3> y(3, static_cast<Eigen::Index>(interface_nodes_.size()));
    for (std::size_t k = 0; k < interface_nodes_.size(); ++k)
      y.col(static_cast<Eigen::Index>(k)) = x.segment<3>(3 * interface_nodes_[k]);
    return y;
  }

  Body<C, Material> body_;
  la::SecondOrder scheme_;
  la::Newton<Solver> newton_;
  State state_, saved_, before_;
  Eigen::VectorXd load_, pressure_;  // at t^{n+1}
  Eigen::VectorXd iterate_;          // u^{n+1} of the last step
  double iterate_dt_ = 0;            // its dt; 0: there is none
  bool restored_ = false;            // the state was restored since, so iterate_ is a good start
  Eigen::VectorXd external_, inertia_, predicted_;
  std::vector<Index> interface_nodes_;
  la::NewtonReport last_;
  Index inverted_cell_ = -1;
};
template <mesh::Cell C, class Material>
Dynamics(const mesh::Mesh<C, 3>&, const Material&, double, DynamicsOptions = {}) -> Dynamics<C, Material>;
template <mesh::Cell C, class Material, la::SecondOrderScheme Scheme>
Dynamics(const mesh::Mesh<C, 3>&, const Material&, double, Scheme, DynamicsOptions = {})
    -> Dynamics<C, Material>;

}  // namespace tunica::solid
