// SPDX-License-Identifier: MIT
// Hyperelastic: the pair of an isochoric and a volumetric law, a material whose parts can be had apart.
#pragma once

#include "tunica/solid/isochoric_part.hpp"

namespace tunica::solid {

/// W = U(J) + Phi(F) with Phi of the isochoric C   [PEREZ08, (3)]. `isochoric` is a law in invariants, or a
/// Material that does not see J (Isochoric<Law>, Viscoelastic).
///   Hyperelastic{Yeoh{.c10 = 174e3, .c20 = 1880e3}, Quadratic{.kappa = 348e6}}
template <class IsochoricLaw, class VolumetricLaw>
struct Hyperelastic {
  IsochoricLaw isochoric;
  VolumetricLaw volumetric;

  template <class S>
  using Point = PointOf<IsochoricLaw, S>;

  template <class S>
  [[nodiscard]] S energy(const Tensor<S>& F, const Point<S>& point) const {
    return solid::energy(isochoric, F, point) + volumetric.energy(determinant(F));
  }
  /// P = P_iso + U'(J) cof F
  template <class S>
  [[nodiscard]] Tensor<S> stress(const Tensor<S>& F, const Point<S>& point) const {
    return solid::stress(isochoric, F, point) + volumetric.slope(determinant(F)) * cofactor(F);
  }
  template <class S>
  [[nodiscard]] Response<S> response(const Tensor<S>& F, const Point<S>& point) const {
    Response<S> r = isochoric_part(F, point);
    const Tensor<S> dJ = cofactor(F);
    const S J = determinant(F);
    add_volumetric(volumetric.slope(J), volumetric.curvature(J), F, dJ, r);
    return r;
  }
  /// P and A of Phi alone.
  template <class S>
  [[nodiscard]] Response<S> isochoric_part(const Tensor<S>& F, const Point<S>& point) const {
    return solid::response(isochoric, F, point);
  }

  void begin_step(double dt) requires HasHistory<IsochoricLaw> { isochoric.begin_step(dt); }
  template <class S>
  [[nodiscard]] Point<S> advance(const Tensor<S>& F,
                                 const Point<S>& point) const requires HasHistory<IsochoricLaw> {
    return isochoric.advance(F, point);
  }

  template <class S>
  requires(!needs_point<IsochoricLaw>) [[nodiscard]] S energy(const Tensor<S>& F) const {
    return energy(F, Point<S>{});
  }
  template <class S>
  requires(!needs_point<IsochoricLaw>) [[nodiscard]] Tensor<S> stress(const Tensor<S>& F) const {
    return stress(F, Point<S>{});
  }
  template <class S>
  requires(!needs_point<IsochoricLaw>) [[nodiscard]] Response<S> response(const Tensor<S>& F) const {
    return response(F, Point<S>{});
  }
  template <class S>
  requires(!needs_point<IsochoricLaw>) [[nodiscard]] Response<S> isochoric_part(const Tensor<S>& F) const {
    return isochoric_part(F, Point<S>{});
  }
};
template <class I, class V>
Hyperelastic(I, V) -> Hyperelastic<I, V>;

}  // namespace tunica::solid
