// SPDX-License-Identifier: MIT
// The linear tetrahedron with linear pressures, stabilised by their projection [DOHRMANN04]: it does not
// lock.
#pragma once

#include "tunica/core/tensor.hpp"
#include "tunica/solid/isochoric_part.hpp"

#include <array>
#include <cstddef>

namespace tunica::solid {

/// Displacements u (metres) and scaled pressures q = p / pressure_scale (metres), both linear:
///   Pi(u, p) = int Phi_iso(F) + p (J - 1) - p^2/(2 kappa) - (p - mean p)^2/(2 mu) dV,
/// whose stationary point is p = kappa (J - 1) up to the last term, which controls the part of p that linear
/// displacements cannot. It holds no length and stays definite in p for kappa = infinity. The matrix is
/// symmetric, definite in u where the body is stable and negative definite in p.
struct MixedTet {
  static constexpr std::size_t nodes = 4, displacements = 12, size = 16;

  /// X: reference nodes [m]; x: 12 displacements (node by node), then 4 values of q [m].
  template <class S>
  using Unknowns = std::array<S, size>;
  using Nodes = std::array<std::array<double, 3>, nodes>;

  template <class S>
  struct Forces {
    std::array<S, size> r{};  // dPi/d(u, q) [N]
    S J{}, p{};               // of the cell, p the mean [Pa]
  };
  template <class S>
  struct Tangent : Forces<S> {
    std::array<S, size * size> K{};  // d2Pi, row by row, symmetric [N/m]
  };

  std::array<std::array<double, 3>, nodes> gradient{};  // dN_a/dX [1/m]
  double volume = 0;                                    // of the reference, negative if inverted [m3]

  explicit MixedTet(const Nodes& X) {
    Tensor<double> edges;  // column k: X_{k+1} - X_0
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t i = 0; i < 3; ++i) edges.m[3 * i + k] = X[k + 1][i] - X[0][i];
    const double det = determinant(edges);
    const Tensor<double> co = cofactor(edges);  // columns: dN_{k+1}/dX times det
    volume = det / 6;
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t k = 0; k < 3; ++k) {
        gradient[k + 1][i] = co.m[3 * i + k] / det;
        gradient[0][i] -= gradient[k + 1][i];
      }
  }

  /// Moduli of the pressure: those of the law, and the scale of q [Pa/m].
  struct Moduli {
    double mu;              // initial shear modulus [Pa]
    double inverse_kappa;   // 0: incompressible [1/Pa]
    double pressure_scale;  // mu over a length of the mesh [Pa/m]
  };

  template <class S>
  [[nodiscard]] Tensor<S> deformation(const Unknowns<S>& x) const {
    Tensor<S> F = identity<S>();
    for (std::size_t a = 0; a < nodes; ++a)
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) F.m[3 * i + j] += x[3 * a + i] * S(gradient[a][j]);
    return F;
  }

  /// Pi [J]
  template <class Law, class S>
  [[nodiscard]] S energy(const Law& isochoric, const PointOf<Law, S>& point, const Moduli& moduli,
                         const Unknowns<S>& x) const {
    const Tensor<S> F = deformation(x);
    const std::array<S, nodes> p = pressures(moduli, x), Cp = compliance(moduli, p);
    S sum = S(volume) * (solid::energy(isochoric, F, point) + mean(p) * (determinant(F) - S(1)));
    for (std::size_t a = 0; a < nodes; ++a) sum -= S(0.5) * p[a] * Cp[a];
    return sum;
  }

  template <class Law, class S>
  [[nodiscard]] Forces<S> forces(const Law& isochoric, const PointOf<Law, S>& point, const Moduli& moduli,
                                 const Unknowns<S>& x) const {
    Forces<S> out;
    add_forces(solid::stress(isochoric, deformation(x), point), moduli, x, out);
    return out;
  }

  template <class Law, class S>
  [[nodiscard]] Tangent<S> tangent(const Law& isochoric, const PointOf<Law, S>& point, const Moduli& moduli,
                                   const Unknowns<S>& x) const {
    Tangent<S> out;
    const Tensor<S> F = deformation(x);
    const Response<S> response = solid::response(isochoric, F, point);
    add_forces(response.P, moduli, x, out);
    const Tensor<S> co = cofactor(F);
    for (std::size_t a = 0; a < nodes; ++a) {
      const auto T = contracted(response, out.p, F, gradient[a]);
      for (std::size_t b = 0; b < nodes; ++b)
        for (std::size_t i = 0; i < 3; ++i)
          for (std::size_t k = 0; k < 3; ++k) {
            S sum(0);
            for (std::size_t l = 0; l < 3; ++l) sum += T[9 * i + 3 * k + l] * S(gradient[b][l]);
            out.K[size * (3 * a + i) + 3 * b + k] = S(volume) * sum;
          }
      for (std::size_t i = 0; i < 3; ++i) {  // d(J)/du_ai at each of the four pressures
        S slope(0);
        for (std::size_t j = 0; j < 3; ++j) slope += co.m[3 * i + j] * S(gradient[a][j]);
        slope *= S(0.25 * volume * moduli.pressure_scale);
        for (std::size_t b = 0; b < nodes; ++b)
          out.K[size * (3 * a + i) + displacements + b] = out.K[size * (displacements + b) + 3 * a + i] =
              slope;
      }
    }
    const double scale2 = moduli.pressure_scale * moduli.pressure_scale;
    for (std::size_t a = 0; a < nodes; ++a)
      for (std::size_t b = 0; b < nodes; ++b)
        out.K[size * (displacements + a) + displacements + b] = S(-scale2 * compliance(moduli, a, b));
    return out;
  }

  /// int N_a N_b / kappa + (N_a - 1/4)(N_b - 1/4) / mu dV = V/(20 kappa) (1 + d_ab) + V/(80 mu) (4 d_ab - 1)
  [[nodiscard]] double compliance(const Moduli& moduli, std::size_t a, std::size_t b) const {
    return volume * ((a == b ? 2 : 1) * moduli.inverse_kappa / 20 + (a == b ? 3 : -1) / (80 * moduli.mu));
  }

 private:
  template <class S>
  static S mean(const std::array<S, nodes>& p) {
    return S(0.25) * (p[0] + p[1] + p[2] + p[3]);
  }
  template <class S>
  static std::array<S, nodes> pressures(const Moduli& moduli, const Unknowns<S>& x) {
    std::array<S, nodes> p;
    for (std::size_t a = 0; a < nodes; ++a) p[a] = S(moduli.pressure_scale) * x[displacements + a];
    return p;
  }
  template <class S>
  std::array<S, nodes> compliance(const Moduli& moduli, const std::array<S, nodes>& p) const {
    std::array<S, nodes> Cp{};
    for (std::size_t a = 0; a < nodes; ++a)
      for (std::size_t b = 0; b < nodes; ++b) Cp[a] += S(compliance(moduli, a, b)) * p[b];
    return Cp;
  }

  // r_a = V (P_iso + p cof F) grad N_a,  r_q = scale (V/4 (J - 1) - C p)
  template <class S>
  void add_forces(const Tensor<S>& P, const Moduli& moduli, const Unknowns<S>& x, Forces<S>& out) const {
    const Tensor<S> F = deformation(x), co = cofactor(F);
    const std::array<S, nodes> p = pressures(moduli, x), Cp = compliance(moduli, p);
    out.J = determinant(F);
    out.p = mean(p);
    for (std::size_t a = 0; a < nodes; ++a) {
      for (std::size_t i = 0; i < 3; ++i) {
        S sum(0);
        for (std::size_t j = 0; j < 3; ++j)
          sum += (P.m[3 * i + j] + out.p * co.m[3 * i + j]) * S(gradient[a][j]);
        out.r[3 * a + i] = S(volume) * sum;
      }
      out.r[displacements + a] = S(moduli.pressure_scale) * (S(0.25 * volume) * (out.J - S(1)) - Cp[a]);
    }
  }

  // T_ikl = (A + p d cof F/dF)_ijkl g_j, with d cof F_ij/dF_kl = eps_ikm eps_jln F_mn
  template <class S>
  static std::array<S, 27> contracted(const Response<S>& response, const S& p, const Tensor<S>& F,
                                      const std::array<double, 3>& g) {
    std::array<S, 27> T{};
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j)
        for (std::size_t kl = 0; kl < 9; ++kl) T[9 * i + kl] += response.A[9 * (3 * i + j) + kl] * S(g[j]);
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j)
        for (const int turn : {1, 2}) {  // k = i + 1, i + 2 and m the third, with the sign of the turn
          const auto step = static_cast<std::size_t>(turn);
          const std::size_t k = (i + step) % 3, m = (i + 3 - step) % 3;
          for (const int other : {1, 2}) {
            const auto shift = static_cast<std::size_t>(other);
            const std::size_t l = (j + shift) % 3, n = (j + 3 - shift) % 3;
            const double sign = turn == other ? 1 : -1;
            T[9 * i + 3 * k + l] += p * F.m[3 * m + n] * S(sign * g[j]);
          }
        }
    return T;
  }
};

}  // namespace tunica::solid
