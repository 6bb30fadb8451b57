// SPDX-License-Identifier: MIT
// An element at one of its points: gradients of the shape functions, weight, deformation, for any scalar.
#pragma once

#include "tunica/core/pack_registers.hpp"
#include "tunica/core/tensor.hpp"
#include "tunica/fem/geometry.hpp"
#include "tunica/mesh/cell_quadratic.hpp"

#include <array>
#include <cstddef>

namespace tunica::solid {

/// Degree of the rule that integrates a stiffness of a cell in full: as many points as its order asks for.
template <mesh::Cell C>
inline constexpr int stiffness_degree = [] {
  if constexpr (C::nodes == C::dim + 1)
    return 1;  // constant gradients
  else if constexpr (C::vtk_type == mesh::Tri6::vtk_type || C::vtk_type == mesh::Tet10::vtk_type)
    return 2;
  else if constexpr (mesh::Quadratic<C>)
    return 5;
  else
    return 3;
}();
template <mesh::Cell C>
using StiffnessRule = fem::Gauss<C, stiffness_degree<C>>;

/// Displacements and the like of an element: v[a][i] is component i at node a.
template <class S, mesh::Cell C>
using NodeVectors = S[C::nodes][C::dim];

template <class S, mesh::Cell C>
struct ElementPoint {
  static constexpr int dim = C::dim, nodes = C::nodes;
  S G[nodes][dim];  // dN_a/dX [1/m]
  S weight;         // volume of the point in the reference [m^dim]

  /// diagonal 1 + sum_a v_a x G_a; in the plane filled up with zeros and `diagonal`: plane strain.
  [[nodiscard]] TUNICA_INLINE Tensor<S> gradient(const NodeVectors<S, C>& v, double diagonal = 0) const {
    S h[dim][dim];
    for (int i = 0; i < dim; ++i)
      for (int j = 0; j < dim; ++j) h[i][j] = v[0][i] * G[0][j];
    for (int a = 1; a < nodes; ++a)
#pragma GCC unroll 3
      for (int i = 0; i < dim; ++i)
#pragma GCC unroll 3
        for (int j = 0; j < dim; ++j) h[i][j] += v[a][i] * G[a][j];
    if (diagonal != 0)
      for (int i = 0; i < dim; ++i) h[i][i] += S(diagonal);
    if constexpr (dim == 3)
      return {.m = {h[0][0], h[0][1], h[0][2], h[1][0], h[1][1], h[1][2], h[2][0], h[2][1], h[2][2]}};
    else
      return {.m = {h[0][0], h[0][1], S(0), h[1][0], h[1][1], S(0), S(0), S(0), S(diagonal)}};
  }
  /// As of the body free of stress, F_p^-1 away: F = (1 + du/dX) F_p = F_p + sum_a u_a x (F_p^T G_a).
  TUNICA_INLINE void free_of_stress(const Tensor<S>& F_p) {
    for (int a = 0; a < nodes; ++a) {
      S g[dim];
      for (int i = 0; i < dim; ++i) {
        g[i] = F_p(0, i) * G[a][0];
        for (int j = 1; j < dim; ++j) g[i] += F_p(j, i) * G[a][j];
      }
      for (int i = 0; i < dim; ++i) G[a][i] = g[i];
    }
    weight = weight / determinant(F_p);
  }
  /// F = 1 + du/dX, of plane strain in the plane.
  [[nodiscard]] TUNICA_INLINE Tensor<S> deformation(const NodeVectors<S, C>& u) const {
    return gradient(u, 1);
  }
  /// f_a += scale T G_a
  TUNICA_INLINE void add_forces(const Tensor<S>& T, const S& scale, NodeVectors<S, C>& f) const {
    S t[dim][dim];
    for (int i = 0; i < dim; ++i)
      for (int j = 0; j < dim; ++j) t[i][j] = scale * T.m[static_cast<std::size_t>(3 * i + j)];
    for (int a = 0; a < nodes; ++a)
#pragma GCC unroll 3
      for (int i = 0; i < dim; ++i) {
        S sum = f[a][i];
#pragma GCC unroll 3
        for (int j = 0; j < dim; ++j) sum += t[i][j] * G[a][j];
        f[a][i] = sum;
      }
  }
};

namespace detail {

template <class S, int Dim>
struct SmallMatrix {
  S m[Dim][Dim];
};

/// det A in `det`; the inverse without its division: cof A^T.
template <class S, int Dim>
[[nodiscard]] TUNICA_INLINE SmallMatrix<S, Dim> adjugate(const SmallMatrix<S, Dim>& A, S& det) {
  const auto& m = A.m;
  if constexpr (Dim == 2) {
    det = m[0][0] * m[1][1] - m[0][1] * m[1][0];
    return {{{m[1][1], -m[0][1]}, {-m[1][0], m[0][0]}}};
  } else {
    SmallMatrix<S, 3> c;
#pragma GCC unroll 3
    for (int i = 0; i < 3; ++i)
#pragma GCC unroll 3
      for (int j = 0; j < 3; ++j) {
        const int p = (i + 1) % 3, q = (i + 2) % 3, r = (j + 1) % 3, s = (j + 2) % 3;
        c.m[j][i] = m[p][r] * m[q][s] - m[p][s] * m[q][r];
      }
    det = m[0][0] * c.m[0][0] + m[0][1] * c.m[1][0] + m[0][2] * c.m[2][0];
    return c;
  }
}

/// sum_a x_a x g_a, g the gradients in the reference cell.
template <mesh::Cell C, class S>
[[nodiscard]] TUNICA_INLINE SmallMatrix<S, C::dim> local_gradient(
    const NodeVectors<S, C>& x, const std::array<fem::LocalPoint<C::dim>, C::nodes>& g) {
  SmallMatrix<S, C::dim> sum;
  for (int i = 0; i < C::dim; ++i)
    for (int k = 0; k < C::dim; ++k) sum.m[i][k] = x[0][i] * S(g[0][static_cast<std::size_t>(k)]);
  for (int a = 1; a < C::nodes; ++a)
#pragma GCC unroll 3
    for (int i = 0; i < C::dim; ++i)
#pragma GCC unroll 3
      for (int k = 0; k < C::dim; ++k)
        sum.m[i][k] += x[a][i] * S(g[static_cast<std::size_t>(a)][static_cast<std::size_t>(k)]);
  return sum;
}

}  // namespace detail

/// Point q of a rule on the element with nodes X [m]. dX/dxi = sum_a X_a x g_a, G_a = (dX/dxi)^-T g_a.
template <mesh::Cell C, class Rule, class S>
[[nodiscard]] TUNICA_INLINE ElementPoint<S, C> element_point(const NodeVectors<S, C>& X, std::size_t q) {
  constexpr int dim = C::dim;
  const auto& g = fem::Tables<fem::Lagrange<C>, Rule>::gradients[q];
  S det;
  auto inverse = detail::adjugate(detail::local_gradient<C>(X, g), det);
  const S scale = S(1) / det;
  for (int i = 0; i < dim; ++i)
    for (int k = 0; k < dim; ++k) inverse.m[i][k] *= scale;
  ElementPoint<S, C> at;
  at.weight = det * S(Rule::weights[q]);
  for (int a = 0; a < C::nodes; ++a)
#pragma GCC unroll 3
    for (int i = 0; i < dim; ++i) {
      S sum = inverse.m[0][i] * S(g[static_cast<std::size_t>(a)][0]);
#pragma GCC unroll 3
      for (int k = 1; k < dim; ++k)
        sum += inverse.m[k][i] * S(g[static_cast<std::size_t>(a)][static_cast<std::size_t>(k)]);
      at.G[a][i] = sum;
    }
  return at;
}

/// det dx/dxi at a point of a rule: over that of X it is J.
template <mesh::Cell C, class Rule, class S>
[[nodiscard]] TUNICA_INLINE S map_determinant(const NodeVectors<S, C>& x, std::size_t q) {
  S det;
  (void)detail::adjugate(detail::local_gradient<C>(x, fem::Tables<fem::Lagrange<C>, Rule>::gradients[q]),
                         det);
  return det;
}

}  // namespace tunica::solid
