// SPDX-License-Identifier: MIT
// What a material is: its energy W(F), or P = dW/dF, or P and A = dP/dF; what is missing comes from duals.
#pragma once

#include "tunica/core/dual.hpp"
#include "tunica/core/jet.hpp"
#include "tunica/core/tensor.hpp"
#include "tunica/core/unroll.hpp"

#include <array>
#include <concepts>
#include <cstddef>
#include <tuple>

namespace tunica::solid {

/// First Piola-Kirchhoff stress P [Pa], and A[9 (3 i + J) + 3 k + L] = dP_iJ/dF_kL [Pa]: all 81 are filled.
template <class S>
struct Response {
  Tensor<S> P;
  std::array<S, 81> A;
};

/// The data that a law needs at a point of the body (fibres, history) beside F: numbers S in a row. A law
/// names its own by `template <class S> struct Point { std::array<S, n> m; };`; this one says: none.
template <class S>
struct NoPoint {
  std::array<S, 0> m{};
};

namespace detail {
template <class Law, class S>
struct PointType {
  using type = NoPoint<S>;
};
template <class Law, class S>
requires requires {
  typename Law::template Point<S>;
}
struct PointType<Law, S> {
  using type = typename Law::template Point<S>;
};
}  // namespace detail

/// Law::Point<S>, or NoPoint<S>.
template <class Law, class S>
using PointOf = typename detail::PointType<Law, S>::type;

/// How many numbers a point of a law holds; a pack of points gathers them one by one.
template <class Law>
inline constexpr std::size_t point_size = std::tuple_size_v<decltype(PointOf<Law, double>::m)>;

template <class Law>
inline constexpr bool needs_point = point_size<Law> != 0;

template <class Law, class S>
concept GivesEnergy = requires(const Law& law, const Tensor<S>& F) {
  { law.energy(F) } -> std::convertible_to<S>;
}
|| requires(const Law& law, const Tensor<S>& F, const PointOf<Law, S>& point) {
  { law.energy(F, point) } -> std::convertible_to<S>;
};
template <class Law, class S>
concept GivesStress = requires(const Law& law, const Tensor<S>& F) {
  { law.stress(F) } -> std::convertible_to<Tensor<S>>;
}
|| requires(const Law& law, const Tensor<S>& F, const PointOf<Law, S>& point) {
  { law.stress(F, point) } -> std::convertible_to<Tensor<S>>;
};
template <class Law, class S>
concept GivesResponse = requires(const Law& law, const Tensor<S>& F) {
  { law.response(F) } -> std::convertible_to<Response<S>>;
}
|| requires(const Law& law, const Tensor<S>& F, const PointOf<Law, S>& point) {
  { law.response(F, point) } -> std::convertible_to<Response<S>>;
};

/// Energy [Pa] for any scalar, or stress, or response; F is dx/dX, dimensionless. Ten lines are enough:
///   struct Mine {
///     double mu, lambda;  // [Pa]
///     template <class S> S energy(const Tensor<S>& F) const {
///       using std::log;
///       const S ln_J = log(determinant(F));
///       return S(0.5 * mu) * (double_dot(F, F) - S(3)) - S(mu) * ln_J + S(0.5 * lambda) * ln_J * ln_J;
///     }
///   };
template <class Law>
concept Material = GivesEnergy<Law, double> || GivesStress<Law, double> || GivesResponse<Law, double>;

/// The numbers of a point as another scalar.
template <class Law, class T, class S>
[[nodiscard]] PointOf<Law, T> cast_point(const PointOf<Law, S>& point) {
  PointOf<Law, T> out{};
  for (std::size_t k = 0; k < point_size<Law>; ++k) out.m[k] = T(point.m[k]);
  return out;
}

namespace detail {

/// F with the nine independent variables F_iJ, in the order of Tensor.
template <class S>
[[nodiscard]] Tensor<Dual<S, 9>> variables(const Tensor<S>& F) {
  Tensor<Dual<S, 9>> x;
  for (int k = 0; k < 9; ++k) {
    const auto n = static_cast<std::size_t>(k);
    x.m[n] = Dual<S, 9>::variable(F.m[n], k);
  }
  return x;
}

}  // namespace detail

/// W(F) [Pa]. `point` is what PointOf<Law, S> asks for.
template <Material Law, class S>
requires GivesEnergy<Law, S>
[[nodiscard]] S energy(const Law& law, const Tensor<S>& F, const PointOf<Law, S>& point) {
  if constexpr (needs_point<Law>)
    return law.energy(F, point);
  else
    return law.energy(F);
}

/// P = dW/dF [Pa]: the law's own, or the nine derivatives of its energy.
template <Material Law, class S>
[[nodiscard]] Tensor<S> stress(const Law& law, const Tensor<S>& F, const PointOf<Law, S>& point) {
  if constexpr (GivesStress<Law, S>) {
    if constexpr (needs_point<Law>)
      return law.stress(F, point);
    else
      return law.stress(F);
  } else if constexpr (GivesEnergy<Law, S>) {
    using D = Dual<S, 9>;
    return {.m = energy(law, detail::variables(F), cast_point<Law, D, S>(point)).d};
  } else if constexpr (needs_point<Law>) {
    return law.response(F, point).P;
  } else {
    return law.response(F).P;
  }
}

/// P and A by nested duals of the energy, or duals of the stress: to hold all other ways against.
template <Material Law, class S>
requires(GivesEnergy<Law, S> || GivesStress<Law, S>)
    [[nodiscard]] Response<S> dual_response(const Law& law, const Tensor<S>& F,
                                            const PointOf<Law, S>& point) {
  using D = Dual<S, 9>;
  const Tensor<D> P = [&] {
    if constexpr (GivesEnergy<Law, S>)
      return Tensor<D>{
          .m = energy(law, detail::variables(detail::variables(F)), cast_point<Law, Dual<D, 9>, S>(point)).d};
    else
      return stress(law, detail::variables(F), cast_point<Law, D, S>(point));
  }();
  Response<S> r;
  for (std::size_t p = 0; p < 9; ++p) {
    r.P.m[p] = P.m[p].value;
    for (std::size_t q = 0; q < 9; ++q) r.A[9 * p + q] = P.m[p].d[q];
  }
  return r;
}

/// P and A = dP/dF [Pa]: the law's own, or the derivatives of its stress, or the second ones of its energy.
template <Material Law, class S>
[[nodiscard]] Response<S> response(const Law& law, const Tensor<S>& F, const PointOf<Law, S>& point) {
  if constexpr (GivesResponse<Law, S>) {
    if constexpr (needs_point<Law>)
      return law.response(F, point);
    else
      return law.response(F);
  } else if constexpr (GivesStress<Law, S>) {
    using D = Dual<S, 9>;
    const Tensor<D> P = stress(law, detail::variables(F), cast_point<Law, D, S>(point));
    Response<S> r;
    for (std::size_t p = 0; p < 9; ++p) {
      r.P.m[p] = P.m[p].value;
      for (std::size_t q = 0; q < 9; ++q) r.A[9 * p + q] = P.m[p].d[q];
    }
    return r;
  } else {
    using J = Jet<S, 9>;
    Tensor<J> x;
    for (std::size_t p = 0; p < 9; ++p) x.m[p] = J::variable(F.m[p], static_cast<int>(p));
    const J W = energy(law, x, cast_point<Law, J, S>(point));
    Response<S> r;
    r.P.m = W.d;
    for (std::size_t p = 0; p < 9; ++p)
      for (std::size_t q = p; q < 9; ++q) r.A[9 * p + q] = r.A[9 * q + p] = W.h[J::pair(p, q)];
    return r;
  }
}

/// r += P and A of a pressure: p cof F, and U'' cof F x cof F + p d cof F/dF with
/// d2J/dF_iJ dF_kL = e_ikm e_JLN F_mN, which holds for every J, also 0.
/// `slope` is p = U'(J), `curvature` is U''(J) [Pa].
template <class S>
void add_volumetric(const S& slope, const S& curvature, const Tensor<S>& F, const Tensor<S>& cof,
                    Response<S>& r) {
  TUNICA_UNROLL
  for (std::size_t p = 0; p < 9; ++p) {
    r.P.m[p] += slope * cof.m[p];
    const S bulk = curvature * cof.m[p];
    TUNICA_UNROLL
    for (std::size_t q = 0; q < 9; ++q) r.A[9 * p + q] += bulk * cof.m[q];
  }
  TUNICA_UNROLL
  for (std::size_t p = 0; p < 9; ++p) {
    const std::size_t i = p / 3, J = p % 3;  // the blocks of rows i+1, i+2 and columns J+1, J+2
    const std::size_t i1 = 3 * ((i + 1) % 3), i2 = 3 * ((i + 2) % 3), J1 = (J + 1) % 3, J2 = (J + 2) % 3;
    const S pF = slope * F.m[p];
    r.A[9 * (i1 + J1) + i2 + J2] += pF;
    r.A[9 * (i2 + J2) + i1 + J1] += pF;
    r.A[9 * (i1 + J2) + i2 + J1] -= pF;
    r.A[9 * (i2 + J1) + i1 + J2] -= pF;
  }
}

/// Whether the response of a law depends on what was before: then its points change from step to step.
template <class Law>
concept HasHistory = requires(Law& law, const Law& fixed, const Tensor<double>& F,
                              const PointOf<Law, double>& point) {
  law.begin_step(0.0);
  { fixed.advance(F, point) } -> std::convertible_to<PointOf<Law, double>>;
};

/// Tells a law with history how long the next step is [s]; all others do not care.
template <class Law>
void begin_step(Law& law, double dt) {
  if constexpr (HasHistory<Law>) law.begin_step(dt);
}

/// What a point holds at the end of a step that went to F; without history it stays as it is.
template <class Law, class S>
[[nodiscard]] PointOf<Law, S> advance(const Law& law, const Tensor<S>& F, const PointOf<Law, S>& point) {
  if constexpr (HasHistory<Law>)
    return law.advance(F, point);
  else
    return point;
}

template <Material Law, class S>
requires(!needs_point<Law>) [[nodiscard]] S energy(const Law& law, const Tensor<S>& F) {
  return energy(law, F, NoPoint<S>{});
}
template <Material Law, class S>
requires(!needs_point<Law>) [[nodiscard]] Tensor<S> stress(const Law& law, const Tensor<S>& F) {
  return stress(law, F, NoPoint<S>{});
}
template <Material Law, class S>
requires(!needs_point<Law>) [[nodiscard]] Response<S> response(const Law& law, const Tensor<S>& F) {
  return response(law, F, NoPoint<S>{});
}

}  // namespace tunica::solid
