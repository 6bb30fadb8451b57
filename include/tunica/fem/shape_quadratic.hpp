// SPDX-License-Identifier: MIT
// Quadratic Lagrange and serendipity functions, and the places of the nodes of a reference cell
// [HUGHES00, ch. 3].
#pragma once

#include "tunica/fem/shape.hpp"
#include "tunica/mesh/cell_quadratic.hpp"

#include <array>
#include <cstddef>

namespace tunica::fem {

/// Where the nodes of a cell lie on its reference cell: corners, middles of edges, of faces, of the cell.
template <mesh::Cell C>
inline constexpr std::array<LocalPoint<C::dim>, C::nodes> reference_nodes = [] {
  constexpr std::size_t dim = C::dim;
  using Linear = mesh::Corners<C>;
  std::array<LocalPoint<C::dim>, C::nodes> x{};
  if constexpr (Linear::nodes == Linear::dim + 1 && Linear::dim > 1) {
    for (std::size_t i = 0; i < dim; ++i) x[i + 1][i] = 1;
  } else {
    for (std::size_t a = 0; a < Linear::nodes; ++a)
      for (std::size_t i = 0; i < dim; ++i) x[a][i] = detail::corners<Linear::dim, Linear::nodes>[a][i];
  }
  if constexpr (mesh::Quadratic<C>) {
    for (const auto& e : C::edges)
      for (std::size_t i = 0; i < dim; ++i)
        x[static_cast<std::size_t>(e[2])][i] =
            0.5 * (x[static_cast<std::size_t>(e[0])][i] + x[static_cast<std::size_t>(e[1])][i]);
    for (std::size_t f = 0; f < C::face_centres.size(); ++f)
      for (std::size_t i = 0; i < dim; ++i) {
        double sum = 0;
        for (const int corner : Linear::faces[f]) sum += x[static_cast<std::size_t>(corner)][i];
        x[static_cast<std::size_t>(C::face_centres[f])][i] = sum / 4;
      }  // the middle of Quad9 and Hex27 is the origin
  }
  return x;
}();

namespace detail {

/// On a simplex with L_0 = 1 - sum xi, L_i = xi_{i-1}: L_a (2 L_a - 1) at corners, 4 L_a L_b between them.
template <mesh::Cell C>
struct SimplexQuadratic {
  using cell = C;
  static constexpr int nodes = C::nodes;
  static constexpr std::size_t dim = C::dim;

  template <class T = double>
  static constexpr std::array<T, C::nodes> values(const std::array<T, C::dim>& xi) {
    const auto L = barycentric(xi);
    std::array<T, C::nodes> N{};
    for (std::size_t a = 0; a <= dim; ++a) N[a] = L[a] * (2 * L[a] - T(1));
    for (const auto& [a, b, middle] : C::edges) N[at(middle)] = 4 * L[at(a)] * L[at(b)];
    return N;
  }
  template <class T = double>
  static constexpr std::array<std::array<T, C::dim>, C::nodes> gradients(const std::array<T, C::dim>& xi) {
    const auto L = barycentric(xi);
    std::array<std::array<T, C::dim>, C::nodes> G{};
    for (std::size_t i = 0; i < dim; ++i) {
      for (std::size_t a = 0; a <= dim; ++a) G[a][i] = slope(a, i) * (4 * L[a] - T(1));
      for (const auto& [a, b, middle] : C::edges)
        G[at(middle)][i] = 4 * (slope(at(a), i) * L[at(b)] + slope(at(b), i) * L[at(a)]);
    }
    return G;
  }

 private:
  static constexpr std::size_t at(int a) { return static_cast<std::size_t>(a); }
  /// dL_a / dxi_i
  static constexpr double slope(std::size_t a, std::size_t i) { return a == 0 ? -1 : a == i + 1 ? 1 : 0; }
  template <class T>
  static constexpr std::array<T, C::dim + 1> barycentric(const std::array<T, C::dim>& xi) {
    std::array<T, C::dim + 1> L{T(1)};
    for (std::size_t i = 0; i < dim; ++i) L[0] -= xi[i], L[i + 1] = xi[i];
    return L;
  }
};

/// N_a = prod_i l(xi_i; xi_i^a) with l = x (x -+ 1) / 2 for a node at +-1 and 1 - x^2 for one at 0.
template <mesh::Cell C>
struct TensorQuadratic {
  using cell = C;
  static constexpr int nodes = C::nodes;
  static constexpr std::size_t dim = C::dim;

  template <class T = double>
  static constexpr std::array<T, C::nodes> values(const std::array<T, C::dim>& xi) {
    std::array<T, C::nodes> N{};
    for (std::size_t a = 0; a < C::nodes; ++a) {
      N[a] = line(xi[0], reference_nodes<C>[a][0]);
      for (std::size_t i = 1; i < dim; ++i) N[a] *= line(xi[i], reference_nodes<C>[a][i]);
    }
    return N;
  }
  template <class T = double>
  static constexpr std::array<std::array<T, C::dim>, C::nodes> gradients(const std::array<T, C::dim>& xi) {
    std::array<std::array<T, C::dim>, C::nodes> G{};
    for (std::size_t a = 0; a < C::nodes; ++a)
      for (std::size_t i = 0; i < dim; ++i) {
        const double s = reference_nodes<C>[a][i];
        G[a][i] = s == 0 ? -2 * xi[i] : xi[i] + T(0.5 * s);
        for (std::size_t j = 0; j < dim; ++j)
          if (j != i) G[a][i] *= line(xi[j], reference_nodes<C>[a][j]);
      }
    return G;
  }

 private:
  template <class T>
  static constexpr T line(const T& x, double at) {
    return at == 0 ? T(1) - x * x : 0.5 * x * (x + T(at));
  }
};

/// With s_i = xi_i xi_i^a: prod_i (1 + s_i) (sum_i s_i - dim + 1) / 2^dim at corners, and
/// (1 - xi_m^2) prod_{i != m} (1 + s_i) / 2^(dim - 1) in the middle of an edge along m.
template <mesh::Cell C>
struct Serendipity {
  using cell = C;
  static constexpr int nodes = C::nodes;
  static constexpr std::size_t dim = C::dim;

  template <class T = double>
  static constexpr std::array<T, C::nodes> values(const std::array<T, C::dim>& xi) {
    std::array<T, C::nodes> N{};
    for (std::size_t a = 0; a < C::nodes; ++a) {
      const auto& x = reference_nodes<C>[a];
      N[a] =
          is_corner(a) ? (sum(xi, x) - T(C::dim - 1)) * (1.0 / (1 << C::dim)) : T(1.0 / (1 << (C::dim - 1)));
      for (std::size_t i = 0; i < dim; ++i) N[a] *= factor(xi[i], x[i]);
    }
    return N;
  }
  template <class T = double>
  static constexpr std::array<std::array<T, C::dim>, C::nodes> gradients(const std::array<T, C::dim>& xi) {
    std::array<std::array<T, C::dim>, C::nodes> G{};
    for (std::size_t a = 0; a < C::nodes; ++a)
      for (std::size_t i = 0; i < dim; ++i) {
        const auto& x = reference_nodes<C>[a];
        // at corners d/dxi_i of (1 + s_i) (sum s - dim + 1) = xi_i^a (sum s - dim + 2 + s_i)
        G[a][i] = is_corner(a) ? (sum(xi, x) + xi[i] * x[i] - T(C::dim - 2)) * (x[i] / (1 << C::dim))
                  : x[i] == 0  ? xi[i] * (-2.0 / (1 << (C::dim - 1)))
                               : T(x[i] / (1 << (C::dim - 1)));
        for (std::size_t j = 0; j < dim; ++j)
          if (j != i) G[a][i] *= factor(xi[j], x[j]);
      }
    return G;
  }

 private:
  static constexpr bool is_corner(std::size_t a) { return a < C::Linear::nodes; }
  template <class T>
  static constexpr T factor(const T& xi, double at) {
    return at == 0 ? T(1) - xi * xi : T(1) + xi * at;
  }
  template <class T>
  static constexpr T sum(const std::array<T, C::dim>& xi, const LocalPoint<C::dim>& x) {
    T s = xi[0] * x[0];
    for (std::size_t i = 1; i < dim; ++i) s += xi[i] * x[i];
    return s;
  }
};

}  // namespace detail

template <>
struct Lagrange<mesh::Line3> : detail::TensorQuadratic<mesh::Line3> {};
template <>
struct Lagrange<mesh::Tri6> : detail::SimplexQuadratic<mesh::Tri6> {};
template <>
struct Lagrange<mesh::Quad8> : detail::Serendipity<mesh::Quad8> {};
template <>
struct Lagrange<mesh::Quad9> : detail::TensorQuadratic<mesh::Quad9> {};
template <>
struct Lagrange<mesh::Tet10> : detail::SimplexQuadratic<mesh::Tet10> {};
template <>
struct Lagrange<mesh::Hex20> : detail::Serendipity<mesh::Hex20> {};
template <>
struct Lagrange<mesh::Hex27> : detail::TensorQuadratic<mesh::Hex27> {};

}  // namespace tunica::fem
