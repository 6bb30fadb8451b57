// SPDX-License-Identifier: MIT
// SAYS: the required expression 'r.viscosity_at(shear_rate)' is invalid
#include "tunica/fluid/projection.hpp"

using namespace tunica;

/// A fluid without a viscosity.
struct Mine {
  double density = 1050;
#ifdef RIGHT
  double viscosity_at(double) const {
    return 0.0035;
  }
#endif
};

fluid::Projection<Mine>* blood = nullptr;
