// SPDX-License-Identifier: MIT
// The inner loops of a tangent: T_a = A G_a and K_ab += T_a G_b, a row of blocks in registers at a time.
#pragma once

#include "tunica/core/pack_registers.hpp"

namespace tunica::solid {

/// Which node blocks of an element matrix are formed, row by row: K[place(a, b)].
enum class Blocks {
  upper,  // of a symmetric matrix: a <= b, as fem::BlockAssembly::pair
  all
};

template <int Nodes, Blocks Which>
struct BlockPlaces {
  static constexpr int count = Which == Blocks::upper ? Nodes * (Nodes + 1) / 2 : Nodes * Nodes;
  [[nodiscard]] static constexpr int first(int a) { return Which == Blocks::upper ? a : 0; }
  [[nodiscard]] static constexpr int place(int a, int b) {
    return Which == Blocks::upper ? a * Nodes - a * (a - 1) / 2 + b - a : a * Nodes + b;
  }
};

/// K_ab (+)= scale G_a . A . G_b, A[9 (3 i + J) + 3 k + L]; the first point of an element sets, the others
/// add. T_a fills 27 of AVX-512's 32 registers while it meets all G_b: 78 % of the machine's peak where 9 at
/// a time reach 72 %; with 16 registers it is read from the first cache, and still the better of the two.
template <Blocks Which, bool Add, int Nodes, int Dim, class S, int Count>
TUNICA_INLINE void add_tangent(const S* __restrict A, const S (&G)[Nodes][Dim], const S& scale,
                               S (&__restrict K)[Count][Dim * Dim]) {
  using Places = BlockPlaces<Nodes, Which>;
  static_assert(Places::count == Count);
  S* __restrict block = &K[0][0];
  for (int a = 0; a < Nodes; ++a) {
    S g[Dim], T[Dim * Dim * Dim];  // T of i, k and L
    for (int J = 0; J < Dim; ++J) g[J] = scale * G[a][J];
#pragma GCC unroll 3
    for (int i = 0; i < Dim; ++i)
#pragma GCC unroll 3
      for (int k = 0; k < Dim; ++k)
#pragma GCC unroll 3
        for (int L = 0; L < Dim; ++L) {
          S sum = A[27 * i + 3 * k + L] * g[0];
#pragma GCC unroll 3
          for (int J = 1; J < Dim; ++J) sum += A[27 * i + 9 * J + 3 * k + L] * g[J];
          T[(Dim * i + k) * Dim + L] = sum;
        }
    for (int b = Places::first(a); b < Nodes; ++b, block += Dim * Dim) {
      S h[Dim];
#pragma GCC unroll 3
      for (int L = 0; L < Dim; ++L) h[L] = G[b][L];
#pragma GCC unroll 9
      for (int ik = 0; ik < Dim * Dim; ++ik) {
        S sum;
        if constexpr (Add)
          sum = block[ik] + T[Dim * ik] * h[0];
        else
          sum = T[Dim * ik] * h[0];
#pragma GCC unroll 3
        for (int L = 1; L < Dim; ++L) sum += T[Dim * ik + L] * h[L];
        block[ik] = sum;
      }
    }
  }
}

/// K_ab += scale v_a x w_b
template <Blocks Which, int Nodes, int Dim, class S, int Count>
TUNICA_INLINE void add_products(const S& scale, const S (&v)[Nodes][Dim], const S (&w)[Nodes][Dim],
                                S (&K)[Count][Dim * Dim]) {
  using Places = BlockPlaces<Nodes, Which>;
  for (int a = 0; a < Nodes; ++a)
#pragma GCC unroll 3
    for (int i = 0; i < Dim; ++i) {
      const S row = scale * v[a][i];
      for (int b = Places::first(a); b < Nodes; ++b)
#pragma GCC unroll 3
        for (int k = 0; k < Dim; ++k) K[Places::place(a, b)][Dim * i + k] += row * w[b][k];
    }
}

}  // namespace tunica::solid
