// SPDX-License-Identifier: MIT
// Prescribed unknowns, and their elimination from a linear system that keeps its symmetry.
#pragma once

#include "tunica/core/expect.hpp"
#include "tunica/core/types.hpp"

#include <Eigen/SparseCore>

#include <cstddef>
#include <vector>

namespace tunica::fem {

class Dirichlet {
 public:
  explicit Dirichlet(Index unknowns = 0)
      : fixed_(static_cast<std::size_t>(unknowns), 0), value_(Eigen::VectorXd::Zero(unknowns)) {}

  /// Prescribes an unknown, or gives a prescribed one a new value.
  void fix(Index unknown, double value = 0) {
    fixed_[static_cast<std::size_t>(unknown)] = 1;
    value_[unknown] = value;
  }
  [[nodiscard]] bool fixed(Index unknown) const { return fixed_[static_cast<std::size_t>(unknown)] != 0; }
  [[nodiscard]] double value(Index unknown) const { return value_[unknown]; }

  /// Turns A x = b into the system with x = value at the prescribed unknowns: their rows and columns
  /// become those of the identity times `diagonal`, so a symmetric (definite) A stays so.
  /// A (unknowns^2) has a symmetric pattern; for free rows b -= A value.
  template <class Matrix>
  void eliminate(Matrix& A, Eigen::VectorXd& b, double diagonal = 1) const {
    TUNICA_EXPECT(static_cast<std::size_t>(A.rows()) == fixed_.size(), "one flag an unknown");
    for (int outer = 0; outer < A.outerSize(); ++outer)
      for (typename Matrix::InnerIterator it(A, outer); it; ++it) {
        const Index i = static_cast<Index>(it.row()), j = static_cast<Index>(it.col());
        if (!fixed(i) && !fixed(j)) continue;
        if (!fixed(i)) b[i] -= it.value() * value_[j];
        it.valueRef() = i == j ? diagonal : 0.0;
      }
    for (Index i = 0; i < static_cast<Index>(fixed_.size()); ++i)
      if (fixed(i)) b[i] = diagonal * value_[i];
  }

  /// x = value at the prescribed unknowns.
  void impose(Eigen::VectorXd& x) const {
    for (Index i = 0; i < static_cast<Index>(fixed_.size()); ++i)
      if (fixed(i)) x[i] = value_[i];
  }

  /// r = 0 at the prescribed unknowns.
  void clear(Eigen::VectorXd& r) const {
    for (Index i = 0; i < static_cast<Index>(fixed_.size()); ++i)
      if (fixed(i)) r[i] = 0;
  }

 private:
  std::vector<char> fixed_;
  Eigen::VectorXd value_;
};

}  // namespace tunica::fem
