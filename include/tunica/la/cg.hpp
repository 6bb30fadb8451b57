// SPDX-License-Identifier: MIT
// Preconditioned conjugate gradients for symmetric positive (semi)definite operators. [SAAD03, alg. 9.1]
#pragma once

#include "tunica/la/krylov.hpp"

#include <cmath>
#include <cstddef>

namespace tunica::la {

namespace detail {

/// x += alpha p, r -= alpha q; r . r, each chunk while it is at hand.
inline double advance(double alpha, const Eigen::VectorXd& p, const Eigen::VectorXd& q, Eigen::VectorXd& x,
                      Eigen::VectorXd& r) {
  return parallel_sum(x.size(), vector_chunk, [&](std::ptrdiff_t b, std::ptrdiff_t e) {
    x.segment(b, e - b) += alpha * p.segment(b, e - b);
    r.segment(b, e - b) -= alpha * q.segment(b, e - b);
    return r.segment(b, e - b).squaredNorm();
  });
}

/// p = z + beta p.
inline void turn(double beta, const Eigen::VectorXd& z, Eigen::VectorXd& p) {
  parallel_chunks(p.size(), vector_chunk, [&](std::ptrdiff_t b, std::ptrdiff_t e) {
    p.segment(b, e - b) = z.segment(b, e - b) + beta * p.segment(b, e - b);
  });
}

}  // namespace detail

/// Solves A x = b from the start x (n); A, M symmetric, M definite. The residual is the true one:
/// when the recurrence claims convergence b - A x is evaluated, and the iteration restarts from it
/// when the claim was wrong. A semidefinite A needs a b in its range.
template <LinearOperator Operator, Preconditioner Precond>
SolveReport cg(const Operator& A, const Precond& M, const Eigen::VectorXd& b, Eigen::VectorXd& x,
               const KrylovOptions& options = {}) {
  SolveReport report;
  detail::Watch watch(norm(b), options);
  Eigen::VectorXd r, z, p, q;
  A.apply(x, q);
  r = b - q;
  double residual = norm(r);
  double gained = 0, marked = 0;  // energy: it falls all the time where a residual may well rise for long
  int claims = 0;
  for (int k = 0;;) {
    if (watch.done(residual, k, report)) return report;
    M.apply(r, z);
    p = z;
    double rz = dot(r, z);
    while (true) {
      A.apply(p, q);
      const double pq = dot(p, q);
      if (!(pq > 0) || !(rz > 0)) {  // not definite, or NaN: no descent from here
        report.iterations = k;
        report.status =
            std::isfinite(pq) && std::isfinite(rz) && pq == 0 ? Status::stalled : Status::diverged;
        return report;
      }
      const double alpha = rz / pq;
      ++k;
      gained += alpha * rz;
      if (gained > 1.01 * marked) marked = gained, watch.advances(k);
      residual = std::sqrt(detail::advance(alpha, p, q, x, r));
      if (residual <= watch.goal() || !std::isfinite(residual)) break;
      if (watch.done(residual, k, report)) return report;
      M.apply(r, z);
      const double next = dot(r, z);
      detail::turn(next / rz, z, p);
      rz = next;
    }
    A.apply(x, q);
    r = b - q;
    residual = norm(r);
    if (++claims > 3 && residual > watch.goal() && std::isfinite(residual)) {  // round-off floor
      report.iterations = k;
      report.residual = residual / norm(b);
      report.status = Status::stalled;
      return report;
    }
  }
}

}  // namespace tunica::la
