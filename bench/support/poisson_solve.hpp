// SPDX-License-Identifier: MIT
// Poisson's equation on linear tetrahedra solved by the multigrid, and by amgcl where its headers are found.
#pragma once

#include "support/stopwatch.hpp"
#include "support/tet_operators.hpp"
#include "tunica/la/cg.hpp"
#include "tunica/la/multigrid.hpp"

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <algorithm>
#include <cstddef>
#include <fstream>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#if __has_include(<amgcl/amg.hpp>)
#define AMGCL_NO_BOOST
#include <amgcl/adapter/crs_tuple.hpp>
#include <amgcl/amg.hpp>
#include <amgcl/backend/builtin.hpp>
#include <amgcl/coarsening/smoothed_aggregation.hpp>
#include <amgcl/make_solver.hpp>
#include <amgcl/relaxation/gauss_seidel.hpp>
#include <amgcl/relaxation/spai0.hpp>
#include <amgcl/solver/cg.hpp>
#endif

namespace tunica::bench {

/// CPU times [s] on one thread, least of the repeats, and what they bought.
struct PoissonRun {
  double setup = 0, solve = 0, refresh = 0;
  int iterations = 0;
  double residual = 0;   // the true one, relative
  double megabytes = 0;  // peak beyond what the matrix and the vectors take
};

namespace detail {

/// Resident memory [MB] from /proc, where it is: VmRSS, or VmHWM, its peak.
[[nodiscard]] inline double resident(const std::string& key) {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;)
    if (double kilobytes = 0; word == key + ":" && status >> kilobytes) return kilobytes / 1024;
  return 0;
}
/// The peak starts again from what is in use now: what was freed is given back first.
inline void forget_peak() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
  std::ofstream("/proc/self/clear_refs") << "5";
}

}  // namespace detail

[[nodiscard]] inline la::RowMatrix poisson(int cells) {
  return test::diffusion(test::perturbed_cube(cells));
}

[[nodiscard]] inline PoissonRun solve_by_multigrid(const la::RowMatrix& A, const Eigen::VectorXd& b,
                                                   int repeats) {
  PoissonRun run;
  for (int k = 0; k < repeats; ++k) {
    detail::forget_peak();
    const double before = detail::resident("VmRSS");
    Eigen::VectorXd x = Eigen::VectorXd::Zero(b.size());
    la::Multigrid<> M;
    const double start = cpu_seconds();
    const auto made = M.compute(A);
    const double ready = cpu_seconds();
    const auto report = la::cg(la::ApplyMatrix<>{A}, M, b, x, {.tolerance = 1e-8});
    const double solved = cpu_seconds();
    const auto again = M.refresh(A);
    const double refreshed = cpu_seconds();
    const auto least = [&](double& value, double seconds) {
      value = k == 0 ? seconds : std::min(value, seconds);
    };
    least(run.setup, ready - start);
    least(run.solve, solved - ready);
    least(run.refresh, refreshed - solved);
    run.iterations = report.iterations;
    run.residual = made && again ? (b - A * x).norm() / b.norm() : 1.0;
    run.megabytes = std::max(run.megabytes, detail::resident("VmHWM") - before);
  }
  return run;
}

#if __has_include(<amgcl/amg.hpp>)
template <template <class> class Relaxation>
PoissonRun solve_by_amgcl(const la::RowMatrix& A, const Eigen::VectorXd& b, int repeats) {
  using Backend = amgcl::backend::builtin<double>;
  using Solver = amgcl::make_solver<amgcl::amg<Backend, amgcl::coarsening::smoothed_aggregation, Relaxation>,
                                    amgcl::solver::cg<Backend>>;
  const auto n = static_cast<std::size_t>(A.rows());
  const auto rows =
      std::make_tuple(n, amgcl::make_iterator_range(A.outerIndexPtr(), A.outerIndexPtr() + n + 1),
                      amgcl::make_iterator_range(A.innerIndexPtr(), A.innerIndexPtr() + A.nonZeros()),
                      amgcl::make_iterator_range(A.valuePtr(), A.valuePtr() + A.nonZeros()));
  typename Solver::params options;
  options.solver.tol = 1e-8;
  PoissonRun run;
  for (int k = 0; k < repeats; ++k) {
    detail::forget_peak();
    const double before = detail::resident("VmRSS");
    const std::vector<double> right(b.data(), b.data() + n);
    std::vector<double> x(n, 0.0);
    const double start = cpu_seconds();
    const Solver solver(rows, options);
    const double ready = cpu_seconds();
    const auto [iterations, error] = solver(right, x);
    const double solved = cpu_seconds();
    run.setup = k == 0 ? ready - start : std::min(run.setup, ready - start);
    run.solve = k == 0 ? solved - ready : std::min(run.solve, solved - ready);
    run.iterations = static_cast<int>(iterations);
    run.residual = (b - A * Eigen::Map<const Eigen::VectorXd>(x.data(), b.size())).norm() / b.norm();
    run.megabytes = std::max(run.megabytes, detail::resident("VmHWM") - before);
  }
  return run;
}
#endif

/// amgcl at its best: conjugate gradients, smoothed aggregation, the faster one of two smoothers.
[[nodiscard]] inline std::optional<PoissonRun> solve_by_peer([[maybe_unused]] const la::RowMatrix& A,
                                                             [[maybe_unused]] const Eigen::VectorXd& b,
                                                             [[maybe_unused]] int repeats) {
#if __has_include(<amgcl/amg.hpp>)
  const auto sweeps = solve_by_amgcl<amgcl::relaxation::gauss_seidel>(A, b, repeats);
  const auto inverse = solve_by_amgcl<amgcl::relaxation::spai0>(A, b, repeats);
  return sweeps.setup + sweeps.solve < inverse.setup + inverse.solve ? sweeps : inverse;
#else
  return std::nullopt;
#endif
}

}  // namespace tunica::bench
