// SPDX-License-Identifier: MIT
// SAYS: a residual with its scale
#include "tunica/la/direct.hpp"
#include "tunica/la/newton.hpp"

using namespace tunica;

/// A problem whose residual comes without its scale.
struct Mine {
#ifdef RIGHT
  la::ResidualInfo residual(const Eigen::VectorXd& x, Eigen::VectorXd& r, double) {
    r = x;
    return {.scale = 1, .merit = x.norm()};
  }
#else
  void residual(const Eigen::VectorXd& x, Eigen::VectorXd& r, double) {
    r = x;
  }
#endif
  void direction(const Eigen::VectorXd&) {}
  void tangent(const Eigen::VectorXd&, la::SparseMatrix& A) {
    A.setIdentity();
  }
  la::SparseMatrix pattern() {
    return la::SparseMatrix(1, 1);
  }
};

void solve(la::Newton<la::Ldlt>& newton, Mine& problem, Eigen::VectorXd& x) {
  static_cast<void>(newton.solve(problem, x));
}
