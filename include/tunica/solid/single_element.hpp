// SPDX-License-Identifier: MIT
// One element by itself, in Eigen's matrices: for output, inverse design and tests, where speed is no matter.
#pragma once

#include "tunica/core/types.hpp"
#include "tunica/solid/cell_data.hpp"
#include "tunica/solid/formulation.hpp"
#include "tunica/solid/kernel.hpp"
#include "tunica/solid/symmetric.hpp"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <type_traits>

namespace tunica::solid {

/// The kernel of Body for one cell. X, u: 3 x nodes [m]; unknown i of node a is number 3 a + i. S is double
/// or a dual. What a law reads at the points, and a stored deformation, stand in `data`.
template <mesh::Cell C, class Locking>
struct SingleElement {
  using Element = Kernel<C, Locking>;
  static constexpr int nodes = C::nodes, size = 3 * C::nodes, points = Element::points;
  template <class S>
  using Nodal = Eigen::Matrix<S, 3, nodes>;
  template <class Material>
  using Data = CellData<PointLaw<Material>>;

  /// theta, p, bulk, volume and volume_slope are those of the first mode where pressures are kept, zero
  /// elsewhere: v/V, the mean of U'(theta) [Pa] and U''(theta) [Pa], V [m3] and dv/du [m2].
  template <class S>
  struct Forces {
    Eigen::Matrix<S, size, 1> force, volume_slope;
    S theta{}, p{}, bulk{}, volume{}, smallest_J{};
  };
  template <class S>
  struct Tangent : Forces<S> {
    Eigen::Matrix<S, size, size> stiffness;
  };

  template <class Material, class S>
  [[nodiscard]] static S energy(const Material& material, const Nodal<S>& X, const Nodal<S>& u,
                                const Data<Material>& data = {}) {
    const Call<Material, S> call(X, u, data);
    return Element::energy(material, call.X, call.u, call.data(), call.stored());
  }
  template <class Material, class S>
  [[nodiscard]] static Forces<S> forces(const Material& material, const Nodal<S>& X, const Nodal<S>& u,
                                        const Data<Material>& data = {}) {
    const Call<Material, S> call(X, u, data);
    typename Element::template Forces<S> out;
    Element::forces(material, call.X, call.u, call.data(), call.stored(), out);
    Forces<S> result;
    copy(out, result);
    return result;
  }
  template <class Material, class S>
  [[nodiscard]] static Tangent<S> tangent(const Material& material, const Nodal<S>& X, const Nodal<S>& u,
                                          const Data<Material>& data = {}) {
    const Call<Material, S> call(X, u, data);
    typename Element::template Tangent<S> out;
    Element::tangent(material, call.X, call.u, call.data(), call.stored(), out);
    return whole(out);
  }
  /// The same with the pressure p [Pa] in the geometric part.
  template <class Material, class S>
  [[nodiscard]] static Tangent<S> tangent(const Material& material, const Nodal<S>& X, const Nodal<S>& u,
                                          const S& p,
                                          const Data<Material>& data = {}) requires(Element::modes == 1) {
    const Call<Material, S> call(X, u, data);
    typename Element::template Tangent<S> out;
    Element::tangent(material, call.X, call.u, call.data(), call.stored(),
                     typename Element::template Pressures<S>{p}, out);
    return whole(out);
  }

  /// The pressure [Pa] at the points of which an element keeps the parts p_i.
  template <class Given>
  [[nodiscard]] static Eigen::Array<double, 1, points> pressure(
      const typename Element::template Pressures<double>& p, const Nodal<double>& X, const Given& data) {
    Tensor<double> stored[points];
    for (std::size_t q = 0; data.prestress != nullptr && q < points; ++q)
      stored[q] = detail::tensor_of(data.prestress[q]);
    const typename Element::Cure::template Modes<double> modes(NodeArray<double>(X).v,
                                                               data.prestress != nullptr ? stored : nullptr);
    Eigen::Array<double, 1, points> at;
    for (std::size_t q = 0; q < points; ++q) at[static_cast<int>(q)] = modes.at(p, q);
    return at;
  }

  /// Where the points lie [m].
  [[nodiscard]] static Vec3 position(const Nodal<double>& X, std::size_t q) {
    Vec3 x = Vec3::Zero();
    for (int a = 0; a < nodes; ++a) x += Tables::values[q][static_cast<std::size_t>(a)] * X.col(a);
    return x;
  }
  /// 1 + du/dX at the points.
  [[nodiscard]] static std::array<Eigen::Matrix3d, static_cast<std::size_t>(points)> deformation(
      const Nodal<double>& X, const Nodal<double>& u) {
    const NodeArray<double> Xa(X), ua(u);
    std::array<Eigen::Matrix3d, static_cast<std::size_t>(points)> F;
    for (std::size_t q = 0; q < F.size(); ++q)
      F[q] = matrix(element_point<C, typename Element::Quadrature>(Xa.v, q).deformation(ua.v));
    return F;
  }

  /// Cauchy stress at the points [Pa], the pressure of the element included; a column a point.
  struct Stress {
    Eigen::Matrix<double, 6, points> sigma;          // xx yy zz xy yz xz
    std::array<double, std::size_t{points}> volume;  // current, of each point [m3]
  };
  /// sigma = P F^T / J   [PEREZ08, (5)]
  template <class Material>
  [[nodiscard]] static Stress stress(const Material& material, const Nodal<double>& X, const Nodal<double>& u,
                                     const Data<Material>& data = {}) {
    const Call<Material, double> call(X, u, data);
    Stress out;
    Element::for_each_stress(material, call.X, call.u, call.data(), call.stored(),
                             [&](std::size_t q, const Tensor<double>& sigma, double volume) {
                               for (std::size_t k = 0; k < 6; ++k) {
                                 const auto [i, j] = symmetric_pairs[k];
                                 out.sigma(static_cast<int>(k), static_cast<int>(q)) = sigma(i, j);
                               }
                               out.volume[q] = volume;
                             });
    return out;
  }

 private:
  using Tables = fem::Tables<fem::Lagrange<C>, typename Element::Quadrature>;

  template <class S>
  struct NodeArray {
    S v[nodes][3];
    explicit NodeArray(const Nodal<S>& x) {
      for (int a = 0; a < nodes; ++a)
        for (int i = 0; i < 3; ++i) v[a][i] = x(i, a);
    }
  };
  static Eigen::Matrix3d matrix(const Tensor<double>& t) {
    return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(t.m.data());
  }

  /// What the kernel is called with.
  template <class Material, class S>
  struct Call {
    S X[nodes][3], u[nodes][3];
    PointOf<PointLaw<Material>, S> read[points];
    Tensor<S> prestress[points];
    bool reads, prestressed;

    Call(const Nodal<S>& X_, const Nodal<S>& u_, const Data<Material>& given)
        : reads(needs_point<PointLaw<Material>>), prestressed(given.prestress != nullptr) {
      for (int a = 0; a < nodes; ++a)
        for (int i = 0; i < 3; ++i) X[a][i] = X_(i, a), u[a][i] = u_(i, a);
      for (std::size_t q = 0; q < points; ++q) {
        read[q] = given.template point<S>(q);
        for (int k = 0; prestressed && k < 9; ++k)
          prestress[q].m[static_cast<std::size_t>(k)] = S(given.prestress[q](k / 3, k % 3));
      }
    }
    [[nodiscard]] const auto* data() const { return reads ? read : nullptr; }
    [[nodiscard]] const Tensor<S>* stored() const { return prestressed ? prestress : nullptr; }
  };

  template <class Out, class S>
  static void copy(const Out& out, Forces<S>& to) {
    to.volume_slope.setConstant(S(0));
    to.smallest_J = out.smallest_J;
    for (int a = 0; a < nodes; ++a)
      for (int i = 0; i < 3; ++i) {
        to.force[3 * a + i] = out.f[a][i];
        if constexpr (Element::keeps) to.volume_slope[3 * a + i] = out.slope[0][a][i];
      }
    if constexpr (Element::keeps)
      to.theta = out.theta[0], to.p = out.p[0], to.bulk = out.bulk[0][0], to.volume = out.volume;
  }
  template <class S>
  static Tangent<S> whole(const typename Element::template Tangent<S>& out) {
    Tangent<S> to;
    copy(out, static_cast<Forces<S>&>(to));
    for (int a = 0; a < nodes; ++a)
      for (int b = Element::Places::first(a); b < nodes; ++b)
        for (int i = 0; i < 3; ++i)
          for (int k = 0; k < 3; ++k) {
            const S& entry = out.K[Element::Places::place(a, b)][3 * i + k];
            to.stiffness(3 * a + i, 3 * b + k) = entry;
            if constexpr (Locking::blocks == Blocks::upper) to.stiffness(3 * b + k, 3 * a + i) = entry;
          }
    return to;
  }
};

}  // namespace tunica::solid
