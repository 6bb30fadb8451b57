// SPDX-License-Identifier: MIT
// SAYS: a scheme says how many old levels it reads
#include "tunica/la/time_scheme.hpp"

using namespace tunica;

/// A scheme that does not say how many old levels it reads.
struct Mine {
#ifdef RIGHT
  static constexpr int depth = 1;
#endif
};

template <la::TimeScheme Scheme>
struct March {};

March<Mine> march;
