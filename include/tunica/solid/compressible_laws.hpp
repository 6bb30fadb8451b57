// SPDX-License-Identifier: MIT
// Laws of the whole F with P and dP/dF in closed form: compressible neo-Hooke and St Venant-Kirchhoff.
#pragma once

#include "tunica/core/unroll.hpp"
#include "tunica/solid/material.hpp"
#include "tunica/solid/parameters.hpp"
#include "tunica/solid/three_terms.hpp"

#include <cmath>
#include <cstddef>

namespace tunica::solid {

/// W = mu/2 (I1 - 3) - mu ln J + lambda/2 ln^2 J with I1 = F : F; of small strains Hooke's law   [BONET97,
/// (5.28)].
struct CompressibleNeoHooke {
  double mu;      // shear modulus [Pa]
  double lambda;  // Lame's first parameter [Pa]; the bulk modulus is lambda + 2/3 mu

  void check() const {
    require_not_negative("CompressibleNeoHooke", "mu", mu);
    require_not_negative("CompressibleNeoHooke", "lambda + 2/3 mu", lambda + 2. / 3 * mu);
  }

  template <class S>
  [[nodiscard]] S energy(const Tensor<S>& F) const {
    using std::log;
    const S l = log(determinant(F));
    return S(0.5 * mu) * (double_dot(F, F) - S(3)) + l * (S(0.5 * lambda) * l - S(mu));
  }
  /// P = mu F + (lambda ln J - mu) F^-T
  template <class S>
  [[nodiscard]] Tensor<S> stress(const Tensor<S>& F) const {
    using std::log;
    const Tensor<S> cof = cofactor(F);
    const S J = F.m[0] * cof.m[0] + F.m[1] * cof.m[1] + F.m[2] * cof.m[2];
    return S(mu) * F + ((S(lambda) * log(J) - S(mu)) / J) * cof;
  }
  /// A_iJkL = mu d_ik d_JL + lambda g_iJ g_kL + (mu - lambda ln J) g_iL g_kJ with g = F^-T
  template <class S>
  [[nodiscard]] ThreeTerms<S> three_terms(const Tensor<S>& F) const {
    using std::log;
    ThreeTerms<S> r;
    r.g = cofactor(F);
    const S J = F.m[0] * r.g.m[0] + F.m[1] * r.g.m[1] + F.m[2] * r.g.m[2], inverse = S(1) / J;
    r.straight = S(mu), r.product = S(lambda), r.swap = S(mu) - S(lambda) * log(J);
    for (std::size_t p = 0; p < 9; ++p) {
      r.g.m[p] *= inverse;
      r.P.m[p] = S(mu) * F.m[p] - r.swap * r.g.m[p];
    }
    return r;
  }
  template <class S>
  [[nodiscard]] Response<S> response(const Tensor<S>& F) const {
    const ThreeTerms<S> t = three_terms(F);
    const Tensor<S>& g = t.g;
    Response<S> r;
    r.P = t.P;
#pragma GCC unroll 9
    for (std::size_t p = 0; p < 9; ++p)
#pragma GCC unroll 9
      for (std::size_t q = 0; q < 9; ++q) {
        if (q < p) continue;
        const std::size_t i = p / 3, K = p % 3, k = q / 3, L = q % 3;
        S A = t.product * g.m[p] * g.m[q] + t.swap * g.m[3 * i + L] * g.m[3 * k + K];
        if (p == q) A += t.straight;
        r.A[9 * p + q] = A;
        r.A[9 * q + p] = A;
      }
    return r;
  }
};

/// W = lambda/2 tr(E)^2 + mu E : E with E = (F^T F - 1)/2. For small strains: it has no resistance against
/// being pressed to nothing, and none against squares turned inside out.
struct StVenantKirchhoff {
  double mu;      // shear modulus [Pa]
  double lambda;  // Lame's first parameter [Pa]

  void check() const {
    require_not_negative("StVenantKirchhoff", "mu", mu);
    require_not_negative("StVenantKirchhoff", "lambda + 2/3 mu", lambda + 2. / 3 * mu);
  }

  template <class S>
  [[nodiscard]] S energy(const Tensor<S>& F) const {
    const Tensor<S> E = strain(F);
    const S tr = trace(E);
    return S(0.5 * lambda) * tr * tr + S(mu) * double_dot(E, E);
  }
  /// P = F S with S = lambda tr(E) 1 + 2 mu E
  template <class S>
  [[nodiscard]] Tensor<S> stress(const Tensor<S>& F) const {
    return product(F, second_stress(F));
  }
  /// A_iJkL = d_ik S_JL + lambda F_iJ F_kL + mu (F_iL F_kJ + (F F^T)_ik d_JL)
  template <class S>
  [[nodiscard]] Response<S> response(const Tensor<S>& F) const {
    const Tensor<S> T = second_stress(F), b = product(F, transpose(F));
    Response<S> r;
    r.P = product(F, T);
    const Tensor<S> lambda_F = S(lambda) * F, mu_F = S(mu) * F, mu_b = S(mu) * b;
    TUNICA_UNROLL
    for (std::size_t p = 0; p < 9; ++p) {
      TUNICA_UNROLL
      for (std::size_t q = p; q < 9; ++q) {
        const std::size_t i = p / 3, K = p % 3, k = q / 3, L = q % 3;
        S A = lambda_F.m[p] * F.m[q] + mu_F.m[3 * i + L] * F.m[3 * k + K];
        if (i == k) A += T.m[3 * K + L];
        if (K == L) A += mu_b.m[3 * i + k];
        r.A[9 * p + q] = A;
        r.A[9 * q + p] = A;
      }
    }
    return r;
  }

 private:
  template <class S>
  [[nodiscard]] static Tensor<S> strain(const Tensor<S>& F) {
    return S(0.5) * (transpose_product(F, F) - identity<S>());
  }
  template <class S>
  [[nodiscard]] Tensor<S> second_stress(const Tensor<S>& F) const {
    const Tensor<S> E = strain(F);
    Tensor<S> T = S(2 * mu) * E;
    const S pressure = S(lambda) * trace(E);
    for (std::size_t k = 0; k < 9; k += 4) T.m[k] += pressure;
    return T;
  }
};

static_assert(Material<CompressibleNeoHooke> && Material<StVenantKirchhoff>);

}  // namespace tunica::solid
