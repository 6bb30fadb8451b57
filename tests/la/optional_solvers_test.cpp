// SPDX-License-Identifier: MIT
// Solvers of other libraries behind the seam, each where it is installed.
#include "support/tet_operators.hpp"

#ifdef TUNICA_WITH_CHOLMOD
#include "tunica/la/cholmod.hpp"
#endif
#ifdef TUNICA_WITH_HYPRE
#include "tunica/la/hypre.hpp"
#endif
#ifdef TUNICA_WITH_PETSC
#include "tunica/la/petsc.hpp"
#endif
#include "tunica/la/linear_solver.hpp"

#include <doctest/doctest.h>

#include <limits>

using namespace tunica;

namespace {

/// Solves, reuses, and says how it fails; `wanted` is the residual that it must reach.
template <la::LinearSolver Solver>
[[maybe_unused]] void check_solver(Solver solver, double wanted) {
  la::SparseMatrix A = test::diffusion(test::perturbed_cube(12));
  test::Noise noise;
  const Eigen::VectorXd exact = noise.vector(A.rows());
  Eigen::VectorXd b = A * exact, x;
  solver.analyse(A);
  REQUIRE(solver.factorise(A));
  auto report = solver.solve(b, x);
  CHECK(report.status == Status::converged);
  CHECK((b - A * x).norm() <= wanted * b.norm());
  CHECK((x - exact).norm() <= 1e3 * wanted * exact.norm());
  MESSAGE(report.iterations << " iterations to " << report.residual);
  A *= 3.0;  // new values on the old pattern
  REQUIRE(solver.factorise(A));
  CHECK(solver.solve(b, x).status == Status::converged);
  CHECK((3 * x - exact).norm() <= 1e3 * wanted * exact.norm());
  Solver moved = std::move(solver);  // Newton's loop takes its solver so
  b[3] = std::numeric_limits<double>::quiet_NaN();
  CHECK(moved.solve(b, x).status == Status::diverged);
  x.resize(0);
  CHECK(moved.solve(Eigen::VectorXd::Zero(A.rows()), x).status == Status::converged);
  CHECK(x.norm() == 0);
  A.coeffRef(0, 0) = std::numeric_limits<double>::quiet_NaN();
  CHECK(moved.factorise(A).status == Status::diverged);
  CHECK(moved.solve(A.rows() > 0 ? exact : b, x).status == Status::diverged);
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("la: cholmod solves what is definite and refuses what is not") {
#ifdef TUNICA_WITH_CHOLMOD
    check_solver(la::Cholmod(), 1e-12);
    la::SparseMatrix A = test::diffusion(test::perturbed_cube(8));
    A.coeffRef(5, 5) = -100;
    la::Cholmod solver;
    solver.analyse(A);
    Eigen::VectorXd x;
    const bool refused = solver.factorise(A).status == Status::diverged;
    const bool solved = !refused && bool(solver.solve(Eigen::VectorXd::Ones(A.rows()), x));
    CHECK((refused || solved));
    if (solved)
      CHECK((A.selfadjointView<Eigen::Lower>() * x - Eigen::VectorXd::Ones(A.rows())).norm() < 1e-8);
#else
    MESSAGE("SKIPPED: no CHOLMOD here");
#endif
  }

  TEST_CASE("la: hypre solves with its own multigrid") {
#ifdef TUNICA_WITH_HYPRE
    check_solver(la::Hypre(), 1.01e-8);
    la::SparseMatrix A = test::diffusion(test::perturbed_cube(8));
    la::Hypre few({.tolerance = 1e-12, .max_iterations = 2});
    REQUIRE(few.factorise(A));
    Eigen::VectorXd x;
    CHECK(few.solve(Eigen::VectorXd::Ones(A.rows()), x).status == Status::max_iterations);
#else
    MESSAGE("SKIPPED: no hypre here");
#endif
  }

  TEST_CASE("la: petsc solves with what it is asked for") {
#ifdef TUNICA_WITH_PETSC
    check_solver(la::Petsc(), 1.01e-8);
    check_solver(la::Petsc({.solver = KSPCG, .preconditioner = PCGAMG}), 1.01e-8);
    check_solver(la::Petsc({.solver = KSPPREONLY, .preconditioner = PCLU}), 1.01e-8);
    la::SparseMatrix A = test::diffusion(test::perturbed_cube(8));
    la::Petsc few({.tolerance = 1e-12, .max_iterations = 2});
    REQUIRE(few.factorise(A));
    Eigen::VectorXd x;
    CHECK(few.solve(Eigen::VectorXd::Ones(A.rows()), x).status == Status::max_iterations);
#else
    MESSAGE("SKIPPED: no PETSc here");
#endif
  }
}
