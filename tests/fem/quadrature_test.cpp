// SPDX-License-Identifier: MIT
#include "tunica/fem/quadrature.hpp"

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
template <class C>
double exact(int i, int j, int k) {
  if constexpr (C::nodes == C::dim + 1)
    return factorial(i) * factorial(j) * factorial(k) / factorial(i + j + k + C::dim);
  const auto line = [](int n) { return n % 2 ? 0.0 : 2.0 / (n + 1); };
  return line(i) * line(j) * (C::dim == 3 ? line(k) : 1);
}

template <class Q>
double integral(int i, int j, int k) {
  double sum = 0;
  for (std::size_t q = 0; q < Q::size; ++q) {
    double value = Q::weights[q] * std::pow(Q::points[q][0], i) * std::pow(Q::points[q][1], j);
    if constexpr (Q::cell::dim == 3) value *= std::pow(Q::points[q][2], k);
    sum += value;
  }
  return sum;
}

template <class Q>
void check_degree() {
  static_assert(fem::Quadrature<Q>);
  using C = typename Q::cell;
  constexpr bool simplex = C::nodes == C::dim + 1;
  bool next_is_wrong = false;
  for (int i = 0; i <= Q::degree + 1; ++i)
    for (int j = 0; j <= Q::degree + 1; ++j)
      for (int k = 0; k <= (C::dim == 3 ? Q::degree + 1 : 0); ++k) {
        const int degree = simplex ? i + j + k : std::max({i, j, k});
        const double error = std::abs(integral<Q>(i, j, k) - exact<C>(i, j, k));
        if (degree <= Q::degree) CHECK(error < 4e-15);
        if (degree == Q::degree + 1 && error > 1e-6) next_is_wrong = true;
      }
  CHECK(next_is_wrong);  // the stated degree is the true one
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("fem: quadrature is exact to its degree and not beyond") {
    check_degree<fem::Gauss<mesh::Tri3, 1>>();
    check_degree<fem::Gauss<mesh::Tri3, 2>>();
    check_degree<fem::Gauss<mesh::Tri3, 4>>();
    check_degree<fem::Gauss<mesh::Tet4, 1>>();
    check_degree<fem::Gauss<mesh::Tet4, 2>>();
    check_degree<fem::Gauss<mesh::Quad4, 1>>();
    check_degree<fem::Gauss<mesh::Quad4, 3>>();
    check_degree<fem::Gauss<mesh::Quad4, 5>>();
    check_degree<fem::Gauss<mesh::Hex8, 1>>();
    check_degree<fem::Gauss<mesh::Hex8, 3>>();
    check_degree<fem::Gauss<mesh::Hex8, 5>>();
  }
}
