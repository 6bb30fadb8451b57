// SPDX-License-Identifier: MIT
// A shortcut through the kernel: a law whose A has three terms needs neither A nor T_a, and half of the
// flops.
#pragma once

#include "tunica/solid/element.hpp"
#include "tunica/solid/kernel_blocks.hpp"
#include "tunica/solid/three_terms.hpp"

#include <cstddef>

namespace tunica::solid {

/// K_ab (+)= w (straight G_a . G_b 1 + product g_a x g_b + swap g_b x g_a), g_a = F^-T G_a, for a <= b.
template <bool Add, class S, mesh::Cell C, int Count>
TUNICA_INLINE void add_three_terms(const ThreeTerms<S>& r, const ElementPoint<S, C>& at,
                                   S (&__restrict K)[Count][C::dim * C::dim]) {
  constexpr int dim = C::dim, nodes = C::nodes;
  static_assert(BlockPlaces<nodes, Blocks::upper>::count == Count);
  S g[nodes][dim];
#pragma GCC unroll 3
  for (int i = 0; i < dim; ++i)
    for (int a = 0; a < nodes; ++a) {
      S sum = r.g.m[static_cast<std::size_t>(3 * i)] * at.G[a][0];
#pragma GCC unroll 3
      for (int J = 1; J < dim; ++J) sum += r.g.m[static_cast<std::size_t>(3 * i + J)] * at.G[a][J];
      g[a][i] = sum;
    }
  const S straight = at.weight * r.straight, product = at.weight * r.product, swap = at.weight * r.swap;
  S* __restrict block = &K[0][0];
  for (int a = 0; a < nodes; ++a) {
    S G[dim], p[dim], s[dim];
#pragma GCC unroll 3
    for (int i = 0; i < dim; ++i)
      G[i] = straight * at.G[a][i], p[i] = product * g[a][i], s[i] = swap * g[a][i];
    for (int b = a; b < nodes; ++b, block += dim * dim) {
      S dot = G[0] * at.G[b][0], h[dim];
#pragma GCC unroll 3
      for (int J = 1; J < dim; ++J) dot += G[J] * at.G[b][J];
#pragma GCC unroll 3
      for (int k = 0; k < dim; ++k) h[k] = g[b][k];
#pragma GCC unroll 3
      for (int i = 0; i < dim; ++i)
#pragma GCC unroll 3
        for (int k = 0; k < dim; ++k) {
          S sum = Add ? block[dim * i + k] + p[i] * h[k] : p[i] * h[k];
          sum += h[i] * s[k];
          if (i == k) sum += dot;
          block[dim * i + k] = sum;
        }
    }
  }
}

}  // namespace tunica::solid
