// SPDX-License-Identifier: MIT
// SAYS: a fluid has a viscosity at a shear rate
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
