// SPDX-License-Identifier: MIT
// Krylov solvers against a direct solution, with every preconditioner, and how they end in trouble.
#include "tunica/la/krylov.hpp"
#include "tunica/la/bicgstab.hpp"
#include "tunica/la/cg.hpp"
#include "tunica/la/iterative.hpp"
#include "tunica/la/preconditioner.hpp"

#include <doctest/doctest.h>

#include <Eigen/SparseLU>

#include <cmath>
#include <limits>
#include <vector>

using namespace tunica;

namespace {

/// -Laplace + wind . grad on an n^3 grid, 7 points, h = 1; wind = 0 is symmetric positive definite.
la::RowMatrix grid_operator(int n, double wind) {
  std::vector<Eigen::Triplet<double>> entries;
  const auto id = [n](int i, int j, int k) { return i + n * (j + n * k); };
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        entries.emplace_back(id(i, j, k), id(i, j, k), 6.0 + 0.1 * std::sin(i + 2 * j + 3 * k));
        if (i > 0) entries.emplace_back(id(i, j, k), id(i - 1, j, k), -1.0 - wind);
        if (i < n - 1) entries.emplace_back(id(i, j, k), id(i + 1, j, k), -1.0 + wind);
        if (j > 0) entries.emplace_back(id(i, j, k), id(i, j - 1, k), -1.0 - wind);
        if (j < n - 1) entries.emplace_back(id(i, j, k), id(i, j + 1, k), -1.0 + wind);
        if (k > 0) entries.emplace_back(id(i, j, k), id(i, j, k - 1), -1.0);
        if (k < n - 1) entries.emplace_back(id(i, j, k), id(i, j, k + 1), -1.0);
      }
  la::RowMatrix A(n * n * n, n * n * n);
  A.setFromTriplets(entries.begin(), entries.end());
  A.makeCompressed();
  return A;
}

Eigen::VectorXd waves(Eigen::Index n) {
  Eigen::VectorXd b(n);
  for (Eigen::Index i = 0; i < n; ++i) b[i] = std::sin(0.3 * double(i)) + 0.2;
  return b;
}

template <class P>
P preconditioner(const la::RowMatrix& A) {
  P p;
  if constexpr (requires { p.compute(A); }) p.compute(A);
  return p;
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE_TEMPLATE("la: conjugate gradients find the solution", P, la::Identity, la::Jacobi<>, la::Ilu0<>,
                     la::IncompleteCholesky) {
    const auto A = grid_operator(12, 0);
    const Eigen::VectorXd exact = waves(A.rows()), b = A * exact;
    Eigen::VectorXd x = Eigen::VectorXd::Zero(A.rows());
    const auto report = la::cg(la::ApplyMatrix<>{A}, preconditioner<P>(A), b, x, {.tolerance = 1e-10});
    CHECK(report.status == Status::converged);
    CHECK((b - A * x).norm() <= 1e-10 * b.norm());
    CHECK((x - exact).norm() < 1e-8 * exact.norm());
    MESSAGE("iterations " << report.iterations);
  }

  TEST_CASE_TEMPLATE("la: bicgstab finds the solution without symmetry", P, la::Identity, la::Jacobi<>,
                     la::Ilu0<>) {
    const auto A = grid_operator(12, 0.6);
    const Eigen::VectorXd exact = waves(A.rows()), b = A * exact;
    Eigen::VectorXd x = Eigen::VectorXd::Zero(A.rows());
    const auto report = la::bicgstab(la::ApplyMatrix<>{A}, preconditioner<P>(A), b, x, {.tolerance = 1e-10});
    CHECK(report.status == Status::converged);
    CHECK((b - A * x).norm() <= 1e-10 * b.norm());
    CHECK((x - exact).norm() < 1e-8 * exact.norm());
    MESSAGE("iterations " << report.iterations);
  }

  TEST_CASE("la: three right-hand sides at once equal three of one") {
    const auto A = grid_operator(8, 0.4);
    const Eigen::VectorXd exact = waves(3 * A.rows());
    Eigen::VectorXd b(exact.size()), x = Eigen::VectorXd::Zero(exact.size());
    la::multiply<3>(A, exact, b);
    for (int c = 0; c < 3; ++c) {
      const Eigen::VectorXd one = A * Eigen::VectorXd(exact.reshaped(3, A.rows()).row(c));
      CHECK((one.transpose() - b.reshaped(3, A.rows()).row(c)).norm() < 1e-13 * one.norm());
    }
    for (const bool jacobi : {true, false}) {
      x.setZero();
      const auto report = jacobi ? la::bicgstab(la::ApplyMatrix<3>{A}, preconditioner<la::Jacobi<3>>(A), b, x,
                                                {.tolerance = 1e-10})
                                 : la::bicgstab(la::ApplyMatrix<3>{A}, preconditioner<la::Ilu0<3>>(A), b, x,
                                                {.tolerance = 1e-10});
      CHECK(bool(report));
      CHECK((x - exact).norm() < 1e-8 * exact.norm());
    }
  }

  TEST_CASE("la: incomplete Cholesky is exact without fill and shifts where there are no factors") {
    std::vector<Eigen::Triplet<double>> entries;
    const int n = 30;
    for (int i = 0; i < n; ++i) {
      entries.emplace_back(i, i, 2.5 + 0.01 * i);
      if (i > 0) entries.emplace_back(i, i - 1, -1.0), entries.emplace_back(i - 1, i, -1.0);
    }
    la::RowMatrix A(n, n);
    A.setFromTriplets(entries.begin(), entries.end());
    la::IncompleteCholesky ic;
    ic.compute(A);
    CHECK(ic.shift() == 0.0);
    Eigen::VectorXd z;
    const Eigen::VectorXd b = waves(n);
    ic.apply(b, z);
    CHECK((A * z - b).norm() < 1e-13);

    // Kershaw's matrix: positive definite, without incomplete factors on its own pattern.
    la::RowMatrix K(4, 4);
    const std::vector<Eigen::Triplet<double>> kershaw{{0, 0, 3},  {0, 1, -2}, {0, 3, 2},  {1, 0, -2},
                                                      {1, 1, 3},  {1, 2, -2}, {2, 1, -2}, {2, 2, 3},
                                                      {2, 3, -2}, {3, 0, 2},  {3, 2, -2}, {3, 3, 3}};
    K.setFromTriplets(kershaw.begin(), kershaw.end());
    ic.compute(K);
    CHECK(ic.shift() > 0);
    Eigen::VectorXd x = Eigen::VectorXd::Zero(4);
    CHECK(bool(la::cg(la::ApplyMatrix<>{K}, ic, waves(4), x, {.tolerance = 1e-12})));
  }

  TEST_CASE_TEMPLATE("la: a krylov solver is a linear solver", S, la::Cg<>, la::BiCgStab<>) {
    la::SparseMatrix A = grid_operator(8, S::symmetric ? 0.0 : 0.5);
    const Eigen::VectorXd exact = waves(A.rows()), b = A * exact;
    S solver(la::KrylovOptions{.tolerance = 1e-10});
    solver.analyse(A);
    REQUIRE(solver.factorise(A));
    Eigen::VectorXd x;
    const auto report = solver.solve(b, x);
    CHECK(report.status == Status::converged);
    CHECK((x - exact).norm() < 1e-8 * exact.norm());
    CHECK(solver.solve(b, x).iterations == 0);  // x is the start
    A.coeffRef(0, 0) = std::numeric_limits<double>::quiet_NaN();
    CHECK(solver.factorise(A).status == Status::diverged);
  }

  TEST_CASE("la: a history of residuals ends in its status") {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const la::KrylovOptions options{.tolerance = 1e-2, .max_iterations = 9, .stall = 3};
    const auto ends = [&](const std::vector<double>& residuals) {
      la::detail::Watch watch(2, options);
      SolveReport report;
      int n = 0;
      for (const double r : residuals)
        if (watch.done(r, n++, report)) break;
      return report;
    };
    CHECK(ends({2, 0.1, 0.02, 0.01}).status == Status::converged);
    CHECK(ends({2, 0.1, 0.02, 0.01}).iterations == 2);
    CHECK(ends({2, 0.1, 0.02}).residual == doctest::Approx(0.01));
    CHECK(ends({2, nan, 0.01}).status == Status::diverged);
    CHECK(ends({2, 3e8}).status == Status::diverged);
    CHECK(ends({2, 1, 1, 0.999, 0.999, 0.01}).status == Status::stalled);
    CHECK(ends({10, 9, 8, 7, 6, 5, 4, 3, 2, 1, 0}).status == Status::max_iterations);
  }

  TEST_CASE("la: a krylov solver says how it failed") {
    auto A = grid_operator(6, 0);
    const Eigen::VectorXd b = waves(A.rows());
    Eigen::VectorXd x = Eigen::VectorXd::Zero(A.rows());
    const la::Identity none;
    CHECK(la::cg(la::ApplyMatrix<>{A}, none, b, x, {.tolerance = 1e-14, .max_iterations = 2}).status ==
          Status::max_iterations);
    x.setZero();
    const auto floor =
        la::cg(la::ApplyMatrix<>{A}, none, b, x, {.tolerance = 1e-20, .max_iterations = 100000});
    CHECK(floor.status == Status::stalled);
    CHECK(floor.residual < 1e-13);
    x.setZero();
    Eigen::VectorXd bad = b;
    bad[5] = std::numeric_limits<double>::quiet_NaN();
    CHECK(la::cg(la::ApplyMatrix<>{A}, none, bad, x).status == Status::diverged);
    x.setZero();
    CHECK(la::bicgstab(la::ApplyMatrix<>{A}, none, bad, x).status == Status::diverged);
    x.setZero();
    A.coeffRef(0, 0) = -50;  // indefinite
    CHECK(la::cg(la::ApplyMatrix<>{A}, none, b, x).status == Status::diverged);
    A.coeffRef(0, 0) = std::numeric_limits<double>::quiet_NaN();
    x.setZero();
    CHECK(la::cg(la::ApplyMatrix<>{A}, preconditioner<la::IncompleteCholesky>(A), b, x).status ==
          Status::diverged);
    x.setZero();
    CHECK(la::bicgstab(la::ApplyMatrix<>{A}, preconditioner<la::Ilu0<>>(A), b, x).status == Status::diverged);
  }

  TEST_CASE("la: the same bits on one thread and on three") {
    const auto A = grid_operator(30, 0.3);
    const Eigen::VectorXd b = waves(A.rows());
    Eigen::VectorXd x1 = Eigen::VectorXd::Zero(A.rows()), x3 = x1;
    const auto ilu = preconditioner<la::Ilu0<>>(A);
    CHECK(bool(la::bicgstab(la::ApplyMatrix<>{A}, ilu, b, x1)));
    thread_count() = 3;
    CHECK(bool(la::bicgstab(la::ApplyMatrix<>{A}, ilu, b, x3)));
    thread_count() = 1;
    CHECK((x1.array() == x3.array()).all());
  }
}
