// SPDX-License-Identifier: MIT
// Packs of element matrices in block rows: against a dense sum, for every width and cell, on any number of
// threads.
#include "tunica/fem/block_assembly.hpp"

#include "tunica/fem/assembly.hpp"
#include "tunica/fem/p1_kernels.hpp"
#include "tunica/fem/p1_tets.hpp"
#include "tunica/fem/quadrature.hpp"
#include "tunica/fem/shape.hpp"
#include "tunica/la/block_convert.hpp"
#include "tunica/mesh/quadratic.hpp"
#include "tunica/meshing/box.hpp"
#include "tunica/meshing/tube.hpp"

#include "support/flow.hpp"

#include <doctest/doctest.h>

#include <Eigen/Dense>

#include <cmath>
#include <cstring>
#include <vector>

using namespace tunica;

namespace {

/// Entry (i, j) of the matrix of cell e: symmetric, or not at all.
double entry(Index e, int i, int j, bool symmetric) {
  if (symmetric && i > j) std::swap(i, j);
  return static_cast<double>((37 * e + 61 * i + 113 * j * j) % 1009) / 1009 - 0.4;  // of no rounding but one
}

template <class C, int N, int Dim, class S>
la::BlockMatrix<N> assembled(const mesh::Mesh<C, Dim>& mesh, la::BlockStorage storage, bool symmetric,
                             Eigen::VectorXd* f = nullptr) {
  using A = fem::BlockAssembly<C, N>;
  const A assembly(mesh, storage);
  auto K = assembly.matrix();
  if (f) f->setZero(assembly.unknowns());
  constexpr int W = Lanes<S>::count;
  const auto lane = [](S& to, int l, double value) {
    if constexpr (W == 1)
      to = value;
    else
      to.set(l, value);
  };
  assembly.template for_each_pack<W>(K, [&](const fem::CellPack<W>& pack) {
    if (symmetric) {
      S Ke[A::pairs][A::block];
      for (int a = 0; a < C::nodes; ++a)
        for (int b = a; b < C::nodes; ++b)
          for (int k = 0; k < A::block; ++k)
            for (int l = 0; l < W; ++l)
              lane(Ke[A::pair(a, b)][k], l, entry(pack.cell[l], N * a + k / N, N * b + k % N, true));
      assembly.add_symmetric(pack, Ke, K);
    } else {
      S Ke[C::nodes * C::nodes][A::block];
      for (int a = 0; a < C::nodes; ++a)
        for (int b = 0; b < C::nodes; ++b)
          for (int k = 0; k < A::block; ++k)
            for (int l = 0; l < W; ++l)
              lane(Ke[C::nodes * a + b][k], l, entry(pack.cell[l], N * a + k / N, N * b + k % N, false));
      assembly.add(pack, Ke, K);
    }
    if (f) {
      S fe[C::nodes][N];
      for (int i = 0; i < C::nodes * N; ++i)
        for (int l = 0; l < W; ++l) lane(fe[i / N][i % N], l, entry(pack.cell[l], i, 1, false));
      assembly.add(pack, fe, *f);
    }
  });
  return K;
}

template <class C, int N, int Dim>
void check_against_dense(const mesh::Mesh<C, Dim>& mesh) {
  const Index n = N * mesh.node_count();
  for (const bool symmetric : {true, false}) {
    Eigen::MatrixXd D = Eigen::MatrixXd::Zero(n, n);
    Eigen::VectorXd d = Eigen::VectorXd::Zero(n), f;
    for (Index e = 0; e < mesh.cell_count(); ++e)
      for (int i = 0; i < N * C::nodes; ++i) {
        const Index row = N * mesh.cells(i / N, e) + i % N;
        d[row] += entry(e, i, 1, false);
        for (int j = 0; j < N * C::nodes; ++j)
          D(row, N * mesh.cells(j / N, e) + j % N) += entry(e, i, j, symmetric);
      }
    const auto close = [&](const la::BlockMatrix<N>& A) {
      return (Eigen::MatrixXd(la::sparse(A)) - D).cwiseAbs().maxCoeff() < 1e-13;
    };
    constexpr auto full = la::BlockStorage::full, upper = la::BlockStorage::upper;
    const auto one = assembled<C, N, Dim, double>(mesh, full, symmetric, &f);
    CHECK(close(one));
    CHECK((f - d).cwiseAbs().maxCoeff() < 1e-13);
    const auto eight = assembled<C, N, Dim, Pack<double, 8>>(mesh, full, symmetric, &f);
    CHECK((f - d).cwiseAbs().maxCoeff() < 1e-13);
    const auto four = assembled<C, N, Dim, Pack<double, 4>>(mesh, full, symmetric);
    const auto bytes =
        static_cast<std::size_t>(N * N) * sizeof(double) * static_cast<std::size_t>(one.block_count());
    CHECK(std::memcmp(one.values(), eight.values(), bytes) == 0);  // the width of the pack leaves no trace
    CHECK(std::memcmp(one.values(), four.values(), bytes) == 0);
    if (symmetric) {
      CHECK(close(assembled<C, N, Dim, Pack<double, 8>>(mesh, upper, true)));
      CHECK(close(assembled<C, N, Dim, double>(mesh, upper, true)));
    }
  }
}

/// A strip of unit squares in the plane.
mesh::Mesh<mesh::Quad4, 2> strip(Index n) {
  mesh::Mesh<mesh::Quad4, 2> m;
  m.nodes.resize(2, 2 * (n + 1)), m.cells.resize(4, n);
  for (Index i = 0; i <= n; ++i) m.nodes.col(i) << i, 0, m.nodes.col(n + 1 + i) << i, 1;
  for (Index i = 0; i < n; ++i) m.cells.col(i) << i, i + 1, n + 2 + i, n + 1 + i;
  return m;
}

/// Each square of the strip in two triangles.
mesh::Mesh<mesh::Tri3, 2> triangles(Index n) {
  const auto q = strip(n);
  mesh::Mesh<mesh::Tri3, 2> m;
  m.nodes = q.nodes, m.cells.resize(3, 2 * n);
  for (Index i = 0; i < n; ++i) {
    m.cells.col(2 * i) << q.cells(0, i), q.cells(1, i), q.cells(2, i);
    m.cells.col(2 * i + 1) << q.cells(0, i), q.cells(2, i), q.cells(3, i);
  }
  return m;
}

mesh::TetMesh shaken(Index n) {
  auto m = meshing::box_tets(n);
  test::shake(m, 0.1 / n);
  return m;
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("fem: packs of element matrices add up as dense ones on solid cells") {
    check_against_dense<mesh::Tet4, 3, 3>(shaken(2));
    check_against_dense<mesh::Tet4, 1, 3>(shaken(2));
    check_against_dense<mesh::Tet10, 3, 3>(mesh::quadratic<mesh::Tet10>(shaken(1)));
    const auto tube = meshing::tube({.inner_radius = 1, .thickness = 0.3, .length = 1, .cells = {1, 7, 3}});
    check_against_dense<mesh::Hex8, 3, 3>(tube);
    check_against_dense<mesh::Hex8, 2, 3>(tube);
    const auto few = meshing::tube({.inner_radius = 1, .thickness = 0.3, .length = 1, .cells = {1, 3, 1}});
    check_against_dense<mesh::Hex20, 3, 3>(mesh::quadratic<mesh::Hex20>(few));
    check_against_dense<mesh::Hex27, 3, 3>(mesh::quadratic<mesh::Hex27>(few));
  }

  TEST_CASE("fem: packs of element matrices add up as dense ones on plane cells") {
    check_against_dense<mesh::Quad4, 2, 2>(strip(19));
    check_against_dense<mesh::Tri3, 2, 2>(triangles(10));
    check_against_dense<mesh::Quad8, 2, 2>(mesh::quadratic<mesh::Quad8>(strip(9)));
    check_against_dense<mesh::Quad9, 2, 2>(mesh::quadratic<mesh::Quad9>(strip(9)));
    check_against_dense<mesh::Tri6, 2, 2>(mesh::quadratic<mesh::Tri6>(triangles(5)));
  }

  TEST_CASE("fem: block assembly has the same bits on any number of threads") {
    const auto mesh = meshing::tube({.inner_radius = 1, .thickness = 0.3, .length = 1, .cells = {3, 40, 25}});
    for (const auto storage : {la::BlockStorage::full, la::BlockStorage::upper}) {
      Eigen::VectorXd f1, f3;
      const auto one = assembled<mesh::Hex8, 3, 3, Pack<double, 8>>(mesh, storage, true, &f1);
      thread_count() = 3;
      const auto three = assembled<mesh::Hex8, 3, 3, Pack<double, 8>>(mesh, storage, true, &f3);
      thread_count() = 1;
      const auto bytes = 9 * sizeof(double) * static_cast<std::size_t>(one.block_count());
      CHECK(std::memcmp(one.values(), three.values(), bytes) == 0);
      CHECK((f1.array() == f3.array()).all());
    }
  }

  TEST_CASE("fem: lanes and rows are each other's transpose for every width") {
    const auto check = [](auto scalar) {
      using S = decltype(scalar);
      using T = typename Lanes<S>::type;
      constexpr int W = Lanes<S>::count, count = 19;
      std::vector<T> row(W * count), back(W * count);
      for (std::size_t i = 0; i < row.size(); ++i) row[i] = static_cast<T>(i) + T(0.25);
      S pack[count];
      fem::rows_to_lanes<count>(row.data(), count, pack);
      if constexpr (W > 1)
        for (int k = 0; k < count; ++k)
          for (int l = 0; l < W; ++l) CHECK(pack[k][l] == row[static_cast<std::size_t>(l * count + k)]);
      fem::lanes_to_rows<count>(pack, back.data(), count);
      CHECK(row == back);
    };
    check(0.0), check(Pack<double, 2>{}), check(Pack<double, 4>{}), check(Pack<double, 8>{});
    check(Pack<float, 4>{}), check(Pack<float, 8>{}), check(Pack<float, 16>{});
  }

  TEST_CASE("fem: packed laplacian and convection-diffusion have the entries of single tetrahedra") {
    const auto mesh = shaken(6);
    const fem::P1Assembly assembly(mesh);
    const fem::Assembly<mesh::Tet4, 1> reference(mesh);
    Points<3> w(3, mesh.node_count());
    for (Index n = 0; n < mesh.node_count(); ++n)
      w.col(n) = Vec3(mesh.nodes(1, n) - 2 * mesh.nodes(2, n), 0.3 + mesh.nodes(0, n), mesh.nodes(0, n));
    fem::P1Tets tets;
    REQUIRE(tets.update(mesh.nodes, mesh.cells));
    auto L = reference.matrix<Eigen::RowMajor>(), C = L;
    const double nu = 0.07;
    for (Index e = 0; e < mesh.cell_count(); ++e) {
      Eigen::Matrix4d Le = tets[e].volume * tets[e].grad.transpose() * tets[e].grad, Ce = nu * Le;
      for (int a = 0; a < 4; ++a) {
        Vec3 flux = w.col(mesh.cells(a, e));
        for (int c = 0; c < 4; ++c) flux += w.col(mesh.cells(c, e));
        for (int b = 0; b < 4; ++b) Ce(a, b) += tets[e].volume / 20 * flux.dot(tets[e].grad.col(b));
      }
      reference.add(e, Le, L), reference.add(e, Ce, C);
    }
    auto L8 = assembly.matrix(), C8 = assembly.matrix();
    auto L1 = assembly.rows(), C1 = assembly.rows();
    REQUIRE(fem::add_laplacian<Pack<double, 8>>(assembly, mesh.nodes, 1, L8) == -1);
    REQUIRE(fem::add_laplacian<double>(assembly, mesh.nodes, 1, L1) == -1);
    REQUIRE(fem::add_convection_diffusion<Pack<double, 8>>(assembly, mesh.nodes, nu, w, C8) == -1);
    REQUIRE(fem::add_convection_diffusion(assembly, mesh.nodes, nu, w, C1) == -1);
    const auto off = [](const auto& A, const auto& B) {
      const Eigen::MatrixXd difference = Eigen::MatrixXd(A) - Eigen::MatrixXd(B);
      return difference.cwiseAbs().maxCoeff() / Eigen::MatrixXd(B).cwiseAbs().maxCoeff();
    };
    const double worst = std::max({off(la::sparse(L8), L), off(L1, L), off(la::sparse(C8), C), off(C1, C)});
    MESSAGE("entries off by ", worst, " of the largest");
    CHECK(worst < 1e-14);

    // exact on polynomials: a linear field has no Laplacian inside, and w . grad of it is its product with w
    const Vec3 slope(1.5, -0.2, 0.8);
    const Eigen::VectorXd u = (slope.transpose() * mesh.nodes).transpose();
    Eigen::VectorXd r;
    L8.apply(u, r);
    double inner = 0;
    for (Index n = 0; n < mesh.node_count(); ++n)
      if (mesh.nodes.col(n).minCoeff() > 1e-9 && mesh.nodes.col(n).maxCoeff() < 1 - 1e-9)
        inner = std::max(inner, std::abs(r[n]));
    CHECK(inner < 1e-15);
    CHECK(u.dot(r) == doctest::Approx(slope.squaredNorm()).epsilon(1e-13));  // int |grad u|^2
    // 1' C u = int w . grad u = slope . mean of w on the unit box
    const Vec3 mean(0.5 - 1, 0.3 + 0.5, 0.5);
    C8.apply(u, r);
    CHECK(r.sum() == doctest::Approx(slope.dot(mean)).epsilon(1e-13));
    // u' C u - nu |slope|^2 = int u w . grad u, of second degree: exact by the rule of degree two
    double exact = 0;
    using Rule = fem::Gauss<mesh::Tet4, 2>;
    for (Index e = 0; e < mesh.cell_count(); ++e)
      for (std::size_t q = 0; q < Rule::size; ++q) {
        const auto N = fem::Lagrange<mesh::Tet4>::values(Rule::points[q]);
        Vec3 wq = Vec3::Zero();
        double uq = 0;
        for (int a = 0; a < 4; ++a) {
          wq += N[static_cast<std::size_t>(a)] * w.col(mesh.cells(a, e));
          uq += N[static_cast<std::size_t>(a)] * u[mesh.cells(a, e)];
        }
        exact += 6 * tets[e].volume * Rule::weights[q] * uq * wq.dot(slope);
      }
    CHECK(u.dot(r) - nu * slope.squaredNorm() == doctest::Approx(exact).epsilon(1e-12));
  }

  TEST_CASE("fem: an inverted tetrahedron is named by the packed assembly") {
    auto mesh = shaken(3);
    const fem::P1Assembly assembly(mesh);
    mesh.nodes.col(mesh.cells(3, 77)) =
        2 * mesh.nodes.col(mesh.cells(0, 77)) - mesh.nodes.col(mesh.cells(3, 77));
    fem::P1Tets tets;
    REQUIRE(!tets.update(mesh.nodes, mesh.cells));
    auto A = assembly.matrix();
    CHECK(fem::add_laplacian(assembly, mesh.nodes, 1, A) == tets.inverted());
    mesh.nodes(1, mesh.cells(2, 40)) = std::nan("");
    CHECK(fem::add_laplacian(assembly, mesh.nodes, 1, A) >= 0);
  }

  TEST_CASE("fem: float packs assemble within single precision") {
    const auto mesh = shaken(4);
    const fem::P1Assembly assembly(mesh);
    auto A = assembly.matrix();
    auto F = assembly.matrix<float>();
    REQUIRE(fem::add_laplacian(assembly, mesh.nodes, 1, A) == -1);
    REQUIRE(fem::add_laplacian<Pack<float, 16>>(assembly, mesh.nodes, 1, F) == -1);
    double off = 0, largest = 0;
    for (Index k = 0; k < A.block_count(); ++k) {
      off = std::max(off, std::abs(*A.block(k) - static_cast<double>(*F.block(k))));
      largest = std::max(largest, std::abs(*A.block(k)));
    }
    CHECK(off < 1e-5 * largest);
  }
}
