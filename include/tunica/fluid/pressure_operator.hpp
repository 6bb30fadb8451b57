// SPDX-License-Identifier: MIT
// The pressure equation with its gradient projected implicitly: symmetric, matrix-free. [ONATE06]
#pragma once

#include "tunica/core/parallel.hpp"
#include "tunica/fluid/total_flux.hpp"
#include "tunica/fluid/weak_pressure.hpp"
#include "tunica/la/vector_ops.hpp"

#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace tunica::fluid {

/// A = gamma L + T,  T = L_t - sum_c Q_c Mt^-1 Q_c^T  (nodes x nodes, symmetric, positive semidefinite),
/// where
///   L_ij = (w grad N_i, grad N_j), w the part of a gradient that arrives at the velocity (UnitResponse), and
///   what weakly prescribed pressures add (WeakFace),
///   L_t with weight tau and nothing else,  Q_c,ij = (tau dN_i/dx_c, N_j),  Mt = lumped (tau N_i, N_j).
/// T p = (tau grad N_i, grad p - P grad p): it vanishes for a linear p. Without any prescribed pressure
/// constants are the null space.
class PressureOperator {
 public:
  explicit PressureOperator(const Pattern& pattern)
      : preconditioning_(pattern.matrix<Eigen::RowMajor>()),
        forward_(4, preconditioning_.nonZeros()),
        backward_(3, preconditioning_.nonZeros()),
        lumped_(pattern.node_count()),
        projected_(3, pattern.node_count()) {}

  /// Refills everything; tau [m3 s/kg] a cell, gamma = dt / (rho c0) [m3 s/kg]. With a total flux the form is
  /// updated to have it.
  void assemble(const Domain& domain, const UnitResponse& response, const std::vector<double>& tau,
                double gamma, const TotalFlux& total = {}) {
    gamma_ = gamma, total_ = total;
    const auto& [pattern, cells, tets, position_of_nodes, inverse_mass, conditions] = domain;
    forward_.setZero(), backward_.setZero(), lumped_.setZero();
    pattern.for_each_cell([&](Index e) {
      const fem::P1Tet& tet = tets[e];
      const double t = tau[static_cast<std::size_t>(e)], quarter = t * tet.volume / 4;
      const double weight =
          (gamma * response.arriving(cells.data() + 4 * std::ptrdiff_t{e}) + t) * tet.volume;
      const Index* position = pattern.positions(e);
      for (int a = 0; a < 4; ++a) {
        const double *ga = tet.grad.data() + 3 * a, *gb = tet.grad.data();
        lumped_[cells(a, e)] += quarter;
        for (int b = 0; b < 4; ++b, ++position, gb += 3) {
          double* forward = forward_.data() + 4 * std::ptrdiff_t{*position};
          double* backward = backward_.data() + 3 * std::ptrdiff_t{*position};
          forward[0] += quarter * gb[0], forward[1] += quarter * gb[1], forward[2] += quarter * gb[2];
          backward[0] += quarter * ga[0], backward[1] += quarter * ga[1], backward[2] += quarter * ga[2];
          forward[3] += weight * (ga[0] * gb[0] + ga[1] * gb[1] + ga[2] * gb[2]);
        }
      }
    });
    for_each_weak_face(domain, response, [&](const WeakFace& face) {
      for (int a = 0; a < 4; ++a)
        for (int b = 0; b < 4; ++b)
          forward_(3, domain.pattern.find(face.node(a), face.node(b))) += gamma * face.entry(a, b);
    });
    for (Eigen::Index i = 0; i < lumped_.size(); ++i) lumped_[i] = lumped_[i] > 0 ? 1 / lumped_[i] : 0;
    for (Eigen::Index k = 0; k < forward_.cols(); ++k) preconditioning_.valuePtr()[k] = forward_(3, k);
  }

  /// y = A x.
  template <class Vector>
  void apply(const Vector& x, Vector& y) const {
    const int *outer = preconditioning_.outerIndexPtr(), *inner = preconditioning_.innerIndexPtr();
    using Four = Eigen::Matrix<typename Vector::Scalar, 4, 1>;
    const double *forward = forward_.data(), *backward = backward_.data();
    double* projected = projected_.data();
    y.resize(x.size());
    parallel_chunks(x.size(), la::row_chunk, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      for (std::ptrdiff_t i = begin; i < end; ++i) {
        Four sum = Four::Zero();  // of Q^T x and (gamma L + L_t) x
        for (int k = outer[i]; k < outer[i + 1]; ++k)
          sum += Eigen::Map<const Four, Eigen::AlignedMax>(forward + 4 * std::ptrdiff_t{k}) * x[inner[k]];
        for (int c = 0; c < 3; ++c) projected[3 * i + c] = lumped_[i] * sum[c];
        y[i] = sum[3];
      }
    });
    parallel_chunks(x.size(), la::row_chunk, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      for (std::ptrdiff_t i = begin; i < end; ++i) {
        double sum = 0;
        for (int k = outer[i]; k < outer[i + 1]; ++k) {
          const double *entry = backward + 3 * std::ptrdiff_t{k},
                       *q = projected + 3 * std::ptrdiff_t{inner[k]};
          sum += entry[0] * q[0] + entry[1] * q[1] + entry[2] * q[2];
        }
        y[i] -= sum;
      }
    });
    if (!total_.none()) total_.update(gamma_, la::dot(total_.g, x), la::dot(total_.f, x), y);
  }

  /// What rounding leaves of b - A x for an x of that size: some hundred roundings of |diag(A) x|.
  [[nodiscard]] double round_off(const Eigen::VectorXd& x) const {
    double sum = 0;
    const int *outer = preconditioning_.outerIndexPtr(), *inner = preconditioning_.innerIndexPtr();
    for (int i = 0; i < preconditioning_.rows(); ++i)
      for (int k = outer[i]; k < outer[i + 1]; ++k)
        if (inner[k] == i)
          sum += preconditioning_.valuePtr()[k] * preconditioning_.valuePtr()[k] * x[i] * x[i];
    return 128 * std::numeric_limits<double>::epsilon() * std::sqrt(sum);
  }

  /// 1 / Mt, 0 at nodes without stabilisation: nodes.
  [[nodiscard]] const Eigen::VectorXd& inverse_mass() const { return lumped_; }

  /// Entries (i, j) in the order of preconditioning(): Q_ji and (gamma L + L_t)_ij.
  [[nodiscard]] const Eigen::Matrix<double, 4, Eigen::Dynamic>& entries() const { return forward_; }

  /// gamma L + L_t: what incomplete factors are made of.
  [[nodiscard]] const la::RowMatrix& preconditioning() const { return preconditioning_; }

 private:
  TotalFlux total_;
  double gamma_ = 0;
  la::RowMatrix preconditioning_;
  Eigen::Matrix<double, 4, Eigen::Dynamic> forward_;   // an entry (i, j): Q_ji and gamma L + L_t
  Eigen::Matrix<double, 3, Eigen::Dynamic> backward_;  // an entry (i, j): Q_ij
  Eigen::VectorXd lumped_;                             // 1 / Mt
  mutable Points<3> projected_;                        // Mt^-1 Q^T x
};

}  // namespace tunica::fluid
