// SPDX-License-Identifier: MIT
// W, P and A of a law in isochoric invariants, in closed form from its slopes, for any scalar.
#pragma once

#include "tunica/core/unroll.hpp"
#include "tunica/solid/energy.hpp"
#include "tunica/solid/fibres.hpp"
#include "tunica/solid/material.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace tunica::solid {

namespace detail {

template <class S>
[[nodiscard]] S cube_root(const S& x) {
  using std::cbrt, std::exp, std::log;
  if constexpr (requires { cbrt(x); })
    return cbrt(x);
  else
    return exp(log(x) * S(1. / 3));
}

/// Whether the second derivatives by this invariant may be other than zero.
template <class Law>
[[nodiscard]] constexpr bool curved(Invariant what) {
  if constexpr (requires { Law::curved; })
    return std::find(Law::curved.begin(), Law::curved.end(), what) != Law::curved.end();
  else
    return true;
}

/// F, J and what the invariants of a law share. The unscaled ones are q = F : F M with M = 1 (I1) or a x a
/// (fibres), and i2 = (q1^2 - C : C)/2; then I = s q with s = J^-2/3, I2 = s^2 i2.
template <class Law, class S>
struct IsochoricReading {
  static constexpr std::size_t count = invariant_count<Law>;
  static constexpr bool reads(Invariant what) {
    return std::find(Law::reads.begin(), Law::reads.end(), what) != Law::reads.end();
  }
  static constexpr std::size_t place(Invariant what) {
    return static_cast<std::size_t>(std::find(Law::reads.begin(), Law::reads.end(), what) -
                                    Law::reads.begin());
  }
  static constexpr bool isotropic = reads(Invariant::I1) || reads(Invariant::I2);
  static constexpr bool second = reads(Invariant::I2);
  static constexpr auto curved =
      std::count_if(Law::reads.begin(), Law::reads.end(), [](Invariant k) { return detail::curved<Law>(k); });
  static constexpr std::array<bool, 2> fibre{reads(Invariant::I4), reads(Invariant::I6)};
  static constexpr std::array<std::size_t, 2> fibre_place{place(Invariant::I4), place(Invariant::I6)};

  const Tensor<S>& F;
  Tensor<S> g;  // F^-T
  S s;          // J^-2/3
  S q1{}, i2{};
  Tensor<S> C;                         // F^T F, set if the law reads I2
  std::array<Vector3<S>, 2> a{}, f{};  // fibres, and f = F a
  std::array<S, 2> q{};                // f . f
  std::array<S, count> I;

  IsochoricReading(const Tensor<S>& deformation, const PointOf<Law, S>& point)
      : F(deformation), g(cofactor(F)) {
    const S J = F.m[0] * g.m[0] + F.m[1] * g.m[1] + F.m[2] * g.m[2];
    g *= S(1) / J;
    const S root = cube_root(J);
    s = S(1) / (root * root);
    if constexpr (isotropic) q1 = double_dot(F, F);
    if constexpr (reads(Invariant::I1)) I[place(Invariant::I1)] = s * q1;
    if constexpr (second) {
      C = transpose_product(F, F);
      i2 = S(0.5) * (q1 * q1 - double_dot(C, C));
      I[place(Invariant::I2)] = s * s * i2;
    }
    if constexpr (fibre[0]) read_fibre<0>(point);
    if constexpr (fibre[1]) read_fibre<1>(point);
  }

 private:
  template <std::size_t Family>
  void read_fibre(const PointOf<Law, S>& point) {
    a[Family] = point[Family];
    f[Family] = product(F, a[Family]);
    q[Family] = dot(f[Family], f[Family]);
    I[fibre_place[Family]] = s * q[Family];
  }
};

/// sum_k Phi_k s M_k of the invariants that are linear in C: B = F M and q = F : B of it.
template <class Law, class S>
struct WeightedReading {
  using At = IsochoricReading<Law, S>;
  Tensor<S> M, B;
  S q;

  WeightedReading(const At& at, const std::array<S, At::count>& slope) : q(0) {
    if constexpr (At::reads(Invariant::I1)) {
      const S w = slope[At::place(Invariant::I1)] * at.s;
      for (std::size_t k = 0; k < 9; k += 4) M.m[k] = w;
      B = w * at.F;
      q = w * at.q1;
    }
    if constexpr (At::fibre[0]) add_fibre(at, 0, slope[At::fibre_place[0]] * at.s);
    if constexpr (At::fibre[1]) add_fibre(at, 1, slope[At::fibre_place[1]] * at.s);
  }

 private:
  void add_fibre(const At& at, std::size_t k, const S& w) {
    const Vector3<S> wa{w * at.a[k][0], w * at.a[k][1], w * at.a[k][2]};
    M += dyad(wa, at.a[k]);
    B += dyad(at.f[k], wa);
    q += w * at.q[k];
  }
};

/// 2 (q1 F - F C) = d i2 / dF
template <class At>
[[nodiscard]] auto second_slope(const At& at) {
  auto X = at.q1 * at.F;
  X -= product(at.F, at.C);
  for (auto& x : X.m) x += x;
  return X;
}

/// dI_k/dF, a tensor an invariant: 2 s (F M - q/3 g), and s^2 (X - 4/3 i2 g) of I2.
template <class At, class S>
[[nodiscard]] std::array<Tensor<S>, At::count> invariant_slopes(const At& at, const Tensor<S>& X) {
  std::array<Tensor<S>, At::count> D;
  const S two_s = at.s + at.s;
  if constexpr (At::reads(Invariant::I1)) {
    const S shift = two_s * at.q1 * S(1. / 3);
    TUNICA_UNROLL
    for (std::size_t p = 0; p < 9; ++p)
      D[At::place(Invariant::I1)].m[p] = two_s * at.F.m[p] - shift * at.g.m[p];
  }
  if constexpr (At::second) {
    const S ss = at.s * at.s, shift = ss * at.i2 * S(4. / 3);
    TUNICA_UNROLL
    for (std::size_t p = 0; p < 9; ++p) D[At::place(Invariant::I2)].m[p] = ss * X.m[p] - shift * at.g.m[p];
  }
  for (std::size_t k = 0; k < 2; ++k)
    if (At::fibre[k]) {
      const S shift = two_s * at.q[k] * S(1. / 3);
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
          D[At::fibre_place[k]].m[3 * i + j] = two_s * at.f[k][i] * at.a[k][j] - shift * at.g.m[3 * i + j];
    }
  return D;
}

}  // namespace detail

/// Phi(invariants of F) [Pa]; J^-2/3 F stands for F.
template <IsochoricEnergy Law, class S>
[[nodiscard]] S energy(const Law& law, const Tensor<S>& F, const PointOf<Law, S>& point) {
  return law.energy(detail::IsochoricReading<Law, S>(F, point).I);
}

/// P = sum_k Phi_k dI_k/dF [Pa]
template <IsochoricEnergy Law, class S>
[[nodiscard]] Tensor<S> stress(const Law& law, const Tensor<S>& F, const PointOf<Law, S>& point) {
  using At = detail::IsochoricReading<Law, S>;
  const At at(F, point);
  const auto W = slopes(law, at.I);
  const detail::WeightedReading<Law, S> sum(at, W.first);
  Tensor<S> P;
  S shift = sum.q * S(2. / 3);
  TUNICA_UNROLL
  for (std::size_t p = 0; p < 9; ++p) P.m[p] = sum.B.m[p] + sum.B.m[p];
  if constexpr (At::second) {
    const S w = W.first[At::place(Invariant::I2)] * at.s * at.s;
    P += w * detail::second_slope(at);
    shift += w * at.i2 * S(4. / 3);
  }
  TUNICA_UNROLL
  for (std::size_t p = 0; p < 9; ++p) P.m[p] -= shift * at.g.m[p];
  return P;
}

/// P and A = sum_kl Phi_kl dI_k/dF x dI_l/dF + sum_k Phi_k d2I_k/dF2 with, of I = J^-2/3 q,
///   d2I/dF2 = s [2 d_ik M_JL - 4/3 (g x B + B x g) + 4/9 q g x g + 2/3 q g_iL g_kJ],  g = F^-T, B = F M.
template <IsochoricEnergy Law, class S>
[[nodiscard]] Response<S> response(const Law& law, const Tensor<S>& F, const PointOf<Law, S>& point) {
  using At = detail::IsochoricReading<Law, S>;
  const At at(F, point);
  const auto W = slopes(law, at.I);
  const detail::WeightedReading<Law, S> sum(at, W.first);
  const Tensor<S>& g = at.g;

  Response<S> r;
  Tensor<S> X, b, Y, N = sum.M + sum.M;  // A holds g x Y + Y x g + d_ik N_JL
  S shift = sum.q * S(2. / 3), swap = shift, w2(0), crossed(0);
  TUNICA_UNROLL
  for (std::size_t p = 0; p < 9; ++p) r.P.m[p] = sum.B.m[p] + sum.B.m[p];
  if constexpr (At::second) {
    X = detail::second_slope(at);
    b = product(F, transpose(F));
    w2 = W.first[At::place(Invariant::I2)] * at.s * at.s;
    crossed = w2 + w2;
    const S more = w2 * at.i2 * S(4. / 3);
    TUNICA_UNROLL
    for (std::size_t p = 0; p < 9; ++p) {
      r.P.m[p] += w2 * X.m[p];
      Y.m[p] = S(-4. / 3) * w2 * X.m[p] + S(2. / 3) * more * g.m[p];
      N.m[p] -= crossed * at.C.m[p];
      if (p % 4 == 0) N.m[p] += crossed * at.q1;
    }
    shift += more;
    swap += more;
  }
  TUNICA_UNROLL
  for (std::size_t p = 0; p < 9; ++p) {
    Y.m[p] += S(-4. / 3) * sum.B.m[p] + S(2. / 9) * sum.q * g.m[p];
    r.P.m[p] -= shift * g.m[p];
  }

  std::array<Tensor<S>, At::count> D, H;  // H_k = sum_l Phi_kl D_l
  constexpr auto curves = [](std::size_t k) { return detail::curved<Law>(Law::reads[k]); };
  if constexpr (At::curved != 0) {
    D = detail::invariant_slopes(at, X);
    TUNICA_UNROLL
    for (std::size_t k = 0; k < At::count; ++k) {
      TUNICA_UNROLL
      for (std::size_t l = 0; l < At::count; ++l)
        if (curves(k) && curves(l)) H[k] += W.second[k][l] * D[l];
    }
  }
  TUNICA_UNROLL
  for (std::size_t p = 0; p < 9; ++p) {
    TUNICA_UNROLL
    for (std::size_t q = p; q < 9; ++q) {
      const std::size_t i = p / 3, J = p % 3, k = q / 3, L = q % 3;
      S A = g.m[p] * Y.m[q] + Y.m[p] * g.m[q] + swap * g.m[3 * i + L] * g.m[3 * k + J];
      if (i == k) A += N.m[3 * J + L];
      if constexpr (At::second) {
        A += crossed * (F.m[p] * F.m[q] + F.m[p] * F.m[q] - F.m[3 * i + L] * F.m[3 * k + J]);
        if (J == L) A -= crossed * b.m[3 * i + k];
      }
      TUNICA_UNROLL
      for (std::size_t n = 0; n < At::count; ++n)
        if (curves(n)) A += D[n].m[p] * H[n].m[q];
      r.A[9 * p + q] = A;
      r.A[9 * q + p] = A;
    }
  }
  return r;
}

template <IsochoricEnergy Law, class S>
requires(!needs_point<Law>) [[nodiscard]] S energy(const Law& law, const Tensor<S>& F) {
  return energy(law, F, NoPoint<S>{});
}
template <IsochoricEnergy Law, class S>
requires(!needs_point<Law>) [[nodiscard]] Tensor<S> stress(const Law& law, const Tensor<S>& F) {
  return stress(law, F, NoPoint<S>{});
}
template <IsochoricEnergy Law, class S>
requires(!needs_point<Law>) [[nodiscard]] Response<S> response(const Law& law, const Tensor<S>& F) {
  return response(law, F, NoPoint<S>{});
}

}  // namespace tunica::solid
