// SPDX-License-Identifier: MIT
// smoothing_native: prints the times of the smoothing built for the machine at hand, a vertex and sweep [ns]:
// the sweeps alone, and with all that a call does. A program of its own, as contour_native is.
#include "support/smoothing_time.hpp"

#include <cstdio>
#include <exception>

int main() {
  try {
    const tunica::bench::SmoothingTime t(tunica::bench::smoothing_volume());
    std::printf("%.6f %.6f\n", t.per_move(t.alone), t.per_move(t.call));
  } catch (const std::exception& e) {
    std::fprintf(stderr, "error: %s\n", e.what());
    return 1;
  }
}
