// SPDX-License-Identifier: MIT
// Preconditions: TUNICA_EXPECT(det > 0, "inverted cell") throws in debug builds and in tests.
#pragma once

#include <stdexcept>

namespace tunica {

/// A broken precondition: a fault of the caller, not of the input.
struct ContractError : std::logic_error {
  using std::logic_error::logic_error;
};

}  // namespace tunica

#if !defined(NDEBUG) || defined(TUNICA_CHECKED)
#define TUNICA_EXPECT(condition, sentence)                                         \
  do {                                                                             \
    if (!(condition)) throw ::tunica::ContractError(sentence " (" #condition ")"); \
  } while (false)
#else
#define TUNICA_EXPECT(condition, sentence) static_cast<void>(0)
#endif
