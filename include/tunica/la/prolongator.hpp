// SPDX-License-Identifier: MIT
// Prolongation: the near-null space cut into aggregates and made orthonormal, then smoothed. [VANEK96,
// (8)-(11)]
#pragma once

#include "tunica/la/aggregate.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace tunica::la::detail {

/// Modes of the nodes, B x K blocks: on return those of the aggregates (K x K each, upper triangular),
/// and `tentative` holds the orthonormal ones; a mode that an aggregate cannot tell from those before
/// it is zero there.
template <int B, int K>
void orthonormalise(const Aggregates& aggregates, const std::vector<double>& modes,
                    std::vector<double>& tentative, std::vector<double>& coarse_modes) {
  constexpr double least = 1e-8;  // of a mode's size, that orthogonalisation must leave
  constexpr std::size_t block = std::size_t{B} * K;
  const auto n = static_cast<Index>(aggregates.of.size());
  std::vector<Index> first(at(aggregates.count) + 1, 0), member(at(n));
  for (const Index a : aggregates.of)
    if (a >= 0) ++first[at(a) + 1];
  for (std::size_t a = 1; a < first.size(); ++a) first[a] += first[a - 1];
  std::vector<Index> next(first.begin(), first.end() - 1);
  for (Index i = 0; i < n; ++i)
    if (const Index a = aggregates.of[at(i)]; a >= 0) member[at(next[at(a)]++)] = i;

  tentative = modes;
  coarse_modes.assign(at(aggregates.count) * K * K, 0.0);
  parallel_chunks(aggregates.count, 512, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (auto a = static_cast<Index>(begin); a < end; ++a) {
      double* R = coarse_modes.data() + at(a) * K * K;
      const auto product = [&](std::size_t c, std::size_t d) {
        double sum = 0;
        for (Index m = first[at(a)]; m < first[at(a) + 1]; ++m) {
          const double* q = tentative.data() + block * at(member[at(m)]);
          for (std::size_t r = 0; r < B; ++r) sum += q[r * K + c] * q[r * K + d];
        }
        return sum;
      };
      for (std::size_t c = 0; c < K; ++c) {
        const double size = std::sqrt(product(c, c));
        for (int pass = 0; pass < 2; ++pass)  // twice: orthogonal to the last bit
          for (std::size_t d = 0; d < c; ++d) {
            const double s = product(c, d);
            R[d * K + c] += s;
            for (Index m = first[at(a)]; m < first[at(a) + 1]; ++m) {
              double* q = tentative.data() + block * at(member[at(m)]);
              for (std::size_t r = 0; r < B; ++r) q[r * K + c] -= s * q[r * K + d];
            }
          }
        const double left = std::sqrt(product(c, c));
        const bool usable = left > least * size;
        R[c * K + c] = usable ? left : 0.0;
        const double scale = usable ? 1 / left : 0.0;
        for (Index m = first[at(a)]; m < first[at(a) + 1]; ++m) {
          double* q = tentative.data() + block * at(member[at(m)]);
          for (std::size_t r = 0; r < B; ++r) q[r * K + c] *= scale;
        }
      }
    }
  });
}

/// What a row of P = (I - omega D^-1 A_F) T takes from the matrix: for scalars A_F is A without its weak
/// couplings, which are added to the diagonal, and omega = 4/3 over the sum of |D^-1 A_F| in that row
/// (2/3 for an M-matrix), so that no row is overshot. Blocks take all of A, so that A keeps every mode.
template <int B>
struct RowSmoothing {
  std::array<double, std::size_t{B} * B> inverse{};  // omega D^-1
  double keep = 0;                                   // of T itself

  RowSmoothing(const RowsView<double, B, B>& A, const std::vector<std::uint8_t>& strong, Index i,
               double omega) {
    std::array<double, std::size_t{B} * B> diagonal{};
    double around = 0;
    for (Index k = A.start[i]; k < A.start[i + 1]; ++k)
      if constexpr (B == 1) {
        if (strong[at(k)])
          around += std::abs(A.value[k]);
        else
          diagonal[0] += A.value[k];
      } else if (A.column[k] == i) {
        std::copy_n(A.block(k), B * B, diagonal.data());
      }
    keep = 1;
    if constexpr (B == 1) {
      if (!(diagonal[0] > 0)) return;
      const double damping = omega / (1 + around / diagonal[0]);
      inverse[0] = damping / diagonal[0];
      keep = 1 - damping;
    } else {
      invert<B>(diagonal.data(), inverse.data());
      for (double& v : inverse) v *= omega;
      keep = 1 - omega;
    }
  }
};

/// Fills the values of P on its pattern, or the pattern too where P has none.
template <class T, int B, int K>
void smooth_prolongation(const RowsView<double, B, B>& A, const std::vector<std::uint8_t>& strong,
                         const Aggregates& aggregates, const std::vector<double>& tentative, double omega,
                         BlockRows<T, B, K>& P) {
  constexpr std::size_t block = std::size_t{B} * K;
  const auto taken = [&](Index i, Index k) {
    return (B > 1 || A.column[k] == i || strong[at(k)]) && aggregates.of[at(A.column[k])] >= 0;
  };
  if (P.start.empty()) {
    P.rows = A.rows, P.cols = aggregates.count;
    P.start.reserve(at(A.rows) + 1);
    P.start.assign(1, 0);
    P.column.reserve(at(A.rows) * 4);
    for (Index i = 0; i < A.rows; ++i) {
      const std::size_t begin = P.column.size();
      const auto add = [&](Index a) {
        for (std::size_t m = begin; m < P.column.size(); ++m)
          if (P.column[m] == a) return;
        P.column.push_back(a);
      };
      if (aggregates.of[at(i)] >= 0)
        for (Index k = A.start[i]; k < A.start[i + 1]; ++k)
          if (taken(i, k)) add(aggregates.of[at(A.column[k])]);
      P.start.push_back(static_cast<Index>(P.column.size()));
    }
    P.value.resize(block * P.column.size());
  }
  parallel_chunks(A.rows, row_chunk, [&](std::ptrdiff_t chunk_begin, std::ptrdiff_t chunk_end) {
    std::vector<double> row;
    for (auto i = static_cast<Index>(chunk_begin); i < chunk_end; ++i) {
      const Index begin = P.start[at(i)], end = P.start[at(i) + 1];
      if (begin == end) continue;
      row.assign(at(end - begin) * block, 0.0);
      const RowSmoothing<B> smoothing(A, strong, i, omega);
      const auto column = [&](Index a) {
        Index m = begin;
        while (P.column[at(m)] != a) ++m;
        return row.data() + block * at(m - begin);
      };
      for (Index k = A.start[i]; k < A.start[i + 1]; ++k) {
        const Index j = A.column[k];
        if (!taken(i, k)) continue;
        double* to = column(aggregates.of[at(j)]);
        const double* t = tentative.data() + block * at(j);
        if (j == i)
          for (std::size_t c = 0; c < block; ++c) to[c] += smoothing.keep * t[c];
        else {
          std::array<double, block> product{}, scaled{};
          add_product<B, B, K>(A.block(k), t, product.data());
          add_product<B, B, K>(smoothing.inverse.data(), product.data(), scaled.data());
          for (std::size_t c = 0; c < block; ++c) to[c] -= scaled[c];
        }
      }
      for (std::size_t c = 0; c < row.size(); ++c) P.value[block * at(begin) + c] = static_cast<T>(row[c]);
    }
  });
}

/// R = P^T; the pattern too where R has none.
template <class T, int B, int K>
void transpose(const BlockRows<T, B, K>& P, BlockRows<T, K, B>& R) {
  R.rows = P.cols, R.cols = P.rows;
  R.start.assign(at(P.cols) + 1, 0);
  for (const Index a : P.column) ++R.start[at(a) + 1];
  for (std::size_t a = 1; a < R.start.size(); ++a) R.start[a] += R.start[a - 1];
  R.column.resize(P.column.size());
  R.value.resize(P.value.size());
  std::vector<Index> next(R.start.begin(), R.start.end() - 1);
  for (Index i = 0; i < P.rows; ++i)
    for (Index k = P.start[at(i)]; k < P.start[at(i) + 1]; ++k) {
      const Index m = next[at(P.column[at(k)])]++;
      R.column[at(m)] = i;
      for (int r = 0; r < B; ++r)
        for (int c = 0; c < K; ++c) R.block(m)[c * B + r] = P.block(k)[r * K + c];
    }
}

}  // namespace tunica::la::detail
