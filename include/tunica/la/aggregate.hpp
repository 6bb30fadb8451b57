// SPDX-License-Identifier: MIT
// Strong couplings of a matrix, and its nodes gathered in aggregates around roots. [VANEK96]
#pragma once

#include "tunica/la/block_rows.hpp"

#include <cstdint>
#include <vector>

namespace tunica::la::detail {

struct Aggregates {
  static constexpr Index none = -1;  // of a node that is coupled strongly to no other
  Index count = 0;
  std::vector<Index> of;  // node -> aggregate
};

/// One flag an entry: |A_ij|^2 > threshold^2 |A_ii| |A_jj|, in Frobenius norms; the diagonal is not strong.
/// Of unknowns that are coupled to nothing (prescribed ones) it does not matter how large their diagonal is.
template <int B>
[[nodiscard]] std::vector<std::uint8_t> strong_couplings(const RowsView<double, B, B>& A, double threshold) {
  std::vector<double> diagonal(at(A.rows), 0.0);
  parallel_chunks(A.rows, row_chunk, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (auto i = static_cast<Index>(begin); i < end; ++i)
      for (Index k = A.start[i]; k < A.start[i + 1]; ++k)
        if (A.column[k] == i) {
          double square = squared_size<B * B>(A.block(k));
          if constexpr (B > 1) {
            const auto coupled = coupled_unknowns(A, i);
            for (std::size_t c = 0; c < B; ++c)
              if (const double d = A.block(k)[c * (B + 1)]; !coupled[c]) square -= d * d;
          }
          diagonal[at(i)] = threshold * std::sqrt(std::max(square, 0.0));
        }
  });
  std::vector<std::uint8_t> strong(at(A.start[A.rows]));
  parallel_chunks(A.rows, row_chunk, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (auto i = static_cast<Index>(begin); i < end; ++i)
      for (Index k = A.start[i]; k < A.start[i + 1]; ++k) {
        const Index j = A.column[k];
        strong[at(k)] = static_cast<std::uint8_t>(
            (j != i) & (squared_size<B * B>(A.block(k)) > diagonal[at(i)] * diagonal[at(j)]));
      }
  });
  return strong;
}

/// Roots with all their strong neighbours first, in the order of the nodes; then what is left joins the
/// aggregate that it is coupled to most strongly, or the unassigned around it.
template <int B>
[[nodiscard]] Aggregates aggregate(const RowsView<double, B, B>& A, const std::vector<std::uint8_t>& strong) {
  constexpr Index unassigned = -2;
  Aggregates aggregates;
  auto& of = aggregates.of;
  of.assign(at(A.rows), unassigned);
  for (Index i = 0; i < A.rows; ++i) {
    if (of[at(i)] != unassigned) continue;
    bool alone = true, free = true;
    for (Index k = A.start[i]; k < A.start[i + 1] && free; ++k)
      if (strong[at(k)]) alone = false, free = of[at(A.column[k])] == unassigned;
    if (alone) of[at(i)] = Aggregates::none;
    if (alone || !free) continue;
    of[at(i)] = aggregates.count;
    for (Index k = A.start[i]; k < A.start[i + 1]; ++k)
      if (strong[at(k)]) of[at(A.column[k])] = aggregates.count;
    ++aggregates.count;
  }
  std::vector<Index> joined;  // pairs: only the aggregates of roots are joined
  for (Index i = 0; i < A.rows; ++i) {
    if (of[at(i)] != unassigned) continue;
    double most = 0;
    Index best = unassigned;
    for (Index k = A.start[i]; k < A.start[i + 1]; ++k)
      if (strong[at(k)] && of[at(A.column[k])] >= 0)
        if (const double size = squared_size<B * B>(A.block(k)); size > most)
          most = size, best = of[at(A.column[k])];
    if (best >= 0) joined.push_back(i), joined.push_back(best);
  }
  for (std::size_t m = 0; m < joined.size(); m += 2) of[at(joined[m])] = joined[m + 1];
  for (Index i = 0; i < A.rows; ++i) {
    if (of[at(i)] != unassigned) continue;
    of[at(i)] = aggregates.count;
    for (Index k = A.start[i]; k < A.start[i + 1]; ++k)
      if (strong[at(k)] && of[at(A.column[k])] == unassigned) of[at(A.column[k])] = aggregates.count;
    ++aggregates.count;
  }
  return aggregates;
}

}  // namespace tunica::la::detail
