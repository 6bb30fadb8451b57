// SPDX-License-Identifier: MIT
// SAYS: it has a time for the momentum
#include "tunica/fluid/projection.hpp"

using namespace tunica;

/// A stabilisation of the mass balance alone.
struct Mine {
  double mass(double, double, double, double) const { return 0; }
#ifdef RIGHT
  double momentum(double, double, double, double, double) const {
    return 0;
  }
#endif
};

fluid::Projection<fluid::Newtonian, Mine>* blood = nullptr;
