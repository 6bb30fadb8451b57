// SPDX-License-Identifier: MIT
// SAYS: the volumetric law needs energy(J), slope(J) and curvature(J)
#include "tunica/solid/body.hpp"
#include "tunica/solid/laws.hpp"
#include "tunica/solid/volumetric.hpp"

using namespace tunica;

/// A law that forgot its second derivative.
struct Mine {
  template <class S>
  S energy(const S& J) const {
    return 0.5e6 * (J - 1) * (J - 1);
  }
  template <class S>
  S slope(const S& J) const {
    return 1e6 * (J - 1);
  }
#ifdef RIGHT
  template <class S>
  S curvature(const S&) const {
    return 1e6;
  }
#endif
};

using Material = solid::Hyperelastic<solid::NeoHooke, Mine>;

std::size_t size() {
  return sizeof(solid::Body<mesh::Hex8, Material>);
}
