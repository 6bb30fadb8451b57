// SPDX-License-Identifier: MIT
// SAYS: an operator applies itself to x: y = A x
#include "tunica/la/cg.hpp"

using namespace tunica;

/// Twice a vector, returned where it should be written.
struct Twice {
#ifdef RIGHT
  void apply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const {
    y = 2 * x;
  }
#else
  Eigen::VectorXd apply(const Eigen::VectorXd& x) const {
    return 2 * x;
  }
#endif
};

SolveReport solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) {
  return la::cg(Twice{}, Twice{}, b, x);
}
