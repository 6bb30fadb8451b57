// SPDX-License-Identifier: MIT
// Isochoric<Law>: a material of the whole F that sees J^-1/3 F in its place, so that it does not see J.
#pragma once

#include "tunica/core/unroll.hpp"
#include "tunica/solid/isochoric_part.hpp"

namespace tunica::solid {

/// W(J^-1/3 F), for the isochoric part of a pair:
///   Hyperelastic{Isochoric{Guccione{...}}, Quadratic{.kappa = 1e6}}
template <class Law>
struct Isochoric {
  static_assert(Material<Law>, "a material gives energy(F), stress(F) or response(F) [Pa] of any scalar");
  Law law;

  template <class S>
  using Point = PointOf<Law, S>;

  template <class S>
  [[nodiscard]] S energy(const Tensor<S>& F, const Point<S>& point) const {
    return solid::energy(law, scale(F) * F, point);
  }
  /// P = s (p - 1/3 (p : F) g) with p = dW at s F, s = J^-1/3 and g = F^-T
  template <class S>
  [[nodiscard]] Tensor<S> stress(const Tensor<S>& F, const Point<S>& point) const {
    const S s = scale(F);
    const Tensor<S> p = s * solid::stress(law, s * F, point);
    return p - (double_dot(p, F) * S(1. / 3)) * transpose(inverse(F));
  }
  /// A = s^2 [a - 1/3 (a:F x g + g x a:F) + 1/9 (F:a:F) g x g]
  ///   + s [-1/3 (p x g + g x p) + 1/9 (p:F) g x g + 1/3 (p:F) g_iL g_kJ]
  template <class S>
  [[nodiscard]] Response<S> response(const Tensor<S>& F, const Point<S>& point) const {
    const S s = scale(F), ss = s * s;
    const Tensor<S> g = transpose(inverse(F));
    Response<S> r = solid::response(law, s * F, point);
    r.P *= s;
    const S third = double_dot(r.P, F) * S(1. / 3);
    Tensor<S> Y;  // what stands beside g in the dyads: A = s^2 a + g x Y + Y x g + third g_iL g_kJ
    S FaF(0);
    TUNICA_UNROLL
    for (std::size_t p = 0; p < 9; ++p) {
      TUNICA_UNROLL
      for (std::size_t q = 0; q < 9; ++q) {
        r.A[9 * p + q] *= ss;
        Y.m[p] += r.A[9 * p + q] * F.m[q];
      }
      FaF += F.m[p] * Y.m[p];
    }
    const S both = S(1. / 18) * FaF + S(1. / 6) * third;
    TUNICA_UNROLL
    for (std::size_t p = 0; p < 9; ++p) Y.m[p] = both * g.m[p] - S(1. / 3) * (Y.m[p] + r.P.m[p]);
    TUNICA_UNROLL
    for (std::size_t p = 0; p < 9; ++p) {
      TUNICA_UNROLL
      for (std::size_t q = 0; q < 9; ++q)
        r.A[9 * p + q] +=
            g.m[p] * Y.m[q] + Y.m[p] * g.m[q] + third * g.m[3 * (p / 3) + q % 3] * g.m[3 * (q / 3) + p % 3];
      r.P.m[p] -= third * g.m[p];
    }
    return r;
  }

  template <class S>
  requires(!needs_point<Law>) [[nodiscard]] S energy(const Tensor<S>& F) const {
    return energy(F, Point<S>{});
  }
  template <class S>
  requires(!needs_point<Law>) [[nodiscard]] Tensor<S> stress(const Tensor<S>& F) const {
    return stress(F, Point<S>{});
  }
  template <class S>
  requires(!needs_point<Law>) [[nodiscard]] Response<S> response(const Tensor<S>& F) const {
    return response(F, Point<S>{});
  }

 private:
  template <class S>
  [[nodiscard]] static S scale(const Tensor<S>& F) {
    return S(1) / detail::cube_root(determinant(F));
  }
};
template <class Law>
Isochoric(Law) -> Isochoric<Law>;

}  // namespace tunica::solid
