// SPDX-License-Identifier: MIT
// select(mask, a, b): a branch that every scalar can take, also one that holds several lanes.
#pragma once

namespace tunica {

/// a where the mask holds, b elsewhere; both are computed. `mask` is what a comparison of two T gives:
/// a bool here; a pack of lanes brings a `select` of its own, found by its argument.
///   const S tension = select(E > S(0), E, S(0));
template <class T>
[[nodiscard]] constexpr T select(bool mask, const T& a, const T& b) {
  return mask ? a : b;
}

}  // namespace tunica
