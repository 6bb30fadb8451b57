// SPDX-License-Identifier: MIT
// A level of the multigrid: its matrix as a smoother, the way to the next level, and room for a cycle.
#pragma once

#include "tunica/la/dense_factors.hpp"
#include "tunica/la/galerkin.hpp"
#include "tunica/la/gauss_seidel.hpp"
#include "tunica/la/prolongator.hpp"

#include <cstdint>
#include <vector>

namespace tunica::la::detail {

/// Largest |eigenvalue| of D^-1 A, from below, by the power method from a fixed start; D: diagonal blocks.
template <int B>
[[nodiscard]] double spectral_radius(const RowsView<double, B, B>& A) {
  constexpr int iterations = 12;
  const auto n = static_cast<std::ptrdiff_t>(A.rows) * B;
  Eigen::VectorXd x(n), y(n), inverse(n * B);
  std::uint64_t state = 1;  // Knuth's generator: any start does that no symmetry of a mesh shares
  for (double& v : x) {
    state = state * 6364136223846793005u + 1442695040888963407u;
    v = static_cast<double>(state >> 11) * 0x1p-53 - 0.5;
  }
  parallel_chunks(A.rows, row_chunk, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (auto i = static_cast<Index>(begin); i < end; ++i)
      for (Index k = A.start[i]; k < A.start[i + 1]; ++k)
        if (A.column[k] == i) invert<B>(A.block(k), inverse.data() + std::ptrdiff_t{B} * B * i);
  });
  double radius = 0;
  for (int m = 0; m < iterations; ++m) {
    x /= norm(x);
    parallel_chunks(A.rows, row_chunk, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      for (auto i = static_cast<Index>(begin); i < end; ++i) {
        std::array<double, B> sum{}, scaled{};
        for (Index k = A.start[i]; k < A.start[i + 1]; ++k)
          add_product<B, B, 1>(A.block(k), x.data() + std::ptrdiff_t{B} * A.column[k], sum.data());
        add_product<B, B, 1>(inverse.data() + std::ptrdiff_t{B} * B * i, sum.data(), scaled.data());
        std::copy_n(scaled.data(), B, y.data() + std::ptrdiff_t{B} * i);
      }
    });
    radius = norm(y);
    x.swap(y);
  }
  return radius;
}

/// B unknowns a node, K modes an aggregate.
template <class T, int B, int K>
struct MultigridLevel {
  std::vector<std::uint8_t> strong;
  Aggregates aggregates;
  std::vector<double> tentative;
  BlockRows<T, B, K> P;
  BlockRows<T, K, B> R;
  GaussSeidel<T, B> smoother;
  mutable std::vector<T> b, x, residual, second_b, second_x, old;

  /// Aggregates and prolongation; modes: those of the nodes, on return those of the aggregates. False
  /// where the level cannot be made a good deal coarser.
  bool coarsen(const RowsView<double, B, B>& A, double threshold, std::vector<double>& modes) {
    strong = strong_couplings<B>(A, threshold);
    aggregates = aggregate<B>(A, strong);
    if (aggregates.count == 0 || aggregates.count > 0.7 * A.rows) return false;
    std::vector<double> coarse_modes;
    orthonormalise<B, K>(aggregates, modes, tentative, coarse_modes);
    modes = std::move(coarse_modes);
    P = {};
    set_transfer(A);
    return true;
  }

  void set_transfer(const RowsView<double, B, B>& A) {
    double omega = 4.0 / 3;
    if constexpr (B > 1) omega /= 1.05 * spectral_radius<B>(A);  // the power method errs to the low side
    smooth_prolongation<T, B, K>(A, strong, aggregates, tentative, omega, P);
    transpose<T, B, K>(P, R);
  }

  void set_smoother(const RowsView<double, B, B>& A, double scale) {
    smoother.set_up(A, scale);
    for (auto* v : {&b, &x, &residual, &second_b, &second_x, &old}) v->assign(at(A.rows) * B, T{0});
  }

  /// coarse_b = R residual.
  void restrict_to(std::vector<T>& coarse_b) const { apply_rows(R, residual.data(), coarse_b.data(), false); }
  /// x += P coarse_x.
  void prolong(const std::vector<T>& coarse_x, T* to) const { apply_rows(P, coarse_x.data(), to, true); }

  [[nodiscard]] std::size_t bytes() const {
    return strong.size() + aggregates.of.size() * sizeof(Index) + tentative.size() * sizeof(double) +
           P.bytes() + R.bytes() + smoother.bytes() + 6 * x.size() * sizeof(T);
  }

 private:
  template <int M, int N>
  static void apply_rows(const BlockRows<T, M, N>& rows, const T* in, T* out, bool add) {
    parallel_chunks(rows.rows, row_chunk, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      for (auto i = static_cast<Index>(begin); i < end; ++i) {
        std::array<T, M> sum{};
        for (Index k = rows.start[at(i)]; k < rows.start[at(i) + 1]; ++k)
          add_product<M, N, 1>(rows.block(k), in + std::size_t{N} * at(rows.column[at(k)]), sum.data());
        for (std::size_t c = 0; c < M; ++c) {
          T& to = out[M * at(i) + c];
          to = add ? to + sum[c] : sum[c];
        }
      }
    });
  }
};

}  // namespace tunica::la::detail
