// SPDX-License-Identifier: MIT
// Right preconditioned BiCGStab for operators without symmetry. [VORST92]
#pragma once

#include "tunica/la/krylov.hpp"

#include <cmath>

namespace tunica::la {

/// Solves A x = b from the start x (n). Breakdowns restart from the true residual.
template <LinearOperator Operator, Preconditioner Precond>
SolveReport bicgstab(const Operator& A, const Precond& M, const Eigen::VectorXd& b, Eigen::VectorXd& x,
                     const KrylovOptions& options = {}) {
  SolveReport report;
  detail::Watch watch(norm(b), options);
  Eigen::VectorXd r, shadow, p, v, s, t, y, z;
  A.apply(x, v);
  r = b - v;
  double residual = norm(r);
  int claims = 0;
  for (int k = 0;;) {
    if (watch.done(residual, k, report)) return report;
    shadow = r;
    p = r;
    double rho = dot(shadow, r);
    while (true) {
      M.apply(p, y);
      A.apply(y, v);
      const double sv = dot(shadow, v);
      const double alpha = rho / sv;
      if (!std::isfinite(alpha)) break;
      s = r - alpha * v;
      M.apply(s, z);
      A.apply(z, t);
      const double tt = dot(t, t);
      const double omega = tt > 0 ? dot(t, s) / tt : 0.0;
      x += alpha * y + omega * z;
      r = s - omega * t;
      ++k;
      residual = norm(r);
      if (residual <= watch.goal() || !std::isfinite(residual)) break;
      if (watch.done(residual, k, report)) return report;
      const double next = dot(shadow, r);
      const double beta = next / rho * (alpha / omega);
      // A shadow residual that r has become orthogonal to carries no information: restart.
      if (!std::isfinite(beta) || std::abs(next) < 1e-14 * norm(shadow) * residual) break;
      p = r + beta * (p - omega * v);
      rho = next;
    }
    A.apply(x, v);
    r = b - v;
    residual = norm(r);
    if (++claims > 20 && residual > watch.goal() && std::isfinite(residual)) {
      report.iterations = k;
      report.residual = residual / norm(b);
      report.status = Status::stalled;
      return report;
    }
  }
}

}  // namespace tunica::la
