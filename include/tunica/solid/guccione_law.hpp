// SPDX-License-Identifier: MIT
// Guccione's exponential of the strains in a fibre frame, transversely isotropic: P and dP/dF in closed form.
#pragma once

#include "tunica/core/unroll.hpp"
#include "tunica/solid/fibres.hpp"
#include "tunica/solid/material.hpp"
#include "tunica/solid/parameters.hpp"

#include <array>
#include <cmath>
#include <cstddef>

namespace tunica::solid {

/// W = C/2 (exp(Q) - 1), Q = bf Eff^2 + bt (Ess^2 + Enn^2 + 2 Esn^2) + 2 bfs (Efs^2 + Efn^2)
/// with E = (F^T F - 1)/2 in the frame f, s, n   [GUCCIONE91]. A point holds the three unit vectors, each
/// orthogonal to the others. Isochoric<Guccione> is the same of J^-1/3 F.
struct Guccione {
  double C;    // [Pa]
  double bf;   // along the fibre [-]
  double bt;   // across [-]
  double bfs;  // shear with the fibre [-]

  static constexpr bool orthogonal_frame = true;
  void check() const {
    require_not_negative("Guccione", "C", C);
    require_not_negative("Guccione", "bf", bf);
    require_not_negative("Guccione", "bt", bt);
    require_not_negative("Guccione", "bfs", bfs);
  }
  template <class S>
  using Point = Fibres<S, 3>;

  template <class S>
  [[nodiscard]] S energy(const Tensor<S>& F, const Fibres<S, 3>& frame) const {
    using std::exp;
    return S(0.5 * C) * (exp(Reading<S>(*this, F, frame).Q) - S(1));
  }

  template <class S>
  [[nodiscard]] Tensor<S> stress(const Tensor<S>& F, const Fibres<S, 3>& frame) const {
    using std::exp;
    const Reading<S> at(*this, F, frame);
    return (S(C) * exp(at.Q)) * product(at.FT, transpose(at.axes));
  }

  /// In the frame, with F' = F axes, T_mn = b_mn E_mn, k = C exp(Q) and S = k T:
  ///   A' = d_ik S_pq + 2 k (F'T)_ip (F'T)_kq + k/2 (d_pq sum_m b_mp F'_im F'_km + b_pq F'_iq F'_kp)
  template <class S>
  [[nodiscard]] Response<S> response(const Tensor<S>& F, const Fibres<S, 3>& frame) const {
    using std::exp;
    const Reading<S> at(*this, F, frame);
    const S k = S(C) * exp(at.Q), half = S(0.5) * k;
    const Tensor<S> kFT = k * at.FT, &G = at.G;
    std::array<Tensor<S>, 3> spread;  // of each direction p: sum_m b_mp F'_im F'_jm
    TUNICA_UNROLL
    for (std::size_t p = 0; p < 3; ++p) {
      TUNICA_UNROLL
      for (std::size_t e = 0; e < 9; ++e) {
        const std::size_t i = 3 * (e / 3), j = 3 * (e % 3);
        for (std::size_t m = 0; m < 3; ++m) spread[p].m[e] += S(exponent(m, p)) * G.m[i + m] * G.m[j + m];
      }
    }
    std::array<S, 81> local;
    TUNICA_UNROLL
    for (std::size_t a = 0; a < 9; ++a) {
      TUNICA_UNROLL
      for (std::size_t c = a; c < 9; ++c) {
        const std::size_t i = a / 3, p = a % 3, j = c / 3, q = c % 3;
        S A = S(2) * kFT.m[a] * at.FT.m[c] + S(exponent(p, q)) * half * G.m[3 * i + q] * G.m[3 * j + p];
        if (i == j) A += k * at.T.m[3 * p + q];
        if (p == q) A += half * spread[p].m[3 * i + j];
        local[9 * a + c] = A;
        local[9 * c + a] = A;
      }
    }
    return {.P = product(kFT, transpose(at.axes)), .A = turned(local, at.axes)};
  }

 private:
  [[nodiscard]] constexpr double exponent(std::size_t m, std::size_t n) const {
    if (m == 0 && n == 0) return bf;
    return m == 0 || n == 0 ? bfs : bt;
  }

  template <class S>
  struct Reading {
    Tensor<S> axes, G, T, FT;  // columns f, s, n; F axes; b_mn E_mn; G T
    S Q;

    Reading(const Guccione& law, const Tensor<S>& F, const Fibres<S, 3>& frame) : Q(0) {
      for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t i = 0; i < 3; ++i) axes.m[3 * i + k] = frame.m[3 * k + i];
      G = product(F, axes);
      const Tensor<S> C = transpose_product(G, G);
      for (std::size_t m = 0; m < 3; ++m)
        for (std::size_t n = 0; n < 3; ++n) {
          const S E = S(0.5) * (m == n ? C.m[3 * m + n] - S(1) : C.m[3 * m + n]);
          T.m[3 * m + n] = S(law.exponent(m, n)) * E;
          Q += T.m[3 * m + n] * E;
        }
      FT = product(G, T);
    }
  };

  /// A_iJkL = sum_pq axes_Jp axes_Lq A'_ipkq
  template <class S>
  [[nodiscard]] static std::array<S, 81> turned(const std::array<S, 81>& local, const Tensor<S>& axes) {
    std::array<S, 81> half, A;
    TUNICA_UNROLL
    for (std::size_t a = 0; a < 9; ++a) {
      const std::size_t i = 9 * (a - a % 3), J = 3 * (a % 3);
      TUNICA_UNROLL
      for (std::size_t c = 0; c < 9; ++c)
        half[9 * a + c] =
            axes.m[J] * local[i + c] + axes.m[J + 1] * local[i + 9 + c] + axes.m[J + 2] * local[i + 18 + c];
    }
    TUNICA_UNROLL
    for (std::size_t a = 0; a < 9; ++a) {
      TUNICA_UNROLL
      for (std::size_t c = 0; c < 9; ++c) {
        const std::size_t k = 9 * a + c - c % 3, L = 3 * (c % 3);
        A[9 * a + c] = axes.m[L] * half[k] + axes.m[L + 1] * half[k + 1] + axes.m[L + 2] * half[k + 2];
      }
    }
    return A;
  }
};

static_assert(Material<Guccione>);

}  // namespace tunica::solid
