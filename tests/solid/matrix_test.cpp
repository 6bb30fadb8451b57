// SPDX-License-Identifier: MIT
// Every law in every cell with every cure of locking: tangents against duals and differences, and frames.
#include "support/any_law.hpp"
#include "support/unit_cells.hpp"
#include "tunica/core/dual.hpp"
#include "tunica/fem/shape_quadratic.hpp"
#include "tunica/fem/shape_wedge.hpp"
#include "tunica/solid/kernel.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <type_traits>

using namespace tunica;
using namespace tunica::solid;

namespace {

/// Relative to the largest entry of K v.
struct Errors {
  double energy = 0;       // dW along v against f . v, relative to |f| |v|
  double duals = 0;        // K v against the derivative of the forces along v by duals
  double differences = 0;  // and by central differences
  double action = 0;       // the action without K against K v
  double skew = 0;         // largest K_ij - K_ji of the largest entry, where K is kept whole
  double frame = 0;        // forces and energy after a turn, of the largest force

  void keep(const Errors& e) {
    const auto worse = [](double& mine, double its) { mine = its <= mine ? mine : its; };
    worse(energy, e.energy), worse(duals, e.duals), worse(differences, e.differences);
    worse(action, e.action), worse(skew, e.skew), worse(frame, e.frame);
  }
};

template <class Law, class S, int Points, class Named>
std::array<PointOf<Law, S>, Points> data_of(const Named& named) {
  std::array<PointOf<Law, S>, Points> data;
  for (std::size_t q = 0; q < Points; ++q)
    data[q] = cast_point<Law, S, double>(named.point(0.07 * static_cast<double>(q)));
  return data;
}

/// The block (a, b) of a tangent, i and k.
template <class K>
double entry(const typename K::template Tangent<double>& t, int a, int b, int i, int k) {
  if (K::Places::count == K::nodes * K::nodes || a <= b) return t.K[K::Places::place(a, b)][K::dim * i + k];
  return t.K[K::Places::place(b, a)][K::dim * k + i];
}

template <class K, class Named>
Errors errors_in(const Named& named, double seed) {
  using Law = decltype(named.law);
  using D = Dual<double, 1>;
  using C = typename K::Cell;
  const auto& law = named.law;
  // What a pair reads is read by its isochoric part.
  const auto data = data_of<Law, double, K::points>(named);
  const auto dual_data = data_of<Law, D, K::points>(named);
  const test::DeformedCell<C, double> at(seed);
  typename K::template Nodal<D> X, u;
  for (int a = 0; a < K::nodes; ++a)
    for (int i = 0; i < K::dim; ++i) X[a][i] = at.X[a][i], u[a][i] = at.u[a][i], u[a][i].d[0] = at.v[a][i];
  auto t = std::make_unique<typename K::template Tangent<double>>();
  typename K::template Forces<D> f;
  typename K::template Nodal<double> Kv;
  K::tangent(law, at.X, at.u, data.data(), *t);
  K::forces(law, X, u, dual_data.data(), f);
  K::action(law, at.X, at.u, data.data(), at.v, Kv);
  REQUIRE(t->smallest_J > 0.2);

  constexpr double h = 1e-6;
  typename K::template Forces<double> side[2];
  for (const int s : {0, 1}) {
    typename K::template Nodal<double> moved;
    for (int a = 0; a < K::nodes; ++a)
      for (int i = 0; i < K::dim; ++i) moved[a][i] = at.u[a][i] + (s == 0 ? -h : h) * at.v[a][i];
    K::forces(law, at.X, moved, data.data(), side[s]);
  }

  Errors e;
  double scale = 0, force = 0, speed = 0, work = 0, largest = 0;
  for (int a = 0; a < K::nodes; ++a)
    for (int i = 0; i < K::dim; ++i) {
      scale = std::max(scale, std::abs(f.f[a][i].d[0]));
      force = std::max(force, std::abs(t->f[a][i]));
      speed = std::max(speed, std::abs(at.v[a][i]));
      work += t->f[a][i] * at.v[a][i];
    }
  for (int a = 0; a < K::nodes; ++a)
    for (int i = 0; i < K::dim; ++i) {
      double product = 0;
      for (int b = 0; b < K::nodes; ++b)
        for (int k = 0; k < K::dim; ++k) {
          product += entry<K>(*t, a, b, i, k) * at.v[b][k];
          largest = std::max(largest, std::abs(entry<K>(*t, a, b, i, k)));
          e.skew = std::max(e.skew, std::abs(entry<K>(*t, a, b, i, k) - entry<K>(*t, b, a, k, i)));
        }
      const double difference = (side[1].f[a][i] - side[0].f[a][i]) / (2 * h);
      e.keep({.energy = std::abs(t->f[a][i] - f.f[a][i].value) / force,
              .duals = std::abs(product - f.f[a][i].d[0]) / scale,
              .differences = std::abs(product - difference) / scale,
              .action = std::abs(Kv[a][i] - product) / scale});
    }
  e.skew /= largest;
  if constexpr (!K::bar) {
    const D W = K::energy(law, X, u, dual_data.data());
    e.keep({.energy = std::abs(W.d[0] - work) / (force * speed)});
  }

  // A turn of all: forces turn with it, the energy stays.
  const Tensor<double> Q = K::dim == 2 ? test::rotation(0, -1.9) : test::rotation(0.7, -1.9);
  typename K::template Nodal<double> turned;
  for (int a = 0; a < K::nodes; ++a)
    for (int i = 0; i < K::dim; ++i) {
      turned[a][i] = -at.X[a][i];
      for (int j = 0; j < K::dim; ++j) turned[a][i] += Q(i, j) * (at.X[a][j] + at.u[a][j]);
    }
  auto g = std::make_unique<typename K::template Tangent<double>>();
  K::tangent(law, at.X, turned, data.data(), *g);
  for (int a = 0; a < K::nodes; ++a)
    for (int i = 0; i < K::dim; ++i) {
      double want = 0;
      for (int j = 0; j < K::dim; ++j) want += Q(i, j) * t->f[a][j];
      e.keep({.frame = std::abs(g->f[a][i] - want) / force});
      for (int b = 0; b < K::nodes; ++b)
        for (int k = 0; k < K::dim; ++k) {
          double K_want = 0;
          for (int j = 0; j < K::dim; ++j)
            for (int l = 0; l < K::dim; ++l) K_want += Q(i, j) * Q(k, l) * entry<K>(*t, a, b, j, l);
          e.keep({.frame = std::abs(entry<K>(*g, a, b, i, k) - K_want) / largest});
        }
    }
  if constexpr (!K::bar) {
    const double before = K::energy(law, at.X, at.u, data.data()),
                 after = K::energy(law, at.X, turned, data.data());
    e.keep({.frame = std::abs(after - before) / force});
  }
  return e;
}

template <class K, class Laws>
void check(const std::string& cell, const Laws& laws) {
  constexpr bool symmetric = K::Places::count < K::nodes * K::nodes;  // all but F-bar
  Errors worst;
  std::string by = "none";
  for (const auto& named : laws) {
    INFO(cell << ", " << named.name);
    Errors e;
    for (const double seed : {0.0, 1.0}) e.keep(errors_in<K>(named, seed));
    CHECK(e.energy < 1e-12);
    CHECK(e.duals < 1e-12);
    CHECK(e.differences < 1e-7);
    CHECK(e.action < 1e-12);
    CHECK(e.frame < 1e-12);
    if (symmetric) CHECK(e.skew < 1e-13);
    if (e.duals > worst.duals) by = named.name;
    worst.keep(e);
  }
  if (!symmetric) CHECK(worst.skew > 1e-3);
  MESSAGE(cell << ", " << laws.size() << " laws: energy " << worst.energy << ", duals " << worst.duals << " ("
               << by << "), differences " << worst.differences << ", action " << worst.action << ", frame "
               << worst.frame);
}

/// An affine displacement has one stress, and its forces are P int G_a dV: those cancel at inner nodes of any
/// patch of cells, if the rule of the kernel integrates them. Largest difference of the largest force.
template <class K, class Named>
double patch_error(const Named& named) {
  using Law = decltype(named.law);
  using C = typename K::Cell;
  constexpr bool simplex = C::vtk_type == mesh::Tri3::vtk_type || C::vtk_type == mesh::Tri6::vtk_type ||
                           C::vtk_type == mesh::Tet4::vtk_type || C::vtk_type == mesh::Tet10::vtk_type;
  using Rule = fem::Gauss<C, simplex || C::nodes == 6 ? 5 : 7>;  // another than the kernel's
  test::DeformedCell<C, double> at;
  if constexpr (std::is_same_v<C, mesh::Tet10>) {  // straight edges: its rule is of second degree
    for (const auto& e : C::edges)
      for (int i = 0; i < 3; ++i) at.X[e[2]][i] = 0.5 * (at.X[e[0]][i] + at.X[e[1]][i]);
  }
  Tensor<double> H{.m = {.3, .2, -.1, .1, -.15, .2, -.05, .1, .1}};
  if (K::dim == 2) H.m[2] = H.m[5] = H.m[6] = H.m[7] = H.m[8] = 0;
  typename K::template Nodal<double> u;
  for (int a = 0; a < K::nodes; ++a)
    for (int i = 0; i < K::dim; ++i) {
      u[a][i] = 0;
      for (int j = 0; j < K::dim; ++j) u[a][i] += H(i, j) * at.X[a][j];
    }
  std::array<PointOf<Law, double>, K::points> data;
  data.fill(PointOf<Law, double>{named.point(0.1).m});
  typename K::template Forces<double> f;
  K::forces(named.law, at.X, u, data.data(), f);
  typename K::template Nodal<double> want{};
  const Tensor<double> P = solid::stress(named.law, identity<double>() + H, data[0]);
  for (std::size_t q = 0; q < Rule::size; ++q) {
    const auto point = element_point<C, Rule>(at.X, q);
    point.add_forces(P, point.weight, want);
  }
  double worst = 0, largest = 0;
  for (int a = 0; a < K::nodes; ++a)
    for (int i = 0; i < K::dim; ++i) {
      worst = std::max(worst, std::abs(f.f[a][i] - want[a][i]));
      largest = std::max(largest, std::abs(want[a][i]));
    }
  return worst / largest;
}

template <class K, class Laws>
void check_patch(const std::string& cell, const Laws& laws) {
  double worst = 0;
  for (const auto& named : laws) {
    INFO(cell << ", " << named.name);
    const double error = patch_error<K>(named);
    CHECK(error < 1e-13);
    worst = std::max(worst, error);
  }
  MESSAGE(cell << ", " << laws.size() << " laws: forces of an affine displacement off by " << worst);
}

}  // namespace

#define TUNICA_MATRIX_CELLS                                                                           \
  mesh::Tri3, mesh::Tri6, mesh::Quad4, mesh::Tet4, mesh::Tet10, mesh::Hex8, mesh::Hex20, mesh::Hex27, \
      mesh::Wedge6

TEST_SUITE("unit") {
  TEST_CASE_TEMPLATE("solid: every law has its derivatives and turns with its frame in every cell", C,
                     TUNICA_MATRIX_CELLS) {
    const std::string name = std::to_string(C::nodes) + " nodes in " + std::to_string(C::dim) + "-D, ";
    const auto materials = test::every_material(20);
    check<Kernel<C>>(name + "pointwise", materials);
    check<Kernel<C, MeanVolume>>(name + "mean volume", test::every_pair(20));
    if constexpr (C::nodes != C::dim + 1) {
      check<Kernel<C, FBar>>(name + "F-bar", materials);
      check<Kernel<C, CentreVolume>>(name + "F-bar with its pressure apart", test::every_pair(20));
    }
    if constexpr (C::nodes >= 20)
      check<Kernel<C, LinearVolume>>(name + "linear volume", test::every_pair(20));
  }

  TEST_CASE_TEMPLATE("solid: every law in every cell passes the patch test", C, TUNICA_MATRIX_CELLS) {
    const std::string name = std::to_string(C::nodes) + " nodes in " + std::to_string(C::dim) + "-D, ";
    const auto materials = test::every_material(20);
    check_patch<Kernel<C>>(name + "pointwise", materials);
    check_patch<Kernel<C, MeanVolume>>(name + "mean volume", test::every_pair(20));
    if constexpr (C::nodes != C::dim + 1) {
      check_patch<Kernel<C, FBar>>(name + "F-bar", materials);
      check_patch<Kernel<C, CentreVolume>>(name + "F-bar with its pressure apart", test::every_pair(20));
    }
    if constexpr (C::nodes >= 20)
      check_patch<Kernel<C, LinearVolume>>(name + "linear volume", test::every_pair(20));
  }
}
