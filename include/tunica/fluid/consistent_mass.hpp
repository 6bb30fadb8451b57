// SPDX-License-Identifier: MIT
// The L2 projection of a pressure gradient on the velocities, with the mass matrix of the predictor.
#pragma once

#include "tunica/fluid/domain.hpp"
#include "tunica/fluid/weak_pressure.hpp"
#include "tunica/la/cg.hpp"
#include "tunica/la/preconditioner.hpp"

#include <cstddef>

namespace tunica::fluid {

/// M w = g on the nodes whose velocity is free, w = 0 on the others. Lumping M here, but not in the
/// predictor, would leave (M M_L^-1 - 1) grad dp in the momentum balance: of first order in time next to
/// prescribed velocities. ||P grad q|| <= ||grad q||, so the projection stays stable. [GUERMOND06]
/// A template of its scalar: only the scenes that take a step pay for it.
template <class Scalar = double>
class ConsistentMass {
  using Vector = Eigen::VectorX<Scalar>;

 public:
  explicit ConsistentMass(const Pattern& pattern) : matrix_(pattern.matrix<Eigen::RowMajor>()) {}

  void assemble(const Domain& domain) {
    domain.pattern.clear(matrix_);
    double* values = matrix_.valuePtr();
    domain.pattern.for_each_cell([&](Index e) {
      const double mass = domain.tets[e].volume / 20;
      const Index* position = domain.pattern.positions(e);
      for (int a = 0; a < 4; ++a)
        for (int b = 0; b < 4; ++b) values[*position++] += a == b ? 2 * mass : mass;
    });
    const auto& fixed = domain.conditions.velocity_flags();
    const int *outer = matrix_.outerIndexPtr(), *inner = matrix_.innerIndexPtr();
    for (int i = 0; i < matrix_.rows(); ++i)
      for (int k = outer[i]; k < outer[i + 1]; ++k)
        if (inner[k] != i &&
            (fixed[static_cast<std::size_t>(i)] || fixed[static_cast<std::size_t>(inner[k])]))
          values[k] = 0;
    jacobi_.compute(matrix_);
  }

  /// What of unit gradients and unit loads arrives at the velocity. With diag(M) the condition is 5 on any
  /// mesh [WATHEN87]: the solves end.
  [[nodiscard]] UnitResponse response(const Domain& domain) {
    constexpr la::KrylovOptions options{.tolerance = 1e-8, .max_iterations = 100};
    const auto& fixed = domain.conditions.velocity_flags();
    UnitResponse unit{.gradient = Vector::Zero(domain.position.cols()),
                      .load = Points<3>::Zero(3, domain.position.cols())};
    Vector lumped = domain.inverse_mass.cwiseInverse();
    for (std::size_t i = 0; i < fixed.size(); ++i)
      if (fixed[i]) lumped[static_cast<Eigen::Index>(i)] = 0;
    la::Jacobi<1> jacobi;
    jacobi.compute(matrix_);
    (void)la::cg(la::ApplyMatrix<1>{matrix_}, jacobi, lumped, unit.gradient, options);
    for (const Condition& c : domain.conditions.list()) {
      if (c.kind != Kind::pressure) continue;
      for (Eigen::Index f = 0; f < c.faces.cols(); ++f)
        for (int i = 0; i < 3; ++i)
          add(unit.load, c.faces(i, f), 1.0 / 3, Conditions::area_vector(domain.position, c.faces, f));
    }
    (void)solve(domain, unit.load, options);
    return unit;
  }

  /// field (3 x nodes): g on entry, w on return.
  SolveReport solve(const Domain& domain, Points<3>& field,
                    const la::KrylovOptions& options = {.tolerance = 1e-6, .max_iterations = 100}) {
    const auto& fixed = domain.conditions.velocity_flags();
    right_ = field.reshaped();
    for (std::size_t i = 0; i < fixed.size(); ++i)
      if (fixed[i])
        for (int c = 0; c < 3; ++c) right_[static_cast<Eigen::Index>(3 * i) + c] = 0;
    jacobi_.apply(right_, solution_);
    const SolveReport report = la::cg(la::ApplyMatrix<3>{matrix_}, jacobi_, right_, solution_, options);
    field = solution_.reshaped(3, field.cols());
    return report;
  }

 private:
  la::RowMatrix matrix_;
  la::Jacobi<3> jacobi_;
  Vector right_, solution_;
};

}  // namespace tunica::fluid
