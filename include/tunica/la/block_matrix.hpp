// SPDX-License-Identifier: MIT
// Sparse matrices of N x N blocks in compressed rows, one index a block, whole or their upper triangle.
#pragma once

#include "tunica/core/expect.hpp"
#include "tunica/core/parallel.hpp"
#include "tunica/core/types.hpp"
#include "tunica/la/aligned.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace tunica::la {

enum class BlockStorage {
  full,
  upper  // of a symmetric matrix: blocks (i, j) with i <= j; those on the diagonal are whole
};

/// Square. Block row i has the blocks start()[i] .. start()[i + 1], their columns ascending, each block by
/// rows. Unknown c of node i is number N i + c. An operator of the Krylov solvers: apply(x, y).
///   BlockMatrix<3> A = assembly.matrix();  A.apply(x, y);
template <int N, class T = double>
class BlockMatrix {
 public:
  static constexpr int block_rows = N;
  static constexpr std::size_t block_size = std::size_t{N} * N;
  using value_type = T;

  BlockMatrix() = default;
  /// All zero. Columns of a row ascend; with BlockStorage::upper none is below its row.
  BlockMatrix(std::vector<Index> start, std::vector<Index> column, BlockStorage storage = BlockStorage::full)
      : start_(std::move(start)),
        column_(std::move(column)),
        value_(block_size * column_.size()),
        storage_(storage) {
    TUNICA_EXPECT(!start_.empty() && start_.back() == static_cast<Index>(column_.size()),
                  "the starts of rows end with the number of blocks");
    if (storage_ == BlockStorage::upper) find_reach();
  }

  [[nodiscard]] Index node_count() const { return static_cast<Index>(start_.size()) - 1; }
  [[nodiscard]] Index rows() const { return N * node_count(); }
  [[nodiscard]] Index block_count() const { return static_cast<Index>(column_.size()); }
  [[nodiscard]] BlockStorage storage() const { return storage_; }
  [[nodiscard]] const std::vector<Index>& start() const { return start_; }
  [[nodiscard]] const std::vector<Index>& column() const { return column_; }
  [[nodiscard]] T* values() { return value_.data(); }
  [[nodiscard]] const T* values() const { return value_.data(); }
  [[nodiscard]] T* block(Index k) { return value_.data() + block_size * static_cast<std::size_t>(k); }
  [[nodiscard]] const T* block(Index k) const {
    return value_.data() + block_size * static_cast<std::size_t>(k);
  }
  /// Number of the block (row, column), -1 where the pattern has none.
  [[nodiscard]] Index find(Index row, Index column) const {
    const auto begin = column_.begin() + at(start_, row), end = column_.begin() + at(start_, row + 1);
    const auto it = std::lower_bound(begin, end, column);
    return it != end && *it == column ? static_cast<Index>(it - column_.begin()) : -1;
  }

  void set_zero() {
    T* const v = values();
    parallel_chunks(static_cast<std::ptrdiff_t>(value_.size()), 1 << 20,
                    [&](std::ptrdiff_t b, std::ptrdiff_t e) { std::fill(v + b, v + e, T(0)); });
  }

  /// y = A x, both rows() long; x and y do not overlap. The same bits on any number of threads. Storage
  /// `upper` keeps its scratch in the matrix: no two products of one matrix at once.
  void multiply(const T* x, T* y) const {
    if (storage_ == BlockStorage::full)
      multiply_full(x, y);
    else
      multiply_upper(x, y);
  }

  template <class X, class Y>
  void apply(const X& x, Y& y) const {
    TUNICA_EXPECT(x.size() == rows(), "a vector has as many numbers as the matrix has rows");
    y.resize(rows());
    multiply(x.data(), y.data());
  }

 private:
  static constexpr std::ptrdiff_t full_chunk = 1024;  // [block rows]
  static Index at(const std::vector<Index>& v, std::ptrdiff_t i) { return v[static_cast<std::size_t>(i)]; }

  void multiply_full(const T* x, T* y) const {
    parallel_chunks(node_count(), full_chunk, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      const T* a = block(at(start_, begin));
      for (std::ptrdiff_t i = begin; i < end; ++i) {
        T sum[N] = {};
        for (Index k = at(start_, i), last = at(start_, i + 1); k < last; ++k, a += block_size) {
          const T* xk = x + std::ptrdiff_t{N} * at(column_, k);
#pragma GCC unroll 4
          for (int r = 0; r < N; ++r)
#pragma GCC unroll 4
            for (int c = 0; c < N; ++c) sum[r] += a[r * N + c] * xk[c];
        }
        for (int r = 0; r < N; ++r) y[N * i + r] = sum[r];
      }
    });
  }

  /// Each chunk of rows adds the transposed blocks to its own rows at once and to later ones in a list of its
  /// own; the lists are added in the order of the chunks.
  void multiply_upper(const T* x, T* y) const {
    spill_.resize(spill_start_.back());
    parallel_chunks(node_count(), chunk_, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      T* const spill = spill_.data() + spill_start_[static_cast<std::size_t>(begin / chunk_)];
      std::fill(y + N * begin, y + N * end, T(0));
      std::fill(spill, spill_.data() + spill_start_[static_cast<std::size_t>(begin / chunk_) + 1], T(0));
      const T* a = block(at(start_, begin));
      for (std::ptrdiff_t i = begin; i < end; ++i) {
        T sum[N] = {}, xi[N];
        for (int r = 0; r < N; ++r) xi[r] = x[N * i + r];
        for (Index k = at(start_, i), last = at(start_, i + 1); k < last; ++k, a += block_size) {
          const std::ptrdiff_t j = at(column_, k);
          const T* xj = x + N * j;
#pragma GCC unroll 4
          for (int r = 0; r < N; ++r)
#pragma GCC unroll 4
            for (int c = 0; c < N; ++c) sum[r] += a[r * N + c] * xj[c];
          if (j == i) continue;
          T* to = j < end ? y + N * j : spill + N * (j - end);
#pragma GCC unroll 4
          for (int c = 0; c < N; ++c)
#pragma GCC unroll 4
            for (int r = 0; r < N; ++r) to[c] += a[r * N + c] * xi[r];
        }
        for (int r = 0; r < N; ++r) y[N * i + r] += sum[r];
      }
    });
    parallel_chunks(node_count(), chunk_, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      for (std::ptrdiff_t d = 0; d < begin / chunk_; ++d) {
        const auto slot = static_cast<std::size_t>(d);
        const std::ptrdiff_t first = (d + 1) * chunk_;  // row that the list starts with
        const std::ptrdiff_t last =
            first + static_cast<std::ptrdiff_t>(spill_start_[slot + 1] - spill_start_[slot]) / N;
        const T* const from = spill_.data() + spill_start_[slot];
        for (std::ptrdiff_t k = N * begin; k < N * std::min(end, last); ++k) y[k] += from[k - N * first];
      }
    });
  }

  /// How far each chunk of rows reaches into later ones.
  void find_reach() {
    chunk_ = std::max<std::ptrdiff_t>(1024, (node_count() + 31) / 32);
    spill_start_.assign(1, 0);
    for (std::ptrdiff_t begin = 0; begin < node_count(); begin += chunk_) {
      const std::ptrdiff_t end = std::min<std::ptrdiff_t>(node_count(), begin + chunk_);
      std::ptrdiff_t reach = end;
      for (std::ptrdiff_t i = begin; i < end; ++i)
        if (at(start_, i + 1) > at(start_, i))
          reach = std::max<std::ptrdiff_t>(reach, at(column_, at(start_, i + 1) - 1) + 1);
      spill_start_.push_back(spill_start_.back() + static_cast<std::size_t>(N * (reach - end)));
    }
  }

  std::vector<Index> start_, column_;
  AlignedVector<T> value_;
  BlockStorage storage_ = BlockStorage::full;
  std::ptrdiff_t chunk_ = 1;  // rows of a chunk of `upper`
  std::vector<std::size_t> spill_start_;
  mutable std::vector<T> spill_;
};

}  // namespace tunica::la
