// SPDX-License-Identifier: MIT
// How dynamics goes along: scheme, mass, Newton's method.
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

}  // namespace tunica::solid
