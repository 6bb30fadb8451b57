// SPDX-License-Identifier: MIT
// The mass matrix of a body: one number for each pair of nodes, in the pattern of its tangent.
#pragma once

#include "tunica/core/parallel.hpp"
#include "tunica/la/block_matrix.hpp"
#include "tunica/mesh/mesh.hpp"
#include "tunica/solid/cell_mass.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace tunica::solid {

/// N: unknowns a node, of which the first three are displacements.
template <mesh::Cell C, int N>
class BodyMass {
 public:
  /// density [kg/m3]. MeshError names the first cell that is inverted as it is given.
  BodyMass(const mesh::Mesh<C, 3>& mesh, const la::BlockMatrix<N>& pattern, double density, Mass kind)
      : mass_(static_cast<std::size_t>(pattern.block_count()), 0) {
    for (Index e = 0; e < mesh.cell_count(); ++e) {
      Eigen::Matrix<double, 3, C::nodes> X;
      for (int a = 0; a < C::nodes; ++a) X.col(a) = mesh.nodes.col(mesh.cells(a, e));
      const auto m = cell_mass<C>(e, X, density, kind);
      for (int a = 0; a < C::nodes; ++a)
        for (int b = 0; b < C::nodes; ++b)
          if (m(a, b) != 0)
            mass_[static_cast<std::size_t>(pattern.find(mesh.cells(a, e), mesh.cells(b, e)))] += m(a, b);
    }
  }

  /// f += factor M a [N].
  void add_forces(const la::BlockMatrix<N>& pattern, const Eigen::VectorXd& a, double factor,
                  Eigen::VectorXd& f) const {
    parallel_chunks(pattern.node_count(), 1024, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      for (std::ptrdiff_t i = begin; i < end; ++i) {
        double sum[3] = {};
        for (Index k = pattern.start()[static_cast<std::size_t>(i)];
             k < pattern.start()[static_cast<std::size_t>(i) + 1]; ++k) {
          const Index j = pattern.column()[static_cast<std::size_t>(k)];
          for (int c = 0; c < 3; ++c) sum[c] += mass_[static_cast<std::size_t>(k)] * a[3 * j + c];
        }
        for (int c = 0; c < 3; ++c) f[3 * i + c] += factor * sum[c];
      }
    });
  }

  /// A += factor M.
  void add_to(double factor, la::BlockMatrix<N>& A) const {
    for (std::size_t k = 0; k < mass_.size(); ++k) {
      double* const block = A.block(static_cast<Index>(k));
      for (int c = 0; c < 3; ++c) block[(N + 1) * c] += factor * mass_[k];
    }
  }

 private:
  std::vector<double> mass_;  // of one component, a number a block [kg]
};

}  // namespace tunica::solid
