// SPDX-License-Identifier: MIT
// Rules of every cell: exact on all monomials of their degree, not beyond, positive and inside.
#include "tunica/fem/quadrature.hpp"
#include "tunica/fem/shape_wedge.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

using namespace tunica;

namespace {

double factorial(int n) {
  return n < 2 ? 1 : n * factorial(n - 1);
}

/// The integral of x^i y^j z^k over the reference cell.
template <class Cell>
double exact(int i, int j, int k) {
  using C = mesh::Corners<Cell>;
  const auto line = [](int n) { return n % 2 ? 0.0 : 2.0 / (n + 1); };
  if constexpr (C::nodes == 6) return line(k) * factorial(i) * factorial(j) / factorial(i + j + 2);
  if constexpr (C::nodes == C::dim + 1 && C::dim > 1)
    return factorial(i) * factorial(j) * factorial(k) / factorial(i + j + k + C::dim);
  return line(i) * (C::dim > 1 ? line(j) : 1) * (C::dim == 3 ? line(k) : 1);
}

template <class Q>
double integral(int i, int j, int k) {
  double sum = 0;
  for (std::size_t q = 0; q < Q::size; ++q) {
    double value = Q::weights[q] * std::pow(Q::points[q][0], i);
    if constexpr (Q::cell::dim > 1) value *= std::pow(Q::points[q][1], j);
    if constexpr (Q::cell::dim == 3) value *= std::pow(Q::points[q][2], k);
    sum += value;
  }
  return sum;
}

template <class Q>
void check_degree() {
  static_assert(fem::Quadrature<Q>);
  using C = typename Q::cell;
  using Linear = mesh::Corners<C>;
  constexpr bool simplex = Linear::nodes == C::dim + 1, wedge = Linear::nodes == 6;
  for (std::size_t q = 0; q < Q::size; ++q) {
    CHECK(Q::weights[q] > 0);
    double sum = 0;
    for (std::size_t i = 0; i < C::dim; ++i) {
      const double x = Q::points[q][i];
      CHECK(((simplex && C::dim > 1) || (wedge && i < 2) ? x > 0 : std::abs(x) < 1));
      if ((simplex && C::dim > 1) || (wedge && i < 2)) sum += x;
    }
    CHECK(sum < 1);
  }
  bool next_is_wrong = false;
  for (int i = 0; i <= Q::degree + 1; ++i)
    for (int j = 0; j <= (C::dim > 1 ? Q::degree + 1 : 0); ++j)
      for (int k = 0; k <= (C::dim == 3 ? Q::degree + 1 : 0); ++k) {
        const int degree = simplex ? i + j + k : wedge ? std::max(i + j, k) : std::max({i, j, k});
        const double error = std::abs(integral<Q>(i, j, k) - exact<C>(i, j, k));
        if (degree <= Q::degree) CHECK(error < 4e-15);
        if (degree == Q::degree + 1 && error > 1e-6) next_is_wrong = true;
      }
  CHECK(next_is_wrong);  // the stated degree is the true one
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE_TEMPLATE("fem: quadrature is exact to its degree and not beyond", Q, fem::Gauss<mesh::Line2, 1>,
                     fem::Gauss<mesh::Line2, 3>, fem::Gauss<mesh::Line3, 5>, fem::Gauss<mesh::Line2, 7>,
                     fem::Gauss<mesh::Tri3, 1>, fem::Gauss<mesh::Tri3, 2>, fem::Gauss<mesh::Tri6, 3>,
                     fem::Gauss<mesh::Tri3, 4>, fem::Gauss<mesh::Tri3, 5>, fem::Gauss<mesh::Tet4, 1>,
                     fem::Gauss<mesh::Tet4, 2>, fem::Gauss<mesh::Tet10, 3>, fem::Gauss<mesh::Tet4, 4>,
                     fem::Gauss<mesh::Tet10, 5>, fem::Gauss<mesh::Quad4, 1>, fem::Gauss<mesh::Quad8, 3>,
                     fem::Gauss<mesh::Quad9, 5>, fem::Gauss<mesh::Quad4, 7>, fem::Gauss<mesh::Hex8, 1>,
                     fem::Gauss<mesh::Hex8, 3>, fem::Gauss<mesh::Hex20, 5>, fem::Gauss<mesh::Hex27, 7>,
                     fem::Gauss<mesh::Wedge6, 1>, fem::Gauss<mesh::Wedge6, 2>, fem::Gauss<mesh::Wedge6, 3>,
                     fem::Gauss<mesh::Wedge6, 5>) {
    check_degree<Q>();
  }

  TEST_CASE("fem: a rule has at least the degree asked for") {
    CHECK(fem::Gauss<mesh::Hex8, 2>::size == 8);
    CHECK(fem::Gauss<mesh::Quad9, 4>::size == 9);
    CHECK(fem::Gauss<mesh::Tri3, 3>::size == 6);
    CHECK(fem::Gauss<mesh::Tet10, 4>::size == 14);
    CHECK(fem::Gauss<mesh::Wedge6, 4>::size == 18);
  }
}
