// SPDX-License-Identifier: MIT
// Restarted GMRES, preconditioned from the right, for operators without symmetry. [SAAD86]
#pragma once

#include "tunica/la/krylov.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace tunica::la {

namespace detail {

/// The least squares problem of the Hessenberg matrix, by rotations, a column at a time.
class Hessenberg {
 public:
  explicit Hessenberg(Eigen::Index size) : R_(size + 1, size), g_(size + 1), cosine_(size), sine_(size) {}

  void start(double residual) {
    g_.setZero();
    g_[0] = residual;
  }
  [[nodiscard]] double& operator()(Eigen::Index i, Eigen::Index j) { return R_(i, j); }
  /// Rotates column j, whose entries 0 .. j + 1 are set; the residual that is left.
  double rotate(Eigen::Index j) {
    for (Eigen::Index i = 0; i < j; ++i) {
      const double upper = R_(i, j);
      R_(i, j) = cosine_[i] * upper + sine_[i] * R_(i + 1, j);
      R_(i + 1, j) = -sine_[i] * upper + cosine_[i] * R_(i + 1, j);
    }
    const double length = std::hypot(R_(j, j), R_(j + 1, j));
    cosine_[j] = length > 0 ? R_(j, j) / length : 1.0;
    sine_[j] = length > 0 ? R_(j + 1, j) / length : 0.0;
    R_(j, j) = length;
    g_[j + 1] = -sine_[j] * g_[j];
    g_[j] *= cosine_[j];
    return std::abs(g_[j + 1]);
  }
  /// The coefficients of the first n vectors; those that a singular matrix leaves open are zero.
  [[nodiscard]] Eigen::VectorXd solve(Eigen::Index n) const {
    Eigen::VectorXd y(n);
    for (Eigen::Index i = n; i-- > 0;) {
      double sum = g_[i];
      for (Eigen::Index j = i + 1; j < n; ++j) sum -= R_(i, j) * y[j];
      y[i] = R_(i, i) != 0 ? sum / R_(i, i) : 0.0;
    }
    return y;
  }

 private:
  Eigen::MatrixXd R_;
  Eigen::VectorXd g_, cosine_, sine_;
};

}  // namespace detail

/// Solves A x = b from the start x (n). Keeps options.restart + 1 vectors; each start has the true residual.
/// Modified Gram-Schmidt, made twice where the first pass cancels more than nine tenths of a vector.
template <LinearOperator Operator, Preconditioner Precond>
SolveReport gmres(const Operator& A, const Precond& M, const Eigen::VectorXd& b, Eigen::VectorXd& x,
                  const KrylovOptions& options = {}) {
  constexpr double cancelled = 0.1;
  constexpr double invariant = 1e-14;  // what is left of a vector that lies in the space already
  SolveReport report;
  detail::Watch watch(norm(b), options);
  const Eigen::Index most =
      std::min<Eigen::Index>(std::max(options.restart, 1), std::max<Eigen::Index>(b.size(), 1));
  std::vector<Eigen::VectorXd> v(static_cast<std::size_t>(most) + 1);
  detail::Hessenberg H(most);
  Eigen::VectorXd r, w, z;
  int fruitless = 0;
  for (int k = 0;;) {
    A.apply(x, w);
    r = b - w;
    const double start = norm(r);
    if (watch.done(start, k, report)) return report;
    H.start(start);
    v[0] = r / start;
    Eigen::Index j = 0;
    double residual = start;
    for (bool more = true; more && j < most && k < options.max_iterations;) {
      M.apply(v[static_cast<std::size_t>(j)], z);
      A.apply(z, w);
      ++k;
      const double size = norm(w);
      for (Eigen::Index i = 0; i <= j; ++i) H(i, j) = 0;
      double left = size;
      for (int pass = 0; pass < 2 && (pass == 0 || left < cancelled * size); ++pass) {
        for (Eigen::Index i = 0; i <= j; ++i) {
          const auto& vi = v[static_cast<std::size_t>(i)];
          const double s = dot(w, vi);
          H(i, j) += s;
          w -= s * vi;
        }
        left = norm(w);
      }
      H(j + 1, j) = left > invariant * size ? left : 0.0;
      more = H(j + 1, j) != 0;
      residual = H.rotate(j);
      ++j;
      if (!std::isfinite(residual) || residual <= watch.goal()) break;
      if (more) v[static_cast<std::size_t>(j)] = w / left;
    }
    const Eigen::VectorXd y = H.solve(j);
    w.setZero(b.size());
    for (Eigen::Index i = 0; i < j; ++i) w += y[i] * v[static_cast<std::size_t>(i)];
    M.apply(w, z);
    x += z;
    // A cycle that finds nothing is repeated by every later one, to the bit.
    fruitless = residual > (1 - 1e-6) * start ? fruitless + 1 : 0;
    if (fruitless > 1) {
      report.iterations = k;
      report.status = Status::stalled;
      return report;
    }
  }
}

}  // namespace tunica::la
