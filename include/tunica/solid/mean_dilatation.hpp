// SPDX-License-Identifier: MIT
// The three-field element Q1-P0-J0 of [SIMO85, SIMO91], condensed exactly: forces, tangent, energy.
#pragma once

#include "tunica/core/types.hpp"
#include "tunica/fem/geometry.hpp"
#include "tunica/solid/cell_data.hpp"
#include "tunica/solid/volumetric.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstddef>
#include <type_traits>

namespace tunica::solid {

/// What an element gives, N = 3 * nodes; unknown i of node a is number 3 a + i.
template <class S, int N>
struct ElementForces {
  Eigen::Matrix<S, N, 1> force;         // internal forces at the pressure p [N]
  Eigen::Matrix<S, N, 1> volume_slope;  // dv/du of the current volume v: force per unit of p [m2]
  S theta, p;                           // v/V and U'(theta) [Pa]
  S bulk, volume;                       // U''(theta) [Pa] and the reference volume V [m3]
  S smallest_J;                         // at the points; not positive: the rest is of no use
};
template <class S, int N>
struct ElementTangent : ElementForces<S, N> {
  Eigen::Matrix<S, N, N> stiffness;  // d force / du, symmetric [N/m]
};

/// Dilatation theta and pressure p are constant in the element; eliminated, they leave
///   Pi(u) = int Phi_iso(u) dV + V U(theta),  theta = v/V = (1/V) int J dV,  p = U'(theta),
/// so forces and tangent below are the exact first and second derivatives of Pi. One and the same
/// kernel for doubles, duals and packs (a lane an element); it does not allocate.
/// Newton on (u, theta, p) differs from Newton on u alone in one thing: the geometric part of its
/// tangent has the pressure that the last step predicts, p + U'' dv.du/V, not U'(theta(u)), which for
/// large kappa is nonsense until u has converged. So `tangent` takes that pressure.
/// X: nodes of the reference shape, u: displacements, both 3 x nodes [m]. With a prestress F_p in `data`
/// the reference carries it: F = (1 + du/dX) F_p, and V, energies and weights are those of the body free
/// of stress, F_p^-1 away.
template <mesh::Cell C, class Rule>
struct MeanDilatation {
  static constexpr int nodes = C::nodes, size = 3 * C::nodes, points = Rule::size;
  template <class S>
  using Nodal = Eigen::Matrix<S, 3, nodes>;
  template <class Material>
  using Data = CellData<decltype(Material::isochoric)>;

  /// The strain energy Pi(u) [J]; NaN or nonsense if some J <= 0.
  template <class Material, class S>
  [[nodiscard]] static S energy(const Material& material, const Nodal<S>& X, const Nodal<S>& u,
                                const Data<Material>& data = {}) {
    const Kinematics<S> k(X, u, data.prestress);
    S sum = k.volume * material.volumetric.energy(k.theta);
    for (std::size_t q = 0; q < points; ++q)
      sum += k.weight[q] * energy_at(material.isochoric, data, q, k.F[q], k.J[q]);
    return sum;
  }

  template <class Material, class S>
  [[nodiscard]] static ElementForces<S, size> forces(const Material& material, const Nodal<S>& X,
                                                     const Nodal<S>& u, const Data<Material>& data = {}) {
    const Kinematics<S> k(X, u, data.prestress);
    ElementForces<S, size> out;
    start(material, k, out);
    for (std::size_t q = 0; q < points; ++q)
      add_forces(k, q, stress_at(material.isochoric, data, q, k.F[q], k.J[q]), out);
    out.force += out.p * out.volume_slope;
    return out;
  }

  /// The exact tangent: p = U'(theta) in every part.
  template <class Material, class S>
  [[nodiscard]] static ElementTangent<S, size> tangent(const Material& material, const Nodal<S>& X,
                                                       const Nodal<S>& u, const Data<Material>& data = {}) {
    const Kinematics<S> k(X, u, data.prestress);
    return tangent_at(material, data, k, material.volumetric.slope(k.theta));
  }
  /// The same with the pressure p [Pa] in the geometric part.
  template <class Material, class S>
  [[nodiscard]] static ElementTangent<S, size> tangent(const Material& material, const Nodal<S>& X,
                                                       const Nodal<S>& u, const S& p,
                                                       const Data<Material>& data = {}) {
    return tangent_at(material, data, Kinematics<S>(X, u, data.prestress), p);
  }

  /// Where its points lie [m].
  [[nodiscard]] static Vec3 position(const Nodal<double>& X, std::size_t q) {
    Vec3 x = Vec3::Zero();
    for (int a = 0; a < nodes; ++a) x += Tables::values[q][static_cast<std::size_t>(a)] * X.col(a);
    return x;
  }
  /// (1 + du/dX) at the points: what a prestress stores.
  [[nodiscard]] static std::array<Eigen::Matrix3d, static_cast<std::size_t>(points)> deformation(
      const Nodal<double>& X, const Nodal<double>& u) {
    return Kinematics<double>(X, u, nullptr).F;
  }

  /// Cauchy stress at the points [Pa], the pressure of the element included; a column a point.
  struct Stress {
    Eigen::Matrix<double, 6, points> sigma;
    std::array<double, static_cast<std::size_t>(points)> volume;  // current, of each point [m3]
  };
  template <class Material>
  [[nodiscard]] static Stress stress(const Material& material, const Nodal<double>& X, const Nodal<double>& u,
                                     const Data<Material>& data = {}) {
    const Kinematics<double> k(X, u, data.prestress);
    Stress out;
    for (std::size_t q = 0; q < points; ++q) {
      // sigma = p 1 + tau / J   [PEREZ08, (5)]
      Symmetric<double> sigma = stress_at(material.isochoric, data, q, k.F[q], k.J[q]) / k.J[q];
      for (int i = 0; i < 3; ++i) sigma[i] += material.volumetric.slope(k.theta);
      out.sigma.col(static_cast<int>(q)) = sigma;
      out.volume[q] = k.weight[q] * k.J[q];
    }
    return out;
  }

 private:
  using Tables = fem::Tables<fem::Lagrange<C>, Rule>;

  template <class S>
  struct Kinematics {
    std::array<Eigen::Matrix<S, 3, 3>, points> F;  // F = (1 + du/dX) F_p
    std::array<Nodal<S>, points> gradient;         // dN_a/dx
    std::array<S, points> J, weight;               // weight: volume of the point free of stress
    S volume, theta, smallest_J;

    Kinematics(const Nodal<S>& X, const Nodal<S>& u, const Eigen::Matrix3d* prestress) : volume(0), theta(0) {
      for (std::size_t q = 0; q < points; ++q) {
        const auto map = fem::map_point<S, 3>(X, Tables::gradients[q]);
        F[q] = u * map.gradient.transpose();
        for (int i = 0; i < 3; ++i) F[q](i, i) += S(1);
        const Eigen::Matrix<S, 3, 3> inverse = F[q].inverse();
        gradient[q] = inverse.transpose() * map.gradient;
        weight[q] = map.det * S(Rule::weights[q]);
        if (prestress != nullptr) {
          F[q] = (F[q] * prestress[q].template cast<S>()).eval();
          weight[q] *= S(1 / prestress[q].determinant());
        }
        J[q] = F[q].determinant();
        volume += weight[q];
        theta += weight[q] * J[q];
        using std::min;
        smallest_J = q == 0 ? J[q] : min(smallest_J, J[q]);
      }
      theta /= volume;
    }
  };

  template <class Material, class S>
  static void start(const Material& material, const Kinematics<S>& k, ElementForces<S, size>& out) {
    out.force.setConstant(S(0));
    out.volume_slope.setConstant(S(0));
    out.theta = k.theta;
    out.p = material.volumetric.slope(k.theta);
    out.bulk = material.volumetric.curvature(k.theta);
    out.volume = k.volume;
    out.smallest_J = k.smallest_J;
  }

  // f_a = int tau grad N_a dV   [PEREZ08, (8)],  dv/du_a = int J grad N_a dV
  template <class S>
  static void add_forces(const Kinematics<S>& k, std::size_t q, Symmetric<S> tau,
                         ElementForces<S, size>& out) {
    tau *= k.weight[q];
    const S dv = k.weight[q] * k.J[q];
    for (int a = 0; a < nodes; ++a) {
      const S x = k.gradient[q](0, a), y = k.gradient[q](1, a), z = k.gradient[q](2, a);
      out.force[3 * a] += tau[0] * x + tau[3] * y + tau[5] * z;
      out.force[3 * a + 1] += tau[3] * x + tau[1] * y + tau[4] * z;
      out.force[3 * a + 2] += tau[5] * x + tau[4] * y + tau[2] * z;
      out.volume_slope[3 * a] += dv * x;
      out.volume_slope[3 * a + 1] += dv * y;
      out.volume_slope[3 * a + 2] += dv * z;
    }
  }

  template <class Material, class S>
  static ElementTangent<S, size> tangent_at(const Material& material, const Data<Material>& data,
                                            const Kinematics<S>& k, const S& p) {
    ElementTangent<S, size> out;
    start(material, k, out);
    out.stiffness.setConstant(S(0));
    for (std::size_t q = 0; q < points; ++q) {
      auto response = response_at(material.isochoric, data, q, k.F[q], k.J[q]);
      add_forces(k, q, response.tau, out);
      // p J (grad Na x grad Nb - grad Nb x grad Na) is the modulus p J (1 x 1 - 2 Id) and stress p J 1.
      const S pJ = p * k.J[q];
      for (int r = 0; r < 3; ++r) {
        response.tau[r] += pJ;
        response.modulus(r, r) -= S(2) * pJ;
        response.modulus(r + 3, r + 3) -= pJ;
        for (int s = 0; s < 3; ++s) response.modulus(r, s) += pJ;
      }
      add_stiffness(k.gradient[q], k.weight[q], response, out.stiffness);
    }
    out.force += out.p * out.volume_slope;
    const S bulk_per_volume = out.bulk / out.volume;
    for (int c = 0; c < size; ++c) {  // U''/V dv dv^T
      const S column = bulk_per_volume * out.volume_slope[c];
      for (int r = 0; r < (c / 3 + 1) * 3; ++r) out.stiffness(r, c) += out.volume_slope[r] * column;
    }
    for (int c = 0; c < size; ++c)
      for (int r = c + 1; r < size; ++r) out.stiffness(r, c) = out.stiffness(c, r);
    return out;
  }

  // K_ab = int B_a^T c B_b + (grad N_a . tau grad N_b) 1 dV, for the node blocks a <= b
  template <class S>
  static void add_stiffness(const Nodal<S>& g, const S& weight, const SpatialResponse<S>& response,
                            Eigen::Matrix<S, size, size>& K) {
    const Eigen::Matrix<S, 6, 6> c = response.modulus * weight;
    const Symmetric<S> tau = response.tau * weight;
    for (int b = 0; b < nodes; ++b) {
      const S x = g(0, b), y = g(1, b), z = g(2, b);
      Eigen::Matrix<S, 6, 3> cB;
      for (int r = 0; r < 6; ++r) {
        cB(r, 0) = c(r, 0) * x + c(r, 3) * y + c(r, 5) * z;
        cB(r, 1) = c(r, 3) * x + c(r, 1) * y + c(r, 4) * z;
        cB(r, 2) = c(r, 5) * x + c(r, 4) * y + c(r, 2) * z;
      }
      const S tx = tau[0] * x + tau[3] * y + tau[5] * z;
      const S ty = tau[3] * x + tau[1] * y + tau[4] * z;
      const S tz = tau[5] * x + tau[4] * y + tau[2] * z;
      for (int a = 0; a <= b; ++a) {
        const S ax = g(0, a), ay = g(1, a), az = g(2, a);
        const S geometric = ax * tx + ay * ty + az * tz;
        for (int j = 0; j < 3; ++j) {
          K(3 * a, 3 * b + j) += ax * cB(0, j) + ay * cB(3, j) + az * cB(5, j);
          K(3 * a + 1, 3 * b + j) += ax * cB(3, j) + ay * cB(1, j) + az * cB(4, j);
          K(3 * a + 2, 3 * b + j) += ax * cB(5, j) + ay * cB(4, j) + az * cB(2, j);
        }
        for (int i = 0; i < 3; ++i) K(3 * a + i, 3 * b + i) += geometric;
      }
    }
  }
};

/// The rule that integrates an element: 2x2x2 points for Hex8, one for Tet4 (which then locks).
template <mesh::Cell C>
using DefaultRule = fem::Gauss<C, std::is_same_v<C, mesh::Hex8> ? 3 : 1>;

}  // namespace tunica::solid
