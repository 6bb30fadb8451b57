// SPDX-License-Identifier: MIT
// Quadrature on the reference cells, as compile-time tables, exact to a stated degree.
#pragma once

#include "tunica/fem/shape.hpp"

#include <array>
#include <concepts>
#include <cstddef>

namespace tunica::fem {

/// Points and weights that integrate polynomials of total degree <= degree exactly (of that degree in
/// each coordinate on Quad4 and Hex8). The weights sum to the measure of the reference cell.
template <class Q>
concept Quadrature = mesh::Cell<typename Q::cell> && requires {
  { Q::degree } -> std::convertible_to<int>;
  { Q::size } -> std::convertible_to<int>;
  { Q::points[0] } -> std::convertible_to<LocalPoint<Q::cell::dim>>;
  { Q::weights[0] } -> std::convertible_to<double>;  // a rule has a weight for each of its points
};

/// The rule of a cell for a degree: Tri3 1, 2, 4; Tet4 1, 2; Quad4 and Hex8 1, 3, 5.
template <mesh::Cell C, int Degree>
struct Gauss;

namespace detail {

constexpr double root_3_5 = 0.774596669241483377035853079956;  // sqrt(3/5)
constexpr double root_1_3 = 0.577350269189625764509148780502;  // sqrt(1/3)

template <int N>
struct Legendre;  // Gauss's N points on [-1, 1]
template <>
struct Legendre<1> {
  static constexpr std::array<double, 1> points{0}, weights{2};
};
template <>
struct Legendre<2> {
  static constexpr std::array<double, 2> points{-root_1_3, root_1_3}, weights{1, 1};
};
template <>
struct Legendre<3> {
  static constexpr std::array<double, 3> points{-root_3_5, 0, root_3_5}, weights{5. / 9, 8. / 9, 5. / 9};
};

template <mesh::Cell C, int N>
struct TensorGauss {
  using cell = C;
  static constexpr int degree = 2 * N - 1;
  static constexpr int size = C::dim == 3 ? N * N * N : N * N;
  static constexpr auto points = [] {
    std::array<LocalPoint<C::dim>, size> p{};
    for (std::size_t q = 0; q < size; ++q)
      for (std::size_t i = 0, k = q; i < C::dim; ++i, k /= N) p[q][i] = Legendre<N>::points[k % N];
    return p;
  }();
  static constexpr auto weights = [] {
    std::array<double, size> w{};
    for (std::size_t q = 0; q < size; ++q) {
      w[q] = 1;
      for (std::size_t i = 0, k = q; i < C::dim; ++i, k /= N) w[q] *= Legendre<N>::weights[k % N];
    }
    return w;
  }();
};

}  // namespace detail

template <int Degree>
struct Gauss<mesh::Quad4, Degree> : detail::TensorGauss<mesh::Quad4, (Degree + 1) / 2> {};
template <int Degree>
struct Gauss<mesh::Hex8, Degree> : detail::TensorGauss<mesh::Hex8, (Degree + 1) / 2> {};

template <>
struct Gauss<mesh::Tri3, 1> {
  using cell = mesh::Tri3;
  static constexpr int degree = 1, size = 1;
  static constexpr std::array<LocalPoint<2>, 1> points{{{1. / 3, 1. / 3}}};
  static constexpr std::array<double, 1> weights{1. / 2};
};

template <>
struct Gauss<mesh::Tri3, 2> {
  using cell = mesh::Tri3;
  static constexpr int degree = 2, size = 3;
  static constexpr std::array<LocalPoint<2>, 3> points{
      {{1. / 6, 1. / 6}, {2. / 3, 1. / 6}, {1. / 6, 2. / 3}}};
  static constexpr std::array<double, 3> weights{1. / 6, 1. / 6, 1. / 6};
};

/// Six points in two orbits (a, a), (1-2a, a), (a, 1-2a), a = (8 - sqrt 10 -+ sqrt(38 - 44 sqrt(2/5)))/18.
template <>
struct Gauss<mesh::Tri3, 4> {
  using cell = mesh::Tri3;
  static constexpr int degree = 4, size = 6;
  static constexpr double a = 0.091576213509770743459571463402, b = 0.445948490915964886318329253883;
  static constexpr double wa = 0.054975871827660933819163162450, wb = 0.111690794839005732847503504217;
  static constexpr std::array<LocalPoint<2>, 6> points{
      {{a, a}, {1 - 2 * a, a}, {a, 1 - 2 * a}, {b, b}, {1 - 2 * b, b}, {b, 1 - 2 * b}}};
  static constexpr std::array<double, 6> weights{wa, wa, wa, wb, wb, wb};
};

template <>
struct Gauss<mesh::Tet4, 1> {
  using cell = mesh::Tet4;
  static constexpr int degree = 1, size = 1;
  static constexpr std::array<LocalPoint<3>, 1> points{{{1. / 4, 1. / 4, 1. / 4}}};
  static constexpr std::array<double, 1> weights{1. / 6};
};

/// Four points (a, a, a) and (1-3a, a, a) cyclic, a = (5 - sqrt 5)/20.
template <>
struct Gauss<mesh::Tet4, 2> {
  using cell = mesh::Tet4;
  static constexpr int degree = 2, size = 4;
  static constexpr double a = 0.138196601125010515179541316563, b = 1 - 3 * a;
  static constexpr std::array<LocalPoint<3>, 4> points{{{a, a, a}, {b, a, a}, {a, b, a}, {a, a, b}}};
  static constexpr std::array<double, 4> weights{1. / 24, 1. / 24, 1. / 24, 1. / 24};
};

}  // namespace tunica::fem
