// SPDX-License-Identifier: MIT
// A second, coarse level for the pressure: what incomplete factors of L + L_t cannot reach.
#pragma once

#include "tunica/core/types.hpp"
#include "tunica/la/vector_ops.hpp"

#include <Eigen/Cholesky>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace tunica::fluid {

enum class NullSpace { none, constants };

/// Trilinear functions of a coarse grid over the nodes. For smooth pressures T nearly vanishes, so the
/// operator gamma L + T is far below gamma L + L_t there, by tau/gamma: those pressures are smooth
/// enough for a coarse grid, on which the operator itself is factored. Preconditioner of the sum form
/// M^-1 = (L L^T)^-1 + Z (Z^T A Z)^-1 Z^T, symmetric positive definite. [NICOLAIDES87]
/// A template of its scalar: dense factors cost the scenes that take a step.
template <class Scalar = double>
class CoarseSpace {
  using Vector = Eigen::VectorX<Scalar>;
  using Dense = Eigen::MatrixX<Scalar>;

 public:
  /// x: 3 x nodes, in a domain of that volume [m3]; later motions of the nodes do not matter.
  CoarseSpace(const Points<3>& x, double volume) {
    constexpr double nodes_a_cell = 200, most_functions = 600;
    const auto n = static_cast<double>(x.cols());
    const double H = std::cbrt(std::max(nodes_a_cell, 2 * n / most_functions) * volume / n);
    Box box;
    for (Eigen::Index i = 0; i < x.cols(); ++i) box.extend(Vec3(x(0, i), x(1, i), x(2, i)));
    int cells[3];
    double step[3];
    for (int d = 0; d < 3; ++d) {
      cells[d] = std::max(1, static_cast<int>(std::ceil((box.hi[d] - box.lo[d]) / H)));
      step[d] = (box.hi[d] - box.lo[d]) / cells[d];
    }
    entries_.resize(static_cast<std::size_t>(x.cols()));
    std::vector<Index> number(static_cast<std::size_t>((cells[0] + 1) * (cells[1] + 1) * (cells[2] + 1)), -1);
    for (Eigen::Index i = 0; i < x.cols(); ++i) {
      double at[3];  // in cells of the grid
      int corner[3];
      for (int d = 0; d < 3; ++d) {
        at[d] = (x(d, i) - box.lo[d]) / step[d];
        corner[d] = std::clamp(static_cast<int>(std::floor(at[d])), 0, cells[d] - 1);
      }
      for (int c = 0; c < 8; ++c) {
        double weight = 1;
        int k[3];
        for (int d = 0; d < 3; ++d) {
          const int far = c >> d & 1;
          const double s = at[d] - corner[d];
          k[d] = corner[d] + far;
          weight *= far ? s : 1 - s;
        }
        auto& id = number[static_cast<std::size_t>(k[0] + (cells[0] + 1) * (k[1] + (cells[1] + 1) * k[2]))];
        if (id < 0) id = size_++;
        entries_[static_cast<std::size_t>(i)][static_cast<std::size_t>(c)] = {id, weight};
      }
    }
  }

  [[nodiscard]] Index size() const { return size_; }

  /// Z^T A Z and its factors. forward (4 x entries of the pattern): for the entry (i, j) the three Q_ji
  /// and (gamma L + L_t)_ij; scale: 1 / Mt.
  void compute(const la::RowMatrix& pattern, const Eigen::Matrix<double, 4, Eigen::Dynamic>& forward,
               const Eigen::VectorXd& scale, NullSpace null_space) {
    Dense E = Dense::Zero(size_, size_);
    using Four = Eigen::Matrix<Scalar, 4, 1>;
    const auto* entry = forward.data();
    std::vector<Four> rows(static_cast<std::size_t>(size_), Four::Zero());
    const auto row = [&](Index k) -> Four& { return rows[static_cast<std::size_t>(k)]; };
    std::vector<char> in(static_cast<std::size_t>(size_), 0);
    std::vector<Index> touched;
    const int *outer = pattern.outerIndexPtr(), *inner = pattern.innerIndexPtr();
    for (int i = 0; i < pattern.rows(); ++i) {
      touched.clear();
      for (int k = outer[i]; k < outer[i + 1]; ++k) {
        for (const Entry& z : entries_[static_cast<std::size_t>(inner[k])]) {
          if (!in[static_cast<std::size_t>(z.function)])
            in[static_cast<std::size_t>(z.function)] = 1, touched.push_back(z.function);
          row(z.function) +=
              z.weight * Eigen::Map<const Four, Eigen::AlignedMax>(entry + 4 * std::ptrdiff_t{k});
        }
      }
      const double s = scale[i];
      const auto& own = entries_[static_cast<std::size_t>(i)];
      for (const Index a : touched) {
        const Four& ra = row(a);
        for (const Entry& z : own) E(z.function, a) += z.weight * ra[3];  // z_i (gamma L + L_t)_i. z
        for (const Index b : touched)
          if (const Four& rb = row(b); b >= a)
            E(b, a) -= s * (ra[0] * rb[0] + ra[1] * rb[1] + ra[2] * rb[2]);  // (Q^T z)^T Mt^-1 (Q^T z)
      }
      for (const Index a : touched) row(a).setZero(), in[static_cast<std::size_t>(a)] = 0;
    }
    const double largest = E.diagonal().maxCoeff();
    for (Index a = 0; a < size_; ++a)  // a function without a node
      if (!(E(a, a) > 1e-12 * largest)) E(a, a) = largest;
    if (null_space == NullSpace::constants) {  // give them the size of the rest
      Vector weight = Vector::Zero(size_);
      for (const auto& entries : entries_)
        for (const Entry& e : entries) weight[e.function] += e.weight;
      E += largest / weight.squaredNorm() * weight * weight.transpose();
    }
    factors_.compute(E);  // reads the lower triangle
    usable_ = factors_.info() == Eigen::Success && E.allFinite();
  }

  /// z += Z (Z^T A Z)^-1 Z^T r.
  void add(const Vector& r, Vector& z) const {
    if (!usable_) return;
    Vector coarse = Vector::Zero(size_);
    for (std::size_t i = 0; i < entries_.size(); ++i)
      for (const Entry& e : entries_[i]) coarse[e.function] += e.weight * r[static_cast<Eigen::Index>(i)];
    factors_.solveInPlace(coarse);
    for (std::size_t i = 0; i < entries_.size(); ++i) {
      double sum = 0;
      for (const Entry& e : entries_[i]) sum += e.weight * coarse[e.function];
      z[static_cast<Eigen::Index>(i)] += sum;
    }
  }

 private:
  struct Entry {
    Index function = 0;
    double weight = 0;
  };
  std::vector<std::array<Entry, 8>> entries_;  // of a node
  Index size_ = 0;
  Eigen::LLT<Dense> factors_;
  bool usable_ = false;
};

}  // namespace tunica::fluid
