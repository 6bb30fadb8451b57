// SPDX-License-Identifier: MIT
// Linear solvers on what breaks lesser ones: jumps, anisotropy, slivers, stiff volumes, null spaces, bad
// matrices.
#include "support/tet_operators.hpp"
#include "tunica/core/units.hpp"
#include "tunica/la/iterative.hpp"
#include "tunica/la/multigrid.hpp"
#include "tunica/la/preconditioner.hpp"
#include "tunica/la/rigid_modes.hpp"
#include "tunica/solid/laws.hpp"
#include "tunica/solid/statics.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <type_traits>
#include <vector>

using namespace tunica;

namespace {

struct Outcome {
  SolveReport report;
  double residual;  // the true one
};

template <class Precond>
Outcome solve_by_cg(const la::RowMatrix& A, const Precond& M, const Eigen::VectorXd& b) {
  Eigen::VectorXd x = Eigen::VectorXd::Zero(b.size());
  Outcome out{la::cg(la::ApplyMatrix<>{A}, M, b, x, {.tolerance = 1e-8, .max_iterations = 500}), 0};
  out.residual = (b - A * x).norm() / b.norm();
  return out;
}

Outcome by_multigrid(const la::RowMatrix& A, const Eigen::VectorXd& b) {
  la::Multigrid<> M;
  CHECK(bool(M.compute(A)));
  return solve_by_cg(A, M, b);
}

Eigen::VectorXd noise(Eigen::Index n) {
  return test::Noise{}.vector(n);
}

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

}  // namespace

TEST_SUITE("hard") {
  TEST_CASE("la: iterations of the multigrid stay while the mesh is refined") {
    int least = 1000, most = 0;
    for (const int n : {12, 24, 40}) {
      const auto A = test::diffusion(test::perturbed_cube(n));
      const auto [report, residual] = by_multigrid(A, noise(A.rows()));
      CHECK(report.status == Status::converged);
      CHECK(residual <= 1e-8);
      least = std::min(least, report.iterations);
      most = std::max(most, report.iterations);
      MESSAGE(A.rows() << " unknowns: " << report.iterations << " iterations");
    }
    CHECK(most <= 14);
    CHECK(most <= 1.3 * least);
  }

  TEST_CASE("la: multigrid where the coefficient jumps by ten thousand") {
    const auto mesh = test::perturbed_cube(24);
    const auto jump = [&](bool layers) {
      return test::diffusion(mesh, test::FreeNodes(mesh), [&, layers](Index e) {
        Vec3 x = Vec3::Zero();
        for (int a = 0; a < 4; ++a) x += 0.25 * mesh.nodes.col(mesh.cells(a, e));
        const int i = int(3 * x[0]), j = int(3 * x[1]), k = int(3 * x[2]);
        return (layers ? k % 2 : (i + j + k) % 2) ? 1e4 : 1.0;
      });
    };
    for (const bool layers : {true, false}) {
      const auto A = jump(layers);
      const auto [report, residual] = by_multigrid(A, noise(A.rows()));
      CHECK(report.status == Status::converged);
      CHECK(residual <= 1e-8);
      CHECK(report.iterations <= 30);
      MESSAGE((layers ? "layers: " : "blocks: ") << report.iterations << " iterations");
    }
  }

  TEST_CASE("la: multigrid on flat cells and on slivers") {
    for (const double flat : {10.0, 100.0, 1000.0}) {
      auto mesh = test::perturbed_cube(20, 0);
      mesh.nodes.row(2) /= flat;
      const auto A = test::diffusion(mesh);
      const auto [report, residual] = by_multigrid(A, noise(A.rows()));
      CHECK(report.status == Status::converged);
      CHECK(residual <= 1e-8);
      CHECK(report.iterations <= 20);
      MESSAGE("cells " << flat << " times as long as high: " << report.iterations << " iterations");
    }
    for (const double flat : {10.0, 100.0}) {  // nodes moved sideways by 1.5 and 15 heights of a cell
      auto mesh = test::perturbed_cube(20);
      mesh.nodes.row(2) /= flat;
      const auto A = test::diffusion(mesh);
      const auto [report, residual] = by_multigrid(A, noise(A.rows()));
      la::IncompleteCholesky ic;
      ic.compute(A);
      const auto other = solve_by_cg(A, ic, noise(A.rows()));
      CHECK(report.status == Status::converged);
      CHECK(residual <= 1e-8);
      CHECK(4 * report.iterations <= other.report.iterations);
      MESSAGE("and sheared: " << report.iterations << " iterations, " << other.report.iterations
                              << " of incomplete Cholesky");
    }
    auto mesh = test::perturbed_cube(20, 0);  // every seventh node almost on its neighbour
    for (Index node = 0; node < mesh.nodes.cols(); node += 7)
      if (const double x = mesh.nodes(0, node); x > 0.1 && x < 0.9) mesh.nodes(0, node) += 0.999 / 20;
    const auto A = test::diffusion(mesh);
    const auto [report, residual] = by_multigrid(A, noise(A.rows()));
    CHECK(report.status == Status::converged);
    CHECK(residual <= 1e-8);
    CHECK(report.iterations <= 40);
    MESSAGE("slivers: " << report.iterations << " iterations");
  }

  TEST_CASE("la: multigrid of an elastic solid keeps its rigid body modes") {
    const auto mesh = test::perturbed_cube(14);
    const test::FreeNodes nodes(mesh);
    const auto modes = la::rigid_body_modes(test::free_points(mesh, nodes));
    for (const double kappa : {1e1, 1e2, 1e3}) {
      const auto A = test::elasticity(mesh, nodes, kappa);
      const Eigen::VectorXd b = noise(A.rows());
      la::Multigrid<3, 6> rigid;
      la::Multigrid<3> constants;
      rigid.near_null_space(modes);
      REQUIRE(rigid.compute(A));
      REQUIRE(constants.compute(A));
      const auto with = solve_by_cg(A, rigid, b), without = solve_by_cg(A, constants, b);
      CHECK(with.report.status == Status::converged);
      CHECK(without.report.status == Status::converged);
      CHECK(with.residual <= 1e-8);
      CHECK(with.report.iterations <= without.report.iterations);
      MESSAGE("kappa/mu " << kappa << ": " << with.report.iterations << " iterations with rotations, "
                          << without.report.iterations << " without");
      if (kappa == 1e1) CHECK(with.report.iterations <= 25);
    }
  }

  TEST_CASE("la: multigrid of a slender elastic bar needs the rotations") {
    auto mesh = meshing::box_tets({.cells = {60, 4, 4}, .lo = Vec3::Zero(), .hi = {15, 1, 1}});
    test::FreeNodes nodes(mesh, false);
    nodes.count = 0;
    for (std::size_t n = 0; n < nodes.of.size(); ++n)
      nodes.of[n] = mesh.nodes(0, static_cast<Eigen::Index>(n)) == 0 ? -1 : nodes.count++;
    const auto A = test::elasticity(mesh, nodes, 2);
    const Eigen::VectorXd b = noise(A.rows());
    la::Multigrid<3, 6> rigid;
    la::Multigrid<3> constants;
    rigid.near_null_space(la::rigid_body_modes(test::free_points(mesh, nodes)));
    REQUIRE(rigid.compute(A));
    REQUIRE(constants.compute(A));
    const auto with = solve_by_cg(A, rigid, b), without = solve_by_cg(A, constants, b);
    CHECK(with.report.status == Status::converged);
    CHECK(with.residual <= 1e-8);
    CHECK(2 * with.report.iterations <= without.report.iterations);
    MESSAGE(with.report.iterations << " iterations with rotations, " << without.report.iterations
                                   << " without");
  }

  TEST_CASE("la: multigrid of semidefinite matrices where the right side is in the range") {
    const auto mesh = test::perturbed_cube(16);
    {  // no side held: constants are free
      const auto A = test::diffusion(mesh, false);
      const Eigen::VectorXd b = A * noise(A.rows());
      const auto [report, residual] = by_multigrid(A, b);
      CHECK(report.status == Status::converged);
      CHECK(residual <= 1e-8);
      CHECK(report.iterations <= 16);
      MESSAGE("all sides free: " << report.iterations << " iterations");
    }
    {  // a solid that nothing holds
      const test::FreeNodes nodes(mesh, false);
      const auto A = test::elasticity(mesh, nodes, 5);
      la::Multigrid<3, 6> M;
      M.near_null_space(la::rigid_body_modes(test::free_points(mesh, nodes)));
      REQUIRE(M.compute(A));
      const auto [report, residual] = solve_by_cg(A, M, A * noise(A.rows()));
      CHECK(report.status == Status::converged);
      CHECK(residual <= 1e-8);
      CHECK(report.iterations <= 30);
      MESSAGE("a free solid: " << report.iterations << " iterations");
    }
  }

  TEST_CASE("la: multigrid where rows were made those of a diagonal matrix") {
    const auto mesh = test::perturbed_cube(16);
    for (const double diagonal : {1.0, 1e-6, 1e6}) {
      auto A = test::diffusion(mesh, false);
      const auto held = [&](Eigen::Index node) {
        const double x = mesh.nodes(0, node);
        return x == 0 || x == 1;
      };
      for (Eigen::Index i = 0; i < A.rows(); ++i)
        for (la::RowMatrix::InnerIterator it(A, i); it; ++it)
          if (held(i) || held(it.col())) it.valueRef() = it.col() == i ? diagonal : 0.0;
      const auto [report, residual] = by_multigrid(A, noise(A.rows()));
      CHECK(report.status == Status::converged);
      CHECK(residual <= 1e-8);
      CHECK(report.iterations <= 16);
    }
    // One component of a node alone, as on a plane of symmetry.
    const test::FreeNodes nodes(mesh);
    auto A = test::elasticity(mesh, nodes, 5);
    const auto x = test::free_points(mesh, nodes);
    const auto held = [&](Eigen::Index i) { return i % 3 == 1 && x(1, i / 3) == 0; };
    for (Eigen::Index i = 0; i < A.rows(); ++i)
      for (la::RowMatrix::InnerIterator it(A, i); it; ++it)
        if (held(i) || held(it.col())) it.valueRef() = it.col() == i ? 1.0 : 0.0;
    la::Multigrid<3, 6> M;
    M.near_null_space(la::rigid_body_modes(x));
    REQUIRE(M.compute(A));
    const auto [report, residual] = solve_by_cg(A, M, noise(A.rows()));
    CHECK(report.status == Status::converged);
    CHECK(residual <= 1e-8);
    CHECK(report.iterations <= 30);
  }

  TEST_CASE("la: multigrid of bad matrices ends in a status") {
    auto A = test::diffusion(test::perturbed_cube(12));
    const Eigen::VectorXd b = noise(A.rows());
    la::Multigrid<> M;
    {  // a row of zeros: fine where nothing is asked of it
      auto Z = A;
      for (Eigen::Index i = 0; i < Z.rows(); ++i)
        for (la::RowMatrix::InnerIterator it(Z, i); it; ++it)
          if (i == 5 || it.col() == 5) it.valueRef() = 0;
      Eigen::VectorXd c = b;
      c[5] = 0;
      REQUIRE(M.compute(Z));
      CHECK(solve_by_cg(Z, M, c).report.status == Status::converged);
      c[5] = 1;
      const auto out = solve_by_cg(Z, M, c);
      CHECK(out.report.status != Status::converged);
      CHECK(std::isfinite(out.residual));
    }
    {  // indefinite
      auto I = A;
      for (Eigen::Index i = 0; i < I.rows(); i += 3) I.coeffRef(i, i) *= -1;
      REQUIRE(M.compute(I));
      CHECK(solve_by_cg(I, M, b).report.status == Status::diverged);
    }
    for (const double bad : {not_a_number, std::numeric_limits<double>::infinity()}) {
      auto N = A;
      N.coeffRef(7, 7) = bad;
      CHECK(M.compute(N).status == Status::diverged);
      CHECK(solve_by_cg(N, M, b).report.status == Status::diverged);
      REQUIRE(M.compute(A));
      CHECK(M.refresh(N).status == Status::diverged);
      REQUIRE(M.refresh(A));
      CHECK(solve_by_cg(A, M, b).report.status == Status::converged);
    }
    Eigen::VectorXd c = b;
    c[3] = not_a_number;
    CHECK(solve_by_cg(A, M, c).report.status == Status::diverged);
  }

  TEST_CASE("la: gmres and bicgstab where the wind outweighs diffusion") {
    const auto mesh = test::perturbed_cube(20);
    const test::FreeNodes nodes(mesh);
    for (const double wind : {1.0, 30.0, 300.0}) {  // times the size of the cube over its diffusivity
      const Vec3 velocity = wind * Vec3(0.8, 0.5, 0.33);
      const auto A =
          test::tet_matrix<1>(mesh, nodes, [&](Index, const fem::P1Tet& tet, int a, int b, auto& out) {
            const double along = velocity.dot(tet.grad.col(a)) * velocity.dot(tet.grad.col(b));
            out[0] +=
                tet.volume * (tet.grad.col(a).dot(tet.grad.col(b)) + 0.25 * velocity.dot(tet.grad.col(b)) +
                              0.5 * tet.size() / wind * along);  // with streamline diffusion
          });
      const Eigen::VectorXd b = noise(A.rows());
      la::Ilu0<> ilu;
      ilu.compute(A);
      la::Multigrid<> multigrid;
      REQUIRE(multigrid.compute(A));
      const auto check = [&](auto&& solve, const auto& M, const std::string& what, int most) {
        Eigen::VectorXd x = Eigen::VectorXd::Zero(b.size());
        const SolveReport report = solve(la::ApplyMatrix<>{A}, M, b, x, la::KrylovOptions{.tolerance = 1e-8});
        CHECK(report.status == Status::converged);
        CHECK((b - A * x).norm() <= 1e-8 * b.norm());
        CHECK(report.iterations <= most);
        MESSAGE("wind " << wind << ": " << what << ", " << report.iterations << " iterations");
      };
      const auto gmres = [](const auto& op, const auto& M, const auto& c, auto& x, const auto& o) {
        return la::gmres(op, M, c, x, o);
      };
      const auto bicgstab = [](const auto& op, const auto& M, const auto& c, auto& x, const auto& o) {
        return la::bicgstab(op, M, c, x, o);
      };
      check(gmres, ilu, "gmres, ILU(0)", 60);
      check(gmres, multigrid, "gmres, multigrid", wind < 100 ? 30 : 200);
      check(bicgstab, ilu, "bicgstab, ILU(0)", 40);
    }
  }

  TEST_CASE("la: minres past the limit where conjugate gradients end") {
    const auto mesh = test::perturbed_cube(16);
    auto A = test::diffusion(mesh);
    la::Multigrid<1, 1, double> M;  // of the definite part
    REQUIRE(M.compute(A));
    // -Laplace - 60: below zero in the lowest modes, of eigenvalues pi^2 (i^2 + j^2 + k^2).
    const auto mass = test::tet_matrix<1>(mesh, test::FreeNodes(mesh),
                                          [](Index, const fem::P1Tet& tet, int a, int b, auto& out) {
                                            out[0] += tet.volume * (a == b ? 0.1 : 0.05);
                                          });
    const la::RowMatrix K = A - 60 * mass;
    const Eigen::VectorXd b = noise(K.rows());
    CHECK(solve_by_cg(K, M, b).report.status == Status::diverged);
    Eigen::VectorXd x = Eigen::VectorXd::Zero(b.size());
    const auto report = la::minres(la::ApplyMatrix<>{K}, M, b, x, {.tolerance = 1e-8});
    CHECK(report.status == Status::converged);
    CHECK((b - K * x).norm() <= 1e-8 * b.norm());
    CHECK(report.iterations <= 60);
    MESSAGE(report.iterations << " iterations");
  }

  TEST_CASE("la: a solid is solved by conjugate gradients with multigrid as it is directly") {
    using namespace tunica::literals;
    const auto mesh = meshing::box_hexes({.cells = {16, 4, 4}, .lo = Vec3::Zero(), .hi = {4e-3, 1e-3, 1e-3}});
    const solid::Hyperelastic law{solid::NeoHooke{.c10 = 100_kPa}, solid::Quadratic{.kappa = 2000_kPa}};
    const auto solve = [&](auto& wall) {
      wall.fix(mesh.patch("x0"));
      wall.pressure(mesh.patch("z1"), 1_kPa);
      const auto report = wall.solve();
      CHECK(bool(report));
      return Points<3>(wall.displacement());
    };
    using Law = std::decay_t<decltype(law)>;
    solid::Statics direct{mesh, law};
    solid::Statics<mesh::Hex8, Law, la::Cg<la::Multigrid<3>>> iterative{mesh, law};
    const Points<3> u = solve(direct), v = solve(iterative);
    CHECK((u - v).norm() < 1e-7 * u.norm());
    CHECK(u.lpNorm<Eigen::Infinity>() > 1e-4);
  }
}
