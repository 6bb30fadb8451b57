// SPDX-License-Identifier: MIT
// Stress and modulus of the isochoric part of a law, in space, after [PEREZ08, (5)] and [SIMO91].
#pragma once

#include "tunica/solid/energy.hpp"

#include <Eigen/Core>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace tunica::solid {

/// Components of a symmetric tensor: xx yy zz xy yz xz. Shears are tensor components, not doubled.
template <class S>
using Symmetric = Eigen::Matrix<S, 6, 1>;
inline constexpr std::array<std::array<int, 2>, 6> symmetric_pairs{
    {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {0, 2}}};
inline constexpr std::array<std::array<int, 3>, 3> symmetric_index{{{0, 3, 5}, {3, 1, 4}, {5, 4, 2}}};

template <class S>
[[nodiscard]] Symmetric<S> symmetric_part(const Eigen::Matrix<S, 3, 3>& A) {
  Symmetric<S> s;
  for (int k = 0; k < 6; ++k) {
    const auto [i, j] = symmetric_pairs[static_cast<std::size_t>(k)];
    s[k] = i == j ? A(i, i) : S(0.5) * (A(i, j) + A(j, i));
  }
  return s;
}

template <class S>
[[nodiscard]] S trace(const Symmetric<S>& a) {
  return a[0] + a[1] + a[2];
}

/// dev a = a - tr(a)/3 1
template <class S>
[[nodiscard]] Symmetric<S> deviator(Symmetric<S> a) {
  const S mean = trace(a) * S(1. / 3);
  for (int k = 0; k < 3; ++k) a[k] -= mean;
  return a;
}

/// Kirchhoff stress tau = dev[2 sum_i dPhi/dI_i M_i] and its modulus c (6x6, symmetric): the Lie
/// derivative of tau is c : d. Both are free of J beyond J^-2/3.
template <class S>
struct SpatialResponse {
  Symmetric<S> tau;                // [Pa]
  Eigen::Matrix<S, 6, 6> modulus;  // [Pa]; left unset by isochoric_stress
};

namespace detail {

/// Invariants of b = J^-2/3 F F^T, and M_i = F (dI_i/dC) F^T for those that the law reads.
template <class Law, class S>
struct Reading {
  static constexpr std::size_t count = invariant_count<Law>;
  static constexpr bool second =
      std::find(Law::reads.begin(), Law::reads.end(), Invariant::I2) != Law::reads.end();
  static_assert(std::find(Law::reads.begin(), Law::reads.end(), Invariant::I4) == Law::reads.end() &&
                    std::find(Law::reads.begin(), Law::reads.end(), Invariant::I6) == Law::reads.end(),
                "a law with fibres goes through solid::response(law, F, fibres)");
  Symmetric<S> b, b2;  // b2 = b b, set if the law reads I2
  std::array<S, count> I;
  std::array<Symmetric<S>, count> M;

  Reading(const Eigen::Matrix<S, 3, 3>& F, const S& J) {
    using std::cbrt;
    const S root = cbrt(J);
    const Eigen::Matrix<S, 3, 3> bar = (F * F.transpose()) * (S(1) / (root * root));
    b = symmetric_part<S>(bar);
    if constexpr (second) b2 = symmetric_part<S>(bar * bar);
    const S I1 = trace(b);
    for (std::size_t k = 0; k < count; ++k) {
      if (Law::reads[k] == Invariant::I1) {
        I[k] = I1;  // I1 = tr C
        M[k] = b;
      } else {
        I[k] = S(0.5) * (I1 * I1 - trace(b2));  // I2 = ((tr C)^2 - tr C^2)/2
        M[k] = I1 * b - b2;
      }
    }
  }
};

}  // namespace detail

/// The energy alone [Pa].
template <IsochoricEnergy Law, class S>
[[nodiscard]] S isochoric_energy(const Law& law, const Eigen::Matrix<S, 3, 3>& F, const S& J) {
  return law.energy(detail::Reading<Law, S>(F, J).I);
}

template <IsochoricEnergy Law, class S>
[[nodiscard]] Symmetric<S> isochoric_stress(const Law& law, const Eigen::Matrix<S, 3, 3>& F, const S& J) {
  const detail::Reading<Law, S> at(F, J);
  const auto W = slopes(law, at.I);
  Symmetric<S> tau = S(2) * W.first[0] * at.M[0];
  for (std::size_t k = 1; k < at.count; ++k) tau += S(2) * W.first[k] * at.M[k];
  return deviator(tau);  // sigma = U' 1 + 2/J dev[F dPhi/dC F^T]   [PEREZ08, (5)]
}

/// c = P (c1) P + 2/3 tr(t) (Id - 1x1/3) - 2/3 (tau x 1 + 1 x tau), with t before its deviator,
/// c1 = 4 sum_ij Phi_ij M_i x M_j + 4 Phi_2 (b x b - b (.) b), and P the deviatoric projection.
template <IsochoricEnergy Law, class S>
[[nodiscard]] SpatialResponse<S> isochoric_response(const Law& law, const Eigen::Matrix<S, 3, 3>& F,
                                                    const S& J) {
  using Reading = detail::Reading<Law, S>;
  const Reading at(F, J);
  const auto W = slopes(law, at.I);
  Symmetric<S> t = S(2) * W.first[0] * at.M[0];
  for (std::size_t k = 1; k < Reading::count; ++k) t += S(2) * W.first[k] * at.M[k];
  SpatialResponse<S> r;
  r.tau = deviator(t);

  std::array<Symmetric<S>, Reading::count> D;
  for (std::size_t k = 0; k < Reading::count; ++k) D[k] = deviator(at.M[k]);
  r.modulus.setConstant(S(0));
  for (std::size_t k = 0; k < Reading::count; ++k)
    for (std::size_t l = 0; l < Reading::count; ++l)
      r.modulus += D[k] * (S(4) * W.second[k][l] * D[l]).transpose();
  if constexpr (Reading::second) {
    const auto k2 = static_cast<std::size_t>(std::find(Law::reads.begin(), Law::reads.end(), Invariant::I2) -
                                             Law::reads.begin());
    const S four_W2 = S(4) * W.first[k2];
    const Symmetric<S> d = deviator(at.b);
    const Symmetric<S>& b2 = at.b2;
    const S ninth = trace(b2) * S(1. / 9);
    for (int p = 0; p < 6; ++p)
      for (int q = 0; q < 6; ++q) {
        const auto [i, j] = symmetric_pairs[static_cast<std::size_t>(p)];
        const auto [k, l] = symmetric_pairs[static_cast<std::size_t>(q)];
        const auto b = [&](int m, int n) {
          return at.b[symmetric_index[static_cast<std::size_t>(m)][static_cast<std::size_t>(n)]];
        };
        S A = S(0.5) * (b(i, k) * b(j, l) + b(i, l) * b(j, k));  // (b (.) b)_ijkl, then P A P
        if (p < 3) A -= S(1. / 3) * b2[q];
        if (q < 3) A -= S(1. / 3) * b2[p];
        if (p < 3 && q < 3) A += ninth;
        r.modulus(p, q) += four_W2 * (d[p] * d[q] - A);
      }
  }
  const S two_thirds_tr = S(2. / 3) * trace(t);
  for (int p = 0; p < 6; ++p) r.modulus(p, p) += p < 3 ? two_thirds_tr : S(0.5) * two_thirds_tr;
  for (int p = 0; p < 3; ++p) {
    for (int q = 0; q < 3; ++q) r.modulus(p, q) -= S(1. / 3) * two_thirds_tr;
    for (int q = 0; q < 6; ++q) {
      r.modulus(p, q) -= S(2. / 3) * r.tau[q];
      r.modulus(q, p) -= S(2. / 3) * r.tau[q];
    }
  }
  return r;
}

}  // namespace tunica::solid
