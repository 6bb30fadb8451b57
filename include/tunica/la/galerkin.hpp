// SPDX-License-Identifier: MIT
// The product P^T A P of sparse rows, in two steps by rows: A P in chunks, then each coarse row.
#pragma once

#include "tunica/la/block_rows.hpp"

#include <vector>

namespace tunica::la::detail {

/// Some rows of a product, made by one thread.
template <int B, int K>
struct ProductRows {
  std::vector<Index> start, column;
  std::vector<double> value;

  /// Makes room for a row of at most `most` blocks more.
  void reserve(std::size_t used, std::size_t most) {
    if (used + most <= column.size()) return;
    const std::size_t size = std::max(used + most, 2 * column.size());
    column.resize(size);
    value.resize(size * B * K);
  }
};

inline constexpr std::ptrdiff_t product_chunk = 32768;

/// A P, a chunk of rows at a time; columns in the order in which they are met.
template <class T, int B, int K>
[[nodiscard]] std::vector<ProductRows<B, K>> product(const RowsView<double, B, B>& A,
                                                     const BlockRows<T, B, K>& P) {
  constexpr std::size_t block = std::size_t{B} * K;
  std::vector<ProductRows<B, K>> chunks(at((A.rows + product_chunk - 1) / product_chunk));
  parallel_chunks(A.rows, product_chunk, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    auto& out = chunks[static_cast<std::size_t>(begin / product_chunk)];
    std::vector<Index> place(at(P.cols), -1);
    out.start.reserve(static_cast<std::size_t>(end - begin) + 1);
    out.start.push_back(0);
    out.reserve(0, static_cast<std::size_t>(end - begin) * 8);
    std::size_t used = 0;
    for (auto i = static_cast<Index>(begin); i < end; ++i) {
      std::size_t most = 0;
      for (Index k = A.start[i]; k < A.start[i + 1]; ++k)
        most += at(P.start[at(A.column[k]) + 1] - P.start[at(A.column[k])]);
      out.reserve(used, most);
      const auto first = static_cast<Index>(used);
      Index* column = out.column.data();
      double* value = out.value.data();
      for (Index k = A.start[i]; k < A.start[i + 1]; ++k) {
        const Index j = A.column[k];
        const double* a = A.block(k);
        for (Index m = P.start[at(j)], last = P.start[at(j) + 1]; m < last; ++m) {
          Index& p = place[at(P.column[at(m)])];
          if (p < first) {
            p = static_cast<Index>(used++);
            column[p] = P.column[at(m)];
            std::fill_n(value + block * at(p), block, 0.0);
          }
          add_product<B, B, K>(a, P.block(m), value + block * at(p));
        }
      }
      out.start.push_back(static_cast<Index>(used));
    }
  });
  return chunks;
}

/// C = R (A P); where C has a pattern only its values are made.
template <class T, int B, int K>
void galerkin(const RowsView<double, B, B>& A, const BlockRows<T, B, K>& P, const BlockRows<T, K, B>& R,
              BlockRows<double, K, K>& C) {
  constexpr std::size_t block = std::size_t{K} * K;
  constexpr std::ptrdiff_t coarse_chunk = 4096;
  const auto AP = product(A, P);
  const bool fresh = C.start.empty();
  std::vector<ProductRows<K, K>> rows(fresh ? at((P.cols + coarse_chunk - 1) / coarse_chunk) : 0);
  parallel_chunks(P.cols, coarse_chunk, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    std::vector<Index> place(at(P.cols), -1);
    ProductRows<K, K> local;
    if (fresh) local.start.push_back(0);
    std::size_t used = 0;
    for (auto i = static_cast<Index>(begin); i < end; ++i) {
      auto first = static_cast<Index>(used);
      if (!fresh) {
        first = C.start[at(i)];
        for (Index k = first; k < C.start[at(i) + 1]; ++k) place[at(C.column[at(k)])] = k;
        std::fill_n(C.block(first), block * at(C.start[at(i) + 1] - first), 0.0);
      }
      for (Index r = R.start[at(i)]; r < R.start[at(i) + 1]; ++r) {
        const Index j = R.column[at(r)];
        const auto& source = AP[at(j) / product_chunk];
        const std::size_t row = at(j) % product_chunk;
        const Index source_begin = source.start[row], source_end = source.start[row + 1];
        if (fresh) local.reserve(used, at(source_end - source_begin));
        double* value = fresh ? local.value.data() : C.value.data();
        for (Index k = source_begin; k < source_end; ++k) {
          Index& p = place[at(source.column[at(k)])];
          if (fresh && p < first) {
            p = static_cast<Index>(used++);
            local.column[at(p)] = source.column[at(k)];
            std::fill_n(value + block * at(p), block, 0.0);
          }
          add_product<K, B, K>(R.block(r), source.value.data() + std::size_t{B} * K * at(k),
                               value + block * at(p));
        }
      }
      if (fresh) local.start.push_back(static_cast<Index>(used));
    }
    if (fresh) rows[static_cast<std::size_t>(begin / coarse_chunk)] = std::move(local);
  });
  if (!fresh) return;
  C.rows = C.cols = P.cols;
  C.start.assign(1, 0);
  C.start.reserve(at(P.cols) + 1);
  std::size_t total = 0;
  for (const auto& part : rows) total += at(part.start.back());
  C.column.reserve(total);
  C.value.reserve(block * total);
  for (auto& part : rows) {
    const Index offset = C.start.back(), used = part.start.back();
    for (std::size_t r = 1; r < part.start.size(); ++r) C.start.push_back(offset + part.start[r]);
    C.column.insert(C.column.end(), part.column.begin(), part.column.begin() + used);
    C.value.insert(C.value.end(), part.value.begin(),
                   part.value.begin() + static_cast<std::ptrdiff_t>(block) * used);
    part = {};
  }
}

}  // namespace tunica::la::detail
