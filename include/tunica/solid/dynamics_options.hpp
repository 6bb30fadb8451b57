// SPDX-License-Identifier: MIT
// How dynamics goes along, and where the energy of a step went.
#pragma once

#include "tunica/la/newton.hpp"
#include "tunica/la/time_scheme.hpp"
#include "tunica/solid/cell_mass.hpp"

namespace tunica::solid {

struct DynamicsOptions {
  la::GeneralizedAlpha scheme{.rho_inf = 0.5};
  Mass mass = Mass::consistent;
  /// The tangent of the first iteration after save() serves as long as each iteration with it takes
  /// the residual down fourfold (a factorisation costs as much as 6 to 15 iterations, measured at
  /// 1,000 and 3,000 cells); refresh_above = 0 is Newton's method proper.
  la::NewtonOptions newton{.refresh_above = 0.25};
};

/// What became of the energy in one step, all [J]. The scheme's share is what the others leave: numerical
/// damping, positive where it takes energy away.
struct EnergyBalance {
  double external = 0;                          // work of the loads
  double kinetic = 0, strain = 0, springs = 0;  // what was stored
  double dashpots = 0;                          // what they took
  double scheme = 0;                            // external - kinetic - strain - springs - dashpots
};

}  // namespace tunica::solid
