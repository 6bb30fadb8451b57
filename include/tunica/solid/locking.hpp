// SPDX-License-Identifier: MIT
// How an element sees its dilatation: at each point, as a mean or a linear field, or by F-bar; and what is
// kept of it.
#pragma once

#include "tunica/solid/kernel_blocks.hpp"
#include "tunica/solid/material.hpp"

#include <array>
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

/// The same with dilatation and pressure linear in the element and free to jump between elements, for
/// quadratic hexahedra and quadrilaterals: with modes phi_i, int phi_i phi_j dV = V delta_ij,
///   Pi(u) = int Phi_iso + U(theta) dV,  theta = sum_i theta_i phi_i,  theta_i = 1/V int phi_i J dV,
///   p = sum_i p_i phi_i,  p_i = 1/V int phi_i U'(theta) dV.
/// The modes are linear in X, so that they keep their order on bent cells [ARNOLD02].
struct LinearVolume {
  static constexpr Blocks blocks = Blocks::upper;
};

/// F-bar = (J0/J)^(1/dim) F with J0 at the centre [NETO96]; any law, its tangent is not symmetric. For cells
/// that are not simplices: there J0 = J.
struct FBar {
  static constexpr Blocks blocks = Blocks::all;
};

/// FBar of a pair, the same forces with the pressure apart: Phi_iso sees F-bar, and U'(J0) int cof F G dV is
/// added. So Newton can predict the pressure.
struct CentreVolume {
  static constexpr Blocks blocks = Blocks::all;
};

/// How many pressures an element keeps.
template <class Locking, int Dim>
inline constexpr int volume_modes = 0;
template <int Dim>
inline constexpr int volume_modes<MeanVolume, Dim> = 1;
template <int Dim>
inline constexpr int volume_modes<CentreVolume, Dim> = 1;
template <int Dim>
inline constexpr int volume_modes<LinearVolume, Dim> = Dim + 1;

/// What an element knows of its dilatation theta = sum_i theta_i phi_i, where it keeps pressures.
template <class S, class Locking, int Nodes, int Dim, int Modes = volume_modes<Locking, Dim>>
struct KeptVolume {
  S volume;                                      // V of the reference [m^dim]
  std::array<S, std::size_t{Modes}> theta;       // v/V first; J0 of CentreVolume
  std::array<S, std::size_t{Modes}> p;           // [Pa]
  std::array<std::array<S, Modes>, Modes> bulk;  // 1/V int phi_i U'' phi_j dV [Pa]
  S slope[Modes][Nodes][Dim];  // int phi_i cof F G dV: the force per unit of p_i [m^(dim-1)]

  /// dp_i = sum_j gain_ij rate_j . du, where rate_j is V dtheta_j/du, and dJ0/du of CentreVolume.
  [[nodiscard]] S gain(std::size_t i, std::size_t j) const { return bulk[i][j] / volume; }
  [[nodiscard]] const auto& rate(std::size_t j) const { return slope[j]; }
};
template <class S, class Locking, int Nodes, int Dim>
struct KeptVolume<S, Locking, Nodes, Dim, 0> {};
template <class S, int Nodes, int Dim>
struct KeptVolume<S, CentreVolume, Nodes, Dim, 1> : KeptVolume<S, MeanVolume, Nodes, Dim, 1> {
  S trial[Nodes][Dim];  // dJ0/du [1/m]

  [[nodiscard]] S gain(std::size_t, std::size_t) const { return this->bulk[0][0]; }
  [[nodiscard]] const auto& rate(std::size_t) const { return trial; }
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
