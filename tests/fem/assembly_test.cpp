// SPDX-License-Identifier: MIT
// Assembly against a dense sum, on one thread and on three, and the elimination of prescribed unknowns.
#include "tunica/fem/assembly.hpp"

#include "tunica/fem/dirichlet.hpp"

#include <doctest/doctest.h>

#include <Eigen/Dense>

#include <cmath>

using namespace tunica;

namespace {

/// A row of n unit cubes of hexahedra, and a second row on top of it.
mesh::HexMesh two_rows(Index n) {
  mesh::HexMesh m;
  const auto id = [n](Index i, Index j, Index k) { return i + (n + 1) * (j + 2 * k); };
  m.nodes.resize(3, (n + 1) * 6);
  for (Index k = 0; k < 3; ++k)
    for (Index j = 0; j < 2; ++j)
      for (Index i = 0; i <= n; ++i) m.nodes.col(id(i, j, k)) = Vec3(i, j, k);
  m.cells.resize(8, 2 * n);
  for (Index k = 0; k < 2; ++k)
    for (Index i = 0; i < n; ++i)
      m.cells.col(i + n * k) << id(i, 0, k), id(i + 1, 0, k), id(i + 1, 1, k), id(i, 1, k), id(i, 0, k + 1),
          id(i + 1, 0, k + 1), id(i + 1, 1, k + 1), id(i, 1, k + 1);
  return m;
}

/// A full element matrix and vector without any symmetry.
template <class A>
typename A::ElementMatrix element_matrix(Index e) {
  typename A::ElementMatrix K;
  for (int i = 0; i < A::size; ++i)
    for (int j = 0; j < A::size; ++j) K(i, j) = std::sin(1.0 + e + 0.7 * i + 1.3 * j * j);
  return K;
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("fem: assembly equals the dense sum in both storage orders") {
    const auto mesh = two_rows(5);
    using A = fem::Assembly<mesh::Hex8, 3>;
    const A assembly(mesh);
    auto K = assembly.matrix();
    auto Kr = assembly.matrix<Eigen::RowMajor>();
    Eigen::VectorXd f = Eigen::VectorXd::Zero(assembly.unknowns());
    Eigen::MatrixXd D = Eigen::MatrixXd::Zero(assembly.unknowns(), assembly.unknowns());
    Eigen::VectorXd d = f;
    for (Index e = 0; e < mesh.cell_count(); ++e) {
      const auto Ke = element_matrix<A>(e);
      for (int i = 0; i < A::size; ++i) {
        const Index row = 3 * mesh.cells(i / 3, e) + i % 3;
        d[row] += Ke(i, 0);
        for (int j = 0; j < A::size; ++j) D(row, 3 * mesh.cells(j / 3, e) + j % 3) += Ke(i, j);
      }
    }
    assembly.for_each_cell([&](Index e) {
      const auto Ke = element_matrix<A>(e);
      assembly.add(e, Ke, K);
      assembly.add(e, Ke, Kr);
      assembly.add(e, Ke.col(0), f);
    });
    CHECK((Eigen::MatrixXd(K) - D).cwiseAbs().maxCoeff() < 1e-13);
    CHECK((Eigen::MatrixXd(Kr) - D).cwiseAbs().maxCoeff() < 1e-13);
    CHECK((f - d).cwiseAbs().maxCoeff() < 1e-13);
    const auto xe = assembly.gather(3, d);
    for (int i = 0; i < A::size; ++i) CHECK(xe[i] == d[3 * mesh.cells(i / 3, 3) + i % 3]);
  }

  TEST_CASE("fem: assembly has the same bits on any number of threads") {
    const auto mesh = two_rows(400);
    using A = fem::Assembly<mesh::Hex8, 3>;
    const A assembly(mesh);
    auto one = assembly.matrix(), three = one;
    Eigen::VectorXd f1 = Eigen::VectorXd::Zero(assembly.unknowns()), f3 = f1;
    const auto run = [&](int threads, auto& K, auto& f) {
      thread_count() = threads;
      assembly.for_each_cell([&](Index e) {
        const auto Ke = element_matrix<A>(e);
        assembly.add(e, Ke, K);
        assembly.add(e, Ke.col(1), f);
      });
      thread_count() = 1;
    };
    run(1, one, f1), run(3, three, f3);
    CHECK(std::equal(one.valuePtr(), one.valuePtr() + one.nonZeros(), three.valuePtr()));
    CHECK((f1.array() == f3.array()).all());
    CHECK(one.coeffs().abs().maxCoeff() > 0);
  }

  TEST_CASE("fem: prescribed unknowns leave a symmetric system with their values") {
    const auto mesh = two_rows(4);
    const fem::Assembly<mesh::Hex8, 1> assembly(mesh);
    auto K = assembly.matrix();
    assembly.for_each_cell([&](Index e) {
      const Eigen::Matrix<double, 8, 8> B = element_matrix<fem::Assembly<mesh::Hex8, 1>>(e);
      const Eigen::Matrix<double, 8, 8> Ke = B * B.transpose() + Eigen::Matrix<double, 8, 8>::Identity();
      assembly.add(e, Ke, K);
    });
    const Eigen::MatrixXd full = K;
    Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(assembly.unknowns(), -1, 2);
    const Eigen::VectorXd b0 = b;
    fem::Dirichlet ends(assembly.unknowns());
    for (const Index i : {0, 7, 29}) ends.fix(i, 0.5 + i);
    ends.eliminate(K, b);
    const Eigen::MatrixXd dense = K;
    CHECK((dense - dense.transpose()).cwiseAbs().maxCoeff() < 1e-14);
    const Eigen::VectorXd x = dense.ldlt().solve(b);
    for (const Index i : {0, 7, 29}) CHECK(x[i] == doctest::Approx(0.5 + i));
    Eigen::VectorXd r = full * x - b0;
    ends.clear(r);
    CHECK(r.norm() < 1e-11 * b0.norm());
  }
}
