// SPDX-License-Identifier: MIT
// The coarsest matrix of a multigrid, dense: elimination that skips the unknowns a semidefinite matrix leaves
// free.
#pragma once

#include "tunica/la/block_rows.hpp"

#include <vector>

namespace tunica::la::detail {

/// A = L U, L with a unit diagonal, without pivoting: sure for definite matrices, and for those that the
/// diagonal dominates. A pivot of which elimination leaves only rounding belongs to the null space: its
/// unknown is set to zero, which is a solution wherever b is in the range.
template <class T>
class DenseFactors {
 public:
  template <int K>
  void compute(const RowsView<double, K, K>& A, double scale) {
    constexpr double least = 1e-10;  // of the diagonal; rounding in products of P^T A P is some 1e-14
    n_ = at(A.rows) * K;
    std::vector<double> m(n_ * n_, 0.0);
    for (Index i = 0; i < A.rows; ++i)
      for (Index k = A.start[i]; k < A.start[i + 1]; ++k)
        for (std::size_t r = 0; r < K; ++r)
          for (std::size_t c = 0; c < K; ++c)
            m[(at(i) * K + r) * n_ + at(A.column[k]) * K + c] += scale * A.block(k)[r * K + c];
    std::vector<double> diagonal(n_);
    for (std::size_t i = 0; i < n_; ++i) diagonal[i] = std::abs(m[i * n_ + i]);
    for (std::size_t k = 0; k < n_; ++k) {
      const double pivot = m[k * n_ + k];
      const double inverse = std::abs(pivot) > least * diagonal[k] ? 1 / pivot : 0.0;
      m[k * n_ + k] = inverse;
      for (std::size_t i = k + 1; i < n_; ++i) {
        const double factor = m[i * n_ + k] *= inverse;
        if (factor == 0) continue;
        for (std::size_t j = k + 1; j < n_; ++j) m[i * n_ + j] -= factor * m[k * n_ + j];
      }
    }
    factors_.assign(m.begin(), m.end());
  }

  void solve(const T* b, T* x) const {
    for (std::size_t i = 0; i < n_; ++i) {
      const T* row = factors_.data() + i * n_;
      T sum = b[i];
      for (std::size_t j = 0; j < i; ++j) sum -= row[j] * x[j];
      x[i] = sum;
    }
    for (std::size_t i = n_; i-- > 0;) {
      const T* row = factors_.data() + i * n_;
      T sum = x[i];
      for (std::size_t j = i + 1; j < n_; ++j) sum -= row[j] * x[j];
      x[i] = sum * row[i];
    }
  }

  [[nodiscard]] std::size_t bytes() const { return factors_.size() * sizeof(T); }

 private:
  std::size_t n_ = 0;
  std::vector<T> factors_;  // L below the diagonal, the inverted pivots on it, U above
};

}  // namespace tunica::la::detail
