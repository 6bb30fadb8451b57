// SPDX-License-Identifier: MIT
// What the staggered loop asks of its five parts; a model is any type with these members. [PEREZ08, 6.1]
#pragma once

#include "tunica/core/solve_report.hpp"
#include "tunica/core/types.hpp"

#include <concepts>

namespace tunica::coupling {

/// A flow in a domain that moves. The smallest model, a column of fluid of mass m on a piston:
///   struct Column {
///     double m, x, v, x0, v0, f;                                    // [kg], [m], [m/s], ..., [N]
///     void move(const Points<3>& d, double dt) { f = -m * ((d(0) - x) / dt - v) / dt, v = (d(0) - x) / dt, x
///     = d(0); } SolveReport step(double) { return {Status::converged}; } Points<3> interface_force() const {
///     return Vec3(f, 0, 0); } void save() { x0 = x, v0 = v; } void restore() { x = x0, v = v0; }
///   };
/// move: displacement of every node of the fluid from the reference shape, 3 x nodes [m], reached at
/// the end of dt [s]; it sets the grid velocity and takes no time step. step: advances by dt [s].
/// interface_force: consistent nodal forces of the fluid on the wall, 3 x wall nodes [N], ascending
/// node numbers. save keeps the state (one slot), restore returns to it to the last bit.
template <class F>
concept FluidSolver = requires(F& fluid, const Points<3>& displacement, double dt) {
  fluid.move(displacement, dt);
  { fluid.step(dt) } -> std::same_as<SolveReport>;
  { fluid.interface_force() } -> std::convertible_to<Points<3>>;
  fluid.save();
  fluid.restore();
};

/// A structure under nodal forces. The smallest model, a mass on a spring (implicit Euler):
///   struct Spring {
///     double m, k, x, v, x0, v0, f;                                 // [kg], [N/m], [m], [m/s], ..., [N]
///     void load(const Points<3>& force) { f = force(0); }
///     SolveReport step(double dt) { v = (m * v + dt * (f - k * x)) / (m + dt * dt * k), x += dt * v; return
///     {Status::converged}; } Points<3> displacement() const { return Vec3(x, 0, 0); } void save() { x0 = x,
///     v0 = v; } void restore() { x = x0, v = v0; }
///   };
/// load: forces at the end of the step on the interface nodes, 3 x n [N], ascending node numbers.
/// displacement: of the same nodes, 3 x n [m], from the reference shape.
template <class S>
concept StructureSolver = requires(S& wall, const Points<3>& force, double dt) {
  wall.load(force);
  { wall.step(dt) } -> std::same_as<SolveReport>;
  { wall.displacement() } -> std::convertible_to<Points<3>>;
  wall.save();
  wall.restore();
};

/// Displacement of the fluid's wall nodes (3 x n, ascending, [m]) -> of all nodes of the fluid, [m].
///   struct Same { Points<3> extend(const Points<3>& d) const { return d; } };
template <class M>
concept MeshMotion = requires(M& motion, const Points<3>& interface_displacement) {
  { motion.extend(interface_displacement) } -> std::convertible_to<Points<3>>;
};

/// Between the interface nodes of the two meshes: displacement H d to the fluid, force H^T f to the
/// structure, so that both sides see the same work. Each row of H sums to 1.
///   struct Same {
///     Points<3> to_fluid(const Points<3>& d) const { return d; }
///     Points<3> to_structure(const Points<3>& f) const { return f; }
///   };
template <class T>
concept Transfer = requires(const T& transfer, const Points<3>& nodal) {
  { transfer.to_fluid(nodal) } -> std::convertible_to<Points<3>>;
  { transfer.to_structure(nodal) } -> std::convertible_to<Points<3>>;
};

/// The next guess of the interface displacement x from its residual r = wall(fluid(x)) - x.
///   struct Relaxed {
///     double omega;
///     void begin(double) {}
///     Eigen::VectorXd next(const Eigen::VectorXd& x, const Eigen::VectorXd& r) { return x + omega * r; }
///     void accept() {}
///   };
/// begin(dt [s]) opens a time step (also one that is tried again, shorter); accept closes one that
/// has converged, and only then may something of it be kept for the next.
template <class A>
concept Acceleration = requires(A& a, const Eigen::VectorXd& x, const Eigen::VectorXd& r, double dt) {
  a.begin(dt);
  { a.next(x, r) } -> std::convertible_to<Eigen::VectorXd>;
  a.accept();
};

}  // namespace tunica::coupling
