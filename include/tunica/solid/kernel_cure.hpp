// SPDX-License-Identifier: MIT
// What a cure of locking does at the points of an element and at their end, for the kernel.
#pragma once

#include "tunica/core/select.hpp"
#include "tunica/solid/element.hpp"
#include "tunica/solid/kernel_bar.hpp"
#include "tunica/solid/kernel_volume.hpp"
#include "tunica/solid/locking.hpp"
#include "tunica/solid/material.hpp"

#include <array>
#include <cstddef>
#include <type_traits>

namespace tunica::solid {

template <mesh::Cell C, class Locking, class Rule>
struct KernelCure {
  static constexpr int nodes = C::nodes, dim = C::dim, modes = volume_modes<Locking, dim>;
  static constexpr bool keeps = modes > 0, centred = std::is_same_v<Locking, CentreVolume>,
                        bar = centred || std::is_same_v<Locking, FBar>;
  template <class S>
  using Nodal = NodeVectors<S, C>;
  template <class S>
  using Pressures = std::array<S, std::size_t{modes}>;
  template <class S>
  struct Forces : KeptVolume<S, Locking, nodes, dim> {
    S f[nodes][dim];
    S smallest_J;
  };

  struct Nothing {
    template <class Nodes, class Other>
    Nothing(const Nodes&, const Other&) {}
  };
  template <class S>
  using Centre = std::conditional_t<bar, BarCentre<C, S>, Nothing>;
  template <class S, class L>
  struct ModesOf {
    using type = std::conditional_t<keeps, ConstantMode<C, Rule, S>, Nothing>;
  };
  template <class S>
  struct ModesOf<S, LinearVolume> {
    using type = LinearModes<C, Rule, S>;
  };
  template <class S>
  using Modes = typename ModesOf<S, Locking>::type;

  template <class S>
  [[nodiscard]] TUNICA_INLINE static Tensor<S> deformation(ElementPoint<S, C>& at, const Nodal<S>& u,
                                                           const Tensor<S>* stored, std::size_t q) {
    if (!stored) return at.deformation(u);
    at.free_of_stress(stored[q]);
    return stored[q] + at.gradient(u);
  }

  /// A point with its deformation; it adds to what the element keeps of its volume.
  template <class S>
  struct Here {
    ElementPoint<S, C> at;
    Tensor<S> F, cof;
    S J;

    TUNICA_INLINE Here(const Nodal<S>& X, const Nodal<S>& u, const Tensor<S>* stored, std::size_t q,
                       const Modes<S>& modes_at, Forces<S>& out)
        : at(element_point<C, Rule>(X, q)), F(KernelCure::deformation(at, u, stored, q)), cof(cofactor(F)) {
      J = F.m[0] * cof.m[0] + F.m[1] * cof.m[1] + F.m[2] * cof.m[2];
      out.smallest_J = q == 0 ? J : select(J < out.smallest_J, J, out.smallest_J);
      if constexpr (keeps) {
        out.volume += at.weight;
        for (std::size_t i = 0; i < modes; ++i) {
          const S weight = modes_at.times(at.weight, q, i);
          out.theta[i] += weight * (J - S(1));
          at.add_forces(cof, weight, out.slope[i]);
        }
      }
    }
  };

  template <class S>
  TUNICA_INLINE static void start(Forces<S>& out) {
    for (int a = 0; a < nodes; ++a)
      for (int i = 0; i < dim; ++i) out.f[a][i] = S(0);
    if constexpr (keeps) {
      out.volume = S(0);
      for (std::size_t k = 0; k < modes; ++k) {
        out.theta[k] = S(0);
        for (int a = 0; a < nodes; ++a)
          for (int i = 0; i < dim; ++i) out.slope[k][a][i] = S(0);
      }
    }
  }
  /// theta, p and bulk of what the points have added.
  template <class Law, class S>
  TUNICA_INLINE static void close(const Law& law, const Modes<S>& modes_at, const Centre<S>& centre,
                                  Forces<S>& out) {
    if constexpr (centred) {
      out.theta[0] = centre.J0;
      out.p[0] = law.volumetric.slope(centre.J0);
      out.bulk[0][0] = law.volumetric.curvature(centre.J0);
      for (int a = 0; a < nodes; ++a)
        for (int i = 0; i < dim; ++i) out.trial[a][i] = centre.J0 * centre.g0[a][i];
    } else if constexpr (keeps) {
      modes_at.close(law.volumetric, out);
    }
  }
  template <class Law, class S>
  TUNICA_INLINE static void finish(const Law& law, const Modes<S>& modes_at, const Centre<S>& centre,
                                   Forces<S>& out) {
    close(law, modes_at, centre, out);
    if constexpr (keeps)
      for (std::size_t k = 0; k < modes; ++k)
        for (int a = 0; a < nodes; ++a)
          for (int i = 0; i < dim; ++i) out.f[a][i] += out.p[k] * out.slope[k][a][i];
  }
  /// dp_i = sum_j gain_ij change_j
  template <class S>
  [[nodiscard]] TUNICA_INLINE static Pressures<S> pressure_changes(const Forces<S>& out,
                                                                   const Pressures<S>& change) {
    Pressures<S> dp{};
    if constexpr (keeps)
      for (std::size_t i = 0; i < modes; ++i)
        for (std::size_t j = 0; j < modes; ++j) dp[i] += out.gain(i, j) * change[j];
    return dp;
  }

  /// The pressures at u, which points need before they are visited.
  template <class Law, class S>
  [[nodiscard]] TUNICA_INLINE static Pressures<S> pressures(const Law& law, const Nodal<S>& X,
                                                            const Nodal<S>& u, const Tensor<S>* stored,
                                                            const Modes<S>& modes_at,
                                                            const Centre<S>& centre) {
    if constexpr (centred) {
      return {law.volumetric.slope(centre.J0)};
    } else if constexpr (keeps) {
      Nodal<S> x;
      for (int a = 0; a < nodes; ++a)
        for (int i = 0; i < dim; ++i) x[a][i] = X[a][i] + u[a][i];
      return modes_at.pressures(law.volumetric, X, x, stored);
    } else {
      return {};
    }
  }

  /// F as the law sees it.
  template <class S>
  [[nodiscard]] TUNICA_INLINE static Tensor<S> seen(const Here<S>& here, const Centre<S>& centre) {
    if constexpr (bar)
      return centre.scaled(centre.ratio(here.J), here.F);
    else
      return here.F;
  }
  /// P and A of `seen` F become those of the cure, but for the part of the pressures in P.
  template <class S>
  TUNICA_INLINE static void cure(const Here<S>& here, const Pressures<S>& p, std::size_t q,
                                 const Modes<S>& modes_at, Centre<S>& centre, Response<S>& r) {
    if constexpr (bar) centre.see_through(here.F, here.cof, here.J, r);
    if constexpr (keeps) add_pressure(modes_at.at(p, q), here.F, r);
  }
};

}  // namespace tunica::solid
