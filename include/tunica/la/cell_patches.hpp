// SPDX-License-Identifier: MIT
// Sweeps over the cells of a mesh around another preconditioner: what a nearly incompressible solid needs
// beside point smoothers. Multiplicative Schwarz on the unknowns of each cell [VANKA86, SCHOBERL99].
#pragma once

#include "tunica/core/expect.hpp"
#include "tunica/core/solve_report.hpp"
#include "tunica/la/aligned.hpp"
#include "tunica/la/block_convert.hpp"
#include "tunica/la/block_matrix.hpp"

#include <Eigen/Core>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace tunica::la {

/// z ~ A^-1 r by a sweep over all cells, one application of Inner to what is left, and a sweep back:
/// symmetric where A and Inner are. A sweep solves with the block of A that belongs to the nodes of a cell,
/// cell after cell: it costs some ten sweeps over nodes and takes out the fields that keep the volumes of
/// cells, which coarse levels do not know. Worth it from kappa/mu of 100 on:
///   la::Multigrid<3, 6> rigid;  rigid.near_null_space(la::rigid_body_modes(mesh.nodes));
///   la::Cg<la::CellPatches<8, la::Multigrid<3, 6>>> solver({}, {mesh.cells, rigid});
/// On one thread whatever thread_count() says; Inner uses them all. Its inverses take 24^2 numbers in float a
/// hexahedron.
template <int Nodes, class Inner>
class CellPatches {
 public:
  static constexpr int block_rows = Inner::block_rows;

  CellPatches() = default;
  explicit CellPatches(Connectivity<Nodes> cells, Inner inner = {})
      : cells_(std::move(cells)), inner_(std::move(inner)) {}

  /// Reads the pattern and the values of A, either storage; nodes of a cell are coupled in the pattern.
  /// `diverged` where Inner refuses A (a NaN) or a cell's block is singular.
  SolveReport compute(const BlockMatrix<block_rows>& A) {
    if (A.storage() == BlockStorage::upper) return compute(whole(A));
    place_.resize(static_cast<std::size_t>(cells_.cols()) * Nodes * Nodes);
    for (Eigen::Index e = 0; e < cells_.cols(); ++e)
      for (int a = 0; a < Nodes; ++a)
        for (int b = 0; b < Nodes; ++b) {
          const Index k = A.find(cells_(a, e), cells_(b, e));
          TUNICA_EXPECT(k >= 0, "the nodes of a cell are coupled in the pattern of the matrix");
          place_[place(e, a, b)] = k;
        }
    return set_up(A, inner_.compute(A));
  }
  /// The same with new values on the old pattern.
  SolveReport refresh(const BlockMatrix<block_rows>& A) {
    if (A.storage() == BlockStorage::upper) return refresh(whole(A));
    if (A.column().size() != column_.size() || A.start().size() != start_.size()) return compute(A);
    return set_up(A, inner_.refresh(A));
  }

  void apply(const Eigen::VectorXd& r, Eigen::VectorXd& z) const {
    const double largest = r.size() > 0 ? r.lpNorm<Eigen::Infinity>() : 0.0;
    z.setZero(r.size());
    if (!r.allFinite()) z.setConstant(std::numeric_limits<double>::quiet_NaN());
    if (largest == 0 || !std::isfinite(z.sum())) return;
    const double in = std::ldexp(1.0, -std::ilogb(largest)), out = scale_ / in;
    const auto n = static_cast<std::size_t>(r.size() / N);
    r_.resize(lanes * n);
    z_.assign(lanes * n, 0.0F);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t c = 0; c < N; ++c)
        r_[lanes * i + c] = static_cast<float>(in * r[static_cast<Eigen::Index>(N * i + c)]);
    for (Eigen::Index e = 0; e < cells_.cols(); ++e) relax(e);
    left_.resize(r.size());
    for (std::size_t i = 0; i < n; ++i) {
      const Four left = residual(static_cast<Index>(i));
      for (int c = 0; c < N; ++c)
        left_[static_cast<Eigen::Index>(N * i) + c] = static_cast<double>(left[c]) / in;
    }
    inner_.apply(left_, correction_);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t c = 0; c < N; ++c)
        z_[lanes * i + c] += static_cast<float>(correction_[static_cast<Eigen::Index>(N * i + c)] / out);
    for (Eigen::Index e = cells_.cols(); e-- > 0;) relax(e);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t c = 0; c < N; ++c)
        z[static_cast<Eigen::Index>(N * i + c)] = out * static_cast<double>(z_[lanes * i + c]);
  }

  [[nodiscard]] const Inner& inner() const { return inner_; }

 private:
  static constexpr int N = block_rows, size = N * Nodes;
  static_assert(N <= 4 && size % 4 == 0, "columns of blocks and of patches fill registers of four numbers");
  static constexpr std::size_t lanes = 4;
  using Patch = Eigen::Matrix<double, size, size>;
  using Four = Eigen::Array<float, 4, 1>;

  [[nodiscard]] static std::size_t place(Eigen::Index e, int a, int b) {
    return (static_cast<std::size_t>(e) * Nodes + static_cast<std::size_t>(a)) * Nodes +
           static_cast<std::size_t>(b);
  }

  SolveReport set_up(const BlockMatrix<N>& A, const SolveReport& inner) {
    if (!inner) return inner;
    start_ = A.start();
    column_ = A.column();
    value_.assign(lanes * N * column_.size(), 0.0F);
    inverse_.resize(static_cast<std::size_t>(cells_.cols()) * size * size);
    double most = 0;
    for (Index n = 0; n < A.node_count(); ++n)
      if (const Index k = A.find(n, n); k >= 0)
        for (int i = 0; i < N; ++i) most = std::max(most, std::abs(A.block(k)[(N + 1) * i]));
    scale_ = most > 0 ? std::ldexp(1.0, -std::ilogb(most)) : 1;  // no unit leaves the range of float
    for (Index k = 0; k < A.block_count(); ++k)
      for (std::size_t i = 0; i < N; ++i)
        for (std::size_t j = 0; j < N; ++j)
          value_[(static_cast<std::size_t>(k) * N + j) * lanes + i] =
              static_cast<float>(scale_ * A.block(k)[N * i + j]);
    bool regular = true;
    Patch patch;
    for (Eigen::Index e = 0; e < cells_.cols(); ++e) {
      double largest = 0;
      for (int a = 0; a < Nodes; ++a)
        for (int b = 0; b < Nodes; ++b) {
          const double* const block = A.block(place_[place(e, a, b)]);
          for (int i = 0; i < N; ++i)
            for (int k = 0; k < N; ++k) patch(N * a + i, N * b + k) = block[N * i + k];
        }
      for (int i = 0; i < size; ++i) largest = std::max(largest, std::abs(patch(i, i)));
      for (int i = 0; i < size; ++i)  // an unknown that nothing acts on stays as it is
        if (patch(i, i) == 0) patch(i, i) = largest > 0 ? largest : 1;
      const Patch inverse = patch.partialPivLu().inverse();
      regular = regular && std::isfinite(inverse.sum());
      float* const to = inverse_.data() + static_cast<std::size_t>(e) * size * size;
      for (int k = 0; k < size * size; ++k) to[k] = static_cast<float>(inverse.data()[k] / scale_);
    }
    return {regular ? Status::converged : Status::diverged, 0, 0};
  }

  /// (r - A z) of a node, in registers of four: its rows, a column of a block at a time.
  [[nodiscard]] Four residual(Index n) const {
    Four sum = Eigen::Map<const Four, Eigen::Aligned16>(r_.data() + lanes * static_cast<std::size_t>(n));
    const Index begin = start_[static_cast<std::size_t>(n)], end = start_[static_cast<std::size_t>(n) + 1];
    const float* a = value_.data() + lanes * N * static_cast<std::size_t>(begin);
    for (Index k = begin; k < end; ++k, a += lanes * N) {
      const float* const x =
          z_.data() + lanes * static_cast<std::size_t>(column_[static_cast<std::size_t>(k)]);
      Four product = Eigen::Map<const Four, Eigen::Aligned16>(a) * x[0];
#pragma GCC unroll 3
      for (std::size_t j = 1; j < N; ++j)
        product += Eigen::Map<const Four, Eigen::Aligned16>(a + lanes * j) * x[j];
      sum -= product;
    }
    return sum;
  }

  /// z += A_ee^-1 (r - A z)_e.
  void relax(Eigen::Index e) const {
    Eigen::Matrix<float, size, 1> left;
    for (int a = 0; a < Nodes; ++a) {
      const Four of_node = residual(cells_(a, e));
      for (int i = 0; i < N; ++i) left[N * a + i] = of_node[i];
    }
    const Eigen::Map<const Eigen::Matrix<float, size, size>, Eigen::Aligned16> inverse(
        inverse_.data() + static_cast<std::size_t>(e) * size * size);
    const Eigen::Matrix<float, size, 1> change = inverse * left;
    for (int a = 0; a < Nodes; ++a)
      for (int i = 0; i < N; ++i)
        z_[lanes * static_cast<std::size_t>(cells_(a, e)) + static_cast<std::size_t>(i)] += change[N * a + i];
  }

  Connectivity<Nodes> cells_;
  Inner inner_;
  std::vector<Index> place_;  // of the block (a, b) of a cell in the matrix
  std::vector<Index> start_, column_;
  AlignedVector<float> value_, inverse_;  // of scale_ A: each block by columns of four; of its patches
  double scale_ = 1;
  mutable AlignedVector<float> r_, z_;  // four numbers a node
  mutable Eigen::VectorXd left_, correction_;
};

}  // namespace tunica::la
