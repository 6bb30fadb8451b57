// SPDX-License-Identifier: MIT
// Error against CPU time: the thick tube of law (17) inflated to an inner stretch of 1.10, with more and more
// Hex8 through its wall. scene_thick_tube ROWS.csv
#include "support/inflated_tube.hpp"
#include "support/provenance.hpp"
#include "support/stopwatch.hpp"

#include <cmath>
#include <cstdio>
#include <fstream>

int main(int count, char** arguments) {
  using namespace tunica;
  if (count != 2) {
    std::fprintf(stderr, "usage: scene_thick_tube ROWS.csv\n");
    return 2;
  }
  std::ofstream rows(arguments[1]);
  rows << "case,method,h,dofs,error,cpu_s,peak_MB,flags,commit\n";
  const test::ThickTube exact;
  constexpr double stretch = 1.10;
  for (const int radial : {1, 2, 4, 8, 16}) {
    const double h = (exact.outer - exact.inner) / radial;  // [m]
    const auto mesh = bench::tube_mesh(exact, radial);
    // kappa so large that its own error, linear in 1/kappa, stays below that of the finest mesh
    const double kappa = 2e6 * exact.c10;
    bench::Inflation reached;
    const double cpu =
        bench::best_cpu_seconds(3, [&] { reached = bench::inflate(mesh, exact, stretch, kappa); });
    if (!reached.converged) {
      std::fprintf(stderr, "error: no equilibrium with %d cells through the wall\n", radial);
      return 1;
    }
    const double error = std::abs(reached.stretch - stretch);
    rows << "thick tube,Q1-P0-J0," << h << ',' << 3 * mesh.node_count() << ',' << error << ',' << cpu << ','
         << bench::peak_megabytes() << ',' << bench::flags() << ',' << bench::commit() << '\n';
    std::printf("Q1-P0-J0  h %.3e m  unknowns %6d  error of the inner stretch %.3e  %.3e s\n", h,
                3 * mesh.node_count(), error, cpu);
  }
  return rows.flush() ? 0 : 1;
}
