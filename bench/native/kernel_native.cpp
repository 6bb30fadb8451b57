// SPDX-License-Identifier: MIT
// kernel_native: prints what KernelTime holds, built for the machine at hand. A program of its own, as
// contour_native is.
#include "support/kernel_time.hpp"

#include <cstdio>
#include <exception>

int main() {
  try {
    const auto t = tunica::bench::kernel_time();
    std::printf(
        "%.3f %.5f %.0f %.5f %.0f %.5f %.5f %.0f %.5f %.0f %.5f %.5f %.3e %.3e %.3e %.5f %.15e %.15e\n",
        t.peak, t.hex, t.hex_flops, t.closed, t.closed_flops, t.plain, t.tet, t.tet_flops, t.fibres,
        t.fibre_flops, t.single, t.action, t.off, t.off_duals, t.off_single, t.assembled, t.work,
        t.stiffness);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "error: %s\n", e.what());
    return 1;
  }
}
