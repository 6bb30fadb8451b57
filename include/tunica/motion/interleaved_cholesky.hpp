// SPDX-License-Identifier: MIT
// One factorisation for the three components of a nodal field, some nodes of which are given.
#pragma once

#include "tunica/core/error.hpp"
#include "tunica/core/types.hpp"

#include <Eigen/SparseCholesky>

#include <cstddef>
#include <utility>
#include <vector>

namespace tunica::motion {

/// A_uu d_u = -A_uk d_k for the unknown nodes u; A symmetric positive definite on them. The three
/// components go through the factors together: their speed is that of the memory.
class InterleavedCholesky {
 public:
  InterleavedCholesky() = default;

  /// A: nodes x nodes; known: one flag a node.
  InterleavedCholesky(const Eigen::SparseMatrix<double>& A, const std::vector<char>& known) {
    std::vector<Index> number(known.size(), -1);
    for (std::size_t n = 0; n < known.size(); ++n)
      if (!known[n])
        number[n] = static_cast<Index>(unknown_.size()), unknown_.push_back(static_cast<Index>(n));
    const auto size = static_cast<Index>(unknown_.size());
    if (size == 0) return;
    std::vector<Eigen::Triplet<double>> inside;
    for (int j = 0; j < A.outerSize(); ++j)
      for (Eigen::SparseMatrix<double>::InnerIterator it(A, j); it; ++it) {
        const Index row = number[static_cast<std::size_t>(it.row())],
                    column = number[static_cast<std::size_t>(j)];
        if (row >= 0 && column >= 0) inside.emplace_back(row, column, it.value());
        if (row >= 0 && column < 0 && it.value() != 0)
          given_.push_back({row, static_cast<Index>(j), it.value()});
      }
    Eigen::SparseMatrix<double> Auu(size, size);
    Auu.setFromTriplets(inside.begin(), inside.end());
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(Auu);
    if (factor.info() != Eigen::Success || !(factor.vectorD().minCoeff() > 0))
      throw MeshError("mesh motion: the mesh is not connected to a patch, or it is degenerate");
    L_ = factor.matrixL();
    inverse_ = factor.vectorD().cwiseInverse();
    place_ = factor.permutationP().indices();
  }

  [[nodiscard]] const std::vector<Index>& unknowns() const { return unknown_; }

  /// d (3 x nodes): given at the known nodes, overwritten at the unknown ones.
  void solve(Points<3>& d) const {
    Points<3> y = Points<3>::Zero(3, static_cast<Eigen::Index>(unknown_.size()));
    for (const Given& g : given_) y.col(place_[g.row]) -= g.value * d.col(g.node);
    const int *outer = L_.outerIndexPtr(), *inner = L_.innerIndexPtr();
    const double* value = L_.valuePtr();
    for (Eigen::Index j = 0; j < y.cols(); ++j) {  // L y = b, the diagonal of L is 1
      const Vec3 yj = y.col(j);
      for (int k = outer[j]; k < outer[j + 1]; ++k)
        if (inner[k] != j) y.col(inner[k]) -= value[k] * yj;
    }
    for (Eigen::Index j = y.cols(); j-- > 0;) {  // L^T x = D^-1 y
      Vec3 sum = inverse_[j] * y.col(j);
      for (int k = outer[j]; k < outer[j + 1]; ++k)
        if (inner[k] != j) sum -= value[k] * y.col(inner[k]);
      y.col(j) = sum;
    }
    for (std::size_t n = 0; n < unknown_.size(); ++n)
      d.col(unknown_[n]) = y.col(place_[static_cast<Eigen::Index>(n)]);
  }

 private:
  struct Given {
    Index row, node;
    double value;
  };
  std::vector<Index> unknown_;  // node numbers
  std::vector<Given> given_;    // the block that multiplies the given nodes
  Eigen::SparseMatrix<double> L_;
  Eigen::VectorXd inverse_;
  Eigen::Matrix<int, Eigen::Dynamic, 1> place_;
};

}  // namespace tunica::motion
