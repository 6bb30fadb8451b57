// SPDX-License-Identifier: MIT
// Krylov solvers against a direct solution, with every preconditioner, and how they end in trouble.
#include "tunica/la/krylov.hpp"
#include "tunica/la/bicgstab.hpp"
#include "tunica/la/cg.hpp"
#include "tunica/la/gmres.hpp"
#include "tunica/la/iterative.hpp"
#include "tunica/la/minres.hpp"
#include "tunica/la/multigrid.hpp"
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
  if constexpr (requires { p.compute(A); }) static_cast<void>(p.compute(A));
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

  TEST_CASE_TEMPLATE("la: gmres finds the solution without symmetry", P, la::Identity, la::Jacobi<>,
                     la::Ilu0<>, la::Multigrid<>) {
    const auto A = grid_operator(12, 0.6);
    const Eigen::VectorXd exact = waves(A.rows()), b = A * exact;
    for (const int restart : {8, 50}) {
      Eigen::VectorXd x = Eigen::VectorXd::Zero(A.rows());
      const auto report = la::gmres(la::ApplyMatrix<>{A}, preconditioner<P>(A), b, x,
                                    {.tolerance = 1e-10, .restart = restart});
      CHECK(report.status == Status::converged);
      CHECK((b - A * x).norm() <= 1e-10 * b.norm());
      CHECK((x - exact).norm() < 1e-8 * exact.norm());
      MESSAGE("restart " << restart << ": iterations " << report.iterations);
    }
  }

  TEST_CASE("la: gmres without restart is exact after as many steps as there are eigenvalues") {
    const int n = 60;
    la::RowMatrix A(n, n);
    for (int i = 0; i < n; ++i) {
      A.insert(i, i) = 1 + i % 4;  // 1 2 3 4
      if (i % 4 == 3) A.insert(i, i - 3) = 0.5;
    }
    A.makeCompressed();
    const Eigen::VectorXd exact = waves(n), b = A * exact;
    Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
    const auto report = la::gmres(la::ApplyMatrix<>{A}, la::Identity{}, b, x, {.tolerance = 1e-13});
    CHECK(report.status == Status::converged);
    CHECK(report.iterations == 4);
    CHECK((x - exact).norm() < 1e-12 * exact.norm());
  }

  TEST_CASE_TEMPLATE("la: minres finds the solution of definite and of indefinite matrices", P, la::Identity,
                     la::Jacobi<>, la::IncompleteCholesky, la::Multigrid<>) {
    const auto A = grid_operator(12, 0);
    const auto M = preconditioner<P>(A);
    for (const double shift : {0.0, -0.7}) {
      la::RowMatrix S = A;
      for (Eigen::Index i = 0; i < S.rows(); ++i) S.coeffRef(i, i) += shift;
      const Eigen::VectorXd exact = waves(A.rows()), b = S * exact;
      Eigen::VectorXd x = Eigen::VectorXd::Zero(A.rows());
      const auto report = la::minres(la::ApplyMatrix<>{S}, M, b, x, {.tolerance = 1e-10});
      CHECK(report.status == Status::converged);
      CHECK((b - S * x).norm() <= 1e-10 * b.norm());
      CHECK((x - exact).norm() < 1e-7 * exact.norm());
      MESSAGE("shift " << shift << ": iterations " << report.iterations);
    }
  }

  TEST_CASE("la: minres on a saddle point takes three steps with the ideal preconditioner") {
    // [A B^T; B 0] with diag(A, B A^-1 B^T): three eigenvalues, 1 and (1 +- sqrt 5) / 2.
    const int n = 40, m = 15;
    Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n + m, n + m);
    for (int i = 0; i < n; ++i) K(i, i) = 1 + 0.1 * i;
    for (int i = 0; i < m; ++i)
      for (int j = 0; j < n; ++j) K(n + i, j) = K(j, n + i) = (j % m == i) + 0.3 * std::sin(1.7 * j * j + i);
    Eigen::MatrixXd inverse = Eigen::MatrixXd::Zero(n + m, n + m);
    for (int i = 0; i < n; ++i) inverse(i, i) = 1 / K(i, i);
    const Eigen::MatrixXd B = K.bottomLeftCorner(m, n);
    inverse.bottomRightCorner(m, m) = (B * inverse.topLeftCorner(n, n) * B.transpose()).inverse();
    struct Dense {
      const Eigen::MatrixXd& m;
      void apply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const { y = m * x; }
    };
    const Eigen::VectorXd exact = waves(n + m), b = K * exact;
    Eigen::VectorXd x = Eigen::VectorXd::Zero(n + m);
    const auto report = la::minres(Dense{K}, Dense{inverse}, b, x, {.tolerance = 1e-11});
    CHECK(report.status == Status::converged);
    CHECK(report.iterations == 3);
    CHECK((x - exact).norm() < 1e-8 * exact.norm());
  }

  TEST_CASE("la: incomplete LU shifts where a pivot breaks down and leaves rows of zeros alone") {
    la::RowMatrix A(4, 4);  // the second pivot is 1 - 1 = 0, the last row is empty
    const std::vector<Eigen::Triplet<double>> entries{{0, 0, 1}, {0, 1, 1}, {1, 0, 1}, {1, 1, 1},
                                                      {1, 2, 2}, {2, 1, 2}, {2, 2, 1}, {3, 3, 0.0}};
    A.setFromTriplets(entries.begin(), entries.end());
    la::Ilu0<> ilu;
    ilu.compute(A);
    CHECK(ilu.shift() > 0);
    CHECK(ilu.shift() < 0.1);
    Eigen::VectorXd x = Eigen::VectorXd::Zero(4), b(4);
    b << 1, 2, 3, 0;
    CHECK(bool(la::gmres(la::ApplyMatrix<>{A}, ilu, b, x, {.tolerance = 1e-12})));
    CHECK((b - A * x).norm() < 1e-11);
    ilu.compute(grid_operator(4, 0.3));
    CHECK(ilu.shift() == 0);
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

  TEST_CASE_TEMPLATE("la: a krylov solver is a linear solver", S, la::Cg<>, la::BiCgStab<>, la::Minres<>,
                     la::Gmres<>, la::Cg<la::Multigrid<>>, la::Gmres<la::Multigrid<>>) {
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
    A *= 2.5;                                   // values that change on a pattern that stays
    REQUIRE(solver.factorise(A));
    CHECK(bool(solver.solve(b, x)));
    CHECK((2.5 * x - exact).norm() < 1e-8 * exact.norm());
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
    CHECK(ends({2, 0.1, 0.02}).residual == doctest::Approx(0.01).scale(0));
    CHECK(ends({2, nan, 0.01}).status == Status::diverged);
    CHECK(ends({2, 3e8}).status == Status::diverged);
    CHECK(ends({2, 1, 1, 0.999, 0.999, 0.01}).status == Status::stalled);
    CHECK(ends({10, 9, 8, 7, 6, 5, 4, 3, 2, 1, 0}).status == Status::max_iterations);
  }

  TEST_CASE("la: a krylov solver says how it failed") {
    using Solve = SolveReport (*)(const la::ApplyMatrix<>&, const la::Identity&, const Eigen::VectorXd&,
                                  Eigen::VectorXd&, const la::KrylovOptions&);
    const Solve conjugate = la::cg<la::ApplyMatrix<>, la::Identity>;
    const Solve minimal = la::minres<la::ApplyMatrix<>, la::Identity>;
    const Solve stabilised = la::bicgstab<la::ApplyMatrix<>, la::Identity>;
    const Solve generalised = la::gmres<la::ApplyMatrix<>, la::Identity>;
    const double nan_value = std::numeric_limits<double>::quiet_NaN();
    const auto A = grid_operator(6, 0);
    const Eigen::VectorXd b = waves(A.rows());
    const auto ends = [&](Solve solve, const la::RowMatrix& matrix, const Eigen::VectorXd& right,
                          const la::KrylovOptions& options) {
      Eigen::VectorXd x = Eigen::VectorXd::Zero(right.size());
      return solve(la::ApplyMatrix<>{matrix}, la::Identity{}, right, x, options);
    };
    for (const Solve solve : {conjugate, minimal, stabilised, generalised}) {
      CHECK(ends(solve, A, b, {.tolerance = 1e-14, .max_iterations = 2}).status == Status::max_iterations);
      const auto floor = ends(solve, A, b, {.tolerance = 1e-20, .max_iterations = 100000});
      CHECK(floor.status == Status::stalled);
      CHECK(floor.residual < 1e-13);
      CHECK(ends(solve, A, Eigen::VectorXd::Zero(b.size()), {}).iterations == 0);
      Eigen::VectorXd bad = b;
      bad[5] = nan_value;
      CHECK(ends(solve, A, bad, {}).status == Status::diverged);
      auto N = A;
      N.coeffRef(0, 0) = nan_value;
      CHECK(ends(solve, N, b, {}).status == Status::diverged);
      // Singular, and b is not in the range: nothing that is found may be called a solution.
      auto Z = A;
      for (Eigen::Index i = 0; i < Z.rows(); ++i)
        for (la::RowMatrix::InnerIterator it(Z, i); it; ++it)
          if (i == 7 || it.col() == 7) it.valueRef() = 0;
      const auto singular = ends(solve, Z, b, {.tolerance = 1e-10, .max_iterations = 3000});
      CHECK(singular.status != Status::converged);
    }
    auto I = A;
    I.coeffRef(0, 0) = -50;  // indefinite: no matter for those that minimise a residual
    CHECK(ends(conjugate, I, b, {}).status == Status::diverged);
    CHECK(ends(minimal, I, b, {}).status == Status::converged);
    CHECK(ends(generalised, I, b, {}).status == Status::converged);

    la::RowMatrix cycle(40, 40);  // x_i = b_(i+1): forty vectors or none
    for (int i = 0; i < 40; ++i) cycle.insert(i, (i + 1) % 40) = 1;
    cycle.makeCompressed();
    const Eigen::VectorXd one = Eigen::VectorXd::Unit(40, 3);
    CHECK(ends(generalised, cycle, one, {.restart = 20}).status == Status::stalled);
    CHECK(ends(generalised, cycle, one, {.restart = 40}).status == Status::converged);

    struct Negative {  // no preconditioner for MINRES or CG
      void apply(const Eigen::VectorXd& r, Eigen::VectorXd& z) const { z = -r; }
    };
    Eigen::VectorXd x = Eigen::VectorXd::Zero(b.size());
    CHECK(la::minres(la::ApplyMatrix<>{A}, Negative{}, b, x).status == Status::diverged);
    CHECK(la::cg(la::ApplyMatrix<>{A}, Negative{}, b, x).status == Status::diverged);
    auto N = A;
    N.coeffRef(0, 0) = nan_value;
    CHECK(la::cg(la::ApplyMatrix<>{N}, preconditioner<la::IncompleteCholesky>(N), b, x).status ==
          Status::diverged);
    x.setZero();
    CHECK(la::bicgstab(la::ApplyMatrix<>{N}, preconditioner<la::Ilu0<>>(N), b, x).status == Status::diverged);
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
