// SPDX-License-Identifier: MIT
// The tangent of a body: assembled in blocks, a block a pair of nodes, and handed to a solver as columns.
#pragma once

#include "tunica/core/expect.hpp"
#include "tunica/core/parallel.hpp"
#include "tunica/core/types.hpp"
#include "tunica/la/block_matrix.hpp"
#include "tunica/la/linear_solver.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace tunica::solid {

/// N unknowns a node: three displacements, 3 a + i in a vector, and with N = 4 a pressure, 3 nodes + a.
template <int N>
class TangentMatrix {
 public:
  static_assert(N == 3 || N == 4, "displacements, or displacements and a pressure");

  /// Zeros in a pattern that is symmetric, both triangles stored.
  explicit TangentMatrix(la::BlockMatrix<N> pattern) : blocks_(std::move(pattern)) {
    mate_.resize(static_cast<std::size_t>(blocks_.block_count()));
    parallel_chunks(nodes(), 1024, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      for (auto i = static_cast<Index>(begin); i < static_cast<Index>(end); ++i)
        for_row(i, [&](Index j, Index k) { mate_[static_cast<std::size_t>(k)] = blocks_.find(j, i); });
    });
  }

  [[nodiscard]] la::BlockMatrix<N>& blocks() { return blocks_; }
  [[nodiscard]] const la::BlockMatrix<N>& blocks() const { return blocks_; }
  [[nodiscard]] Index unknowns() const { return blocks_.rows(); }

  /// Rows and columns of fixed unknowns (a flag each, in the order of vectors) become zero but for their
  /// diagonal, which stays as large as those beside it and positive.
  void constrain(const std::vector<char>& fixed) {
    TUNICA_EXPECT(fixed.size() == static_cast<std::size_t>(unknowns()), "a flag for each unknown");
    parallel_chunks(nodes(), 1024, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      for (auto i = static_cast<Index>(begin); i < static_cast<Index>(end); ++i)
        for_row(i, [&](Index j, Index k) { constrain(i, j, k, fixed); });
    });
  }

  /// A matrix of zeros in the pattern, for columns().
  [[nodiscard]] la::SparseMatrix pattern() const {
    la::SparseMatrix A(unknowns(), unknowns());
    A.resizeNonZeros(static_cast<Eigen::Index>(blocks_.block_count()) * N * N);
    int* const outer = A.outerIndexPtr();
    int* const inner = A.innerIndexPtr();
    std::size_t n = 0;
    for_column([&](Index column, Index j, int) {
      outer[column] = static_cast<int>(n);
      for_row(j, [&](Index i, Index) {
        for (int r = 0; r < 3; ++r) inner[n++] = 3 * i + r;
      });
      if constexpr (N == 4) for_row(j, [&](Index i, Index) { inner[n++] = 3 * nodes() + i; });
    });
    outer[unknowns()] = static_cast<int>(n);
    std::fill(A.valuePtr(), A.valuePtr() + A.nonZeros(), 0.0);
    return A;
  }

  /// A (from pattern()) = this. A symmetric matrix is read row by row, as it lies.
  void columns(bool symmetric, la::SparseMatrix& A) const {
    const int* const outer = A.outerIndexPtr();
    double* const values = A.valuePtr();
    parallel_chunks(nodes(), 1024, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      for (auto j = static_cast<Index>(begin); j < static_cast<Index>(end); ++j)
        for (int c = 0; c < N; ++c) {
          double* to = values + outer[unknown(j, c)];
          const auto entries = [&](int first, int last) {
            for_row(j, [&](Index, Index k) {
              const double* const from = blocks_.block(symmetric ? k : mate_[static_cast<std::size_t>(k)]);
              for (int r = first; r < last; ++r) *to++ = from[symmetric ? N * c + r : N * r + c];
            });
          };
          entries(0, 3);
          if constexpr (N == 4) entries(3, 4);
        }
    });
  }

 private:
  [[nodiscard]] Index nodes() const { return blocks_.node_count(); }
  [[nodiscard]] Index unknown(Index node, int c) const { return c < 3 ? 3 * node + c : 3 * nodes() + node; }

  /// body(column, number of the block) for the blocks of a row.
  template <class Body>
  void for_row(Index i, Body&& body) const {
    for (Index k = blocks_.start()[static_cast<std::size_t>(i)];
         k < blocks_.start()[static_cast<std::size_t>(i) + 1]; ++k)
      body(blocks_.column()[static_cast<std::size_t>(k)], k);
  }
  /// body(column, node, component) in the order of vectors.
  template <class Body>
  void for_column(Body&& body) const {
    for (Index j = 0; j < nodes(); ++j)
      for (int c = 0; c < 3; ++c) body(3 * j + c, j, c);
    if constexpr (N == 4)
      for (Index j = 0; j < nodes(); ++j) body(3 * nodes() + j, j, 3);
  }

  void constrain(Index i, Index j, Index k, const std::vector<char>& fixed) {
    double* const block = blocks_.block(k);
    double size = 0;
    for (int c = 0; i == j && c < N; ++c) size = std::max(size, std::abs(block[(N + 1) * c]));
    const auto is_fixed = [&](Index node, int c) {
      return fixed[static_cast<std::size_t>(unknown(node, c))] != 0;
    };
    for (int r = 0; r < N; ++r)
      for (int c = 0; c < N; ++c)
        if (is_fixed(i, r) || is_fixed(j, c)) block[N * r + c] = i == j && r == c ? (size > 0 ? size : 1) : 0;
  }

  la::BlockMatrix<N> blocks_;
  std::vector<Index> mate_;  // number of the block (j, i) for each block (i, j)
};

}  // namespace tunica::solid
