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

/// Trilinear functions of a coarse grid over the nodes. For smooth pressures T nearly vanishes, so the
/// operator gamma L + T is far below gamma L + L_t there, by tau/gamma: those pressures are smooth
/// enough for a coarse grid, on which the operator itself is factored. Preconditioner of the sum form
/// M^-1 = (L L^T)^-1 + Z (Z^T A Z)^-1 Z^T, symmetric positive definite. [NICOLAIDES87]
class CoarseSpace {
 public:
  /// x: 3 x nodes, in a domain of that volume [m3]; later motions of the nodes do not matter.
  template <class Nodes>
  CoarseSpace(const Nodes& x, double volume) {
    constexpr double nodes_a_cell = 200, most_functions = 600;
    const auto n = static_cast<double>(x.cols());
    const double H = std::cbrt(std::max(nodes_a_cell, 2 * n / most_functions) * volume / n);
    const Vec3 lo = x.rowwise().minCoeff(), extent = x.rowwise().maxCoeff() - lo;
    const Eigen::Vector3i cells = (extent / H).array().ceil().max(1).cast<int>();
    const Vec3 step = (extent.array() / cells.cast<double>().array()).matrix();
    entries_.resize(static_cast<std::size_t>(x.cols()));
    std::vector<Index> number(static_cast<std::size_t>((cells.array() + 1).prod()), -1);
    for (Eigen::Index i = 0; i < x.cols(); ++i) {
      const Vec3 at = (x.col(i) - lo).cwiseQuotient(step);
      const Eigen::Vector3i corner = at.array().floor().cast<int>().max(0).min(cells.array() - 1);
      for (int c = 0; c < 8; ++c) {
        double weight = 1;
        std::array<int, 3> k{};
        for (int d = 0; d < 3; ++d) {
          const int far = c >> d & 1;
          const double s = at[d] - corner[d];
          k[static_cast<std::size_t>(d)] = corner[d] + far;
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
  /// and (gamma L + L_t)_ij; scale: 1 / Mt; prescribed: nodes that are left out.
  template <class Matrix, class Forward>
  void compute(const Matrix& pattern, const Forward& forward, const Eigen::VectorXd& scale,
               const std::vector<char>& prescribed) {
    prescribed_ = prescribed;
    Eigen::MatrixXd E = Eigen::MatrixXd::Zero(size_, size_);
    Eigen::Matrix<double, 4, Eigen::Dynamic> row = Eigen::Matrix<double, 4, Eigen::Dynamic>::Zero(4, size_);
    std::vector<char> in(static_cast<std::size_t>(size_), 0);
    std::vector<Index> touched;
    const int *outer = pattern.outerIndexPtr(), *inner = pattern.innerIndexPtr();
    for (int i = 0; i < pattern.rows(); ++i) {
      touched.clear();
      for (int k = outer[i]; k < outer[i + 1]; ++k) {
        const auto j = static_cast<std::size_t>(inner[k]);
        if (prescribed[j]) continue;
        for (const Entry& z : entries_[j]) {
          if (!in[static_cast<std::size_t>(z.function)])
            in[static_cast<std::size_t>(z.function)] = 1, touched.push_back(z.function);
          row.col(z.function) += z.weight * forward.col(k);
        }
      }
      const double s = scale[i];
      const auto& own = entries_[static_cast<std::size_t>(i)];
      for (const Index a : touched) {
        if (!prescribed[static_cast<std::size_t>(i)])  // z_i (gamma L + L_t)_i. z
          for (const Entry& z : own) E(z.function, a) += z.weight * row(3, a);
        for (const Index b : touched)
          if (b >= a)
            E(b, a) -= s * row.col(a).head<3>().dot(row.col(b).head<3>());  // (Q^T z)^T Mt^-1 (Q^T z)
      }
      for (const Index a : touched) row.col(a).setZero(), in[static_cast<std::size_t>(a)] = 0;
    }
    const double largest = E.diagonal().maxCoeff();
    for (Index a = 0; a < size_; ++a)  // a function without a free node
      if (!(E(a, a) > 1e-12 * largest)) E(a, a) = largest;
    if (std::find(prescribed.begin(), prescribed.end(), 1) == prescribed.end()) {
      // Constants are in the null space of A: give them the size of the rest.
      Eigen::VectorXd weight = Eigen::VectorXd::Zero(size_);
      for (const auto& entries : entries_)
        for (const Entry& e : entries) weight[e.function] += e.weight;
      E += largest / weight.squaredNorm() * weight * weight.transpose();
    }
    factors_.compute(E.selfadjointView<Eigen::Lower>());
    usable_ = factors_.info() == Eigen::Success && E.allFinite();
  }

  /// z += Z (Z^T A Z)^-1 Z^T r; r zero at the prescribed nodes.
  template <class Vector>
  void add(const Vector& r, Vector& z) const {
    if (!usable_) return;
    Vector coarse = Vector::Zero(size_);
    for (std::size_t i = 0; i < entries_.size(); ++i)
      for (const Entry& e : entries_[i]) coarse[e.function] += e.weight * r[static_cast<Eigen::Index>(i)];
    factors_.solveInPlace(coarse);
    for (std::size_t i = 0; i < entries_.size(); ++i) {
      if (prescribed_[i]) continue;
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
  Eigen::LLT<Eigen::MatrixXd> factors_;
  std::vector<char> prescribed_;
  bool usable_ = false;
};

}  // namespace tunica::fluid
