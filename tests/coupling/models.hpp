// SPDX-License-Identifier: MIT
// Reduced models of the subsolvers: a column of fluid on a piston, and the tube of [CGN05].
#pragma once

#include "tunica/core/solve_report.hpp"
#include "tunica/core/types.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace tunica::test {

/// Mesh motion of a model that has no mesh.
struct NoMesh {
  Points<3> extend(const Points<3>& d) const { return d; }
};

/// A column of fluid of mass m on a piston, under a force; BDF2 in velocity and acceleration.
struct Column {
  double mass = 1;   // [kg]
  double drive = 0;  // [N]
  double x = 0, x1 = 0, v = 0, v1 = 0, force = 0;
  int steps = 0;
  std::vector<double> saved{};

  void move(const Points<3>& d, double dt) {
    const double next = d(0), first = steps == 0 ? 1 : 0;
    const double velocity = first != 0 ? (next - x) / dt : (3 * next - 4 * x + x1) / (2 * dt);
    const double acceleration = first != 0 ? (velocity - v) / dt : (3 * velocity - 4 * v + v1) / (2 * dt);
    force = drive - mass * acceleration;
    x1 = std::exchange(x, next);
    v1 = std::exchange(v, velocity);
    ++steps;
  }
  SolveReport step(double) { return {Status::converged, 1, 0}; }
  Points<3> interface_force() const { return Vec3(force, 0, 0); }
  void save() { saved = {x, x1, v, v1, static_cast<double>(steps)}; }
  void restore() {
    x = saved[0], x1 = saved[1], v = saved[2], v1 = saved[3], steps = static_cast<int>(saved[4]);
  }
};

/// A mass on a spring with the same BDF2.
struct Spring {
  double mass = 1, stiffness = 0;  // [kg], [N/m]
  double x = 0, x1 = 0, v = 0, v1 = 0, force = 0;
  int steps = 0;
  std::vector<double> saved{};

  void load(const Points<3>& f) { force = f(0); }
  SolveReport step(double dt) {
    // m a + k x = f with v = (c x - hx) / dt, a = (c v - hv) / dt
    const double c = steps == 0 ? 1 : 1.5;
    const double hx = steps == 0 ? x : 2 * x - 0.5 * x1, hv = steps == 0 ? v : 2 * v - 0.5 * v1;
    const double next = (force + mass / dt * (c * hx / dt + hv)) / (mass * c * c / (dt * dt) + stiffness);
    const double velocity = (c * next - hx) / dt;
    x1 = std::exchange(x, next);
    v1 = std::exchange(v, velocity);
    ++steps;
    return {Status::converged, 1, 0};
  }
  Points<3> displacement() const { return Vec3(x, 0, 0); }
  void save() { saved = {x, x1, v, v1, static_cast<double>(steps)}; }
  void restore() {
    x = saved[0], x1 = saved[1], v = saved[2], v1 = saved[3], steps = static_cast<int>(saved[4]);
  }
};

/// The tube of [CGN05] in cgs: length, radius, wall thickness [cm], densities [g/cm3], E [dyn/cm2].
struct TubeData {
  double length = 5, radius = 0.5, thickness = 0.1;
  double fluid_density = 1, wall_density = 1.1;
  double youngs_modulus = 3e6, poisson = 0.3;
  int cells = 60;

  [[nodiscard]] double stiffness() const {  // of a ring, per unit of area [dyn/cm3]
    return youngs_modulus * thickness / ((1 - poisson * poisson) * radius * radius);
  }
  /// Added mass of mode k per density: mu_k = I0(kappa R) / (kappa I1(kappa R)), kappa = k pi / L [cm].
  [[nodiscard]] double added_mass(int k) const {
    const double kappa = k * std::numbers::pi / length;
    return std::cyl_bessel_i(0.0, kappa * radius) / (kappa * std::cyl_bessel_i(1.0, kappa * radius));
  }
};

/// Potential flow in the tube: p = p_ext - rho_f M_A d2(eta)/dt2, implicit Euler; the radial
/// displacement is the second component, forces are per unit of area.
struct PotentialFlow {
  explicit PotentialFlow(const TubeData& d) : data(d), eta(Eigen::VectorXd::Zero(d.cells - 1)) {
    const int n = d.cells - 1;
    Eigen::MatrixXd S(n, n);
    for (int i = 0; i < n; ++i)
      for (int k = 0; k < n; ++k)
        S(i, k) = std::sqrt(2.0 / d.cells) * std::sin((i + 1) * (k + 1) * std::numbers::pi / d.cells);
    Eigen::VectorXd mu(n);
    for (int k = 0; k < n; ++k) mu[k] = d.added_mass(k + 1);
    M_A = S * mu.asDiagonal() * S.transpose();
    v = p = Eigen::VectorXd::Zero(n);
  }

  void move(const Points<3>& d, double dt) {
    const Eigen::VectorXd next = d.row(1).transpose(), velocity = (next - eta) / dt;
    t += dt;
    p = -data.fluid_density * (M_A * ((velocity - v) / dt));
    for (Eigen::Index i = 0; i < p.size(); ++i)
      p[i] += (t <= pulse_end ? pulse : 0) * (1 - static_cast<double>(i + 1) / data.cells);
    eta = next;
    v = velocity;
  }
  SolveReport step(double) { return {Status::converged, 1, 0}; }
  Points<3> interface_force() const {
    Points<3> f = Points<3>::Zero(3, p.size());
    f.row(1) = p.transpose();
    return f;
  }
  void save() { saved_eta = eta, saved_v = v, saved_t = t; }
  void restore() { eta = saved_eta, v = saved_v, t = saved_t; }
  template <class A>
  void archive(A& a) {
    a("flow.eta", eta), a("flow.v", v), a("flow.t", t);
  }

  TubeData data;
  double pulse = 13332, pulse_end = 3e-3;  // [dyn/cm2], [s]
  Eigen::MatrixXd M_A;
  Eigen::VectorXd eta, v, p;
  double t = 0;
  Eigen::VectorXd saved_eta, saved_v;
  double saved_t = 0;
};

/// Independent rings m d2(eta)/dt2 + k eta = p.
struct RingWall {
  enum class Scheme { implicit_euler, leap_frog };

  RingWall(const TubeData& d, Scheme s = Scheme::implicit_euler)
      : mass(d.wall_density * d.thickness), stiffness(d.stiffness()), scheme(s) {
    eta = v = Eigen::VectorXd::Zero(d.cells - 1);
  }
  void load(const Points<3>& f) { p = f.row(1).transpose(); }
  SolveReport step(double dt) {
    if (scheme == Scheme::implicit_euler)
      v = (mass * v + dt * (p - stiffness * eta)) / (mass + dt * dt * stiffness);
    else
      v += dt / mass * (p - stiffness * eta);
    eta += dt * v;
    return {Status::converged, 1, 0};
  }
  Points<3> displacement() const {
    Points<3> d = Points<3>::Zero(3, eta.size());
    d.row(1) = eta.transpose();
    return d;
  }
  void save() { saved_eta = eta, saved_v = v; }
  void restore() { eta = saved_eta, v = saved_v; }
  template <class A>
  void archive(A& a) {
    a("wall.eta", eta), a("wall.v", v);
  }

  double mass, stiffness;
  Scheme scheme;
  Eigen::VectorXd eta, v, p;
  Eigen::VectorXd saved_eta, saved_v;
};

/// Keeps copies of what is archived, by name.
class Memory {
 public:
  enum class Mode { write, read };
  Mode mode = Mode::write;

  void operator()(const std::string& name, double& x) { number(name, x); }
  void operator()(const std::string& name, int& x) { number(name, x); }
  template <int R, int C>
  void operator()(const std::string& name, Eigen::Matrix<double, R, C>& x) {
    if (mode == Mode::write)
      matrices_[name] = x;
    else
      x = matrices_.at(name);
  }
  void operator()(const std::string& name, std::vector<Index>& x) {
    if (mode == Mode::write)
      lists_[name] = x;
    else
      x = lists_.at(name);
  }

 private:
  template <class T>
  void number(const std::string& name, T& x) {
    if (mode == Mode::write)
      numbers_[name] = x;
    else
      x = static_cast<T>(numbers_.at(name));
  }
  std::map<std::string, double> numbers_;
  std::map<std::string, Eigen::MatrixXd> matrices_;
  std::map<std::string, std::vector<Index>> lists_;
};

}  // namespace tunica::test
