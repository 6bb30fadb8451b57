// SPDX-License-Identifier: MIT
// SAYS: a solver says whether it takes A for symmetric
#include "tunica/la/newton.hpp"

using namespace tunica;

/// A solver that does not say whether it takes the matrix for symmetric.
struct Mine {
#ifdef RIGHT
  static constexpr bool symmetric = true;
#endif
  void analyse(const la::SparseMatrix&) {}
  SolveReport factorise(const la::SparseMatrix&) {
    return {};
  }
  SolveReport solve(const Eigen::VectorXd&, Eigen::VectorXd&) {
    return {};
  }
};

la::Newton<Mine> newton;
