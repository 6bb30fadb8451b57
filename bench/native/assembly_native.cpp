// SPDX-License-Identifier: MIT
// assembly_native: prints what AssemblyTime holds, built for the machine at hand. A program of its own, as
// contour_native is.
#include "support/assembly_time.hpp"

#include <cstdio>
#include <exception>

int main() {
  try {
    const auto t = tunica::bench::assembly_time();
    std::printf("%.4f %.4f %.3e %.4f %.4f %.4f %.4f %.4f\n", t.laplacian, t.convection, t.off, t.scatter,
                t.scatter_upper, t.product, t.product_upper, t.scalar);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "error: %s\n", e.what());
    return 1;
  }
}
