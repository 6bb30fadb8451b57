// SPDX-License-Identifier: MIT
// Sparse rows of small dense blocks, 32-bit indices: the matrices of a multigrid hierarchy.
#pragma once

#include "tunica/la/vector_ops.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace tunica::la::detail {

[[nodiscard]] constexpr std::size_t at(std::ptrdiff_t i) {
  return static_cast<std::size_t>(i);
}

/// Rows of R x C blocks that somebody else holds; each block by rows.
template <class T, int R, int C>
struct RowsView {
  static constexpr std::size_t size = std::size_t{R} * C;  // of a block
  Index rows = 0, cols = 0;
  const Index *start = nullptr, *column = nullptr;
  const T* value = nullptr;

  [[nodiscard]] const T* block(Index k) const { return value + size * at(k); }
};

template <class T, int R, int C>
struct BlockRows {
  static constexpr std::size_t size = std::size_t{R} * C;
  Index rows = 0, cols = 0;
  std::vector<Index> start, column;
  std::vector<T> value;

  [[nodiscard]] RowsView<T, R, C> view() const {
    return {rows, cols, start.data(), column.data(), value.data()};
  }
  [[nodiscard]] T* block(Index k) { return value.data() + size * at(k); }
  [[nodiscard]] const T* block(Index k) const { return value.data() + size * at(k); }
  [[nodiscard]] std::size_t bytes() const {
    return (start.capacity() + column.capacity()) * sizeof(Index) + value.capacity() * sizeof(T);
  }
};

/// c += a b with a (R x S), b (S x C).
template <int R, int S, int C, class X, class Y, class Z>
inline void add_product(const X* a, const Y* b, Z* c) {
  for (int i = 0; i < R; ++i)
    for (int s = 0; s < S; ++s)
      for (int j = 0; j < C; ++j) c[i * C + j] += static_cast<Z>(a[i * S + s]) * static_cast<Z>(b[s * C + j]);
}

/// Squared Frobenius norm of an R x C block.
template <int Size, class T>
[[nodiscard]] inline double squared_size(const T* a) {
  double sum = 0;
  for (int k = 0; k < Size; ++k) sum += static_cast<double>(a[k]) * static_cast<double>(a[k]);
  return sum;
}

/// Which unknowns of a node are coupled to any other unknown: prescribed ones are not.
template <int B>
[[nodiscard]] std::array<bool, B> coupled_unknowns(const RowsView<double, B, B>& A, Index node) {
  std::array<bool, B> coupled{};
  for (Index k = A.start[node]; k < A.start[node + 1]; ++k)
    for (std::size_t r = 0; r < B; ++r)
      for (std::size_t c = 0; c < B; ++c)
        coupled[r] = coupled[r] || ((A.column[k] != node || r != c) && A.block(k)[r * B + c] != 0);
  return coupled;
}

/// The inverse of a B x B block by elimination on the diagonal. A pivot that is not safely away from
/// zero is skipped, its unknown stays as it is: the zero rows of coarse functions that do not exist.
template <int B>
inline void invert(const double* a, double* inverse) {
  constexpr double least = 1e-12;  // of the entry it came from: what is left is rounding
  if constexpr (B == 1) {
    *inverse = *a != 0 && std::isfinite(*a) ? 1 / *a : 0.0;
  } else {
    double m[B][2 * B] = {};
    for (int i = 0; i < B; ++i) {
      for (int j = 0; j < B; ++j) m[i][j] = a[i * B + j];
      m[i][B + i] = 1;
    }
    for (int k = 0; k < B; ++k) {
      if (!(std::abs(m[k][k]) > least * std::abs(a[k * B + k]))) {
        for (int i = 0; i < B; ++i) m[i][k] = 0;
        for (int j = 0; j < 2 * B; ++j) m[k][j] = 0;
        continue;
      }
      const double scale = 1 / m[k][k];
      for (int j = 0; j < 2 * B; ++j) m[k][j] *= scale;
      for (int i = 0; i < B; ++i) {
        const double factor = m[i][k];
        if (i == k || factor == 0) continue;
        for (int j = 0; j < 2 * B; ++j) m[i][j] -= factor * m[k][j];
      }
    }
    for (int i = 0; i < B; ++i)
      for (int j = 0; j < B; ++j) inverse[i * B + j] = m[i][B + j];
  }
}

/// The B x B blocks of a matrix of scalars whose unknowns come B to a node; entries that the pattern
/// lacks are zero. Places keeps, for values that change later, where each entry went.
template <int B>
class Blocked {
 public:
  void set_up(const RowMatrix& A) {
    const auto n = static_cast<Index>(A.rows() / B);
    rows_.rows = rows_.cols = n;
    rows_.start.assign(1, 0);
    rows_.column.clear();
    place_.resize(static_cast<std::size_t>(A.nonZeros()));
    std::vector<Index> marker(at(n), -1);
    const int *outer = A.outerIndexPtr(), *inner = A.innerIndexPtr();
    for (Index i = 0; i < n; ++i) {
      const Index begin = rows_.start.back();
      for (int c = 0; c < B; ++c)
        for (int k = outer[B * i + c]; k < outer[B * i + c + 1]; ++k) {
          const Index j = inner[k] / B;
          if (marker[at(j)] < begin) {
            marker[at(j)] = static_cast<Index>(rows_.column.size());
            rows_.column.push_back(j);
          }
        }
      std::sort(rows_.column.begin() + begin, rows_.column.end());
      for (std::size_t k = at(begin); k < rows_.column.size(); ++k)
        marker[at(rows_.column[k])] = static_cast<Index>(k);
      for (int c = 0; c < B; ++c)
        for (int k = outer[B * i + c]; k < outer[B * i + c + 1]; ++k)
          place_[at(k)] = at(marker[at(inner[k] / B)]) * B * B + at(c * B + inner[k] % B);
      rows_.start.push_back(static_cast<Index>(rows_.column.size()));
    }
    set_values(A);
  }

  void set_values(const RowMatrix& A) {
    rows_.value.assign(rows_.column.size() * B * B, 0.0);
    for (std::size_t k = 0; k < place_.size(); ++k) rows_.value[place_[k]] = A.valuePtr()[k];
  }

  [[nodiscard]] RowsView<double, B, B> view() const { return rows_.view(); }
  /// Stored numbers of the matrix of scalars.
  [[nodiscard]] Eigen::Index entries() const { return static_cast<Eigen::Index>(place_.size()); }

 private:
  BlockRows<double, B, B> rows_;
  std::vector<std::size_t> place_;
};

/// The matrix itself: nothing is copied.
template <>
class Blocked<1> {
 public:
  void set_up(const RowMatrix& A) { set_values(A); }
  void set_values(const RowMatrix& A) {
    const auto n = static_cast<Index>(A.rows());
    view_ = {n, n, A.outerIndexPtr(), A.innerIndexPtr(), A.valuePtr()};
    entries_ = A.nonZeros();
  }
  [[nodiscard]] RowsView<double, 1, 1> view() const { return view_; }
  [[nodiscard]] Eigen::Index entries() const { return entries_; }

 private:
  RowsView<double, 1, 1> view_;
  Eigen::Index entries_ = 0;
};

}  // namespace tunica::la::detail
