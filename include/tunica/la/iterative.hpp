// SPDX-License-Identifier: MIT
// The Krylov solvers as models of LinearSolver: a preconditioner is set up when the values are read.
#pragma once

#include "tunica/la/bicgstab.hpp"
#include "tunica/la/block_convert.hpp"
#include "tunica/la/block_rows.hpp"
#include "tunica/la/cg.hpp"
#include "tunica/la/gmres.hpp"
#include "tunica/la/linear_solver.hpp"
#include "tunica/la/minres.hpp"
#include "tunica/la/preconditioner.hpp"

#include <algorithm>
#include <cmath>
#include <concepts>
#include <utility>

namespace tunica::la {

namespace detail {

enum class Krylov { cg, minres, bicgstab, gmres };

/// A preconditioner that can take new values on its old pattern.
template <class P>
concept Refreshable = requires(P p, const RowMatrix& A) {
  { p.refresh(A) } -> std::same_as<SolveReport>;
};

/// A preconditioner that reads matrices of blocks as they are.
template <class P>
concept ReadsBlocks = requires(P p, const BlockMatrix<P::block_rows>& A) {
  { p.compute(A) } -> std::same_as<SolveReport>;
  { p.refresh(A) } -> std::same_as<SolveReport>;
};
template <class P>
struct BlocksOf {
  struct None {};
  using type = None;
};
template <ReadsBlocks P>
struct BlocksOf<P> {
  using type = BlockMatrix<P::block_rows>;
};

template <Krylov Method, class Precond>
class Iterative {
 public:
  static constexpr bool symmetric = Method == Krylov::cg || Method == Krylov::minres;
  static constexpr int block_rows = [] {
    if constexpr (ReadsBlocks<Precond>) return Precond::block_rows;
    return 1;
  }();

  Iterative() = default;
  explicit Iterative(KrylovOptions options, Precond preconditioner = Precond())
      : options_(options), preconditioner_(std::move(preconditioner)) {}

  /// A preconditioner that lasts as long as the pattern is made anew by the next factorise().
  void analyse(const SparseMatrix&) { fresh_ = true; }

  /// `diverged` for a matrix with a NaN.
  SolveReport factorise(const SparseMatrix& A) {
    TUNICA_EXPECT(A.isCompressed(), "a solver reads compressed matrices");
    in_blocks_ = false;
    if constexpr (symmetric)  // its columns are its rows
      A_ = Eigen::Map<const RowMatrix>(A.rows(), A.cols(), A.nonZeros(), A.outerIndexPtr(), A.innerIndexPtr(),
                                       A.valuePtr());
    else
      A_ = A;
    if (!std::isfinite(A.coeffs().sum())) return {Status::diverged, 0, 0};
    if constexpr (ReadsBlocks<Precond> && !Refreshable<Precond>) {
      return factorise(blocks_of(A_));  // it reads nothing else
    } else if constexpr (Refreshable<Precond>) {
      const auto report = fresh_ ? preconditioner_.compute(A_) : preconditioner_.refresh(A_);
      fresh_ = !report;
      return report;
    } else {
      if constexpr (requires { preconditioner_.compute(A_); }) preconditioner_.compute(A_);
      return {Status::converged, 0, 0};
    }
  }

  /// The same for a matrix of blocks, either storage: nothing is turned into numbers and back. A solver of
  /// symmetric matrices keeps the upper triangle alone.
  void analyse(const BlockMatrix<block_rows>&) requires ReadsBlocks<Precond> { fresh_ = true; }
  SolveReport factorise(const BlockMatrix<block_rows>& A) requires ReadsBlocks<Precond> {
    if (!in_blocks_ || blocks_.rows() != A.rows()) fresh_ = true;
    if (symmetric && A.storage() == BlockStorage::full)  // another pattern that nobody announced
      fresh_ = fresh_ || 2 * blocks_.block_count() - A.node_count() != A.block_count();
    in_blocks_ = true;
    if (!symmetric || A.storage() == BlockStorage::upper) {
      blocks_ = A;
    } else {
      if (fresh_) blocks_ = upper_pattern(A);
      copy_upper(A, blocks_);
    }
    const auto report = fresh_ ? preconditioner_.compute(A) : preconditioner_.refresh(A);
    fresh_ = !report;
    return report;
  }

  /// x: the start if it has the size of b, zero otherwise.
  SolveReport solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) {
    if (x.size() != b.size()) x = Eigen::VectorXd::Zero(b.size());
    if constexpr (ReadsBlocks<Precond>)
      if (in_blocks_) return solve(blocks_, b, x);
    return solve(ApplyMatrix<>{A_}, b, x);
  }

  [[nodiscard]] const Precond& preconditioner() const { return preconditioner_; }

 private:
  [[nodiscard]] static BlockMatrix<block_rows> blocks_of(const RowMatrix& A) {
    Blocked<block_rows> blocked;
    blocked.set_up(A);
    const auto rows = blocked.view();
    BlockMatrix<block_rows> B({rows.start, rows.start + rows.rows + 1},
                              {rows.column, rows.column + rows.start[rows.rows]});
    std::copy_n(rows.value, BlockMatrix<block_rows>::block_size * B.column().size(), B.values());
    return B;
  }

  template <class Operator>
  SolveReport solve(const Operator& A, const Eigen::VectorXd& b, Eigen::VectorXd& x) {
    if constexpr (Method == Krylov::cg) return cg(A, preconditioner_, b, x, options_);
    if constexpr (Method == Krylov::minres) return minres(A, preconditioner_, b, x, options_);
    if constexpr (Method == Krylov::bicgstab) return bicgstab(A, preconditioner_, b, x, options_);
    if constexpr (Method == Krylov::gmres) return gmres(A, preconditioner_, b, x, options_);
  }

  KrylovOptions options_;
  RowMatrix A_;
  typename BlocksOf<Precond>::type blocks_;
  Precond preconditioner_;
  bool fresh_ = true, in_blocks_ = false;
};

}  // namespace detail

/// Conjugate gradients for symmetric positive definite matrices, both triangles stored.
template <class Precond = IncompleteCholesky>
using Cg = detail::Iterative<detail::Krylov::cg, Precond>;

/// MINRES for symmetric matrices, indefinite ones too; both triangles stored, a definite preconditioner.
template <class Precond = Identity>
using Minres = detail::Iterative<detail::Krylov::minres, Precond>;

/// BiCGStab for any regular matrix.
template <class Precond = Ilu0<>>
using BiCgStab = detail::Iterative<detail::Krylov::bicgstab, Precond>;

/// Restarted GMRES for any regular matrix: a residual that never grows, for the memory of its vectors.
template <class Precond = Ilu0<>>
using Gmres = detail::Iterative<detail::Krylov::gmres, Precond>;

static_assert(LinearSolver<Cg<>> && LinearSolver<Minres<>> && LinearSolver<BiCgStab<>> &&
              LinearSolver<Gmres<>>);

}  // namespace tunica::la
