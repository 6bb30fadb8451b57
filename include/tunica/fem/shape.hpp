// SPDX-License-Identifier: MIT
// Linear Lagrange shape functions on the reference cells, and the concept they model.
#pragma once

#include "tunica/mesh/cell.hpp"

#include <array>
#include <concepts>
#include <cstddef>

namespace tunica::fem {

/// Coordinates on the reference cell: [-1, 1]^dim for lines, quadrilaterals and hexahedra, the unit simplex
/// for triangles and tetrahedra, the unit triangle x [-1, 1] for wedges.
template <int Dim>
using LocalPoint = std::array<double, Dim>;

/// N_a(xi) and dN_a/dxi_i at a point, all usable at compile time.
///   struct P0 { using cell = Tet4; static constexpr int nodes = 1;
///               static constexpr std::array<double, 1> values(const LocalPoint<3>&); ... };
template <class S>
concept Shape = mesh::Cell<typename S::cell> && requires(const LocalPoint<S::cell::dim>& xi) {
  { S::nodes } -> std::convertible_to<int>;
  { S::values(xi) } -> std::same_as<std::array<double, S::nodes>>;  // a shape has values at a point
  { S::gradients(xi) } -> std::same_as<std::array<LocalPoint<S::cell::dim>, S::nodes>>;  // and gradients
};

/// The isoparametric Lagrange functions of a cell.
template <mesh::Cell C>
struct Lagrange;

namespace detail {

/// Local coordinates of the corners of [-1, 1]^Dim in the numbering of the cells.
template <int Dim, int Nodes>
inline constexpr std::array<std::array<int, Dim>, Nodes> corners = [] {
  constexpr std::array<std::array<int, 2>, 4> square{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
  std::array<std::array<int, Dim>, Nodes> c{};
  for (std::size_t a = 0; a < Nodes; ++a) {
    c[a][0] = square[a % 4][0];
    if constexpr (Dim > 1) c[a][1] = square[a % 4][1];
    if constexpr (Dim == 3) c[a][2] = a < 4 ? -1 : 1;
  }
  return c;
}();

/// N_a = prod_i (1 + xi_i xi_i^a) / 2
template <mesh::Cell C>
struct TensorLinear {
  using cell = C;
  static constexpr int nodes = C::nodes;
  static constexpr std::size_t dim = C::dim;

  template <class T = double>
  static constexpr std::array<T, C::nodes> values(const std::array<T, C::dim>& xi) {
    std::array<T, C::nodes> N{};
    for (std::size_t a = 0; a < C::nodes; ++a) {
      N[a] = T(1);
      for (std::size_t i = 0; i < dim; ++i) N[a] *= 0.5 * (1 + xi[i] * corners<C::dim, C::nodes>[a][i]);
    }
    return N;
  }
  template <class T = double>
  static constexpr std::array<std::array<T, C::dim>, C::nodes> gradients(const std::array<T, C::dim>& xi) {
    std::array<std::array<T, C::dim>, C::nodes> G{};
    for (std::size_t a = 0; a < C::nodes; ++a)
      for (std::size_t i = 0; i < dim; ++i) {
        G[a][i] = T(0.5 * corners<C::dim, C::nodes>[a][i]);
        for (std::size_t j = 0; j < dim; ++j)
          if (j != i) G[a][i] *= 0.5 * (1 + xi[j] * corners<C::dim, C::nodes>[a][j]);
      }
    return G;
  }
};

/// N_0 = 1 - sum xi, N_i = xi_{i-1}
template <mesh::Cell C>
struct SimplexLinear {
  using cell = C;
  static constexpr int nodes = C::nodes;

  template <class T = double>
  static constexpr std::array<T, C::nodes> values(const std::array<T, C::dim>& xi) {
    std::array<T, C::nodes> N{T(1)};
    for (std::size_t i = 0; i < C::dim; ++i) N[0] -= xi[i], N[i + 1] = xi[i];
    return N;
  }
  template <class T = double>
  static constexpr std::array<std::array<T, C::dim>, C::nodes> gradients(const std::array<T, C::dim>&) {
    std::array<std::array<T, C::dim>, C::nodes> G{};
    for (std::size_t i = 0; i < C::dim; ++i) G[0][i] = T(-1), G[i + 1][i] = T(1);
    return G;
  }
};

}  // namespace detail

template <>
struct Lagrange<mesh::Line2> : detail::TensorLinear<mesh::Line2> {};
template <>
struct Lagrange<mesh::Tri3> : detail::SimplexLinear<mesh::Tri3> {};
template <>
struct Lagrange<mesh::Tet4> : detail::SimplexLinear<mesh::Tet4> {};
template <>
struct Lagrange<mesh::Quad4> : detail::TensorLinear<mesh::Quad4> {};
template <>
struct Lagrange<mesh::Hex8> : detail::TensorLinear<mesh::Hex8> {};

}  // namespace tunica::fem
