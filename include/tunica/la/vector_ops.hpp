// SPDX-License-Identifier: MIT
// Sums and products of long vectors over fixed chunks: the same bits on any number of threads.
#pragma once

#include "tunica/core/parallel.hpp"
#include "tunica/core/types.hpp"

#include <Eigen/SparseCore>

#include <array>
#include <cmath>
#include <cstddef>

namespace tunica::la {

inline constexpr std::ptrdiff_t vector_chunk = 16384;  // below this a second thread costs more than it saves
inline constexpr std::ptrdiff_t row_chunk = 4096;

using RowMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

[[nodiscard]] inline double dot(const Eigen::VectorXd& x, const Eigen::VectorXd& y) {
  if (x.size() <= vector_chunk) return x.dot(y);
  return parallel_sum(x.size(), vector_chunk, [&](std::ptrdiff_t b, std::ptrdiff_t e) {
    return x.segment(b, e - b).dot(y.segment(b, e - b));
  });
}

[[nodiscard]] inline double norm(const Eigen::VectorXd& x) {
  return std::sqrt(dot(x, x));
}

/// y = A x for `Components` interleaved vectors at once: x, y are Components * rows long.
template <int Components = 1>
void multiply(const RowMatrix& A, const Eigen::VectorXd& x, Eigen::VectorXd& y) {
  y.resize(Components * A.rows());
  const int *outer = A.outerIndexPtr(), *inner = A.innerIndexPtr();
  const double *values = A.valuePtr(), *in = x.data();
  double* out = y.data();
  parallel_chunks(A.rows(), row_chunk, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t i = begin; i < end; ++i) {
      std::array<double, Components> sum{};
      for (int k = outer[i]; k < outer[i + 1]; ++k) {
        const double* xk = in + static_cast<std::ptrdiff_t>(Components) * inner[k];
        for (std::size_t c = 0; c < Components; ++c) sum[c] += values[k] * xk[c];
      }
      for (std::size_t c = 0; c < Components; ++c)
        out[Components * i + static_cast<std::ptrdiff_t>(c)] = sum[c];
    }
  });
}

}  // namespace tunica::la
