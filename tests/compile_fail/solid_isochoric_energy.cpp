// SPDX-License-Identifier: MIT
// SAYS: the isochoric law needs `reads` and energy(invariants)
#include "tunica/solid/body.hpp"
#include "tunica/solid/laws.hpp"
#include "tunica/solid/volumetric.hpp"

using namespace tunica;

/// A law that forgot its energy.
struct Mine {
  static constexpr std::array reads{solid::Invariant::I1};
#ifdef RIGHT
  template <class S>
  S energy(const std::array<S, 1>& I) const {
    return 1e3 * (I[0] - 3);
  }
#endif
};

using Material = solid::Hyperelastic<Mine, solid::Quadratic>;

std::size_t size() {
  return sizeof(solid::Body<mesh::Hex8, Material>);
}
