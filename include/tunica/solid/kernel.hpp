// SPDX-License-Identifier: MIT
// The element kernel of every hyperelastic solid: one template over cell, law, cure of locking and scalar.
#pragma once

#include "tunica/solid/element.hpp"
#include "tunica/solid/isochoric_part.hpp"
#include "tunica/solid/kernel_blocks.hpp"
#include "tunica/solid/kernel_cure.hpp"
#include "tunica/solid/kernel_terms.hpp"
#include "tunica/solid/material.hpp"

#include <array>
#include <cstddef>
#include <type_traits>

namespace tunica::solid {

/// f = int P G dV [N], K = df/du [N/m], K v without K, and the energy [J]. Cells in space or, as plane strain
/// of unit depth, in the plane. S is double, float, a pack (a lane an element), a dual or Counted. Nothing is
/// allocated, nothing is virtual. A law is a Material; what it reads at the points of the rule stands in
/// `data`, an array of `points` entries, or nullptr for a law that reads nothing. `stored`: nullptr, or the
/// deformation F_p of a prestress at each point; the reference carries it, F = (1 + du/dX) F_p, and volumes
/// and energies are those of the body free of stress (not for FBar and CentreVolume).
///   using K = Kernel<Hex8>;  K::Tangent<S> out;  K::tangent(law, X, u, data, out);   // X, u: S[8][3]
/// The blocks of K are those that fem::BlockAssembly adds: add_symmetric where a <= b, add for FBar and
/// CentreVolume. `smallest_J` not positive, or NaN: the rest is of no use.
template <mesh::Cell C, class Locking = Pointwise, class Rule = StiffnessRule<C>>
struct Kernel {
  using Cell = C;
  using Quadrature = Rule;
  using Cure = KernelCure<C, Locking, Rule>;
  static constexpr int nodes = C::nodes, dim = C::dim, points = Rule::size;
  /// Pressures that an element keeps.
  static constexpr int modes = Cure::modes;
  static constexpr bool keeps = Cure::keeps, centred = Cure::centred, bar = Cure::bar;
  using Places = BlockPlaces<nodes, Locking::blocks>;
  static_assert(dim == 2 || dim == 3, "a solid is made of cells in the plane or in space");

  template <class S>
  using Nodal = NodeVectors<S, C>;
  /// What a law reads at a point.
  template <class Law, class S>
  using Data = PointOf<Law, S>;
  template <class S>
  using Forces = typename Cure::template Forces<S>;
  template <class S>
  struct Tangent : Forces<S> {
    S K[Places::count][dim * dim];
  };
  template <class S>
  using Pressures = typename Cure::template Pressures<S>;

  template <class Law, class S>
  [[nodiscard]] static S energy(const Law& law, const Nodal<S>& X, const Nodal<S>& u,
                                const Data<Law, S>* data, const Tensor<S>* stored = nullptr) requires(!bar) {
    S sum(0), volume(0);
    Pressures<S> growth{};  // int phi_i (J - 1) dV
    const Modes<S> modes_at(X, stored);
    for (std::size_t q = 0; q < points; ++q) {
      auto at = element_point<C, Rule>(X, q);
      const Tensor<S> F = Cure::deformation(at, u, stored, q);
      sum += at.weight * solid::energy(part(law), F, point<Law, S>(data, q));
      if constexpr (keeps) {
        volume += at.weight;
        const S dv = at.weight * (determinant(F) - S(1));
        for (std::size_t i = 0; i < modes; ++i) growth[i] += modes_at.times(dv, q, i);
      }
    }
    if constexpr (keeps) sum += modes_at.energy(law.volumetric, growth, volume);
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
    Cure::start(out);
    const Modes<S> modes_at(X, stored);
    const Centre<S> centre(X, u);
    for (std::size_t q = 0; q < points; ++q) {
      const Here<S> here(X, u, stored, q, modes_at, out);
      S weight = here.at.weight;
      if constexpr (bar) weight *= centre.stress_factor(centre.ratio(here.J));
      here.at.add_forces(solid::stress(part(law), Cure::seen(here, centre), point<Law, S>(data, q)), weight,
                         out.f);
    }
    Cure::finish(law, modes_at, centre, out);
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
    tangent_at<Law, S>(law, X, u, data, stored, nullptr, out);
  }
  /// The same with other pressures p_i [Pa] in its geometric part, as Newton on (u, theta, p) predicts them;
  /// the forces are those at U'(theta).
  template <class Law, class S>
  static void tangent(const Law& law, const Nodal<S>& X, const Nodal<S>& u, const Data<Law, S>* data,
                      const Pressures<S>& p, Tangent<S>& out) requires keeps {
    tangent_at<Law, S>(law, X, u, data, nullptr, &p, out);
  }
  template <class Law, class S>
  static void tangent(const Law& law, const Nodal<S>& X, const Nodal<S>& u, const Data<Law, S>* data,
                      const Tensor<S>* stored, const Pressures<S>& p, Tangent<S>& out) requires keeps {
    tangent_at(law, X, u, data, stored, &p, out);
  }

  /// body(q, sigma, volume): Cauchy stress at each point [Pa] and the growth volume of the point [m^dim];
  /// sigma = P F^T / J, with the pressures that are kept and the F of FBar.
  template <class Law, class S, class Body>
  static void for_each_stress(const Law& law, const Nodal<S>& X, const Nodal<S>& u, const Data<Law, S>* data,
                              const Tensor<S>* stored, Body&& body) {
    Forces<S> sums;
    Cure::start(sums);
    const Modes<S> modes_at(X, stored);
    const Centre<S> centre(X, u);
    const auto p = Cure::pressures(law, X, u, stored, modes_at, centre);
    for (std::size_t q = 0; q < points; ++q) {
      const Here<S> here(X, u, stored, q, modes_at, sums);
      const Tensor<S> F = Cure::seen(here, centre);
      Tensor<S> sigma = (S(1) / determinant(F)) *
                        product(solid::stress(part(law), F, point<Law, S>(data, q)), transpose(F));
      if constexpr (keeps)
        for (std::size_t k = 0; k < 9; k += 4) sigma.m[k] += modes_at.at(p, q);
      body(q, sigma, here.at.weight * here.J);
    }
  }

  /// Kv = K v at u; pressures are those at U'(theta).
  template <class Law, class S>
  static void action(const Law& law, const Nodal<S>& X, const Nodal<S>& u, const Data<Law, S>* data,
                     const Nodal<S>& v, Nodal<S>& Kv) {
    action<Law, S>(law, X, u, data, nullptr, v, Kv);
  }
  template <class Law, class S>
  static void action(const Law& law, const Nodal<S>& X, const Nodal<S>& u, const Data<Law, S>* data,
                     const Tensor<S>* stored, const Nodal<S>& v, Nodal<S>& Kv) {
    Forces<S> out;
    Cure::start(out);
    const Modes<S> modes_at(X, stored);
    Centre<S> centre(X, u);
    const auto p = Cure::template pressures<Law, S>(law, X, u, stored, modes_at, centre);
    S divergence(0);
    Pressures<S> change{};  // rate_i . v
    if constexpr (bar) divergence = centre.divergence(v);
    for (std::size_t q = 0; q < points; ++q) {
      const Here<S> here(X, u, stored, q, modes_at, out);
      Response<S> r = solid::response(part(law), Cure::seen(here, centre), point<Law, S>(data, q));
      Cure::cure(here, p, q, modes_at, centre, r);
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
      if constexpr (keeps && !centred)
        for (std::size_t i = 0; i < modes; ++i)
          change[i] += modes_at.times(here.at.weight, q, i) * double_dot(here.cof, H);
    }
    Cure::close(law, modes_at, centre, out);
    if constexpr (centred) change[0] = centre.J0 * divergence;
    const auto dp = Cure::pressure_changes(out, change);
    for (int a = 0; a < nodes; ++a)
      for (int i = 0; i < dim; ++i) {
        S sum = out.f[a][i];
        if constexpr (keeps)
          for (std::size_t k = 0; k < modes; ++k) sum += dp[k] * out.slope[k][a][i];
        Kv[a][i] = sum;
      }
  }

 private:
  template <class S>
  using Centre = typename Cure::template Centre<S>;
  template <class S>
  using Modes = typename Cure::template Modes<S>;
  template <class S>
  using Here = typename Cure::template Here<S>;

  /// Only the isochoric law stands in the points of an element that keeps its pressures.
  template <class Law>
  [[nodiscard]] TUNICA_INLINE static const auto& part(const Law& law) {
    if constexpr (keeps)
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

  template <class Law, class S>
  static void tangent_at(const Law& law, const Nodal<S>& X, const Nodal<S>& u, const Data<Law, S>* data,
                         const Tensor<S>* stored, const Pressures<S>* given, Tangent<S>& out) {
    Cure::start(out);
    const Modes<S> modes_at(X, stored);
    Centre<S> centre(X, u);
    const Pressures<S> p = given ? *given : Cure::pressures(law, X, u, stored, modes_at, centre);
    for (std::size_t q = 0; q < points; ++q) {
      const Here<S> here(X, u, stored, q, modes_at, out);
      if constexpr (std::is_same_v<Locking, Pointwise> && GivesThreeTerms<Law, S>) {
        const auto r = law.three_terms(here.F);
        here.at.add_forces(r.P, here.at.weight, out.f);
        q == 0 ? add_three_terms<false>(r, here.at, out.K) : add_three_terms<true>(r, here.at, out.K);
      } else {
        Response<S> r = solid::response(part(law), Cure::seen(here, centre), point<Law, S>(data, q));
        Cure::cure(here, p, q, modes_at, centre, r);
        here.at.add_forces(r.P, here.at.weight, out.f);
        if constexpr (bar) here.at.add_forces(centre.M, here.at.weight, centre.middle);
        if (q == 0)
          add_tangent<Locking::blocks, false>(r.A.data(), here.at.G, here.at.weight, out.K);
        else
          add_tangent<Locking::blocks, true>(r.A.data(), here.at.G, here.at.weight, out.K);
      }
    }
    Cure::finish(law, modes_at, centre, out);
    if constexpr (bar) add_products<Locking::blocks>(S(1), centre.middle, centre.g0, out.K);
    if constexpr (modes == 1)
      add_products<Locking::blocks>(out.gain(0, 0), out.slope[0], out.rate(0), out.K);
    else if constexpr (keeps)
      for (std::size_t i = 0; i < modes; ++i) {
        S row[nodes][dim];  // sum_j bulk_ij slope_j
        for (int a = 0; a < nodes; ++a)
          for (int k = 0; k < dim; ++k) {
            row[a][k] = out.bulk[i][0] * out.slope[0][a][k];
            for (std::size_t j = 1; j < modes; ++j) row[a][k] += out.bulk[i][j] * out.slope[j][a][k];
          }
        add_products<Locking::blocks>(S(1) / out.volume, out.slope[i], row, out.K);
      }
  }
};

}  // namespace tunica::solid
