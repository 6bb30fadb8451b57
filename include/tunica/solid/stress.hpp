// SPDX-License-Identifier: MIT
// Cauchy stress of a body for output: means of cells, recovery to nodes, von Mises.
#pragma once

#include "tunica/solid/body.hpp"

#include <Eigen/Core>

#include <cmath>
#include <cstddef>

namespace tunica::solid {

/// One column a cell or node: xx yy zz xy yz xz [Pa].
using StressField = Eigen::Matrix<double, 6, Eigen::Dynamic>;

namespace detail {
/// p: one a point, or one of all.
template <class Pressure, class Sigma>
void add_multiplier(const Pressure& p, Sigma& sigma) {
  for (int i = 0; i < 3; ++i) sigma.row(i).array() += p;
}

/// Cauchy stress at the points of a cell with the pressures that its formulation has: of the cell, held by
/// augment(), or of the nodes.
template <mesh::Cell C, class Material>
[[nodiscard]] auto stress_of(const Body<C, Material>& body, Index e, const Eigen::VectorXd& u) {
  if constexpr (requires { body.inside().stress(e, u); }) {
    return body.inside().stress(e, u);
  } else {
    auto at = Body<C, Material>::Element::stress(body.material(e), body.reference(e), body.gather(e, u),
                                                 body.data(e));
    add_multiplier(body.inside().multiplier(e), at.sigma);
    return at;
  }
}
}  // namespace detail

/// Cauchy stress of each cell, the mean over its current volume: 6 x cells. u: 3 * nodes [m], or all
/// unknowns of the body where it has pressures beside them.
template <mesh::Cell C, class Material>
[[nodiscard]] StressField cell_stress(const Body<C, Material>& body, const Eigen::VectorXd& u) {
  StressField sigma(6, body.mesh().cell_count());
  for (Index e = 0; e < body.mesh().cell_count(); ++e) {
    const auto at = detail::stress_of(body, e, u);
    Symmetric<double> sum = Symmetric<double>::Zero();
    double volume = 0;
    for (std::size_t q = 0; q < at.volume.size(); ++q) {
      sum += at.volume[q] * at.sigma.col(static_cast<int>(q));
      volume += at.volume[q];
    }
    sigma.col(e) = sum / volume;
  }
  return sigma;
}

/// The mean of the cells around each node, weighted by volume: 6 x nodes. First order at the boundary.
template <mesh::Cell C, class Material>
[[nodiscard]] StressField nodal_stress(const Body<C, Material>& body, const Eigen::VectorXd& u) {
  StressField sigma = StressField::Zero(6, body.mesh().node_count());
  Eigen::RowVectorXd weight = Eigen::RowVectorXd::Zero(body.mesh().node_count());
  for (Index e = 0; e < body.mesh().cell_count(); ++e) {
    const auto at = detail::stress_of(body, e, u);
    for (std::size_t q = 0; q < at.volume.size(); ++q)
      for (const Index n : body.mesh().cells.col(e)) {
        sigma.col(n) += at.volume[q] * at.sigma.col(static_cast<int>(q));
        weight[n] += at.volume[q];
      }
  }
  for (Index n = 0; n < body.mesh().node_count(); ++n)
    if (weight[n] > 0) sigma.col(n) /= weight[n];
  return sigma;
}

/// sqrt(3/2 dev s : dev s)
[[nodiscard]] inline double von_mises(const Symmetric<double>& sigma) {
  const Symmetric<double> d = deviator(sigma);
  return std::sqrt(1.5 * (d.head<3>().squaredNorm() + 2 * d.tail<3>().squaredNorm()));
}

/// One number a column [Pa].
[[nodiscard]] inline Eigen::VectorXd von_mises(const StressField& sigma) {
  Eigen::VectorXd v(sigma.cols());
  for (Eigen::Index k = 0; k < sigma.cols(); ++k) v[k] = von_mises(Symmetric<double>(sigma.col(k)));
  return v;
}

}  // namespace tunica::solid
