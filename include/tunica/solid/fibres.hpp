// SPDX-License-Identifier: MIT
// Fibres<S, N>: the unit vectors of N fibre families (or of a fibre frame) at a point of the reference body.
#pragma once

#include "tunica/core/tensor.hpp"

#include <array>
#include <cstddef>

namespace tunica::solid {

/// Directions one after the other, in the undeformed body. Zero: no fibres, then I4 = 0 and nothing pulls.
template <class S, std::size_t N>
struct Fibres {
  std::array<S, 3 * N> m{};

  [[nodiscard]] Vector3<S> operator[](std::size_t family) const {
    return {m[3 * family], m[3 * family + 1], m[3 * family + 2]};
  }
  void set(std::size_t family, const Vector3<S>& direction) {
    for (std::size_t k = 0; k < 3; ++k) m[3 * family + k] = direction[k];
  }
};

}  // namespace tunica::solid
