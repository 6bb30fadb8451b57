// SPDX-License-Identifier: MIT
// Where the energy of a step in time went.
#pragma once

#include <Eigen/Core>

namespace tunica::solid {

/// What became of the energy in one step, all [J]. The scheme's share is what the others leave: numerical
/// damping, positive where it takes energy away.
struct EnergyBalance {
  double external = 0;                          // work of the loads
  double kinetic = 0, strain = 0, springs = 0;  // what was stored
  double dashpots = 0;                          // what they took
  double scheme = 0;                            // external - kinetic - strain - springs - dashpots
};

/// Of a step of generalised-alpha from `before` to `now`, each with displacements u and velocities v as
/// vectors of the body; `external`: the forces at t^{n+af} [N].
template <class Body, class Before, class Now>
[[nodiscard]] EnergyBalance energy_balance(const Body& body, const Before& before, const Now& now,
                                           const Eigen::VectorXd& external, double af) {
  const Eigen::VectorXd du = now.u - before.u, none = Eigen::VectorXd::Zero(du.size());
  const Eigen::VectorXd v_af = before.v + af * (now.v - before.v);
  Eigen::VectorXd damping = none;
  body.add_support_forces(none, v_af, damping);
  EnergyBalance e;
  e.external = external.dot(du);
  e.dashpots = damping.dot(du);
  e.kinetic = body.kinetic_energy(now.v) - body.kinetic_energy(before.v);
  e.strain = body.strain_energy(now.u) - body.strain_energy(before.u);
  e.springs = body.spring_energy(now.u) - body.spring_energy(before.u);
  e.scheme = e.external - e.kinetic - e.strain - e.springs - e.dashpots;
  return e;
}

}  // namespace tunica::solid
