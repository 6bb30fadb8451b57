// SPDX-License-Identifier: MIT
// The linear tetrahedron with linear pressures, stabilised by their projection [DOHRMANN04]: it does not
// lock.
#pragma once

#include "tunica/core/unroll.hpp"
#include "tunica/mesh/cell.hpp"
#include "tunica/solid/element.hpp"
#include "tunica/solid/isochoric_part.hpp"
#include "tunica/solid/kernel_blocks.hpp"
#include "tunica/solid/locking.hpp"
#include "tunica/solid/material.hpp"

#include <cstddef>
#include <type_traits>

namespace tunica::solid {

/// Displacements u (metres) and scaled pressures q = p / scale (metres), both linear:
///   Pi(u, p) = int Phi_iso(F) + p (J - 1) - U*(p) - (p - mean p)^2/(2 mu) dV,
/// with the complementary energy U*(p) = max_J [p (J - 1) - U(J)]. Its stationary point is p = U'(J) up to
/// the last term, which controls the part of p that linear displacements cannot. It holds no length and
/// stays definite in p for kappa = infinity. The matrix is symmetric, definite in u where the body is stable
/// and negative definite in p. Of any law in two parts and any scalar, as Kernel; U* is integrated with four
/// points, exactly where it is a square.
///   MixedTet::Tangent<S> out;  MixedTet::tangent(law, moduli, X, u, q, data, stored, out);
struct MixedTet {
  using Cell = mesh::Tet4;
  using Quadrature = StiffnessRule<Cell>;
  static constexpr int nodes = 4, size = 4, points = 1;  // size: unknowns of a node
  using Places = BlockPlaces<nodes, Blocks::upper>;

  template <class S>
  using Nodal = NodeVectors<S, Cell>;
  template <class S>
  using Pressures = S[nodes];
  /// F_p of a prestress as for Kernel, or nullptr.
  template <class S>
  using Stored = const std::type_identity_t<Tensor<S>>*;

  /// Of the law, and the scale of q.
  struct Moduli {
    double mu;              // shear modulus at rest [Pa]
    double pressure_scale;  // mu over a length of the mesh [Pa/m]
  };

  /// Of each node the three forces and dPi/dq [N].
  template <class S>
  struct Forces {
    S f[nodes][size];
    S J;
  };
  /// The blocks of d2Pi [N/m] that fem::BlockAssembly<Tet4, 4>::add_symmetric takes.
  template <class S>
  struct Tangent : Forces<S> {
    S K[Places::count][size * size];
  };

  /// Pi [J]
  template <class Law, class S>
  [[nodiscard]] static S energy(const Law& law, const Moduli& moduli, const Nodal<S>& X, const Nodal<S>& u,
                                const Pressures<S>& q, const PointOf<Law, S>& data,
                                Stored<S> stored = nullptr) {
    const Here<S> here(moduli, X, u, q, stored);
    S sum = solid::energy(law.isochoric, here.F, data) + here.mean * (here.J - S(1)), lost(0);
    const S away = S(1 / (20 * moduli.mu));  // int (N_a - 1/4)(N_b - 1/4) dV = V/80 (4 d_ab - 1)
    for (int a = 0; a < nodes; ++a) {
      const S off = here.p[a] - here.mean;
      lost += S(0.25) * law.volumetric.complement(here.at_point(a)).energy + S(0.5) * away * off * off;
    }
    return here.at.weight * (sum - lost);
  }

  template <class Law, class S>
  static void forces(const Law& law, const Moduli& moduli, const Nodal<S>& X, const Nodal<S>& u,
                     const Pressures<S>& q, const PointOf<Law, S>& data, Stored<S> stored, Forces<S>& out) {
    const Here<S> here(moduli, X, u, q, stored);
    Tensor<S> P = solid::stress(law.isochoric, here.F, data);
    P += here.mean * here.cof;
    add_forces(here, P, out);
    S dilatation[nodes];
    for (int a = 0; a < nodes; ++a) dilatation[a] = law.volumetric.complement(here.at_point(a)).dilatation;
    add_constraint(moduli, here, dilatation, out);
  }

  template <class Law, class S>
  static void tangent(const Law& law, const Moduli& moduli, const Nodal<S>& X, const Nodal<S>& u,
                      const Pressures<S>& q, const PointOf<Law, S>& data, Stored<S> stored, Tangent<S>& out) {
    const Here<S> here(moduli, X, u, q, stored);
    Response<S> r = solid::response(law.isochoric, here.F, data);
    r.P += here.mean * here.cof;
    add_pressure(here.mean, here.F, r);
    add_forces(here, r.P, out);
    S K[Places::count][9], slope[nodes][3] = {};
    add_tangent<Blocks::upper, false>(r.A.data(), here.at.G, here.at.weight, K);
    // dJ/du_a at each of the four pressures
    here.at.add_forces(here.cof, S(0.25 * moduli.pressure_scale) * here.at.weight, slope);

    S dilatation[nodes], compliance[nodes], sum(0);
    for (int a = 0; a < nodes; ++a) {
      const auto complement = law.volumetric.complement(here.at_point(a));
      dilatation[a] = complement.dilatation;
      compliance[a] = complement.compliance;
      sum += compliance[a];
    }
    add_constraint(moduli, here, dilatation, out);
    // int N_a N_b c dV with N_a = far + (near - far) d_aq at point q, V/4 each
    const S unit = S(-moduli.pressure_scale * moduli.pressure_scale) * here.at.weight;
    const S even = S(0.25 * far * far) * sum, away = S(1 / (80 * moduli.mu));
    for (int a = 0; a < nodes; ++a)
      for (int b = a; b < nodes; ++b) {
        const int ab = Places::place(a, b);
        S C = even + S(0.25 * far * (near - far)) * (compliance[a] + compliance[b]) - away;
        if (a == b) C += S(0.25 * (near - far) * (near - far)) * compliance[a] + S(4) * away;
        S* const to = out.K[ab];
        TUNICA_UNROLL
        for (int i = 0; i < 3; ++i) {
          for (int k = 0; k < 3; ++k) to[4 * i + k] = K[ab][3 * i + k];
          to[4 * i + 3] = slope[a][i];
          to[12 + i] = slope[b][i];
        }
        to[15] = unit * C;
      }
  }

  /// Cauchy stress in the middle, the deviator of the law and the mean of the pressures of the nodes [Pa];
  /// `volume` is the current one [m3].
  template <class Law, class S>
  [[nodiscard]] static Tensor<S> stress(const Law& law, const Moduli& moduli, const Nodal<S>& X,
                                        const Nodal<S>& u, const Pressures<S>& q, const PointOf<Law, S>& data,
                                        Stored<S> stored, S& volume) {
    const Here<S> here(moduli, X, u, q, stored);
    Tensor<S> sigma =
        (S(1) / here.J) * product(solid::stress(law.isochoric, here.F, data), transpose(here.F));
    for (std::size_t k = 0; k < 9; k += 4) sigma.m[k] += here.mean;
    volume = here.at.weight * here.J;
    return sigma;
  }

 private:
  // The rule of four points: of the shape functions one is near 1, three are far from it.
  static constexpr double near = 0.58541019662496845446, far = 0.13819660112501051518;

  template <class S>
  struct Here {
    ElementPoint<S, Cell> at;
    Tensor<S> F, cof;
    S J, mean;
    S p[nodes];

    TUNICA_INLINE Here(const Moduli& moduli, const Nodal<S>& X, const Nodal<S>& u, const Pressures<S>& q,
                       const Tensor<S>* stored)
        : at(element_point<Cell, Quadrature>(X, 0)) {
      if (stored) {
        at.free_of_stress(*stored);
        F = *stored + at.gradient(u);
      } else {
        F = at.deformation(u);
      }
      cof = cofactor(F);
      J = F.m[0] * cof.m[0] + F.m[1] * cof.m[1] + F.m[2] * cof.m[2];
      for (int a = 0; a < nodes; ++a) p[a] = S(moduli.pressure_scale) * q[a];
      mean = S(0.25) * ((p[0] + p[1]) + (p[2] + p[3]));
    }
    [[nodiscard]] TUNICA_INLINE S at_point(int a) const { return S(4 * far) * mean + S(near - far) * p[a]; }
  };

  // f_a = V P G_a
  template <class S>
  TUNICA_INLINE static void add_forces(const Here<S>& here, const Tensor<S>& P, Forces<S>& out) {
    out.J = here.J;
    S f[nodes][3] = {};
    here.at.add_forces(P, here.at.weight, f);
    for (int a = 0; a < nodes; ++a)
      for (int i = 0; i < 3; ++i) out.f[a][i] = f[a][i];
  }

  // dPi/dq_a = scale V ((J - 1)/4 - mean of N_a U*' - (p_a - mean p)/(20 mu))
  template <class S>
  TUNICA_INLINE static void add_constraint(const Moduli& moduli, const Here<S>& here,
                                           const S (&dilatation)[nodes], Forces<S>& out) {
    const S sum = (dilatation[0] + dilatation[1]) + (dilatation[2] + dilatation[3]);
    const S even = S(0.25) * (here.J - S(1)) - S(0.25 * far) * sum,
            unit = S(moduli.pressure_scale) * here.at.weight;
    for (int a = 0; a < nodes; ++a)
      out.f[a][3] = unit * (even - S(0.25 * (near - far)) * dilatation[a] -
                            S(1 / (20 * moduli.mu)) * (here.p[a] - here.mean));
  }
};

}  // namespace tunica::solid
