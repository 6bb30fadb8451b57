// SPDX-License-Identifier: MIT
// Multigrid by smoothed aggregation: its parts, refresh against a fresh set-up, threads, units and its
// limits.
#include "tunica/la/multigrid.hpp"
#include "support/tet_operators.hpp"
#include "tunica/la/cg.hpp"
#include "tunica/la/rigid_modes.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <vector>

using namespace tunica;

namespace {

la::RowMatrix from_entries(int n, const std::vector<Eigen::Triplet<double>>& entries) {
  la::RowMatrix A(n, n);
  A.setFromTriplets(entries.begin(), entries.end());
  A.makeCompressed();
  return A;
}

template <class Precond>
SolveReport solve(const la::RowMatrix& A, const Precond& M, const Eigen::VectorXd& b, Eigen::VectorXd& x) {
  x = Eigen::VectorXd::Zero(b.size());
  return la::cg(la::ApplyMatrix<>{A}, M, b, x, {.tolerance = 1e-8, .max_iterations = 400});
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("la: aggregates cover the nodes that are coupled and their modes are orthonormal") {
    const auto A = test::diffusion(test::perturbed_cube(9));
    la::detail::Blocked<1> rows;
    rows.set_up(A);
    const auto strong = la::detail::strong_couplings<1>(rows.view(), 0.08);
    const auto aggregates = la::detail::aggregate<1>(rows.view(), strong);
    std::vector<int> members(static_cast<std::size_t>(aggregates.count), 0);
    for (const Index a : aggregates.of) {
      REQUIRE(a >= 0);
      ++members[static_cast<std::size_t>(a)];
    }
    CHECK(*std::min_element(members.begin(), members.end()) > 0);
    CHECK(aggregates.count < A.rows() / 5);

    // Rigid body modes on nodes of three unknowns: T^T T = I, T R = modes.
    const test::FreeNodes nodes(test::perturbed_cube(9));
    const auto modes = la::rigid_body_modes(test::free_points(test::perturbed_cube(9), nodes));
    const std::vector<double> by_rows = [&] {
      std::vector<double> v;
      for (Eigen::Index i = 0; i < modes.rows(); ++i)
        for (Eigen::Index m = 0; m < 6; ++m) v.push_back(modes(i, m));
      return v;
    }();
    std::vector<double> tentative, coarse;
    la::detail::orthonormalise<3, 6>(aggregates, by_rows, tentative, coarse);
    double off = 0, lost = 0;
    for (Index a = 0; a < aggregates.count; ++a) {
      Eigen::Matrix<double, 6, 6> gram = Eigen::Matrix<double, 6, 6>::Zero();
      const Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>> R(coarse.data() + 36 * a);
      for (Index i = 0; i < A.rows(); ++i) {
        if (aggregates.of[static_cast<std::size_t>(i)] != a) continue;
        const Eigen::Map<const Eigen::Matrix<double, 3, 6, Eigen::RowMajor>> T(tentative.data() + 18 * i);
        gram += T.transpose() * T;
        lost = std::max(lost, (T * R - modes.middleRows<3>(3 * i)).cwiseAbs().maxCoeff());
      }
      for (Eigen::Index c = 0; c < 6; ++c)  // a mode that is not there is a column of zeros
        if (gram(c, c) < 0.5) gram(c, c) += 1;
      off = std::max(off, (gram - Eigen::Matrix<double, 6, 6>::Identity()).cwiseAbs().maxCoeff());
    }
    CHECK(off < 1e-13);
    CHECK(lost < 1e-13);
  }

  TEST_CASE("la: the product of three matrices is that of Eigen and is made anew in place") {
    auto A = test::diffusion(test::perturbed_cube(8));
    la::detail::Blocked<1> rows;
    rows.set_up(A);
    la::detail::MultigridLevel<double, 1, 1> level;
    std::vector<double> modes(static_cast<std::size_t>(A.rows()), 1.0);
    REQUIRE(level.coarsen(rows.view(), 0.08, modes));
    const auto dense = [](const auto& m) {
      Eigen::MatrixXd full = Eigen::MatrixXd::Zero(m.rows, m.cols);
      for (Index i = 0; i < m.rows; ++i)
        for (Index k = m.start[static_cast<std::size_t>(i)]; k < m.start[static_cast<std::size_t>(i) + 1];
             ++k)
          full(i, m.column[static_cast<std::size_t>(k)]) += m.value[static_cast<std::size_t>(k)];
      return full;
    };
    la::detail::BlockRows<double, 1, 1> C;
    for (int pass = 0; pass < 2; ++pass) {
      la::detail::galerkin(rows.view(), level.P, level.R, C);
      const Eigen::MatrixXd P = dense(level.P), exact = P.transpose() * Eigen::MatrixXd(A) * P;
      CHECK((dense(C) - exact).cwiseAbs().maxCoeff() < 1e-14 * exact.cwiseAbs().maxCoeff() * 10);
      A *= 3.7;
    }
  }

  TEST_CASE("la: a refreshed multigrid is one that is made anew") {
    const auto mesh = test::perturbed_cube(16);
    const test::FreeNodes nodes(mesh);
    const auto first = test::diffusion(mesh, nodes, [](Index) { return 1.0; });
    const auto second = test::diffusion(mesh, nodes, [](Index e) { return 3 + 1e-6 * std::sin(0.1 * e); });
    const auto other = test::diffusion(mesh, nodes, [](Index e) { return 3 + std::sin(0.1 * e); });
    la::Multigrid<1, 1, double> fresh, used;
    la::Multigrid<> single, single_used;
    REQUIRE(fresh.compute(second));
    REQUIRE(used.compute(first));
    REQUIRE(used.refresh(second));
    REQUIRE(single.compute(second));
    REQUIRE(single_used.compute(second));
    REQUIRE(single_used.refresh(second));
    const Eigen::VectorXd r = test::Noise{}.vector(first.rows());
    Eigen::VectorXd z, w;
    fresh.apply(r, z);
    used.apply(r, w);
    CHECK((z - w).norm() < 1e-12 * z.norm());
    single.apply(r, z);
    single_used.apply(r, w);
    CHECK((z.array() == w.array()).all());
    fresh.apply(r, w);
    CHECK((z - w).norm() < 1e-5 * w.norm());  // float against double
    CHECK(used.levels() > 2);

    Eigen::VectorXd x;  // values changed by a third: as good as one that chose its aggregates for them
    REQUIRE(fresh.compute(other));
    REQUIRE(used.refresh(other));
    const int anew = solve(other, fresh, r, x).iterations, kept = solve(other, used, r, x).iterations;
    CHECK(kept <= anew + 2);
    MESSAGE(anew << " iterations made anew, " << kept << " refreshed");
    MESSAGE("levels " << used.levels() << ", operator complexity " << used.operator_complexity());
  }

  TEST_CASE("la: a multigrid is symmetric and definite") {
    const auto A = test::diffusion(test::perturbed_cube(14));
    la::Multigrid<1, 1, double> M;
    REQUIRE(M.compute(A));
    test::Noise noise;
    for (int k = 0; k < 5; ++k) {
      const Eigen::VectorXd r = noise.vector(A.rows()), s = noise.vector(A.rows());
      Eigen::VectorXd Mr, Ms;
      M.apply(r, Mr);
      M.apply(s, Ms);
      CHECK(std::abs(r.dot(Ms) - s.dot(Mr)) < 1e-12 * std::sqrt(r.dot(Mr) * s.dot(Ms)));
      CHECK(r.dot(Mr) > 0);
    }
  }

  TEST_CASE("la: a multigrid has the same bits on one thread and on two") {
    const auto mesh = test::perturbed_cube(30);
    const auto A = test::diffusion(mesh);
    const Eigen::VectorXd b = test::Noise{}.vector(A.rows());
    Eigen::VectorXd x1, x2;
    la::Multigrid<> one, two;
    REQUIRE(one.compute(A));
    const auto r1 = solve(A, one, b, x1);
    thread_count() = 2;
    REQUIRE(two.compute(A));
    const auto r2 = solve(A, two, b, x2);
    thread_count() = 1;
    CHECK(bool(r1));
    CHECK(r1.iterations == r2.iterations);
    CHECK((x1.array() == x2.array()).all());
  }

  TEST_CASE("la: a multigrid knows no units") {
    const auto A = test::diffusion(test::perturbed_cube(12));
    const Eigen::VectorXd b = test::Noise{}.vector(A.rows());
    la::Multigrid<> M, scaled;
    REQUIRE(M.compute(A));
    REQUIRE(scaled.compute(la::RowMatrix(A * 0x1p-160)));
    Eigen::VectorXd z, w;
    M.apply(b, z);
    scaled.apply(b * 0x1p120, w);
    CHECK((w.array() == (z * 0x1p280).array()).all());
  }

  TEST_CASE("la: small and odd matrices have a multigrid too") {
    Eigen::VectorXd x;
    la::Multigrid<> M({.coarsest = 4});
    {  // one unknown
      const auto A = from_entries(1, {{0, 0, 4.0}});
      REQUIRE(M.compute(A));
      CHECK(solve(A, M, Eigen::VectorXd::Constant(1, 2.0), x).iterations == 1);
      CHECK(x[0] == doctest::Approx(0.5));
    }
    {  // no couplings at all
      std::vector<Eigen::Triplet<double>> entries;
      for (int i = 0; i < 2000; ++i) entries.emplace_back(i, i, 1.0 + i);
      const auto A = from_entries(2000, entries);
      REQUIRE(M.compute(A));
      CHECK(solve(A, M, Eigen::VectorXd::Ones(2000), x).iterations <= 2);
    }
    {  // two chains that know nothing of each other, one of them a thousand times stiffer
      std::vector<Eigen::Triplet<double>> entries;
      for (int i = 0; i < 400; ++i) {
        const double k = i < 200 ? 1 : 1000;
        entries.emplace_back(i, i, 2 * k);
        if (i % 200 > 0) entries.emplace_back(i, i - 1, -k), entries.emplace_back(i - 1, i, -k);
      }
      const auto A = from_entries(400, entries);
      REQUIRE(M.compute(A));
      const auto report = solve(A, M, Eigen::VectorXd::Ones(400), x);
      CHECK(report.status == Status::converged);
      CHECK(report.iterations < 20);
    }
    {  // no unknowns
      const la::RowMatrix A(0, 0);
      REQUIRE(M.compute(A));
      CHECK(bool(solve(A, M, Eigen::VectorXd(0), x)));
    }
  }

  TEST_CASE("la: rigid body modes carry no energy") {
    const auto mesh = test::perturbed_cube(5);
    const test::FreeNodes nodes(mesh, false);
    const auto A = test::elasticity(mesh, nodes, 10);
    const auto modes = la::rigid_body_modes(test::free_points(mesh, nodes));
    CHECK((A * modes).norm() < 1e-13 * A.norm() * modes.norm());
    CHECK(Eigen::FullPivLU<Eigen::MatrixXd>(modes).rank() == 6);
  }
}
