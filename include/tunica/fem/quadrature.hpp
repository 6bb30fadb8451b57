// SPDX-License-Identifier: MIT
// Quadrature on the reference cells, as compile-time tables, exact to a stated degree, of positive weights
// and with all points inside [STROUD71, RADON48, WALKINGTON00].
#pragma once

#include "tunica/fem/shape.hpp"
#include "tunica/mesh/cell_quadratic.hpp"

#include <array>
#include <concepts>
#include <cstddef>

namespace tunica::fem {

/// Points and weights that integrate polynomials of total degree <= degree exactly (of that degree in
/// each coordinate on lines, quadrilaterals and hexahedra). The weights sum to the measure of the reference
/// cell.
template <class Q>
concept Quadrature = mesh::Cell<typename Q::cell> && requires {
  { Q::degree } -> std::convertible_to<int>;
  { Q::size } -> std::convertible_to<int>;
  { Q::points[0] } -> std::convertible_to<LocalPoint<Q::cell::dim>>;
  { Q::weights[0] } -> std::convertible_to<double>;  // a rule has a weight for each of its points
};

/// The rule of a cell for a degree, at least: Tri3 and Tet4 1 to 5; Line2, Quad4, Hex8 and Wedge6 1 to 7 (a
/// wedge to 5). A quadratic cell has the rules of its corners.
template <mesh::Cell C, int Degree>
struct Gauss;

template <mesh::Quadratic C, int Degree>
struct Gauss<C, Degree> : Gauss<typename C::Linear, Degree> {
  using cell = C;
};

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
template <>
struct Legendre<4> {  // at -+sqrt(3/7 +- 2/7 sqrt(6/5)) with (18 -+ sqrt 30)/36
  static constexpr double a = 0.861136311594052575223946488893, b = 0.339981043584856264802665759103;
  static constexpr double wa = 0.347854845137453857373063949222, wb = 0.652145154862546142626936050778;
  static constexpr std::array<double, 4> points{-a, -b, b, a}, weights{wa, wb, wb, wa};
};

template <mesh::Cell C, int N>
struct TensorGauss {
  using cell = C;
  static constexpr int degree = 2 * N - 1;
  static constexpr int size = C::dim == 3 ? N * N * N : C::dim == 2 ? N * N : N;
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
struct Gauss<mesh::Line2, Degree> : detail::TensorGauss<mesh::Line2, Degree / 2 + 1> {};
template <int Degree>
struct Gauss<mesh::Quad4, Degree> : detail::TensorGauss<mesh::Quad4, Degree / 2 + 1> {};
template <int Degree>
struct Gauss<mesh::Hex8, Degree> : detail::TensorGauss<mesh::Hex8, Degree / 2 + 1> {};

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
struct Gauss<mesh::Tri3, 3> : Gauss<mesh::Tri3, 4> {};

/// Seven points: the middle and two orbits, a, b = (6 -+ sqrt 15)/21 [RADON48].
template <>
struct Gauss<mesh::Tri3, 5> {
  using cell = mesh::Tri3;
  static constexpr int degree = 5, size = 7;
  static constexpr double a = 0.101286507323456338800987361915, b = 0.470142064105115089770441209513;
  static constexpr double wa = 0.062969590272413576297841972750, wb = 0.066197076394253090368824693917;
  static constexpr std::array<LocalPoint<2>, 7> points{
      {{1. / 3, 1. / 3}, {a, a}, {1 - 2 * a, a}, {a, 1 - 2 * a}, {b, b}, {1 - 2 * b, b}, {b, 1 - 2 * b}}};
  static constexpr std::array<double, 7> weights{9. / 80, wa, wa, wa, wb, wb, wb};
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

/// Eight points in two orbits (a, a, a), (1-3a, a, a) cyclic, with weights 1/60 and 1/40: then a and b solve
/// the moment equations of x^2 and x^3.
template <>
struct Gauss<mesh::Tet4, 3> {
  using cell = mesh::Tet4;
  static constexpr int degree = 3, size = 8;
  static constexpr double a = 0.101009320100098119034952557424, b = 0.327682161414166695990453242500;
  static constexpr double c = 1 - 3 * a, d = 1 - 3 * b, wa = 1. / 60, wb = 1. / 40;
  static constexpr std::array<LocalPoint<3>, 8> points{
      {{a, a, a}, {c, a, a}, {a, c, a}, {a, a, c}, {b, b, b}, {d, b, b}, {b, d, b}, {b, b, d}}};
  static constexpr std::array<double, 8> weights{wa, wa, wa, wa, wb, wb, wb, wb};
};

/// Fourteen points: two orbits as above and the six (e, e, f), (e, f, f) with e + f = 1/2 [WALKINGTON00].
template <>
struct Gauss<mesh::Tet4, 5> {
  using cell = mesh::Tet4;
  static constexpr int degree = 5, size = 14;
  static constexpr double a = 0.092735250310891226402323913737, b = 0.310885919263300609797345733763;
  static constexpr double c = 1 - 3 * a, d = 1 - 3 * b, e = 0.045503704125649649491880526279, f = 0.5 - e;
  static constexpr double wa = 0.012248840519393658257285034248, wb = 0.018781320953002641799864275389,
                          we = 0.007091003462846911073011571353;
  static constexpr std::array<LocalPoint<3>, 14> points{{{a, a, a},
                                                         {c, a, a},
                                                         {a, c, a},
                                                         {a, a, c},
                                                         {b, b, b},
                                                         {d, b, b},
                                                         {b, d, b},
                                                         {b, b, d},
                                                         {e, e, f},
                                                         {e, f, e},
                                                         {f, e, e},
                                                         {e, f, f},
                                                         {f, e, f},
                                                         {f, f, e}}};
  static constexpr std::array<double, 14> weights{wa, wa, wa, wa, wb, wb, wb, wb, we, we, we, we, we, we};
};

template <>
struct Gauss<mesh::Tet4, 4> : Gauss<mesh::Tet4, 5> {};

}  // namespace tunica::fem
