// SPDX-License-Identifier: MIT
// The most that one core does: multiplications and additions of doubles in registers, in the same build.
#pragma once

#include "support/stopwatch.hpp"
#include "tunica/core/pack.hpp"

namespace tunica::bench {

/// Twelve chains x = x m + c that depend on nothing but themselves: enough for the latency of any machine
/// today. An FMA counts as two, as a multiplication and an addition do where there is none. [GFLOP/s]
[[nodiscard]] inline double fma_peak() {
  constexpr int chains = 12, lanes = registers::width<double>(8), repeats = 2000000;
  using P = Pack<double, lanes>;
  P x[chains];
  for (int c = 0; c < chains; ++c) x[c] = P(1 + 1e-3 * c);
  const P factor(0.999999), shift(1e-6);
  const double seconds = best_cpu_seconds(7, [&] {
    P y[chains];
#pragma GCC unroll 12
    for (int c = 0; c < chains; ++c) y[c] = x[c];
    for (int k = 0; k < repeats; ++k)
#pragma GCC unroll 12
      for (int c = 0; c < chains; ++c) y[c] = y[c] * factor + shift;
#pragma GCC unroll 12
    for (int c = 0; c < chains; ++c) x[c] = y[c];
  });
  double kept = 0;
  for (const P& v : x) kept += v[0];
  volatile double sink = kept;  // so that the chains are not dropped
  static_cast<void>(sink);
  return 2e-9 * chains * lanes * repeats / seconds;
}

}  // namespace tunica::bench
