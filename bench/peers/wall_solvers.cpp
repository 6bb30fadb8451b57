// SPDX-License-Identifier: MIT
// The tangent of a thick wall, near incompressible and less so, by each linear solver: wall_solvers [CELLS].
#include "support/stopwatch.hpp"
#include "tunica/la/cell_patches.hpp"
#include "tunica/la/direct.hpp"
#include "tunica/la/iterative.hpp"
#include "tunica/la/multigrid.hpp"
#include "tunica/la/rigid_modes.hpp"
#include "tunica/mesh/patch_nodes.hpp"
#include "tunica/meshing/box.hpp"
#include "tunica/solid/body.hpp"
#include "tunica/solid/laws.hpp"

#ifdef TUNICA_WITH_CHOLMOD
#include "tunica/la/cholmod.hpp"
#endif
#ifdef TUNICA_WITH_HYPRE
#include "tunica/la/hypre.hpp"
#endif
#if __has_include(<amgcl/amg.hpp>)
#define AMGCL_NO_BOOST
#include <amgcl/adapter/crs_tuple.hpp>
#include <amgcl/amg.hpp>
#include <amgcl/backend/builtin.hpp>
#include <amgcl/coarsening/smoothed_aggregation.hpp>
#include <amgcl/make_solver.hpp>
#include <amgcl/relaxation/gauss_seidel.hpp>
#include <amgcl/solver/cg.hpp>
#endif

#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <tuple>
#include <utility>
#include <vector>

using namespace tunica;

namespace {

/// A sector of a thick tube, n cells each way, held at one end, from which it follows along an arc.
mesh::Mesh<mesh::Hex8, 3> sector(int n) {
  auto mesh = meshing::box_hexes({.cells = {n, n, n}, .lo = Vec3::Zero(), .hi = {1, 1, 1}});
  for (Index k = 0; k < mesh.node_count(); ++k) {
    const Vec3 X = mesh.nodes.col(k);
    const double r = 5e-3 + 5e-3 * X[0], angle = 1.5 * X[1];
    mesh.nodes.col(k) = Vec3(r * std::cos(angle), r * std::sin(angle), 7.5e-3 * X[2]);
  }
  return mesh;
}

void print(const char* solver, double setup, double again, double solve, int iterations, double residual) {
  std::printf("  %-28s %8.2f %8.2f %8.2f %6d   %.1e\n", solver, setup, again, solve, iterations, residual);
  std::fflush(stdout);
}

/// CPU times of the first and the next factorisation and of a solve.
template <class Solver, class Matrix>
void measure(const char* name, Solver solver, const Matrix& K, const la::SparseMatrix& A,
             const Eigen::VectorXd& b) {
  const double start = bench::cpu_seconds();
  solver.analyse(K);
  const auto made = solver.factorise(K);
  const double ready = bench::cpu_seconds();
  Eigen::VectorXd x;
  const auto report = solver.solve(b, x);
  const double solved = bench::cpu_seconds();
  const auto again = solver.factorise(K);
  const double refreshed = bench::cpu_seconds();
  print(made && again ? name : "(refused)", ready - start, refreshed - solved, solved - ready,
        report.iterations, (b - A * x).norm() / b.norm());
}

#if __has_include(<amgcl/amg.hpp>)
void measure_amgcl(const la::SparseMatrix& A, const Eigen::MatrixXd& modes, const Eigen::VectorXd& b) {
  using Backend = amgcl::backend::builtin<double>;
  using Solver = amgcl::make_solver<
      amgcl::amg<Backend, amgcl::coarsening::smoothed_aggregation, amgcl::relaxation::gauss_seidel>,
      amgcl::solver::cg<Backend>>;
  const auto n = static_cast<std::size_t>(A.rows());
  const auto rows =
      std::make_tuple(n, amgcl::make_iterator_range(A.outerIndexPtr(), A.outerIndexPtr() + n + 1),
                      amgcl::make_iterator_range(A.innerIndexPtr(), A.innerIndexPtr() + A.nonZeros()),
                      amgcl::make_iterator_range(A.valuePtr(), A.valuePtr() + A.nonZeros()));
  typename Solver::params options;
  options.solver.tol = 1e-8;
  options.solver.maxiter = 5000;
  options.precond.coarsening.aggr.block_size = 3;
  options.precond.coarsening.nullspace.cols = static_cast<int>(modes.cols());
  for (Eigen::Index i = 0; i < modes.rows(); ++i)
    for (Eigen::Index m = 0; m < modes.cols(); ++m)
      options.precond.coarsening.nullspace.B.push_back(modes(i, m));
  const std::vector<double> right(b.data(), b.data() + n);
  std::vector<double> x(n, 0.0);
  const double start = bench::cpu_seconds();
  const Solver solver(rows, options);
  const double ready = bench::cpu_seconds();
  const auto result = solver(right, x);
  const double solved = bench::cpu_seconds();
  print("amgcl, rigid modes", ready - start, 0, solved - ready, static_cast<int>(std::get<0>(result)),
        (b - A * Eigen::Map<const Eigen::VectorXd>(x.data(), b.size())).norm() / b.norm());
}
#endif

void run(int n, double ratio, bool direct) {
  constexpr double mu = 1e5;  // [Pa]
  const auto mesh = sector(n);
  const solid::Hyperelastic law{solid::NeoHooke{.c10 = mu / 2}, solid::Quadratic{.kappa = ratio * mu}};
  solid::Body<mesh::Hex8, std::remove_const_t<decltype(law)>> body(mesh, law, 0, solid::Mass::lumped);
  for (const Index k : mesh::patch_nodes(mesh.patch("z0")))
    for (const auto axis : {solid::Axis::x, solid::Axis::y, solid::Axis::z}) body.fix(k, axis);
  for (const Index k : mesh::patch_nodes(mesh.patch("y0"))) body.fix(k, solid::Axis::y);
  Eigen::VectorXd u = Eigen::VectorXd::Zero(body.unknowns()), f, predicted, b = u;
  if (!body.internal_forces(u, -1, f, predicted)) return;
  for (const Index k : mesh::patch_nodes(mesh.patch("x0")))  // as a pressure from within
    b.segment<3>(3 * k) = Vec3(mesh.nodes(0, k), mesh.nodes(1, k), 0);
  body.clear_fixed(b);
  la::SparseMatrix A = body.pattern();
  body.tangent(u, Eigen::VectorXd(), {}, A);
  const auto& K = body.tangent_blocks(u, Eigen::VectorXd(), {});
  const Eigen::MatrixXd modes = la::rigid_body_modes(mesh.nodes);
  std::printf("%d unknowns, kappa/mu = %g         set-up  refresh    solve   its   residual\n", K.rows(),
              ratio);
  const auto multigrid = [&] {
    la::Multigrid<3, 6> M;
    M.near_null_space(modes);
    return M;
  };
  const la::KrylovOptions options{.tolerance = 1e-8, .max_iterations = 5000};
  measure("Cg<Multigrid>, blocks", la::Cg<la::Multigrid<3, 6>>(options, multigrid()), K, A, b);
  measure("Cg<CellPatches<Multigrid>>",
          la::Cg<la::CellPatches<8, la::Multigrid<3, 6>>>(
              options, la::CellPatches<8, la::Multigrid<3, 6>>(mesh.cells, multigrid())),
          K, A, b);
  measure("Cg<Multigrid>, numbers", la::Cg<la::Multigrid<3, 6>>(options, multigrid()), A, A, b);
  measure("Cg<IncompleteCholesky>", la::Cg<>(options), A, A, b);
#if __has_include(<amgcl/amg.hpp>)
  measure_amgcl(A, modes, b);
#endif
#ifdef TUNICA_WITH_HYPRE
  measure("hypre, BoomerAMG",
          la::Hypre({.max_iterations = 5000, .components = 3, .strong = 0.5, .aggressive = 0}), A, A, b);
#endif
  if (!direct) return;
#ifdef TUNICA_WITH_CHOLMOD
  measure("Cholmod", la::Cholmod(), A, A, b);
#endif
  if (n <= 16) measure("Ldlt", la::Ldlt(), A, A, b);
}

}  // namespace

int main(int count, char** arguments) {
  const int n = count > 1 ? std::atoi(arguments[1]) : 32;
  for (const double ratio : {1e1, 1e2, 1e3, 1e4}) run(n, ratio, ratio == 1e1);
}
