// SPDX-License-Identifier: MIT
// F-bar [NETO96] for a kernel: the centre of the element, and a law seen through F-bar with its exact
// derivative.
#pragma once

#include "tunica/solid/element.hpp"
#include "tunica/solid/kernel_blocks.hpp"
#include "tunica/solid/material.hpp"

#include <cmath>
#include <cstddef>

namespace tunica::solid {

/// F-bar = r F in the space of the cell, r = (J0/J)^(1/dim). With Q = r^(1-dim) P(F-bar) = J sigma(F-bar)
/// F^-T,
///   dQ = r^(2-dim) A : dF + M (g0 . dv - F^-T : dF),  M = (r^(2-dim) A : F + (1-dim) r^(1-dim) P)/dim,
/// where g0 . dv = div dv at the centre, of the gradients g0 in space.
template <mesh::Cell C, class S>
struct BarCentre {
  static constexpr int dim = C::dim, nodes = C::nodes;
  S J0;
  S g0[nodes][dim];      // dN_a/dx at the centre [1/m]
  S middle[nodes][dim];  // int M G_a dV, of the points so far
  Tensor<S> M;           // at the point seen last

  TUNICA_INLINE BarCentre(const NodeVectors<S, C>& X, const NodeVectors<S, C>& u) {
    const auto at = element_point<C, fem::Gauss<C, 1>>(X, 0);
    const Tensor<S> F = at.deformation(u);
    Tensor<S> g = cofactor(F);
    J0 = F.m[0] * g.m[0] + F.m[1] * g.m[1] + F.m[2] * g.m[2];
    g *= S(1) / J0;
    for (int a = 0; a < nodes; ++a)
      for (int k = 0; k < dim; ++k) g0[a][k] = middle[a][k] = S(0);
    at.add_forces(g, S(1), g0);
  }

  [[nodiscard]] TUNICA_INLINE S ratio(const S& J) const {
    using std::cbrt, std::sqrt;
    if constexpr (dim == 2)
      return sqrt(J0 / J);
    else
      return cbrt(J0 / J);
  }
  [[nodiscard]] TUNICA_INLINE static Tensor<S> scaled(const S& r, Tensor<S> F) {
    for (int i = 0; i < dim; ++i)
      for (int j = 0; j < dim; ++j) F(i, j) *= r;
    return F;
  }
  /// r^(1-dim)
  [[nodiscard]] TUNICA_INLINE static S stress_factor(const S& r) {
    return dim == 2 ? S(1) / r : S(1) / (r * r);
  }
  /// div v at the centre.
  [[nodiscard]] TUNICA_INLINE S divergence(const NodeVectors<S, C>& v) const {
    S sum(0);
    for (int a = 0; a < nodes; ++a)
      for (int k = 0; k < dim; ++k) sum += g0[a][k] * v[a][k];
    return sum;
  }

  /// P and A at F-bar become Q and the part of dQ/dF at the point, without its M g0.
  TUNICA_INLINE void see_through(const Tensor<S>& F, const Tensor<S>& cof, const S& J, Response<S>& at) {
    const S r = ratio(J), stress = stress_factor(r), modulus = dim == 2 ? S(1) : S(1) / r, inverse = S(1) / J;
    for (int i = 0; i < dim; ++i)
      for (int K = 0; K < dim; ++K) {
        const auto row = static_cast<std::size_t>(3 * i + K);
        S sum(0);
        for (int k = 0; k < dim; ++k)
          for (int L = 0; L < dim; ++L) {
            S& A = at.A[9 * row + static_cast<std::size_t>(3 * k + L)];
            A *= modulus;
            sum += A * F(k, L);
          }
        at.P.m[row] *= stress;
        M.m[row] = (sum + S(1 - dim) * at.P.m[row]) * S(1. / dim);
        const S scale = M.m[row] * inverse;
        for (int k = 0; k < dim; ++k)
          for (int L = 0; L < dim; ++L)
            at.A[9 * row + static_cast<std::size_t>(3 * k + L)] -= scale * cof(k, L);
      }
  }
};

}  // namespace tunica::solid
