// SPDX-License-Identifier: MIT
// Preconditioned MINRES for symmetric operators that may be indefinite, as saddle points and buckled
// tangents. [PAIGE75]
#pragma once

#include "tunica/la/krylov.hpp"

#include <cmath>

namespace tunica::la {

/// Solves A x = b from the start x (n); A symmetric, M symmetric positive definite. It minimises the residual
/// in the norm of M^-1; what is measured and reported is |b - A x|, carried along by a recurrence and
/// evaluated when that claims convergence.
template <LinearOperator Operator, Preconditioner Precond>
SolveReport minres(const Operator& A, const Precond& M, const Eigen::VectorXd& b, Eigen::VectorXd& x,
                   const KrylovOptions& options = {}) {
  SolveReport report;
  detail::Watch watch(norm(b), options);
  Eigen::VectorXd r, v, v_old, v_next, z, z_next, w, w_old, w_next;
  A.apply(x, v);
  r = b - v;
  double residual = norm(r);
  int claims = 0;
  const auto ended = [&](Status status, int k) {
    report.iterations = k;
    report.status = status;
    return report;
  };
  for (int k = 0;;) {
    if (watch.done(residual, k, report)) return report;
    v = r;
    M.apply(v, z);
    double gamma = dot(v, z);
    if (!(gamma > 0)) return ended(Status::diverged, k);  // M is not definite, or NaN
    gamma = std::sqrt(gamma);
    double gamma_old = 1, eta = gamma, s = 0, s_old = 0, c = 1, c_old = 1;
    v_old = w = w_old = Eigen::VectorXd::Zero(b.size());
    while (true) {
      z /= gamma;
      A.apply(z, v_next);
      const double delta = dot(v_next, z);
      v_next -= (delta / gamma) * v + (gamma / gamma_old) * v_old;
      M.apply(v_next, z_next);
      const double square = dot(v_next, z_next);
      // Rounding may leave a square below zero where the space is exhausted, no more than that.
      if (!(square > -1e-14 * gamma * gamma)) return ended(Status::diverged, k);
      const double gamma_next = square > 0 ? std::sqrt(square) : 0.0;
      const double a0 = c * delta - c_old * s * gamma, a1 = std::hypot(a0, gamma_next);
      const double a2 = s * delta + c_old * c * gamma, a3 = s_old * gamma;
      if (!(a1 > 0)) return ended(std::isfinite(a1) ? Status::stalled : Status::diverged, k);  // singular
      c_old = c;
      s_old = s;
      c = a0 / a1;
      s = gamma_next / a1;
      w_next = (z - a3 * w_old - a2 * w) / a1;
      x += (c * eta) * w_next;
      eta *= -s;
      if (gamma_next > 0)
        r = s * s * r + (eta * c / gamma_next) * v_next;
      else
        r.setZero();
      ++k;
      residual = norm(r);
      if (residual <= watch.goal() || !std::isfinite(residual)) break;
      if (watch.done(residual, k, report)) return report;
      w_old.swap(w);
      w.swap(w_next);
      v_old.swap(v);
      v.swap(v_next);
      z.swap(z_next);
      gamma_old = gamma;
      gamma = gamma_next;
    }
    A.apply(x, v);
    r = b - v;
    residual = norm(r);
    if (++claims > 3 && residual > watch.goal() && std::isfinite(residual)) {  // round-off floor
      report.residual = residual / norm(b);
      return ended(Status::stalled, k);
    }
  }
}

}  // namespace tunica::la
