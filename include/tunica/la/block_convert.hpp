// SPDX-License-Identifier: MIT
// Block matrices as whole ones, as Eigen's and as plain compressed rows; the elimination of prescribed
// unknowns.
#pragma once

#include "tunica/core/error.hpp"
#include "tunica/core/parallel.hpp"
#include "tunica/la/block_matrix.hpp"

#include <Eigen/SparseCore>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace tunica::la {

/// Compressed rows of numbers, their columns ascending.
template <class T = double>
struct Csr {
  std::vector<Index> start, column;
  std::vector<T> value;
};

namespace detail {

template <int N, class T>
void check_size(const BlockMatrix<N, T>& A) {
  const auto numbers = static_cast<std::size_t>(A.block_count()) * BlockMatrix<N, T>::block_size;
  if (numbers > static_cast<std::size_t>(std::numeric_limits<Index>::max()))
    throw InputError("block matrix", std::to_string(numbers) + " numbers",
                     "too many for the 32-bit indices of scalar rows");
}

/// Rows of numbers into arrays of the right lengths; A is whole.
template <int N, class T, class Start, class Column, class Value>
void fill_rows(const BlockMatrix<N, T>& A, Start* start, Column* column, Value* value) {
  std::size_t k = 0;
  for (Index i = 0; i < A.node_count(); ++i) {
    const Index begin = A.start()[static_cast<std::size_t>(i)],
                end = A.start()[static_cast<std::size_t>(i) + 1];
    for (int r = 0; r < N; ++r) {
      start[N * i + r] = static_cast<Start>(k);
      for (Index b = begin; b < end; ++b)
        for (int c = 0; c < N; ++c, ++k) {
          column[k] = N * A.column()[static_cast<std::size_t>(b)] + c;
          value[k] = static_cast<Value>(A.block(b)[r * N + c]);
        }
    }
  }
  start[A.rows()] = static_cast<Start>(k);
}

}  // namespace detail

/// The matrix with both triangles.
template <int N, class T>
[[nodiscard]] BlockMatrix<N, T> whole(const BlockMatrix<N, T>& A) {
  if (A.storage() == BlockStorage::full) return A;
  const auto n = static_cast<std::size_t>(A.node_count());
  const auto index = [](Index i) { return static_cast<std::size_t>(i); };
  const auto each = [&](auto&& body) {  // blocks by rows
    for (std::size_t i = 0; i < n; ++i)
      for (Index k = A.start()[i]; k < A.start()[i + 1]; ++k)
        body(static_cast<Index>(i), A.column()[index(k)], k);
  };
  std::vector<Index> start(n + 1, 0);
  each([&](Index i, Index j, Index) {
    ++start[index(i) + 1];
    if (j != i) ++start[index(j) + 1];
  });
  for (std::size_t i = 0; i < n; ++i) start[i + 1] += start[i];
  std::vector<Index> column(index(start.back())), fill(start.begin(), start.end() - 1), place(column.size());
  std::vector<char> turned(column.size(), 0);
  // a row's lower blocks come first: when row i is reached, those of the rows above it are there
  each([&](Index i, Index j, Index k) {
    const auto own = index(fill[index(i)]++);
    column[own] = j, place[own] = k;
    if (j == i) return;
    const auto other = index(fill[index(j)]++);
    column[other] = i, place[other] = k, turned[other] = 1;
  });
  BlockMatrix<N, T> B(std::move(start), std::move(column));
  for (Index b = 0; b < B.block_count(); ++b)
    for (int r = 0; r < N; ++r)
      for (int c = 0; c < N; ++c)
        B.block(b)[r * N + c] = A.block(place[index(b)])[turned[index(b)] ? c * N + r : r * N + c];
  return B;
}

/// Zeros in the pattern of the upper triangle of a matrix with a symmetric pattern.
template <int N, class T>
[[nodiscard]] BlockMatrix<N, T> upper_pattern(const BlockMatrix<N, T>& A) {
  std::vector<Index> start{0}, column;
  start.reserve(A.start().size());
  column.reserve(A.column().size() / 2 + A.start().size());
  for (std::size_t i = 0; i + 1 < A.start().size(); ++i) {
    for (Index k = A.start()[i]; k < A.start()[i + 1]; ++k)
      if (const Index j = A.column()[static_cast<std::size_t>(k)]; j >= static_cast<Index>(i))
        column.push_back(j);
    start.push_back(static_cast<Index>(column.size()));
  }
  return {std::move(start), std::move(column), BlockStorage::upper};
}

/// U, from upper_pattern(A), = the upper triangle of A.
template <int N, class T>
void copy_upper(const BlockMatrix<N, T>& A, BlockMatrix<N, T>& U) {
  parallel_chunks(A.node_count(), 1024, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
      const Index count = U.start()[i + 1] - U.start()[i];  // the last ones of the row
      std::copy_n(A.block(A.start()[i + 1] - count),
                  static_cast<std::size_t>(count) * BlockMatrix<N, T>::block_size, U.block(U.start()[i]));
    }
  });
}

/// As Eigen's compressed matrix with both triangles, by rows or by columns. InputError beyond 32-bit indices.
template <int StorageOrder = Eigen::RowMajor, int N, class T>
[[nodiscard]] Eigen::SparseMatrix<T, StorageOrder> sparse(const BlockMatrix<N, T>& A) {
  if (A.storage() == BlockStorage::upper) return sparse<StorageOrder>(whole(A));
  detail::check_size(A);
  Eigen::SparseMatrix<T, Eigen::RowMajor> B(A.rows(), A.rows());
  B.resizeNonZeros(A.block_count() * N * N);
  detail::fill_rows(A, B.outerIndexPtr(), B.innerIndexPtr(), B.valuePtr());
  return B;
}

/// As plain arrays, with both triangles. InputError beyond 32-bit indices.
template <int N, class T>
[[nodiscard]] Csr<T> csr(const BlockMatrix<N, T>& A) {
  if (A.storage() == BlockStorage::upper) return csr(whole(A));
  detail::check_size(A);
  const auto count = static_cast<std::size_t>(A.block_count()) * N * N;
  Csr<T> B{.start = std::vector<Index>(static_cast<std::size_t>(A.rows()) + 1),
           .column = std::vector<Index>(count),
           .value = std::vector<T>(count)};
  detail::fill_rows(A, B.start.data(), B.column.data(), B.value.data());
  return B;
}

/// Turns A x = b into the system with x = prescribed.value(i) at the unknowns with prescribed.fixed(i) (those
/// of fem::Dirichlet): their rows and columns become those of the identity times `diagonal`, for free rows b
/// -= A value. The pattern is symmetric. With `upper`, both triangles are meant.
template <int N, class T, class Prescribed, class Vector>
void eliminate(BlockMatrix<N, T>& A, const Prescribed& prescribed, Vector& b, double diagonal = 1) {
  const bool upper = A.storage() == BlockStorage::upper;
  std::vector<char> touched(static_cast<std::size_t>(A.node_count()), 0);
  for (Index i = 0; i < A.node_count(); ++i)
    for (int r = 0; r < N; ++r)
      if (prescribed.fixed(N * i + r)) touched[static_cast<std::size_t>(i)] = 1;
  for (Index i = 0; i < A.node_count(); ++i)
    for (Index k = A.start()[static_cast<std::size_t>(i)]; k < A.start()[static_cast<std::size_t>(i) + 1];
         ++k) {
      const Index j = A.column()[static_cast<std::size_t>(k)];
      if (!touched[static_cast<std::size_t>(i)] && !touched[static_cast<std::size_t>(j)]) continue;
      for (int r = 0; r < N; ++r)
        for (int c = 0; c < N; ++c) {
          const Index row = N * i + r, col = N * j + c;
          const bool fixed_row = prescribed.fixed(row), fixed_col = prescribed.fixed(col);
          if (!fixed_row && !fixed_col) continue;
          T& a = A.block(k)[r * N + c];
          if (!fixed_row) b[row] -= a * prescribed.value(col);
          if (upper && j != i && !fixed_col) b[col] -= a * prescribed.value(row);
          a = row == col ? static_cast<T>(diagonal) : T(0);
        }
    }
  for (Index i = 0; i < A.rows(); ++i)
    if (prescribed.fixed(i)) b[i] = diagonal * prescribed.value(i);
}

}  // namespace tunica::la
