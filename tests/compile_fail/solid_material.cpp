// SPDX-License-Identifier: MIT
// SAYS: a material gives energy(F), stress(F) or response(F) [Pa] of any scalar
#include "tunica/solid/isochoric_law.hpp"

using namespace tunica;

/// A law that forgot its energy.
struct Mine {
  double mu;
#ifdef RIGHT
  template <class S>
  S energy(const Tensor<S>& F) const {
    return S(0.5 * mu) * (double_dot(F, F) - S(3));
  }
#endif
};

std::size_t size() {
  return sizeof(solid::Isochoric<Mine>);
}
