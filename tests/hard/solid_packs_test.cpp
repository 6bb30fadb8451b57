// SPDX-License-Identifier: MIT
// Every law in every cell with every cure of locking, in packs of doubles and of floats, against doubles.
#include "support/any_law.hpp"
#include "support/unit_cells.hpp"
#include "tunica/core/pack_math.hpp"
#include "tunica/fem/shape_quadratic.hpp"
#include "tunica/fem/shape_wedge.hpp"
#include "tunica/solid/kernel.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>

using namespace tunica;
using namespace tunica::solid;

namespace {

template <class Law, class S, int Points, class Named>
std::array<PointOf<Law, S>, Points> data_of(const Named& named) {
  std::array<PointOf<Law, S>, Points> data;
  for (std::size_t q = 0; q < Points; ++q) {
    const auto point = named.point(0.07 * static_cast<double>(q));
    for (std::size_t k = 0; k < point.m.size(); ++k)
      data[q].m[k] = S(static_cast<typename Lanes<S>::type>(point.m[k]));
  }
  return data;
}

/// The largest difference of K of a lane from the same element in double, of its largest entry, and of f, of
/// its largest or of what K makes of displacements of a tenth of the cell, which roundings of F come with.
template <class K, class S, class Named>
double off(const Named& named) {
  using Law = decltype(named.law);
  using Cell = typename K::Cell;
  auto pack = std::make_unique<typename K::template Tangent<S>>();
  auto one = std::make_unique<typename K::template Tangent<double>>();
  const test::DeformedCell<Cell, S> at;
  const auto data = data_of<Law, S, K::points>(named);
  const auto single = data_of<Law, double, K::points>(named);
  K::tangent(named.law, at.X, at.u, data.data(), *pack);
  double worst = 0;
  const auto keep = [&](double e) { worst = e <= worst ? worst : e; };
  for (int l = 0; l < Lanes<S>::count; ++l) {
    test::DeformedCell<Cell, double> lane;
    for (int a = 0; a < K::nodes; ++a)
      for (int i = 0; i < K::dim; ++i)
        lane.X[a][i] = static_cast<double>(at.X[a][i][l]), lane.u[a][i] = static_cast<double>(at.u[a][i][l]);
    K::tangent(named.law, lane.X, lane.u, single.data(), *one);
    REQUIRE(one->smallest_J > 0.2);
    double stiffness = 0;
    for (const auto& block : one->K)
      for (const double k : block) stiffness = std::max(stiffness, std::abs(k));
    double force = 0.1 * stiffness;
    for (const auto& f : one->f)
      for (const double k : f) force = std::max(force, std::abs(k));
    for (int p = 0; p < K::Places::count; ++p)
      for (int k = 0; k < K::dim * K::dim; ++k)
        keep(std::abs(static_cast<double>(pack->K[p][k][l]) - one->K[p][k]) / stiffness);
    for (int a = 0; a < K::nodes; ++a)
      for (int i = 0; i < K::dim; ++i)
        keep(std::abs(static_cast<double>(pack->f[a][i][l]) - one->f[a][i]) / force);
  }
  return worst;
}

template <class K, class Laws>
void check(const std::string& cell, const Laws& laws) {
  double doubles = 0, floats = 0;
  std::string by = "none";
  for (const auto& named : laws) {
    INFO(cell << ", " << named.name);
    const double d = off<K, Pack<double>>(named), f = off<K, Pack<float>>(named);
    CHECK(d < 1e-12);
    CHECK(f < 1e-5);
    if (f > floats) by = named.name;
    doubles = std::max(doubles, d), floats = std::max(floats, f);
  }
  MESSAGE(cell << ", " << laws.size() << " laws: packs of double off by " << doubles << ", of float by "
               << floats << " (" << by << ")");
}

}  // namespace

#define TUNICA_MATRIX_CELLS                                                                           \
  mesh::Tri3, mesh::Tri6, mesh::Quad4, mesh::Tet4, mesh::Tet10, mesh::Hex8, mesh::Hex20, mesh::Hex27, \
      mesh::Wedge6

TEST_SUITE("hard") {
  TEST_CASE_TEMPLATE("solid: packs of every law in every cell hold the elements of their lanes", C,
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
}
