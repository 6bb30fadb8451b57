// SPDX-License-Identifier: MIT
// Solvers that read matrices of blocks as they are: the same as through matrices of numbers, both storages.
#include "support/tet_operators.hpp"
#include "tunica/la/block_convert.hpp"
#include "tunica/la/cell_patches.hpp"
#include "tunica/la/iterative.hpp"
#include "tunica/la/multigrid.hpp"
#include "tunica/la/rigid_modes.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace tunica;

static_assert(la::LinearSolver<la::Cg<la::Multigrid<3, 6>>, la::BlockMatrix<3>>);
static_assert(la::LinearSolver<la::Gmres<la::Multigrid<3>>, la::BlockMatrix<3>>);
static_assert(la::LinearSolver<la::Cg<la::Multigrid<3, 6>>>);
static_assert(!la::LinearSolver<la::Cg<>, la::BlockMatrix<3>>);
static_assert(!la::LinearSolver<la::Cg<la::Multigrid<3>>, la::BlockMatrix<2>>);

namespace {

struct Solid {
  mesh::Mesh<mesh::Tet4, 3> mesh = test::perturbed_cube(12);
  test::FreeNodes nodes{mesh};
  la::RowMatrix A = test::elasticity(mesh, nodes, 10);
  Eigen::MatrixXd modes = la::rigid_body_modes(test::free_points(mesh, nodes));
  Eigen::VectorXd b = test::Noise{}.vector(A.rows());

  [[nodiscard]] la::Multigrid<3, 6> multigrid() const {
    la::Multigrid<3, 6> M;
    M.near_null_space(modes);
    return M;
  }
};

/// A matrix of numbers in blocks of three.
la::BlockMatrix<3> in_blocks(const la::RowMatrix& A) {
  la::detail::Blocked<3> rows;
  rows.set_up(A);
  const auto view = rows.view();
  const auto count = view.start[view.rows];
  la::BlockMatrix<3> B({view.start, view.start + view.rows + 1}, {view.column, view.column + count});
  std::copy_n(view.value, 9 * static_cast<std::size_t>(count), B.values());
  return B;
}

la::BlockMatrix<3> upper(const la::BlockMatrix<3>& A) {
  auto U = la::upper_pattern(A);
  la::copy_upper(A, U);
  return U;
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("la: the upper triangle of a block matrix is its upper triangle") {
    const Solid s;
    const auto A = in_blocks(s.A);
    const auto U = upper(A);
    CHECK(U.storage() == la::BlockStorage::upper);
    CHECK((Eigen::MatrixXd(la::sparse(U)) - Eigen::MatrixXd(s.A)).cwiseAbs().maxCoeff() <
          1e-15 * s.A.coeffs().cwiseAbs().maxCoeff());
    thread_count() = 2;
    auto V = la::upper_pattern(A);
    la::copy_upper(A, V);
    thread_count() = 1;
    CHECK(std::equal(U.values(), U.values() + 9 * U.block_count(), V.values()));
  }

  TEST_CASE("la: a multigrid reads blocks in either storage to the same bits as numbers") {
    const Solid s;
    const auto A = in_blocks(s.A);
    const auto U = upper(la::whole(upper(A)));  // symmetric to the last bit
    auto from_numbers = s.multigrid(), from_blocks = s.multigrid(), from_upper = s.multigrid();
    REQUIRE(from_numbers.compute(s.A));
    REQUIRE(from_blocks.compute(A));
    REQUIRE(from_upper.compute(U));
    Eigen::VectorXd x, y, z;
    from_numbers.apply(s.b, x), from_blocks.apply(s.b, y), from_upper.apply(s.b, z);
    CHECK((x.array() == y.array()).all());
    CHECK((x - z).norm() < 1e-5 * x.norm());

    // New values, and a matrix of numbers in between.
    auto A2 = A;
    for (std::size_t k = 0; k < 9 * static_cast<std::size_t>(A.block_count()); ++k) A2.values()[k] *= 1.75;
    REQUIRE(from_blocks.refresh(A2));
    REQUIRE(from_upper.refresh(upper(A2)));
    REQUIRE(from_numbers.refresh(la::RowMatrix(1.75 * s.A)));
    from_numbers.apply(s.b, x), from_blocks.apply(s.b, y), from_upper.apply(s.b, z);
    CHECK((x.array() == y.array()).all());
    CHECK((x - z).norm() < 1e-5 * x.norm());
    REQUIRE(from_blocks.refresh(s.A));
    REQUIRE(from_blocks.refresh(A2));
    from_blocks.apply(s.b, y);
    CHECK((x.array() == y.array()).all());

    A2.block(7)[4] = std::numeric_limits<double>::quiet_NaN();
    CHECK(from_blocks.refresh(A2).status == Status::diverged);
    CHECK(s.multigrid().compute(A2).status == Status::diverged);
    REQUIRE(from_blocks.refresh(A));
  }

  TEST_CASE_TEMPLATE("la: a krylov solver takes blocks without a detour", S, la::Cg<la::Multigrid<3, 6>>,
                     la::Minres<la::Multigrid<3, 6>>, la::Gmres<la::Multigrid<3, 6>>,
                     la::BiCgStab<la::Multigrid<3, 6>>) {
    const Solid s;
    S solver({.tolerance = 1e-9}, s.multigrid()), by_numbers({.tolerance = 1e-9}, s.multigrid());
    const auto A = in_blocks(s.A);
    Eigen::VectorXd x, y;
    solver.analyse(A);
    REQUIRE(solver.factorise(A));
    const auto report = solver.solve(s.b, x);
    CHECK(report.status == Status::converged);
    CHECK((s.b - s.A * x).norm() <= 1e-9 * s.b.norm());
    const la::SparseMatrix columns = s.A;
    by_numbers.analyse(columns);
    REQUIRE(by_numbers.factorise(columns));
    const auto other = by_numbers.solve(s.b, y);
    CHECK(std::abs(report.iterations - other.iterations) <= 1);
    CHECK((x - y).norm() < 1e-6 * x.norm());

    // Prescribed unknowns of any diagonal, eliminated in either storage.
    struct Some {
      [[nodiscard]] bool fixed(Index i) const { return i % 31 == 0; }
      [[nodiscard]] double value(Index i) const { return 1e-3 * i; }
    };
    for (const double diagonal : {1e-6, 1.0, 1e6})
      for (const bool half : {false, true}) {
        auto K = half ? upper(A) : A;
        Eigen::VectorXd b = s.b;
        la::eliminate(K, Some{}, b, diagonal);
        solver.analyse(K);
        REQUIRE(solver.factorise(K));
        x.setZero(b.size());
        const auto eliminated = solver.solve(b, x);
        CHECK(eliminated.status == Status::converged);
        CHECK((b - la::sparse(K) * x).norm() <= 1.01e-9 * b.norm());
        CHECK(eliminated.iterations <= report.iterations + 5);
      }

    // A NaN, then numbers after blocks.
    S moved = std::move(solver);
    auto bad = A;
    bad.block(0)[0] = std::numeric_limits<double>::quiet_NaN();
    CHECK(moved.factorise(bad).status == Status::diverged);
    moved.analyse(columns);
    REQUIRE(moved.factorise(columns));
    x.setZero();
    CHECK(moved.solve(s.b, x).iterations == other.iterations);
    CHECK((x.array() == y.array()).all());
  }

  TEST_CASE("la: sweeps over cells are symmetric and save iterations") {
    const auto mesh = test::perturbed_cube(10);
    const test::FreeNodes nodes(mesh, false);
    using Patches = la::CellPatches<4, la::Multigrid<3, 6>>;
    la::Multigrid<3, 6> rigid;
    rigid.near_null_space(la::rigid_body_modes(mesh.nodes));
    struct Held {  // the side x = 0
      const mesh::TetMesh& mesh;
      [[nodiscard]] bool fixed(Index i) const { return mesh.nodes(0, i / 3) == 0; }
      [[nodiscard]] double value(Index) const { return 0; }
    };
    for (const double kappa : {10.0, 1e3}) {
      auto A = in_blocks(test::elasticity(mesh, nodes, kappa));
      Eigen::VectorXd b = test::Noise{}.vector(A.rows()), x, y;
      la::eliminate(A, Held{mesh}, b, 3);
      la::Cg<Patches> with({.tolerance = 1e-8}, Patches(mesh.cells, rigid));
      la::Cg<la::Multigrid<3, 6>> without({.tolerance = 1e-8}, rigid);
      with.analyse(A), without.analyse(A);
      REQUIRE(with.factorise(A));
      REQUIRE(without.factorise(A));
      const auto patched = with.solve(b, x), plain = without.solve(b, y);
      CHECK(patched.status == Status::converged);
      CHECK((b - la::sparse(A) * x).norm() <= 1e-8 * b.norm());
      CHECK((x - y).norm() < 1e-4 * y.norm());
      CHECK(patched.iterations < plain.iterations);
      MESSAGE("kappa/mu " << kappa << ": " << patched.iterations << " iterations, " << plain.iterations
                          << " without sweeps over cells");

      const la::SparseMatrix numbers = la::sparse(A);  // come to blocks by the solver
      with.analyse(numbers);
      REQUIRE(with.factorise(numbers));
      x.setZero();
      CHECK(with.solve(b, x).iterations == patched.iterations);
      CHECK((x - y).norm() < 1e-4 * y.norm());

      Patches M(mesh.cells, rigid), half(mesh.cells, rigid);
      REQUIRE(M.compute(A));
      REQUIRE(half.compute(upper(A)));
      Eigen::VectorXd Mr, Ms, r = test::Noise{}.vector(A.rows()), s = r.reverse();
      M.apply(r, Mr), M.apply(s, Ms);
      CHECK(std::abs(r.dot(Ms) - s.dot(Mr)) < 1e-4 * std::sqrt(r.dot(Mr) * s.dot(Ms)));  // in float
      CHECK(r.dot(Mr) > 0);
      half.apply(r, Ms);
      CHECK((Ms - Mr).norm() < 1e-3 * Mr.norm());
      // Powers of two pass through to the bit, new values on the old pattern too.
      auto scaled = A;
      for (std::size_t k = 0; k < 9 * static_cast<std::size_t>(A.block_count()); ++k)
        scaled.values()[k] *= 0x1p-90;
      REQUIRE(M.refresh(scaled));
      M.apply(r * 0x1p60, Ms);
      CHECK((Ms.array() == (Mr * 0x1p150).array()).all());
      scaled.block(3)[0] = std::numeric_limits<double>::quiet_NaN();
      CHECK(M.refresh(scaled).status == Status::diverged);
      r[5] = std::numeric_limits<double>::quiet_NaN();
      REQUIRE(M.refresh(A));
      M.apply(r, Mr);
      CHECK(!Mr.allFinite());
    }
  }
}
