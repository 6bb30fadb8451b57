// SPDX-License-Identifier: MIT
// How an element sees its dilatation: at each point, as one mean, or by F-bar; and what the mean one keeps.
#pragma once

#include "tunica/solid/kernel_blocks.hpp"
#include "tunica/solid/material.hpp"

#include <cstddef>

namespace tunica::solid {

/// F as it is: displacements alone. Locks when the bulk modulus is large.
struct Pointwise {
  static constexpr Blocks blocks = Blocks::upper;
};

/// The three-field element of [SIMO85, SIMO91] condensed: dilatation and pressure constant in the element,
///   Pi(u) = int Phi_iso dV + V U(theta),  theta = v/V,  p = U'(theta).
/// The law is a pair with `isochoric` and `volumetric`, as Hyperelastic.
struct MeanVolume {
  static constexpr Blocks blocks = Blocks::upper;
};

/// F-bar = (J0/J)^(1/dim) F with J0 at the centre [NETO96]; any law, its tangent is not symmetric. For cells
/// that are not simplices: there J0 = J.
struct FBar {
  static constexpr Blocks blocks = Blocks::all;
};

/// What MeanVolume knows of an element; nothing for the others.
template <class S, class Locking, int Nodes, int Dim>
struct ElementMean {};
template <class S, int Nodes, int Dim>
struct ElementMean<S, MeanVolume, Nodes, Dim> {
  S volume;             // V of the reference [m^dim]
  S theta;              // v/V
  S p, bulk;            // U'(theta), U''(theta) [Pa]
  S slope[Nodes][Dim];  // dv/du, also the force per unit of p [m^(dim-1)]
};

/// The part p of a pressure in A: p d cof F/dF = p e_ikm e_JLN F_mN, and P += p cof F.
template <class S>
TUNICA_INLINE void add_pressure(const S& p, const Tensor<S>& F, Response<S>& r) {
#pragma GCC unroll 3
  for (std::size_t i = 0; i < 3; ++i)
#pragma GCC unroll 3
    for (std::size_t J = 0; J < 3; ++J) {
      const S pF = p * F.m[3 * i + J];
      const std::size_t i1 = 3 * ((i + 1) % 3), i2 = 3 * ((i + 2) % 3), J1 = (J + 1) % 3, J2 = (J + 2) % 3;
      r.A[9 * (i1 + J1) + i2 + J2] += pF;
      r.A[9 * (i2 + J2) + i1 + J1] += pF;
      r.A[9 * (i1 + J2) + i2 + J1] -= pF;
      r.A[9 * (i2 + J1) + i1 + J2] -= pF;
    }
}

}  // namespace tunica::solid
