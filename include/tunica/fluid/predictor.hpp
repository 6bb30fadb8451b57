// SPDX-License-Identifier: MIT
// The momentum predictor of a pass: assembly, prescribed velocities, and the solution for u*. [ONATE06]
#pragma once

#include "tunica/fluid/boundary_terms.hpp"
#include "tunica/fluid/momentum.hpp"
#include "tunica/la/bicgstab.hpp"
#include "tunica/la/preconditioner.hpp"

#include <algorithm>
#include <cstddef>

namespace tunica::fluid {

class Predictor {
 public:
  explicit Predictor(const Pattern& pattern)
      : matrix_(pattern.matrix<Eigen::RowMajor>()), smoothed_(Points<3>::Zero(3, pattern.node_count())) {}

  /// (a . grad) u of the last solve, projected on the nodes: 3 x nodes [m/s2].
  [[nodiscard]] const Points<3>& smoothed() const { return smoothed_; }

  /// u (3 x nodes): on entry a guess with the prescribed velocities, on return u*. loads: the prescribed
  /// pressures (nodes). options.tolerance is relative to the residual of the guess.
  template <Rheology R, Stabilization S>
  SolveReport solve(const Domain& domain, const R& fluid, const S& stabilization,
                    const MomentumFields& fields, const Eigen::VectorXd& loads, la::KrylovOptions options,
                    Points<3>& u) {
    smooth_convection(domain, fields.a, fields.u, smoothed_);
    assemble_momentum(domain, fluid, stabilization, fields, matrix_, right_);
    add_boundary_terms(domain.pattern, domain.conditions, domain.position, fields.a, loads, fluid.density,
                       matrix_, right_);
    prescribe(domain.conditions, u);
    incomplete_.compute(matrix_);
    solution_ = u.reshaped();
    const Eigen::VectorXd b = right_.reshaped();
    const la::ApplyMatrix<3> A{matrix_};
    A.apply(solution_, product_);
    const double round_off = 1e-14 * std::max(la::norm(b), la::norm(product_));
    options.absolute = std::max(options.tolerance * la::norm(b - product_), round_off);
    options.tolerance = 0;
    const SolveReport report = la::bicgstab(A, incomplete_, b, solution_, options);
    u = solution_.reshaped(3, u.cols());
    return report;
  }

 private:
  /// Rows of nodes with prescribed velocity become u_i = prescribed, at the size of their diagonal.
  void prescribe(const Conditions& conditions, const Points<3>& u) {
    const auto& fixed = conditions.velocity_flags();
    const int* outer = matrix_.outerIndexPtr();
    for (int i = 0; i < matrix_.rows(); ++i) {
      if (!fixed[static_cast<std::size_t>(i)]) continue;
      for (int k = outer[i]; k < outer[i + 1]; ++k) {
        double& value = matrix_.valuePtr()[k];
        if (matrix_.innerIndexPtr()[k] == i)
          right_.col(i) = value * u.col(i);
        else
          value = 0;
      }
    }
  }

  la::RowMatrix matrix_;
  la::Ilu0<3> incomplete_;
  Points<3> smoothed_, right_;
  Eigen::VectorXd solution_, product_;
};

}  // namespace tunica::fluid
