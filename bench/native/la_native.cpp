// SPDX-License-Identifier: MIT
// The multigrid on Poisson's equation built for the machine at hand: la_native CELLS. Prints unknowns, then
// set-up, solve, refresh [s], iterations, residual and MB: ours, and in a second line amgcl's where it is.
#include "support/poisson_solve.hpp"

#include <cstdio>
#include <cstdlib>
#include <exception>

namespace {

void print(const tunica::bench::PoissonRun& run) {
  std::printf("%.4f %.4f %.4f %d %.3e %.0f\n", run.setup, run.solve, run.refresh, run.iterations,
              run.residual, run.megabytes);
}

}  // namespace

int main(int count, char** arguments) {
  using namespace tunica;
  const int cells = count == 2 ? std::atoi(arguments[1]) : 0;
  if (cells < 2 || cells > 200) {
    std::fprintf(stderr, "usage: la_native CELLS, 2 to 200 along an edge\n");
    return 2;
  }
  try {
    constexpr int repeats = 2;
    const auto A = bench::poisson(cells);
    const Eigen::VectorXd b = test::Noise{}.vector(A.rows());
    std::printf("%d\n", static_cast<int>(A.rows()));
    print(bench::solve_by_multigrid(A, b, repeats));
    if (const auto peer = bench::solve_by_peer(A, b, repeats)) print(*peer);
    return 0;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "error: %s\n", e.what());
    return 1;
  }
}
