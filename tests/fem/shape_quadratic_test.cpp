// SPDX-License-Identifier: MIT
// Functions of all reference cells: nodes, sums, gradients, and the numbering against VTK's own cells.
#include "tunica/fem/shape_quadratic.hpp"
#include "tunica/core/dual.hpp"
#include "tunica/core/types.hpp"
#include "tunica/fem/geometry.hpp"
#include "tunica/fem/shape_wedge.hpp"

#include "support/vtk_python.hpp"

#include <doctest/doctest.h>

#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>

using namespace tunica;

namespace {

template <class C>
constexpr bool on_triangles = C::nodes == 6 && C::dim == 3;  // a wedge

template <class C>
constexpr bool simplex = mesh::Corners<C>::nodes == C::dim + 1 && C::dim > 1;

/// A point inside of the reference cell.
template <class C>
fem::LocalPoint<C::dim> inside(std::mt19937& random) {
  std::uniform_real_distribution<double> u(-0.9, 0.9);
  fem::LocalPoint<C::dim> xi;
  double sum = 0;
  for (std::size_t i = 0; i < C::dim; ++i) {
    const bool barycentric = simplex<C> || (on_triangles<C> && i < 2);
    xi[i] = barycentric ? 0.5 * (u(random) + 1) * (1 - sum) : u(random);
    sum += barycentric ? xi[i] : 0;
  }
  return xi;
}

/// x^i y^j z^k with all exponents of the space of the cell: the functions reproduce it.
template <class C>
double polynomial(const fem::LocalPoint<C::dim>& x) {
  double value = 0.3;
  for (std::size_t i = 0; i < C::dim; ++i) value += (1.1 + static_cast<double>(i)) * x[i];
  if constexpr (mesh::Quadratic<C>)
    for (std::size_t i = 0; i < C::dim; ++i)
      for (std::size_t j = 0; j <= i; ++j) value += (0.7 - static_cast<double>(i + 2 * j)) * x[i] * x[j];
  return value;
}

/// From this reference cell to VTK's, which is [0, 1]^dim.
template <class C>
fem::LocalPoint<C::dim> to_vtk(fem::LocalPoint<C::dim> xi) {
  for (std::size_t i = 0; i < C::dim; ++i)
    if (!simplex<C> && !(on_triangles<C> && i < 2)) xi[i] = 0.5 * (1 + xi[i]);
  return xi;
}

/// Lines for vtk_cells.py: type, nodes; places; a point with the functions there; faces.
template <class C>
void describe(std::ofstream& file, std::mt19937& random) {
  const auto write = [&](const fem::LocalPoint<C::dim>& xi) {
    const auto x = to_vtk<C>(xi);
    for (std::size_t i = 0; i < 3; ++i) file << (i < C::dim ? x[i] : 0) << ' ';
  };
  file << "cell " << C::vtk_type << ' ' << C::nodes << "\nnodes ";
  for (const auto& xi : fem::reference_nodes<C>) write(xi);
  for (int k = 0; k < 5; ++k) {
    const auto xi = inside<C>(random);
    file << "\nfunctions ";
    write(xi);
    for (const double N : fem::Lagrange<C>::values(xi)) file << N << ' ';
  }
  for (const auto& face : C::faces) {
    file << "\nface ";
    for (const int a : face) file << a << ' ';
  }
  file << '\n';
}

template <class... C>
struct Cells {
  static void describe_all(std::ofstream& file) {
    std::mt19937 random(3);
    (describe<C>(file, random), ...);
  }
};

}  // namespace

#define ALL_CELLS                                                                                      \
  mesh::Line2, mesh::Line3, mesh::Tri3, mesh::Tri6, mesh::Quad4, mesh::Quad8, mesh::Quad9, mesh::Tet4, \
      mesh::Tet10, mesh::Hex8, mesh::Hex20, mesh::Hex27, mesh::Wedge6

TEST_SUITE("unit") {
  TEST_CASE_TEMPLATE("fem: functions of every cell are one at their node and sum to one", C, ALL_CELLS) {
    using S = fem::Lagrange<C>;
    static_assert(mesh::Cell<C> && fem::Shape<S> && S::nodes == C::nodes);
    for (std::size_t a = 0; a < C::nodes; ++a) {
      const auto N = S::values(fem::reference_nodes<C>[a]);
      for (std::size_t b = 0; b < C::nodes; ++b) CHECK(N[b] == (a == b ? 1 : 0));
    }
    std::mt19937 random(1);
    for (int trial = 0; trial < 20; ++trial) {
      const auto xi = inside<C>(random);
      const auto N = S::values(xi);
      double sum = 0, field = 0;
      for (std::size_t a = 0; a < C::nodes; ++a) {
        sum += N[a];
        field += N[a] * polynomial<C>(fem::reference_nodes<C>[a]);
      }
      CHECK(std::abs(sum - 1) < 2e-15);
      CHECK(std::abs(field - polynomial<C>(xi)) < 2e-14);
    }
  }

  TEST_CASE_TEMPLATE("fem: gradients of every cell are those of dual numbers", C, ALL_CELLS) {
    using S = fem::Lagrange<C>;
    using D = Dual<double, C::dim>;
    std::mt19937 random(2);
    for (int trial = 0; trial < 20; ++trial) {
      const auto xi = inside<C>(random);
      std::array<D, C::dim> x;
      for (std::size_t i = 0; i < C::dim; ++i) x[i] = D::variable(xi[i], static_cast<int>(i));
      const auto N = S::template values<D>(x);
      const auto G = S::gradients(xi);
      for (std::size_t a = 0; a < C::nodes; ++a)
        for (std::size_t i = 0; i < C::dim; ++i) CHECK(std::abs(N[a].d[i] - G[a][i]) < 4e-15);
    }
  }

  TEST_CASE_TEMPLATE("fem: functions and gradients of quadratic cells are constants for the compiler", C,
                     mesh::Line3, mesh::Tri6, mesh::Quad8, mesh::Quad9, mesh::Tet10, mesh::Hex20, mesh::Hex27,
                     mesh::Wedge6) {
    using T = fem::Tables<fem::Lagrange<C>, fem::Gauss<C, 2>>;
    constexpr double sum = [] {
      double s = 0;
      for (const auto& N : T::values)
        for (const double v : N) s += v;
      for (const auto& G : T::gradients)
        for (const auto& g : G) s += g[0];
      return s;
    }();
    CHECK(sum == doctest::Approx(fem::Gauss<C, 2>::size));
  }

  TEST_CASE("fem: a wedge's collapsed face has the functions of the triangle") {
    // nodes {0, 1, 2, 2}: N_2 + N_3 is L_2, and the point of a bilinear map has L_0, L_1 as well
    std::mt19937 random(4);
    for (int k = 0; k < 20; ++k) {
      const auto N = fem::Lagrange<mesh::Quad4>::values(inside<mesh::Quad4>(random));
      const fem::LocalPoint<2> xi{N[1], N[2] + N[3]};  // on the triangle (0, 0), (1, 0), (0, 1)
      const auto L = fem::Lagrange<mesh::Tri3>::values(xi);
      CHECK(std::abs(L[0] - N[0]) < 1e-15);
    }
    // and the rule of the square is exact on it to degree 2: the collapsed map adds one to a coordinate
    using Rule = fem::Gauss<mesh::Quad4, 3>;
    for (int i = 0; i <= 2; ++i)
      for (int j = 0; i + j <= 2; ++j) {
        double sum = 0;
        for (std::size_t q = 0; q < Rule::size; ++q) {
          const auto N = fem::Lagrange<mesh::Quad4>::values(Rule::points[q]);
          const double det = (1 - Rule::points[q][1]) / 8;  // of (xi, eta) -> (N_1, N_2 + N_3)
          sum += Rule::weights[q] * det * std::pow(N[1], i) * std::pow(N[2] + N[3], j);
        }
        const auto factorial = [](int n) { return std::tgamma(n + 1.0); };
        CHECK(std::abs(sum - factorial(i) * factorial(j) / factorial(i + j + 2)) < 1e-15);
      }
  }

  TEST_CASE("fem: nodes and functions and faces are those of VTK's cells") {
    const auto python = test::vtk_python();
    if (!python) return;
    const auto path = std::filesystem::temp_directory_path() / ("tunica_cells_" + std::to_string(::getpid()));
    {
      std::ofstream file(path);
      file.precision(17);
      Cells<ALL_CELLS>::describe_all(file);
    }
    const std::string script =
        std::string(__FILE__).substr(0, std::string(__FILE__).rfind('/')) + "/vtk_cells.py";
    CHECK(std::system((*python + " '" + script + "' '" + path.string() + "'").c_str()) == 0);
    std::filesystem::remove(path);
  }
}
