// SPDX-License-Identifier: MIT
// What assembly costs: linear tetrahedra and the scatter of hexahedra, in a build for the machine at hand or
// not.
#pragma once

#include "support/stopwatch.hpp"
#include "tunica/fem/p1_kernels.hpp"
#include "tunica/fem/p1_tets.hpp"
#include "tunica/la/block_convert.hpp"
#include "tunica/mesh/mesh.hpp"
#include "tunica/meshing/box.hpp"
#include "tunica/meshing/tube.hpp"

#include <Eigen/SparseCore>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace tunica::bench {

inline constexpr Index assembly_side = 32;  // cubes of six tetrahedra along an edge of the unit cube
inline constexpr int assembly_runs = 15;
inline constexpr double viscosity = 0.07;

struct AssemblyTime {
  double laplacian = 0, convection = 0;   // [M tetrahedra/s], zeroing included
  double off = 0;                         // largest entry off those of single tetrahedra, of the largest
  double scatter = 0, scatter_upper = 0;  // [M hexahedra/s]
  double product = 0, product_upper = 0, scalar = 0;  // [M unknowns/s], blocks and Eigen's rows
};

namespace detail {

/// The two matrices from one tetrahedron after another; the largest difference to those of packs.
inline double p1_error(const mesh::TetMesh& mesh, const Points<3>& w,
                       const Eigen::SparseMatrix<double, Eigen::RowMajor>& laplacian,
                       const Eigen::SparseMatrix<double, Eigen::RowMajor>& convection) {
  using Matrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;
  Matrix L = laplacian, C = convection;
  std::fill(L.valuePtr(), L.valuePtr() + L.nonZeros(), 0.0);
  std::fill(C.valuePtr(), C.valuePtr() + C.nonZeros(), 0.0);
  for (Index e = 0; e < mesh.cell_count(); ++e) {
    const fem::P1Tet tet = fem::p1_tet(mesh.nodes, mesh.cells, e);
    for (int a = 0; a < 4; ++a) {
      Vec3 flux = w.col(mesh.cells(a, e));
      for (int c = 0; c < 4; ++c) flux += w.col(mesh.cells(c, e));
      for (int b = 0; b < 4; ++b) {
        const double k = tet.volume * tet.grad.col(a).dot(tet.grad.col(b));
        L.coeffRef(mesh.cells(a, e), mesh.cells(b, e)) += k;
        C.coeffRef(mesh.cells(a, e), mesh.cells(b, e)) +=
            viscosity * k + tet.volume / 20 * flux.dot(tet.grad.col(b));
      }
    }
  }
  const auto off = [](const Matrix& A, const Matrix& B) {
    double difference = 0, largest = 0;
    for (Eigen::Index k = 0; k < A.nonZeros(); ++k) {
      difference = std::max(difference, std::abs(A.valuePtr()[k] - B.valuePtr()[k]));
      largest = std::max(largest, std::abs(B.valuePtr()[k]));
    }
    return difference / largest;
  };
  return std::max(off(laplacian, L), off(convection, C));
}

template <class S>
double scatter_rate(const fem::BlockAssembly<mesh::Hex8, 3>& assembly, la::BlockMatrix<3>& K) {
  using Assembly = fem::BlockAssembly<mesh::Hex8, 3>;
  S Ke[Assembly::pairs][Assembly::block];
  for (auto& block : Ke)
    for (S& v : block) v = S(1.25);
  const double seconds = best_cpu_seconds(5, [&] {
    assembly.for_each_pack<Lanes<S>::count>(K, [&](const auto& pack) {
      asm volatile("" : : "r"(Ke) : "memory");  // another element matrix each time
      assembly.add_symmetric(pack, Ke, K);
    });
  });
  return 1e-6 * static_cast<double>(assembly.cells().cols()) / seconds;
}

}  // namespace detail

[[nodiscard]] inline AssemblyTime assembly_time() {
  using S = Pack<double>;
  AssemblyTime t;
  {
    const auto mesh = meshing::box_tets(assembly_side);
    const double cells = 1e-6 * mesh.cell_count();
    const fem::P1Assembly assembly(mesh);
    Points<3> w(3, mesh.node_count());
    for (Index n = 0; n < mesh.node_count(); ++n)
      w.col(n) = Vec3(mesh.nodes(1, n) - 2 * mesh.nodes(2, n), 0.3 + mesh.nodes(0, n), mesh.nodes(0, n));
    auto L = assembly.rows(), C = assembly.rows();
    Index bad = -1;
    t.laplacian = cells / best_cpu_seconds(assembly_runs, [&] {
                    std::fill(L.valuePtr(), L.valuePtr() + L.nonZeros(), 0.0);
                    bad = std::max(bad, fem::add_laplacian<S>(assembly, mesh.nodes, 1, L));
                  });
    t.convection =
        cells / best_cpu_seconds(assembly_runs, [&] {
          std::fill(C.valuePtr(), C.valuePtr() + C.nonZeros(), 0.0);
          bad = std::max(bad, fem::add_convection_diffusion<S>(assembly, mesh.nodes, viscosity, w, C));
        });
    t.off = bad < 0 ? detail::p1_error(mesh, w, L, C) : 1;
  }
  const auto tube = meshing::tube(
      {.inner_radius = 1, .thickness = 0.5, .length = 2, .cells = {16, 100, 40}});  // 64 000 cells
  const fem::BlockAssembly<mesh::Hex8, 3> full(tube), upper(tube, la::BlockStorage::upper);
  auto A = full.matrix(), U = upper.matrix();
  t.scatter = detail::scatter_rate<S>(full, A);
  t.scatter_upper = detail::scatter_rate<S>(upper, U);
  const double unknowns = 1e-6 * A.rows();
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(A.rows(), -1, 1);
  Eigen::VectorXd y(A.rows());
  t.product = unknowns / best_cpu_seconds(9, [&] { A.apply(x, y); });
  t.product_upper = unknowns / best_cpu_seconds(9, [&] { U.apply(x, y); });
  const auto rows = la::sparse(A);
  t.scalar = unknowns / best_cpu_seconds(9, [&] { y.noalias() = rows * x; });
  return t;
}

}  // namespace tunica::bench
