// SPDX-License-Identifier: MIT
// Gauss-Seidel within fixed chunks of rows, Jacobi between them: the smoother of the multigrid. [BAKER11]
#pragma once

#include "tunica/la/block_rows.hpp"

#include <array>
#include <vector>

namespace tunica::la::detail {

/// A = L + D + U + O: L, D, U within the chunks, O between them. The forward sweep solves with L + D, the
/// backward one with D + U, its adjoint. Where O outweighs D the diagonal is raised, by as much as makes
/// L + D + (L + D)^T - A definite, so that a sweep never amplifies an error; O takes the difference.
template <class T, int B>
class GaussSeidel {
 public:
  static constexpr std::size_t block = std::size_t{B} * B;

  /// The matrix times `scale`.
  void set_up(const RowsView<double, B, B>& A, double scale) {
    rows_ = A.rows;
    // As many chunks as can keep some threads busy, never fewer rows in one than pay for a thread.
    chunk_ = std::max<std::ptrdiff_t>(least_chunk, (A.rows + most_chunks - 1) / most_chunks);
    start_.assign(A.start, A.start + A.rows + 1);
    upper_.resize(at(rows_));
    outer_.resize(at(rows_));
    end_.resize(at(rows_));
    inverse_.resize(block * at(rows_));
    diagonal_.resize(block * at(rows_));
    column_.resize(at(A.start[A.rows]));
    value_.resize(block * column_.size());
    set_values(A, scale);
  }

  void set_values(const RowsView<double, B, B>& A, double scale) {
    parallel_chunks(rows_, chunk_, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      for (auto i = static_cast<Index>(begin); i < end; ++i) fill_row(A, i, begin, end, scale);
    });
  }

  /// x = (L + D)^-1 b, which is a sweep from x = 0.
  void forward_from_zero(const T* b, T* x) const {
    parallel_chunks(rows_, chunk_, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      for (auto i = static_cast<Index>(begin); i < end; ++i) {
        std::array<T, B> sum = copy(b, i);
        subtract(start_[at(i)], upper_[at(i)], x, sum);
        store(i, sum, x);
      }
    });
  }

  /// r = b - A x for the x of forward_from_zero(b, x): what L and D leave is zero.
  void residual_of_forward(const T* x, T* r) const {
    parallel_chunks(rows_, row_chunk, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      for (auto i = static_cast<Index>(begin); i < end; ++i) {
        std::array<T, B> sum{};
        subtract(upper_[at(i)], end_[at(i)], x, sum);
        for (std::size_t c = 0; c < B; ++c) r[B * at(i) + c] = sum[c];
      }
    });
  }

  /// r = b - A x.
  void residual(const T* b, const T* x, T* r) const {
    residual_of_forward(x, r);
    parallel_chunks(rows_, row_chunk, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      for (auto i = static_cast<Index>(begin); i < end; ++i) {
        std::array<T, B> sum{};
        for (std::size_t c = 0; c < B; ++c) sum[c] = b[B * at(i) + c] + r[B * at(i) + c];
        subtract(start_[at(i)], upper_[at(i)], x, sum);
        const T* d = diagonal_.data() + block * at(i);
        for (std::size_t k = 0; k < B; ++k) {
          for (std::size_t c = 0; c < B; ++c) sum[k] -= d[k * B + c] * x[B * at(i) + c];
          r[B * at(i) + k] = sum[k];
        }
      }
    });
  }

  /// A sweep from the last row to the first. old: room for a copy of x.
  void backward(const T* b, T* x, T* old) const {
    const bool several = rows_ > chunk_;
    if (several) std::copy_n(x, B * at(rows_), old);
    parallel_chunks(rows_, chunk_, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      for (auto i = static_cast<Index>(end); i-- > begin;) {
        std::array<T, B> sum = copy(b, i);
        if constexpr (B > 1)
          if (i > begin) fetch(i - 1);
        subtract(start_[at(i)], outer_[at(i)], x, sum);
        if (several) subtract(outer_[at(i)], end_[at(i)], old, sum);
        store(i, sum, x);
      }
    });
  }

  [[nodiscard]] std::size_t bytes() const {
    return (start_.size() + 3 * upper_.size() + column_.size()) * sizeof(Index) +
           (value_.size() + 2 * inverse_.size()) * sizeof(T);
  }

 private:
  static constexpr std::ptrdiff_t least_chunk = 8192 / B, most_chunks = 8;

  [[nodiscard]] static std::array<T, B> copy(const T* b, Index i) {
    std::array<T, B> sum;
    for (std::size_t c = 0; c < B; ++c) sum[c] = b[B * at(i) + c];
    return sum;
  }

  void subtract(Index begin, Index end, const T* x, std::array<T, B>& sum) const {
    for (Index k = begin; k < end; ++k) {
      const T* a = value_.data() + block * at(k);
      const T* xk = x + B * at(column_[at(k)]);
      for (std::size_t r = 0; r < B; ++r) {  // the product by itself: sums of rows wait for one another less
        T product = a[r * B] * xk[0];
        for (std::size_t c = 1; c < B; ++c) product += a[r * B + c] * xk[c];
        sum[r] -= product;
      }
    }
  }

  /// Asks for the numbers of a row early: no machine expects rows that come last to first.
  void fetch(Index i) const {
#if defined(__GNUC__)
    constexpr std::size_t line = 64 / sizeof(T);
    for (std::size_t k = block * at(start_[at(i)]), end = block * at(start_[at(i) + 1]); k < end; k += line)
      __builtin_prefetch(value_.data() + k);
#endif
  }

  void store(Index i, const std::array<T, B>& sum, T* x) const {
    const T* inverse = inverse_.data() + block * at(i);
    for (std::size_t r = 0; r < B; ++r) {
      T value = 0;
      for (std::size_t c = 0; c < B; ++c) value += inverse[r * B + c] * sum[c];
      x[B * at(i) + r] = value;
    }
  }

  void fill_row(const RowsView<double, B, B>& A, Index i, std::ptrdiff_t begin, std::ptrdiff_t end,
                double scale) {
    Index place = A.start[i];
    std::array<double, block> diagonal{}, raise{}, inverse{};
    std::array<double, B> outside{};
    const auto put = [&](Index j, const double* a) {
      column_[at(place)] = j;
      for (std::size_t c = 0; c < block; ++c) value_[block * at(place) + c] = static_cast<T>(scale * a[c]);
      ++place;
    };
    for (Index k = A.start[i]; k < A.start[i + 1]; ++k)
      if (A.column[k] >= begin && A.column[k] < i) put(A.column[k], A.block(k));
    upper_[at(i)] = place;
    for (Index k = A.start[i]; k < A.start[i + 1]; ++k)
      if (A.column[k] > i && A.column[k] < end) put(A.column[k], A.block(k));
    outer_[at(i)] = place;
    bool has_diagonal = false;
    for (Index k = A.start[i]; k < A.start[i + 1]; ++k)
      if (A.column[k] == i) {
        std::copy_n(A.block(k), block, diagonal.data());
        has_diagonal = true;
      } else if (A.column[k] < begin || A.column[k] >= end) {
        put(A.column[k], A.block(k));
        for (std::size_t c = 0; c < block; ++c) outside[c / B] += std::abs(A.block(k)[c]);
      }
    if (has_diagonal && place > outer_[at(i)]) {  // Gershgorin's bound on D - O, row by row
      bool raised = false;
      for (std::size_t r = 0; r < B; ++r) {
        double least = 2 * diagonal[r * B + r] - outside[r];
        for (std::size_t c = 0; c < B; ++c) least -= std::abs(diagonal[r * B + c]);
        if (least < 0) raise[r * B + r] = 0.5 * least, raised = true;
      }
      if (raised) put(i, raise.data());
    }
    end_[at(i)] = place;
    for (std::size_t c = 0; c < block; ++c) diagonal[c] = scale * (diagonal[c] - raise[c]);
    invert<B>(diagonal.data(), inverse.data());
    for (std::size_t c = 0; c < block; ++c) {
      diagonal_[block * at(i) + c] = static_cast<T>(diagonal[c]);
      inverse_[block * at(i) + c] = static_cast<T>(inverse[c]);
    }
  }

  Index rows_ = 0;
  std::ptrdiff_t chunk_ = 1;
  std::vector<Index> start_, upper_, outer_, end_, column_;  // of a row: L, U, O, and its end
  std::vector<T> value_, diagonal_, inverse_;                // D as raised
};

}  // namespace tunica::la::detail
