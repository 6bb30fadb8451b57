// SPDX-License-Identifier: MIT
// The map from a reference cell into space: gradients of the shape functions and volume elements.
#pragma once

#include "tunica/fem/quadrature.hpp"
#include "tunica/fem/shape.hpp"

#include <Eigen/Core>
#include <Eigen/LU>

#include <array>
#include <cstddef>

namespace tunica::fem {

/// Values and reference gradients of the functions of S at the points of Q: tables made by the compiler.
template <Shape S, Quadrature Q>
struct Tables {
  static constexpr auto values = [] {
    std::array<std::array<double, S::nodes>, Q::size> t{};
    for (std::size_t q = 0; q < Q::size; ++q) t[q] = S::values(Q::points[q]);
    return t;
  }();
  static constexpr auto gradients = [] {
    std::array<std::array<LocalPoint<S::cell::dim>, S::nodes>, Q::size> t{};
    for (std::size_t q = 0; q < Q::size; ++q) t[q] = S::gradients(Q::points[q]);
    return t;
  }();
};

/// What the map of a cell is at one point.
template <class Scalar, int Dim, int Nodes>
struct MapPoint {
  Eigen::Matrix<Scalar, Dim, Nodes> gradient;  // dN_a/dX, a column a node [1/m]
  Scalar det;                                  // of dX/dxi: negative where the cell is inverted [m^Dim]
};

/// dX/dxi = sum_a X_a dN_a/dxi, dN_a/dX = (dX/dxi)^-T dN_a/dxi; X is Dim x nodes, `local` from Tables.
template <class Scalar, int Dim, std::size_t Nodes>
[[nodiscard]] MapPoint<Scalar, Dim, static_cast<int>(Nodes)> map_point(
    const Eigen::Matrix<Scalar, Dim, static_cast<int>(Nodes)>& X,
    const std::array<LocalPoint<Dim>, Nodes>& local) {
  Eigen::Matrix<Scalar, Dim, Dim> jacobian;
  for (int i = 0; i < Dim; ++i)
    for (int k = 0; k < Dim; ++k) {
      Scalar sum(0);
      for (std::size_t a = 0; a < Nodes; ++a)
        sum += X(i, static_cast<int>(a)) * local[a][static_cast<std::size_t>(k)];
      jacobian(i, k) = sum;
    }
  MapPoint<Scalar, Dim, static_cast<int>(Nodes)> map;
  map.det = jacobian.determinant();
  const Eigen::Matrix<Scalar, Dim, Dim> inverse = jacobian.inverse();
  for (std::size_t a = 0; a < Nodes; ++a)
    for (int i = 0; i < Dim; ++i) {
      Scalar sum(0);
      for (int k = 0; k < Dim; ++k) sum += inverse(k, i) * local[a][static_cast<std::size_t>(k)];
      map.gradient(i, static_cast<int>(a)) = sum;
    }
  return map;
}

}  // namespace tunica::fem
