// SPDX-License-Identifier: MIT
// The mass matrix of a cell for one component, consistent or lumped.
#pragma once

#include "tunica/core/error.hpp"
#include "tunica/core/types.hpp"
#include "tunica/fem/geometry.hpp"
#include "tunica/fem/quadrature.hpp"

#include <Eigen/Core>

#include <cmath>
#include <cstddef>
#include <string>

namespace tunica::solid {

enum class Mass { consistent, lumped };  // lumped: row sums

/// m_ab = int rho N_a N_b dV [kg] on the nodes X [m]. MeshError, by the number of the cell, if it is
/// inverted or a node is not a number.
template <mesh::Cell C>
[[nodiscard]] Eigen::Matrix<double, C::nodes, C::nodes> cell_mass(Index cell,
                                                                  const Eigen::Matrix<double, 3, C::nodes>& X,
                                                                  double density, Mass kind) {
  using Rule = fem::Gauss<C, C::nodes == 8 ? 3 : 2>;
  using Tables = fem::Tables<fem::Lagrange<C>, Rule>;
  Eigen::Matrix<double, C::nodes, C::nodes> m;
  m.setZero();
  for (std::size_t q = 0; q < Rule::size; ++q) {
    const double det = fem::map_point<double, 3>(X, Tables::gradients[q]).det;
    if (!(det > 0))
      throw MeshError("solid: cell " + std::to_string(cell) +
                      (std::isnan(det) ? " has a node that is not a number" : " is inverted as it is given"));
    const Eigen::Map<const Eigen::Matrix<double, C::nodes, 1>> N(Tables::values[q].data());
    m += density * det * Rule::weights[q] * N * N.transpose();
  }
  if (kind == Mass::lumped) m = m.rowwise().sum().asDiagonal().toDenseMatrix().eval();
  return m;
}

}  // namespace tunica::solid
