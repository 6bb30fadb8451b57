// SPDX-License-Identifier: MIT
// Preconditioners on the pattern of the matrix: Jacobi, incomplete Cholesky and LU without fill. [SAAD03, 10]
#pragma once

#include "tunica/core/expect.hpp"
#include "tunica/la/vector_ops.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace tunica::la {

struct Identity {
  void apply(const Eigen::VectorXd& r, Eigen::VectorXd& z) const { z = r; }
};

/// z = r / diag(A); Components interleaved vectors share one matrix.
template <int Components = 1>
class Jacobi {
 public:
  void compute(const RowMatrix& A) { inverse_ = A.diagonal().cwiseInverse(); }
  void apply(const Eigen::VectorXd& r, Eigen::VectorXd& z) const {
    z.resize(r.size());
    z.reshaped(Components, inverse_.size()) =
        r.reshaped(Components, inverse_.size()).array().rowwise() * inverse_.transpose().array();
  }

 private:
  Eigen::VectorXd inverse_;
};

/// A ~ L U on the pattern of A (compressed, rows ascending, with its diagonal). The diagonal of U is
/// kept inverted. Where a pivot is not safely away from zero all diagonals are raised by a part of the
/// largest entry of their row, doubled until no pivot breaks down. A row of zeros is left alone.
template <int Components = 1>
class Ilu0 {
 public:
  void compute(const RowMatrix& A) {
    outer_.assign(A.outerIndexPtr(), A.outerIndexPtr() + A.rows() + 1);
    inner_.assign(A.innerIndexPtr(), A.innerIndexPtr() + A.nonZeros());
    diagonal_.resize(static_cast<std::size_t>(A.rows()));
    for (shift_ = 0; !factorise(A); shift_ = shift_ == 0 ? 1e-3 : 2 * shift_)
      if (!(shift_ < 1e3)) {  // NaN in A: leave factors that hand the NaN on
        std::fill(value_.begin(), value_.end(), std::numeric_limits<double>::quiet_NaN());
        return;
      }
  }

  /// Raise of the diagonals that was needed, relative to the largest entries of their rows; mostly 0.
  [[nodiscard]] double shift() const { return shift_; }

  void apply(const Eigen::VectorXd& r, Eigen::VectorXd& z) const {
    constexpr auto C = static_cast<std::size_t>(Components);
    z = r;
    double* x = z.data();
    const std::size_t n = diagonal_.size();
    const auto subtract = [&](std::size_t i, std::size_t begin, std::size_t end) {
      for (std::size_t c = 0; c < C; ++c) {
        double sum = x[C * i + c];
        for (std::size_t k = begin; k < end; ++k)
          sum -= value_[k] * x[C * static_cast<std::size_t>(inner_[k]) + c];
        x[C * i + c] = sum;
      }
    };
    for (std::size_t i = 0; i < n; ++i) subtract(i, static_cast<std::size_t>(outer_[i]), diagonal_[i]);
    for (std::size_t i = n; i-- > 0;) {
      subtract(i, diagonal_[i] + 1, static_cast<std::size_t>(outer_[i + 1]));
      for (std::size_t c = 0; c < C; ++c) x[C * i + c] *= value_[diagonal_[i]];
    }
  }

 private:
  bool factorise(const RowMatrix& A) {
    const std::size_t n = diagonal_.size();
    value_.assign(A.valuePtr(), A.valuePtr() + A.nonZeros());
    std::vector<int> place(n, -1);
    for (std::size_t i = 0; i < n; ++i) {
      const auto begin = static_cast<std::size_t>(outer_[i]), end = static_cast<std::size_t>(outer_[i + 1]);
      double largest = 0;
      for (std::size_t k = begin; k < end; ++k) {
        place[static_cast<std::size_t>(inner_[k])] = static_cast<int>(k);
        largest = std::max(largest, std::abs(value_[k]));
      }
      TUNICA_EXPECT(place[i] >= static_cast<int>(begin),
                    "incomplete factors need every diagonal in the pattern");
      const auto own = static_cast<std::size_t>(place[i]);
      const double original = value_[own];
      value_[own] += std::copysign(shift_ * largest, original);
      std::size_t k = begin;
      for (; static_cast<std::size_t>(inner_[k]) < i; ++k) {
        const auto j = static_cast<std::size_t>(inner_[k]);
        const double l = value_[k] *= value_[diagonal_[j]];
        for (auto m = diagonal_[j] + 1; m < static_cast<std::size_t>(outer_[j + 1]); ++m) {
          const int p = place[static_cast<std::size_t>(inner_[m])];
          if (p >= 0) value_[static_cast<std::size_t>(p)] -= l * value_[m];
        }
      }
      diagonal_[i] = k;
      if (largest == 0) value_[k] = 1;
      if (!(std::abs(value_[k]) > 1e-3 * std::abs(original)) || !std::isfinite(value_[k])) return false;
      value_[k] = 1 / value_[k];
      for (k = begin; k < end; ++k) place[static_cast<std::size_t>(inner_[k])] = -1;
    }
    return true;
  }

  std::vector<int> outer_, inner_;
  std::vector<double> value_;
  std::vector<std::size_t> diagonal_;
  double shift_ = 0;
};

/// A ~ L L^T on the pattern of a symmetric positive definite A. Where that pattern admits no such
/// factors the diagonal is raised, by a factor that is doubled until it does (Manteuffel's shift).
class IncompleteCholesky {
 public:
  void compute(const RowMatrix& A) {
    build_pattern(A);
    for (shift_ = 0; !factorise(A); shift_ = shift_ == 0 ? 1e-3 : 2 * shift_)
      if (!(shift_ < 1e3)) {  // NaN in A: leave factors that hand the NaN on
        std::fill(inverse_.begin(), inverse_.end(), std::numeric_limits<double>::quiet_NaN());
        return;
      }
  }

  /// Relative raise of the diagonal that was needed; 0 for an M-matrix.
  [[nodiscard]] double shift() const { return shift_; }

  void apply(const Eigen::VectorXd& r, Eigen::VectorXd& z) const {
    z = r;
    double* x = z.data();
    const std::size_t n = inverse_.size();
    for (std::size_t i = 0; i < n; ++i) {  // L y = r, by rows
      double sum = x[i];
      for (std::size_t k = start_[i]; k < start_[i + 1]; ++k) sum -= value_[k] * x[column_[k]];
      x[i] = sum * inverse_[i];
    }
    for (std::size_t i = n; i-- > 0;) {  // L^T x = y, by columns
      const double xi = x[i] *= inverse_[i];
      for (std::size_t k = start_[i]; k < start_[i + 1]; ++k) x[column_[k]] -= value_[k] * xi;
    }
  }

 private:
  void build_pattern(const RowMatrix& A) {
    const auto n = static_cast<std::size_t>(A.rows());
    start_.assign(1, 0);
    column_.clear();
    source_.clear();
    diagonal_.assign(n, 0);
    for (std::size_t i = 0; i < n; ++i) {
      [[maybe_unused]] bool found = false;
      for (int k = A.outerIndexPtr()[i]; k < A.outerIndexPtr()[i + 1]; ++k) {
        const auto j = static_cast<std::size_t>(A.innerIndexPtr()[k]);
        if (j < i) column_.push_back(j), source_.push_back(static_cast<std::size_t>(k));
        if (j == i) diagonal_[i] = static_cast<std::size_t>(k), found = true;
      }
      TUNICA_EXPECT(found, "incomplete factors need every diagonal in the pattern");
      start_.push_back(column_.size());
    }
    value_.resize(column_.size());
    inverse_.resize(n);
  }

  bool factorise(const RowMatrix& A) {
    const double* a = A.valuePtr();
    const std::size_t n = inverse_.size();
    std::vector<double> row(n, 0);
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t k = start_[i]; k < start_[i + 1]; ++k) row[column_[k]] = a[source_[k]];
      double pivot = a[diagonal_[i]] * (1 + shift_);
      for (std::size_t k = start_[i]; k < start_[i + 1]; ++k) {
        const std::size_t j = column_[k];
        double sum = row[j];
        for (std::size_t m = start_[j]; m < start_[j + 1]; ++m) sum -= value_[m] * row[column_[m]];
        row[j] = value_[k] = sum * inverse_[j];
        pivot -= value_[k] * value_[k];
      }
      for (std::size_t k = start_[i]; k < start_[i + 1]; ++k) row[column_[k]] = 0;
      if (pivot == 0 && a[diagonal_[i]] == 0) pivot = 1;  // a row of zeros is left alone
      if (!(pivot > 1e-3 * a[diagonal_[i]]) || !(pivot > 0)) return false;
      inverse_[i] = 1 / std::sqrt(pivot);
    }
    return true;
  }

  std::vector<std::size_t> start_, column_, source_, diagonal_;  // strictly lower rows of A
  std::vector<double> value_, inverse_;                          // of L; 1 / its diagonal
  double shift_ = 0;
};

}  // namespace tunica::la
