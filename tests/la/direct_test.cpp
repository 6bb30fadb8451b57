// SPDX-License-Identifier: MIT
#include "tunica/la/direct.hpp"
#include "tunica/la/linear_solver.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <vector>

using namespace tunica;

static_assert(la::LinearSolver<la::Ldlt> && la::Ldlt::symmetric);
static_assert(la::LinearSolver<la::Lu> && !la::Lu::symmetric);
static_assert(!la::LinearSolver<la::SparseMatrix>);

namespace {

/// The 5-point Laplacian on an n x n grid, with `skew` added above and taken off below the diagonal.
la::SparseMatrix grid_matrix(int n, double skew, double shift) {
  std::vector<Eigen::Triplet<double>> entries;
  const auto id = [n](int i, int j) { return i + n * j; };
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      entries.emplace_back(id(i, j), id(i, j), 4 + shift);
      if (i > 0) entries.emplace_back(id(i, j), id(i - 1, j), -1 - skew);
      if (i + 1 < n) entries.emplace_back(id(i, j), id(i + 1, j), -1 + skew);
      if (j > 0) entries.emplace_back(id(i, j), id(i, j - 1), -1 - skew);
      if (j + 1 < n) entries.emplace_back(id(i, j), id(i, j + 1), -1 + skew);
    }
  la::SparseMatrix A(n * n, n * n);
  A.setFromTriplets(entries.begin(), entries.end());
  return A;
}

template <class Solver>
void check_solves(const la::SparseMatrix& A) {
  Solver solver;
  solver.analyse(A);
  REQUIRE(solver.factorise(A));
  Eigen::VectorXd exact(A.rows()), x;
  for (Eigen::Index k = 0; k < exact.size(); ++k) exact[k] = std::sin(0.1 * static_cast<double>(k));
  const auto report = solver.solve(A * exact, x);
  CHECK(report);
  CHECK(report.residual < 1e-12);
  CHECK((x - exact).norm() < 1e-10 * exact.norm());
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(A.rows());
  CHECK(solver.solve(zero, x));
  CHECK(x.norm() == 0);
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("la: direct solvers solve definite and indefinite and unsymmetric systems") {
    check_solves<la::Ldlt>(grid_matrix(20, 0, 0));
    check_solves<la::Ldlt>(grid_matrix(20, 0, -1.2345));  // indefinite
    check_solves<la::Lu>(grid_matrix(20, 0, 0));
    check_solves<la::Lu>(grid_matrix(20, 0, -1.2345));
    check_solves<la::Lu>(grid_matrix(20, 0.7, 0));
  }

  TEST_CASE_TEMPLATE("la: direct solvers report singular matrices and NaN", Solver, la::Ldlt, la::Lu) {
    Solver solver;
    la::SparseMatrix A = grid_matrix(5, 0, 0);
    solver.analyse(A);
    A.coeffRef(0, 0) = std::numeric_limits<double>::quiet_NaN();
    Eigen::VectorXd x;
    const bool factorised = static_cast<bool>(solver.factorise(A));
    CHECK_FALSE((factorised && solver.solve(Eigen::VectorXd::Ones(25), x)));
    A = grid_matrix(5, 0, 0);
    A *= 0.0;
    CHECK(solver.factorise(A).status == Status::diverged);
    CHECK(solver.solve(Eigen::VectorXd::Ones(25), x).status == Status::diverged);
    A = grid_matrix(5, 0, 0);
    REQUIRE(solver.factorise(A));
    Eigen::VectorXd b = Eigen::VectorXd::Ones(25);
    b[3] = std::numeric_limits<double>::quiet_NaN();
    CHECK(solver.solve(b, x).status == Status::diverged);
  }
}
