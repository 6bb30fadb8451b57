// SPDX-License-Identifier: MIT
// SAYS: F-bar takes no prestress: it knows F at the centre of the unstressed cell alone
#include "tunica/solid/laws.hpp"
#include "tunica/solid/prestress.hpp"

using namespace tunica::solid;

using Law = Hyperelastic<NeoHooke, Quadratic>;
#ifdef RIGHT
using Cure = MeanVolume;
#else
using Cure = FBar;
#endif

PrestressReport stressed(Statics<tunica::mesh::Hex8, With<Cure, Law>>& wall) {
  return prestress(wall);
}
