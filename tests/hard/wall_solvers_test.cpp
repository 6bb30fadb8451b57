// SPDX-License-Identifier: MIT
// Walls through linear solvers that read their tangent in blocks: as directly, on threads, in time, buckled.
#include "tunica/core/units.hpp"
#include "tunica/la/cell_patches.hpp"
#include "tunica/la/direct.hpp"
#include "tunica/la/iterative.hpp"
#include "tunica/la/multigrid.hpp"
#include "tunica/la/rigid_modes.hpp"
#include "tunica/meshing/box.hpp"
#include "tunica/meshing/tube.hpp"
#include "tunica/solid/dynamics.hpp"
#include "tunica/solid/laws.hpp"
#include "tunica/solid/statics.hpp"

#include <doctest/doctest.h>

#include <Eigen/Eigenvalues>

#include <cmath>
#include <vector>

using namespace tunica;
using namespace tunica::literals;

namespace {

struct Counts {
  int made = 0, refreshed = 0, of_numbers = 0;
};

/// A multigrid that counts what it is given: matrices of blocks, or of numbers.
class Counted {
 public:
  static constexpr int block_rows = 3;
  Counted() = default;
  Counted(const mesh::Mesh<mesh::Hex8, 3>& mesh, Counts& counts) : counts_(&counts) {
    multigrid_.near_null_space(la::rigid_body_modes(mesh.nodes));
  }
  SolveReport compute(const la::BlockMatrix<3>& A) {
    ++counts_->made;
    return multigrid_.compute(A);
  }
  SolveReport refresh(const la::BlockMatrix<3>& A) {
    ++counts_->refreshed;
    return multigrid_.refresh(A);
  }
  SolveReport compute(const la::RowMatrix& A) {
    ++counts_->of_numbers;
    return multigrid_.compute(A);
  }
  SolveReport refresh(const la::RowMatrix& A) { return compute(A); }
  void apply(const Eigen::VectorXd& r, Eigen::VectorXd& z) const { multigrid_.apply(r, z); }

 private:
  la::Multigrid<3, 6> multigrid_;
  Counts* counts_ = nullptr;
};

using Law = solid::Hyperelastic<solid::NeoHooke, solid::Quadratic>;
constexpr double mu = 100e3;  // [Pa]

Law law_of(double ratio) {
  return {solid::NeoHooke{.c10 = mu / 2}, solid::Quadratic{.kappa = ratio * mu}};
}

mesh::Mesh<mesh::Hex8, 3> column(int n, int high) {
  return meshing::box_hexes({.cells = {n, n, high}, .lo = Vec3::Zero(), .hi = {1e-3, 1e-3, 12e-3}});
}

}  // namespace

TEST_SUITE("hard") {
  TEST_CASE("la: a thick tube under pressure is solved through blocks as it is directly") {
    const auto mesh =
        meshing::tube({.inner_radius = 5e-3, .thickness = 1.5e-3, .length = 8e-3, .cells = {3, 24, 6}});
    for (const double ratio : {10.0, 1e3}) {
      const auto solve = [&](auto& wall) {
        wall.fix(mesh.patch("ends"));
        wall.pressure(mesh.patch("inner"), 8e3);
        const auto report = wall.solve();
        CHECK(bool(report));
        return report.solve.iterations;
      };
      solid::Statics direct{mesh, law_of(ratio)};
      using Cg = la::Cg<Counted>;
      Counts counts;
      const auto make = [&] {
        return solid::Statics<mesh::Hex8, Law, Cg>{
            mesh, law_of(ratio), {}, Cg({.tolerance = 1e-9}, Counted(mesh, counts))};
      };
      auto wall = make();
      const int wanted = solve(direct), iterations = solve(wall);
      const Counts seen = counts;
      const Points<3> u = direct.displacement(), v = wall.displacement();
      CHECK((u - v).norm() < 1e-8 * u.norm());
      CHECK(u.cwiseAbs().maxCoeff() > 1e-4);
      CHECK(iterations == wanted);
      CHECK(seen.made == 1);  // one hierarchy for all steps of load and of Newton
      CHECK(seen.refreshed >= iterations - 1);
      CHECK(seen.of_numbers == 0);
      MESSAGE("kappa/mu " << ratio << ": off by " << (u - v).norm() / u.norm());
      thread_count() = 2;
      auto other = make();
      (void)solve(other);
      thread_count() = 1;
      CHECK((other.displacement().array() == v.array()).all());
    }
  }

  TEST_CASE("la: a wall that swings keeps one hierarchy over its time steps") {
    const auto mesh = column(3, 24);
    const auto run = [&](auto& wall) {
      wall.fix(mesh.patch("z0"));
      wall.pressure(mesh.patch("x0"), 5);
      wall.interface(mesh.patch("x0"));
      for (int k = 0; k < 5; ++k) {
        CHECK(bool(wall.step(1e-3)));
        wall.save();
      }
      return Points<3>(wall.displacement());
    };
    using Cg = la::Cg<Counted>;
    Counts counts;
    solid::Dynamics direct{mesh, law_of(50), 1100.0};
    solid::Dynamics<mesh::Hex8, Law, Cg> wall{
        mesh, law_of(50), 1100.0, {}, Cg({.tolerance = 1e-10}, Counted(mesh, counts))};
    const Points<3> u = run(direct), v = run(wall);
    CHECK((u - v).norm() < 1e-7 * u.norm());
    CHECK(u.cwiseAbs().maxCoeff() > 1e-5);
    CHECK(counts.made == 1);
    CHECK(counts.refreshed >= 4);
    CHECK(counts.of_numbers == 0);
  }

  TEST_CASE("la: the tangent of a buckled column ends in a status and minres solves it") {
    // Euler: a clamped column of E = 3 mu, l = 12 w, free at its top, buckles at a strain of (pi w / 4 l)^2 /
    // 3 = 1.4e-3, for the mesh somewhat later; it is compressed along its axis by three times as much.
    const auto mesh = column(2, 24);
    const double strain = 6e-3;
    solid::Body<mesh::Hex8, Law> body(mesh, law_of(50), 0, solid::Mass::lumped);
    for (const Index n : mesh::patch_nodes(mesh.patch("z0")))
      for (const auto axis : {solid::Axis::x, solid::Axis::y, solid::Axis::z}) body.fix(n, axis);
    Eigen::VectorXd u = Eigen::VectorXd::Zero(body.unknowns()), f, predicted;
    for (Index n = 0; n < mesh.node_count(); ++n) {
      const Vec3 X = mesh.nodes.col(n);
      u.segment<3>(3 * n) = strain * Vec3(0.49 * (X[0] - 0.5e-3), 0.49 * (X[1] - 0.5e-3), -X[2]);
    }
    body.clear_fixed(u);
    REQUIRE(body.internal_forces(u, la::no_step, f, predicted));
    const auto& K = body.tangent_blocks(u, Eigen::VectorXd(), {});
    const la::SparseMatrix A = la::sparse<Eigen::ColMajor>(K);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes{Eigen::MatrixXd(A)};
    REQUIRE(modes.eigenvalues()[0] < 0);
    Eigen::VectorXd b = Eigen::VectorXd::Zero(body.unknowns()), x;
    for (const Index n : mesh::patch_nodes(mesh.patch("z1"))) b[3 * n] = 1e-3;  // across the column

    la::Multigrid<3, 6> M;
    M.near_null_space(la::rigid_body_modes(mesh.nodes));
    la::Cg<la::Multigrid<3, 6>> cg({.tolerance = 1e-8}, M);
    cg.analyse(K);
    const bool made = bool(cg.factorise(K));
    const auto report = made ? cg.solve(b, x) : SolveReport{Status::diverged, 0, 0};
    MESSAGE("lowest eigenvalue " << modes.eigenvalues()[0] << "; after " << report.iterations
                                 << " iterations status " << int(report.status));
    CHECK(report.status == Status::diverged);

    // A preconditioner of the unloaded column is definite: MINRES goes on where CG ends.
    Eigen::VectorXd zero = Eigen::VectorXd::Zero(body.unknowns());
    const la::BlockMatrix<3> loaded = K;
    REQUIRE(body.internal_forces(zero, la::no_step, f, predicted));
    la::Multigrid<3, 6, double> of_unloaded;
    of_unloaded.near_null_space(la::rigid_body_modes(mesh.nodes));
    REQUIRE(of_unloaded.compute(body.tangent_blocks(zero, Eigen::VectorXd(), {})));
    x = zero;
    const auto minres = la::minres(loaded, of_unloaded, b, x, {.tolerance = 1e-8});
    CHECK(minres.status == Status::converged);
    CHECK((b - A * x).norm() <= 1e-8 * b.norm());
    la::Lu lu;
    lu.analyse(A);
    REQUIRE(lu.factorise(A));
    Eigen::VectorXd exact;
    REQUIRE(lu.solve(b, exact));
    CHECK((x - exact).norm() < 1e-4 * exact.norm());
    MESSAGE("minres: " << minres.iterations << " iterations");
  }

  TEST_CASE("la: a column that is pressed beyond its buckling load never ends silently") {
    const auto mesh = column(2, 24);
    using Cg = la::Cg<la::Multigrid<3, 6>>;
    la::Multigrid<3, 6> M;
    M.near_null_space(la::rigid_body_modes(mesh.nodes));
    solid::Statics<mesh::Hex8, Law, Cg> wall{mesh, law_of(50), {}, Cg({.tolerance = 1e-9}, M)};
    wall.fix(mesh.patch("z0"));
    const double area = 1e-6, critical = 3 * mu * area * 1.4e-3;  // [m2], [N]
    const auto top = mesh::patch_nodes(mesh.patch("z1"));
    for (const Index n : top) {
      const double share = 1.0 / static_cast<double>(top.size());
      wall.force(n, Vec3(1e-3, 0, -4) * critical * share);  // and a little across, so that it must choose
    }
    const auto report = wall.solve();
    // Either it found the buckled shape, which is then far from the straight one and in balance, or it says
    // no.
    MESSAGE("status " << int(report.solve.status) << " at load " << report.load << ", deflection "
                      << wall.displacement().row(0).cwiseAbs().maxCoeff());
    if (report)
      CHECK(wall.displacement().row(0).cwiseAbs().maxCoeff() > 1e-3);
    else
      CHECK(report.load < 1);
  }

  TEST_CASE("la: sweeps over hexahedra keep volumes where coarse levels do not") {
    const auto mesh = meshing::box_hexes({.cells = {8, 8, 8}, .lo = Vec3::Zero(), .hi = {8e-3, 8e-3, 8e-3}});
    la::Multigrid<3, 6> rigid;
    rigid.near_null_space(la::rigid_body_modes(mesh.nodes));
    for (const double ratio : {1e2, 1e3, 1e4}) {
      solid::Body<mesh::Hex8, Law> body(mesh, law_of(ratio), 0, solid::Mass::lumped);
      for (const Index n : mesh::patch_nodes(mesh.patch("z0")))
        for (const auto axis : {solid::Axis::x, solid::Axis::y, solid::Axis::z}) body.fix(n, axis);
      Eigen::VectorXd u = Eigen::VectorXd::Zero(body.unknowns()), f, predicted, b = u, x, y;
      REQUIRE(body.internal_forces(u, la::no_step, f, predicted));
      const auto& K = body.tangent_blocks(u, Eigen::VectorXd(), {});
      for (const Index n : mesh::patch_nodes(mesh.patch("x0"))) b[3 * n] = 1e-3;
      body.clear_fixed(b);
      using Patches = la::CellPatches<8, la::Multigrid<3, 6>>;
      la::Cg<Patches> with({.tolerance = 1e-8, .max_iterations = 4000}, Patches(mesh.cells, rigid));
      la::Cg<la::Multigrid<3, 6>> without({.tolerance = 1e-8, .max_iterations = 4000}, rigid);
      with.analyse(K), without.analyse(K);
      REQUIRE(with.factorise(K));
      REQUIRE(without.factorise(K));
      const auto patched = with.solve(b, x), plain = without.solve(b, y);
      CHECK(patched.status == Status::converged);
      CHECK(plain.status == Status::converged);
      Eigen::VectorXd product;
      K.apply(x, product);
      CHECK((b - product).norm() <= 1e-8 * b.norm());
      CHECK(2 * patched.iterations < plain.iterations);
      if (ratio >= 1e4) CHECK(4 * patched.iterations < plain.iterations);
      MESSAGE("kappa/mu " << ratio << ": " << patched.iterations << " iterations, " << plain.iterations
                          << " without sweeps over cells");
    }
  }
}
