// SPDX-License-Identifier: MIT
// SAYS: inverse design finds nodes alone: give a formulation without pressures at them
#include "tunica/solid/inverse.hpp"
#include "tunica/solid/laws.hpp"

using namespace tunica::solid;

using Law = Hyperelastic<NeoHooke, Quadratic>;
#ifdef RIGHT
using Cure = MeanVolume;
#else
using Cure = NodalPressure;
#endif

InverseReport unloaded(const Statics<tunica::mesh::Tet4, With<Cure, Law>>& wall) {
  return unloaded_shape(wall);
}
