// SPDX-License-Identifier: MIT
// The element kernel of every hyperelastic solid: one template over cell, law, cure of locking and scalar.
#pragma once

#include "tunica/core/select.hpp"
#include "tunica/solid/element.hpp"
#include "tunica/solid/isochoric_part.hpp"
#include "tunica/solid/kernel_bar.hpp"
#include "tunica/solid/kernel_blocks.hpp"
#include "tunica/solid/kernel_terms.hpp"
#include "tunica/solid/locking.hpp"
#include "tunica/solid/material.hpp"

#include <cstddef>
#include <type_traits>

namespace tunica::solid {

/// f = int P G dV [N], K = df/du [N/m], K v without K, and the energy [J]. Cells in space or, as plane strain
/// of unit depth, in the plane. S is double, float, a pack (a lane an element), a dual or Counted. Nothing is
/// allocated, nothing is virtual. A law is a Material; what it reads at the points of the rule stands in
/// `data`, an array of `points` entries, or nullptr for a law that reads nothing. `stored`: nullptr, or the
/// deformation F_p of a prestress at each point; the reference carries it, F = (1 + du/dX) F_p, and volumes
/// and energies are those of the body free of stress (not for FBar).
///   using K = Kernel<Hex8>;  K::Tangent<S> out;  K::tangent(law, X, u, data, out);   // X, u: S[8][3]
/// The blocks of K are those that fem::BlockAssembly adds: add_symmetric where a <= b, add for FBar.
/// `smallest_J` not positive, or NaN: the rest is of no use.
template <mesh::Cell C, class Locking = Pointwise, class Rule = StiffnessRule<C>>
struct Kernel {
  using Cell = C;
  using Quadrature = Rule;
  static constexpr int nodes = C::nodes, dim = C::dim, points = Rule::size;
  using Places = BlockPlaces<nodes, Locking::blocks>;
  static constexpr bool mean = std::is_same_v<Locking, MeanVolume>, bar = std::is_same_v<Locking, FBar>;
  static_assert(dim == 2 || dim == 3, "a solid is made of cells in the plane or in space");

  template <class S>
  using Nodal = NodeVectors<S, C>;
  /// What a law reads at a point.
  template <class Law, class S>
  using Data = PointOf<Law, S>;
  template <class S>
  struct Forces : ElementMean<S, Locking, nodes, dim> {
    S f[nodes][dim];
    S smallest_J;
  };
  template <class S>
  struct Tangent : Forces<S> {
    S K[Places::count][dim * dim];
  };

  template <class Law, class S>
  [[nodiscard]] static S energy(const Law& law, const Nodal<S>& X, const Nodal<S>& u,
                                const Data<Law, S>* data, const Tensor<S>* stored = nullptr) requires(!bar) {
    S sum(0), volume(0), current(0);
    for (std::size_t q = 0; q < points; ++q) {
      auto at = element_point<C, Rule>(X, q);
      const Tensor<S> F = deformation(at, u, stored, q);
      sum += at.weight * solid::energy(part(law), F, point<Law, S>(data, q));
      if constexpr (mean) volume += at.weight, current += at.weight * determinant(F);
    }
    if constexpr (mean) sum += volume * law.volumetric.energy(current / volume);
    return sum;
  }

  template <class Law, class S>
  static void forces(const Law& law, const Nodal<S>& X, const Nodal<S>& u, const Data<Law, S>* data,
                     Forces<S>& out) {
    forces<Law, S>(law, X, u, data, nullptr, out);
  }
  template <class Law, class S>
  static void forces(const Law& law, const Nodal<S>& X, const Nodal<S>& u, const Data<Law, S>* data,
                     const Tensor<S>* stored, Forces<S>& out) {
    start(out);
    const Centre<S> centre(X, u);
    for (std::size_t q = 0; q < points; ++q) {
      const Here<S> here(X, u, stored, q, out);
      S weight = here.at.weight;
      if constexpr (bar) weight *= centre.stress_factor(centre.ratio(here.J));
      here.at.add_forces(solid::stress(part(law), seen(here, centre), point<Law, S>(data, q)), weight, out.f);
    }
    finish(law, out);
  }

  /// The exact tangent.
  template <class Law, class S>
  static void tangent(const Law& law, const Nodal<S>& X, const Nodal<S>& u, const Data<Law, S>* data,
                      Tangent<S>& out) {
    tangent<Law, S>(law, X, u, data, nullptr, out);
  }
  template <class Law, class S>
  static void tangent(const Law& law, const Nodal<S>& X, const Nodal<S>& u, const Data<Law, S>* data,
                      const Tensor<S>* stored, Tangent<S>& out) {
    tangent_at(law, X, u, data, stored, pressure(law, X, u, stored), out);
  }
  /// The same with another pressure p [Pa] in its geometric part, as Newton on (u, theta, p) predicts it; the
  /// forces are those at U'(theta).
  template <class Law, class S>
  static void tangent(const Law& law, const Nodal<S>& X, const Nodal<S>& u, const Data<Law, S>* data,
                      const S& p, Tangent<S>& out) requires mean {
    tangent_at<Law, S>(law, X, u, data, nullptr, p, out);
  }
  template <class Law, class S>
  static void tangent(const Law& law, const Nodal<S>& X, const Nodal<S>& u, const Data<Law, S>* data,
                      const Tensor<S>* stored, const S& p, Tangent<S>& out) requires mean {
    tangent_at(law, X, u, data, stored, p, out);
  }

  /// body(q, sigma, volume): Cauchy stress at each point [Pa] and the current volume of the point [m^dim];
  /// sigma = P F^T / J, with the pressure of MeanVolume and the F of FBar.
  template <class Law, class S, class Body>
  static void for_each_stress(const Law& law, const Nodal<S>& X, const Nodal<S>& u, const Data<Law, S>* data,
                              const Tensor<S>* stored, Body&& body) {
    Forces<S> sums;
    start(sums);
    const S p = pressure(law, X, u, stored);
    const Centre<S> centre(X, u);
    for (std::size_t q = 0; q < points; ++q) {
      const Here<S> here(X, u, stored, q, sums);
      const Tensor<S> F = seen(here, centre);
      Tensor<S> sigma = (S(1) / determinant(F)) *
                        product(solid::stress(part(law), F, point<Law, S>(data, q)), transpose(F));
      for (std::size_t k = 0; mean && k < 9; k += 4) sigma.m[k] += p;
      body(q, sigma, here.at.weight * here.J);
    }
  }

  /// Kv = K v at u; the pressure of MeanVolume is U'(theta).
  template <class Law, class S>
  static void action(const Law& law, const Nodal<S>& X, const Nodal<S>& u, const Data<Law, S>* data,
                     const Nodal<S>& v, Nodal<S>& Kv) {
    const S p = pressure<Law, S>(law, X, u, nullptr);
    Forces<S> out;
    start(out);
    Centre<S> centre(X, u);
    S divergence(0), dv(0);
    if constexpr (bar) divergence = centre.divergence(v);
    for (std::size_t q = 0; q < points; ++q) {
      const Here<S> here(X, u, nullptr, q, out);
      Response<S> r = solid::response(part(law), seen(here, centre), point<Law, S>(data, q));
      cure(here, p, centre, r);
      const Tensor<S> H = here.at.gradient(v);
      Tensor<S> dP;
      for (int row = 0; row < 9; ++row) {
        if (row / 3 >= dim || row % 3 >= dim) continue;
        S sum(0);
        if constexpr (bar) sum = centre.M.m[static_cast<std::size_t>(row)] * divergence;
#pragma GCC unroll 3
        for (int k = 0; k < dim; ++k)
#pragma GCC unroll 3
          for (int L = 0; L < dim; ++L) sum += r.A[static_cast<std::size_t>(9 * row + 3 * k + L)] * H(k, L);
        dP.m[static_cast<std::size_t>(row)] = sum;
      }
      here.at.add_forces(dP, here.at.weight, out.f);
      if constexpr (mean) dv += here.at.weight * double_dot(here.cof, H);
    }
    if constexpr (mean) dv *= law.volumetric.curvature(out.theta / out.volume) / out.volume;
    for (int a = 0; a < nodes; ++a)
      for (int i = 0; i < dim; ++i)
        if constexpr (mean)
          Kv[a][i] = out.f[a][i] + dv * out.slope[a][i];
        else
          Kv[a][i] = out.f[a][i];
  }

 private:
  struct Nothing {
    template <class Nodes>
    Nothing(const Nodes&, const Nodes&) {}
  };
  template <class S>
  using Centre = std::conditional_t<bar, BarCentre<C, S>, Nothing>;

  /// Only the laws of the isochoric part stand in the points of MeanVolume.
  template <class Law>
  [[nodiscard]] TUNICA_INLINE static const auto& part(const Law& law) {
    if constexpr (mean)
      return law.isochoric;
    else
      return law;
  }
  template <class Law, class S>
  [[nodiscard]] TUNICA_INLINE static Data<Law, S> point(const Data<Law, S>* data, std::size_t q) {
    if constexpr (needs_point<Law>)
      return data[q];
    else
      return {};
  }

  template <class S>
  [[nodiscard]] TUNICA_INLINE static Tensor<S> deformation(ElementPoint<S, C>& at, const Nodal<S>& u,
                                                           const Tensor<S>* stored, std::size_t q) {
    if (!stored) return at.deformation(u);
    at.free_of_stress(stored[q]);
    return stored[q] + at.gradient(u);
  }

  /// A point with its deformation; it adds to what MeanVolume sums.
  template <class S>
  struct Here {
    ElementPoint<S, C> at;
    Tensor<S> F, cof;
    S J;

    TUNICA_INLINE Here(const Nodal<S>& X, const Nodal<S>& u, const Tensor<S>* stored, std::size_t q,
                       Forces<S>& out)
        : at(element_point<C, Rule>(X, q)), F(Kernel::deformation(at, u, stored, q)), cof(cofactor(F)) {
      J = F.m[0] * cof.m[0] + F.m[1] * cof.m[1] + F.m[2] * cof.m[2];
      out.smallest_J = q == 0 ? J : select(J < out.smallest_J, J, out.smallest_J);
      if constexpr (mean) {
        out.volume += at.weight;
        out.theta += at.weight * J;
        at.add_forces(cof, at.weight, out.slope);  // dv/du_a = int cof F G_a dV
      }
    }
  };

  template <class S>
  TUNICA_INLINE static void start(Forces<S>& out) {
    for (int a = 0; a < nodes; ++a)
      for (int i = 0; i < dim; ++i) out.f[a][i] = S(0);
    if constexpr (mean) {
      out.volume = out.theta = S(0);
      for (int a = 0; a < nodes; ++a)
        for (int i = 0; i < dim; ++i) out.slope[a][i] = S(0);
    }
  }
  template <class Law, class S>
  TUNICA_INLINE static void finish(const Law& law, Forces<S>& out) {
    if constexpr (mean) {
      out.theta = out.theta / out.volume;
      out.p = law.volumetric.slope(out.theta);
      out.bulk = law.volumetric.curvature(out.theta);
      for (int a = 0; a < nodes; ++a)
        for (int i = 0; i < dim; ++i) out.f[a][i] += out.p * out.slope[a][i];
    }
  }

  /// U'(v/V) of MeanVolume, which its points need before they are visited.
  template <class Law, class S>
  [[nodiscard]] TUNICA_INLINE static S pressure(const Law& law, const Nodal<S>& X, const Nodal<S>& u,
                                                const Tensor<S>* stored) {
    if constexpr (mean) {
      Nodal<S> x;
      for (int a = 0; a < nodes; ++a)
        for (int i = 0; i < dim; ++i) x[a][i] = X[a][i] + u[a][i];
      S volume = stored ? S(0) : element_volume<C, Rule, S>(X);
      for (std::size_t q = 0; stored && q < points; ++q)
        volume += element_point<C, Rule>(X, q).weight / determinant(stored[q]);
      return law.volumetric.slope(element_volume<C, Rule, S>(x) / volume);
    } else {
      return S(0);
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
  /// P and A of `seen` F become those of the cure.
  template <class S>
  TUNICA_INLINE static void cure(const Here<S>& here, const S& p, Centre<S>& centre, Response<S>& r) {
    if constexpr (bar) centre.see_through(here.F, here.cof, here.J, r);
    if constexpr (mean) add_pressure(p, here.F, r);
  }

  template <class Law, class S>
  static void tangent_at(const Law& law, const Nodal<S>& X, const Nodal<S>& u, const Data<Law, S>* data,
                         const Tensor<S>* stored, const S& p, Tangent<S>& out) {
    start(out);
    Centre<S> centre(X, u);
    for (std::size_t q = 0; q < points; ++q) {
      const Here<S> here(X, u, stored, q, out);
      if constexpr (std::is_same_v<Locking, Pointwise> && GivesThreeTerms<Law, S>) {
        const auto r = law.three_terms(here.F);
        here.at.add_forces(r.P, here.at.weight, out.f);
        q == 0 ? add_three_terms<false>(r, here.at, out.K) : add_three_terms<true>(r, here.at, out.K);
      } else {
        Response<S> r = solid::response(part(law), seen(here, centre), point<Law, S>(data, q));
        cure(here, p, centre, r);
        here.at.add_forces(r.P, here.at.weight, out.f);
        if constexpr (bar) here.at.add_forces(centre.M, here.at.weight, centre.middle);
        if (q == 0)
          add_tangent<Locking::blocks, false>(r.A.data(), here.at.G, here.at.weight, out.K);
        else
          add_tangent<Locking::blocks, true>(r.A.data(), here.at.G, here.at.weight, out.K);
      }
    }
    finish(law, out);
    if constexpr (mean) add_products<Locking::blocks>(out.bulk / out.volume, out.slope, out.slope, out.K);
    if constexpr (bar) add_products<Locking::blocks>(S(1), centre.middle, centre.g0, out.K);
  }
};

}  // namespace tunica::solid
