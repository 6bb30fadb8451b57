// SPDX-License-Identifier: MIT
// What a strain energy is: Phi = U(J) + Phi(invariants) of the isochoric C, as [PEREZ08, (3)-(4)].
#pragma once

#include "tunica/core/dual.hpp"

#include <array>
#include <concepts>
#include <cstddef>

namespace tunica::solid {

/// Invariants of the isochoric right Cauchy-Green tensor J^-2/3 C   [PEREZ08, (4)]; I4 and I6 are its squared
/// stretches along the fibres of the first and the second family   [HGO00].
enum class Invariant { I1, I2, I4, I6 };

/// How many invariants a law reads.
template <class Law>
inline constexpr std::size_t invariant_count = Law::reads.size();

/// The energy [Pa] of a law in the invariants that it reads, in their order, for any scalar.
///   struct NeoHooke {
///     static constexpr std::array reads{Invariant::I1};
///     template <class S> S energy(const std::array<S, 1>& I) const { return c10 * (I[0] - 3); }
///     double c10;  // [Pa]
///   };
/// `slopes(I)` with the first and second derivatives is optional; without it they come from duals.
/// `curved`, optional too, lists the invariants in which the second ones are not all zero (an empty array: a
/// linear energy). A law that reads I4 or I6 names the fibres at a point:
///   template <class S> using Point = Fibres<S, 2>;
template <class Law>
concept IsochoricEnergy = requires(const Law& law, const std::array<double, Law::reads.size()>& I) {
  { Law::reads[0] } -> std::convertible_to<Invariant>;
  { law.energy(I) } -> std::convertible_to<double>;
};

/// U(J) [Pa] with U(1) = U'(1) = 0: energy, first and second derivative for any scalar.
template <class Law>
concept VolumetricEnergy = requires(const Law& law, double J) {
  { law.energy(J) } -> std::convertible_to<double>;
  { law.slope(J) } -> std::convertible_to<double>;
  { law.curvature(J) } -> std::convertible_to<double>;
};

/// First and second derivatives of an energy in its K invariants.
template <class S, std::size_t K>
struct Slopes {
  std::array<S, K> first{};
  std::array<std::array<S, K>, K> second{};  // symmetric
};

/// By nested duals: for laws that give their energy alone, and to hold written ones against.
template <IsochoricEnergy Law, class S, std::size_t K>
[[nodiscard]] Slopes<S, K> dual_slopes(const Law& law, const std::array<S, K>& I) {
  using Inner = Dual<S, static_cast<int>(K)>;
  using Outer = Dual<Inner, static_cast<int>(K)>;
  std::array<Outer, K> x;
  for (std::size_t k = 0; k < K; ++k)
    x[k] = Outer::variable(Inner::variable(I[k], static_cast<int>(k)), static_cast<int>(k));
  const Outer W = law.energy(x);
  Slopes<S, K> slopes;
  for (std::size_t k = 0; k < K; ++k) {
    slopes.first[k] = W.d[k].value;
    for (std::size_t l = 0; l < K; ++l) slopes.second[k][l] = W.d[k].d[l];
  }
  return slopes;
}

template <IsochoricEnergy Law, class S, std::size_t K>
[[nodiscard]] Slopes<S, K> slopes(const Law& law, const std::array<S, K>& I) {
  if constexpr (requires { law.slopes(I); })
    return law.slopes(I);
  else
    return dual_slopes(law, I);
}

}  // namespace tunica::solid
