// SPDX-License-Identifier: MIT
// The functions of the wedge: linear on the triangle times linear along its height, and its tensor rules.
#pragma once

#include "tunica/fem/quadrature.hpp"
#include "tunica/fem/shape_quadratic.hpp"
#include "tunica/mesh/wedge.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace tunica::fem {

template <>
inline constexpr std::array<LocalPoint<3>, 6> reference_nodes<mesh::Wedge6>{
    {{0, 0, -1}, {1, 0, -1}, {0, 1, -1}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}}};

/// N_a = L_a (1 - xi_2) / 2, N_{a+3} = L_a (1 + xi_2) / 2 with L_a those of Tri3.
template <>
struct Lagrange<mesh::Wedge6> {
  using cell = mesh::Wedge6;
  static constexpr int nodes = 6;

  template <class T = double>
  static constexpr std::array<T, 6> values(const std::array<T, 3>& xi) {
    const auto L = Lagrange<mesh::Tri3>::values<T>({xi[0], xi[1]});
    std::array<T, 6> N{};
    for (std::size_t a = 0; a < 3; ++a)
      N[a] = 0.5 * L[a] * (T(1) - xi[2]), N[a + 3] = 0.5 * L[a] * (T(1) + xi[2]);
    return N;
  }
  template <class T = double>
  static constexpr std::array<std::array<T, 3>, 6> gradients(const std::array<T, 3>& xi) {
    const auto L = Lagrange<mesh::Tri3>::values<T>({xi[0], xi[1]});
    const auto D = Lagrange<mesh::Tri3>::gradients<T>({xi[0], xi[1]});
    std::array<std::array<T, 3>, 6> G{};
    for (std::size_t a = 0; a < 3; ++a) {
      for (std::size_t i = 0; i < 2; ++i)
        G[a][i] = 0.5 * D[a][i] * (T(1) - xi[2]), G[a + 3][i] = 0.5 * D[a][i] * (T(1) + xi[2]);
      G[a][2] = -0.5 * L[a], G[a + 3][2] = 0.5 * L[a];
    }
    return G;
  }
};

/// Exact to `Degree` on the triangle and along the height alike.
template <int Degree>
struct Gauss<mesh::Wedge6, Degree> {
  using cell = mesh::Wedge6;
  using Base = Gauss<mesh::Tri3, Degree>;
  using Height = detail::Legendre<Degree / 2 + 1>;
  static constexpr int layers = Degree / 2 + 1, size = Base::size * layers;
  static constexpr int degree = std::min(Base::degree, 2 * layers - 1);
  static constexpr auto points = [] {
    std::array<LocalPoint<3>, size> p{};
    for (std::size_t k = 0; k < layers; ++k)
      for (std::size_t q = 0; q < Base::size; ++q)
        p[k * Base::size + q] = {Base::points[q][0], Base::points[q][1], Height::points[k]};
    return p;
  }();
  static constexpr auto weights = [] {
    std::array<double, size> w{};
    for (std::size_t k = 0; k < layers; ++k)
      for (std::size_t q = 0; q < Base::size; ++q)
        w[k * Base::size + q] = Base::weights[q] * Height::weights[k];
    return w;
  }();
};

}  // namespace tunica::fem
