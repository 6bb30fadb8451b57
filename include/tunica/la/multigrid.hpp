// SPDX-License-Identifier: MIT
// Multigrid by smoothed aggregation, a preconditioner for symmetric positive (semi)definite matrices.
// [VANEK96]
#pragma once

#include "tunica/core/expect.hpp"
#include "tunica/core/solve_report.hpp"
#include "tunica/la/block_convert.hpp"
#include "tunica/la/multigrid_level.hpp"

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace tunica::la {

struct MultigridOptions {
  double strong = 0.08;  // a coupling is strong above this part of its diagonals; halved on each level
  Index coarsest = 300;  // unknowns of the level that is solved directly
  int max_levels = 20;
  int visits = 2;  // of the next level, from the second level on: 1 makes a V of the cycle, 2 a W
};

/// Block: unknowns of a node, interleaved. Modes: functions that the coarse levels must keep, one a
/// component (constants) or what near_null_space() is given: six rigid body modes of a solid. Scalar: of
/// the hierarchy; float under a Krylov loop in double costs no digit, since residuals are not its own.
///
/// Everything is ordered by index and cut into fixed chunks: the same bits on any number of threads. One
/// object must not be applied by two threads at once.
template <int Block = 1, int Modes = Block, class Scalar = float>
class Multigrid {
 public:
  static constexpr int block_rows = Block;

  Multigrid() = default;
  explicit Multigrid(MultigridOptions options) : options_(options) {}

  /// One column a mode: Block * nodes x Modes. Call it before compute().
  void near_null_space(const Eigen::MatrixXd& modes) {
    TUNICA_EXPECT(modes.cols() == Modes, "a near-null space has as many columns as the multigrid has modes");
    modes_ = modes;
  }

  /// Reads the pattern and the values of A (square, compressed, both triangles). `diverged` for a
  /// matrix that holds a NaN or an infinity.
  SolveReport compute(const RowMatrix& A) {
    TUNICA_EXPECT(A.rows() == A.cols() && A.rows() % Block == 0,
                  "a multigrid needs a square matrix of blocks");
    matrix_.set_up(A);
    return set_up(matrix_.view());
  }
  /// The same where the blocks are there already: they are read in place, those of an upper triangle as a
  /// whole matrix.
  SolveReport compute(const BlockMatrix<Block>& A) {
    if (A.storage() == BlockStorage::upper) return compute(whole(A));
    matrix_ = {};
    return set_up(view_of(A));
  }

  /// Reads new values of a matrix of the same pattern: aggregates and patterns stay, every product is
  /// made anew in its place. What was strong stays strong: after large changes compute() again.
  SolveReport refresh(const RowMatrix& A) {
    if (A.rows() != size_ || A.nonZeros() != matrix_.entries()) return compute(A);
    matrix_.set_values(A);
    return renew(matrix_.view());
  }
  SolveReport refresh(const BlockMatrix<Block>& A) {
    if (A.storage() == BlockStorage::upper) return refresh(whole(A));
    if (A.rows() != size_ || A.block_count() != blocks_) return compute(A);
    return renew(view_of(A));
  }

  /// z ~ A^-1 r: one cycle. r is scaled by a power of two, so that no unit leaves the range of Scalar.
  void apply(const Eigen::VectorXd& r, Eigen::VectorXd& z) const {
    z.resize(r.size());
    const double largest = r.size() > 0 ? r.lpNorm<Eigen::Infinity>() : 0.0;
    if (!usable_ || !std::isfinite(largest) || largest == 0) {
      z.setConstant(usable_ && largest == 0 ? 0.0 : std::numeric_limits<double>::quiet_NaN());
      return;
    }
    const double in = power_of_two_near(1 / largest), out = scale_ / in;
    copy(r.data(), fine_.b.data(), r.size(), in);
    cycle(fine_, 0, fine_.b.data(), fine_.x.data());
    copy(fine_.x.data(), z.data(), r.size(), out);
  }

  [[nodiscard]] int levels() const { return levels_; }
  /// Stored blocks of all levels' matrices, times their size, over those of the first.
  [[nodiscard]] double operator_complexity() const {
    const auto entries = static_cast<double>(blocks_) * Block * Block;
    double sum = entries;
    for (const auto& m : matrices_) sum += static_cast<double>(m.value.size());
    return sum / entries;
  }
  /// Of everything that is kept [bytes].
  [[nodiscard]] std::size_t bytes() const {
    std::size_t sum = fine_.bytes() + factors_.bytes();
    for (const auto& level : coarse_) sum += level.bytes();
    for (const auto& m : matrices_) sum += m.bytes();
    return sum;
  }

 private:
  using Fine = detail::MultigridLevel<Scalar, Block, Modes>;
  using Coarse = detail::MultigridLevel<Scalar, Modes, Modes>;
  using View = detail::RowsView<double, Block, Block>;

  [[nodiscard]] static View view_of(const BlockMatrix<Block>& A) {
    return {A.node_count(), A.node_count(), A.start().data(), A.column().data(), A.values()};
  }

  SolveReport set_up(const View& A) {
    coarse_.clear();
    matrices_.clear();
    fine_ = {};
    size_ = blocks_ = 0;
    if (!finite(A)) return failed();
    scale_ = scale_of(A);
    const bool direct = A.rows * Block <= options_.coarsest;
    std::vector<double> modes = direct ? std::vector<double>{} : fine_modes(A);
    double threshold = options_.strong;
    levels_ = 1;
    fine_.set_smoother(A, scale_);
    if (!direct && options_.max_levels > 1 && fine_.coarsen(A, threshold, modes)) {
      matrices_.reserve(detail::at(options_.max_levels));
      detail::galerkin(A, fine_.P, fine_.R, matrices_.emplace_back());
      while (true) {
        auto& level = coarse_.emplace_back();
        const auto A_l = matrices_.back().view();
        level.set_smoother(A_l, scale_);
        ++levels_;
        threshold *= 0.5;
        if (A_l.rows * Modes <= options_.coarsest || levels_ >= options_.max_levels ||
            !level.coarsen(A_l, threshold, modes))
          break;
        detail::BlockRows<double, Modes, Modes> next;
        detail::galerkin(A_l, level.P, level.R, next);
        matrices_.push_back(std::move(next));
      }
    }
    factorise_coarsest(A);
    size_ = Eigen::Index{Block} * A.rows;
    blocks_ = A.start[A.rows];
    return usable_report();
  }

  SolveReport renew(const View& A) {
    if (!finite(A)) return failed();
    scale_ = scale_of(A);
    fine_.smoother.set_values(A, scale_);
    if (!coarse_.empty()) {
      fine_.set_transfer(A);
      detail::galerkin(A, fine_.P, fine_.R, matrices_[0]);
    }
    for (std::size_t l = 0; l < coarse_.size(); ++l) {
      coarse_[l].smoother.set_values(matrices_[l].view(), scale_);
      if (l + 1 == coarse_.size()) break;
      coarse_[l].set_transfer(matrices_[l].view());
      detail::galerkin(matrices_[l].view(), coarse_[l].P, coarse_[l].R, matrices_[l + 1]);
    }
    factorise_coarsest(A);
    return usable_report();
  }

  [[nodiscard]] static double power_of_two_near(double x) { return std::ldexp(1.0, std::ilogb(x)); }

  template <class From, class To>
  static void copy(const From* from, To* to, std::ptrdiff_t n, double factor) {
    parallel_chunks(n, vector_chunk, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      for (std::ptrdiff_t i = begin; i < end; ++i)
        to[i] = static_cast<To>(factor * static_cast<double>(from[i]));
    });
  }

  [[nodiscard]] static bool finite(const View& A) {
    const auto count = std::ptrdiff_t{Block} * Block * A.start[A.rows];
    return std::isfinite(parallel_sum(count, vector_chunk, [&](std::ptrdiff_t b, std::ptrdiff_t e) {
      return Eigen::Map<const Eigen::VectorXd>(A.value + b, e - b).sum();
    }));
  }

  [[nodiscard]] static double scale_of(const View& A) {
    double largest = 0;
    for (Index i = 0; i < A.rows; ++i)
      for (Index k = A.start[i]; k < A.start[i + 1]; ++k)
        if (A.column[k] == i)
          for (int c = 0; c < Block; ++c) largest = std::max(largest, std::abs(A.block(k)[c * (Block + 1)]));
    return largest > 0 ? power_of_two_near(1 / largest) : 1.0;
  }

  /// The modes of the nodes by blocks; zero at unknowns that are coupled to nothing (prescribed ones).
  [[nodiscard]] std::vector<double> fine_modes(const View& A) const {
    const Eigen::Index n = Eigen::Index{Block} * A.rows;
    TUNICA_EXPECT(modes_.size() == 0 || modes_.rows() == n, "a near-null space has a row an unknown");
    TUNICA_EXPECT(modes_.size() > 0 || Modes == Block, "modes other than constants must be given");
    std::vector<double> modes(detail::at(n) * Modes, 0.0);
    for (Index node = 0; node < A.rows; ++node) {
      const auto coupled = detail::coupled_unknowns(A, node);
      for (int c = 0; c < Block; ++c) {
        const Eigen::Index i = Eigen::Index{Block} * node + c;
        for (int m = 0; m < Modes && coupled[detail::at(c)]; ++m)
          modes[detail::at(i) * Modes + detail::at(m)] = modes_.size() > 0 ? modes_(i, m)
                                                         : c == m          ? 1.0
                                                                           : 0.0;
      }
    }
    return modes;
  }

  /// The last level directly where it is small; where nothing made it so its diagonal dominates.
  void factorise_coarsest(const View& A) {
    direct_ = false;
    const std::size_t room = 2 * detail::at(options_.coarsest);
    if (!matrices_.empty() && detail::at(matrices_.back().rows) * Modes <= room) {
      factors_.template compute<Modes>(matrices_.back().view(), scale_);
      direct_ = true;
    } else if (matrices_.empty() && detail::at(A.rows) * Block <= room) {
      factors_.template compute<Block>(A, scale_);
      direct_ = true;
    }
  }

  SolveReport failed() {
    usable_ = false;
    return {Status::diverged, 0, 0};
  }
  SolveReport usable_report() {
    usable_ = true;
    return {Status::converged, 0, 0};
  }

  template <class Level>
  void cycle(const Level& level, std::size_t l, const Scalar* b, Scalar* x) const {
    if (l == coarse_.size()) {
      if (direct_) return factors_.solve(b, x);
      level.smoother.forward_from_zero(b, x);
      return level.smoother.backward(b, x, level.old.data());
    }
    const Coarse& next = coarse_[l];
    level.smoother.forward_from_zero(b, x);
    level.smoother.residual_of_forward(x, level.residual.data());
    level.restrict_to(next.b);
    cycle(next, l + 1, next.b.data(), next.x.data());
    for (int visit = 1; visit < options_.visits && l + 1 < coarse_.size(); ++visit) {
      next.smoother.residual(next.b.data(), next.x.data(), next.second_b.data());
      cycle(next, l + 1, next.second_b.data(), next.second_x.data());
      for (std::size_t i = 0; i < next.x.size(); ++i) next.x[i] += next.second_x[i];
    }
    level.prolong(next.x, x);
    level.smoother.backward(b, x, level.old.data());
  }

  MultigridOptions options_;
  Eigen::MatrixXd modes_;
  detail::Blocked<Block> matrix_;  // of a matrix that came as scalars
  Fine fine_;
  std::vector<Coarse> coarse_;                                     // those after the first
  std::vector<detail::BlockRows<double, Modes, Modes>> matrices_;  // of coarse_
  detail::DenseFactors<Scalar> factors_;
  Eigen::Index size_ = 0, blocks_ = 0;  // of the matrix
  double scale_ = 1;                    // of the matrix, a power of two
  int levels_ = 0;
  bool direct_ = false, usable_ = false;
};

}  // namespace tunica::la
