// SPDX-License-Identifier: MIT
// Newton's method in whole bodies: every law in every cell with every cure of locking ends quadratically.
#include "support/any_law.hpp"
#include "tunica/fem/shape_quadratic.hpp"
#include "tunica/fem/shape_wedge.hpp"
#include "tunica/mesh/quadratic.hpp"
#include "tunica/meshing/box.hpp"
#include "tunica/solid/statics.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <sstream>
#include <string>
#include <type_traits>
#include <vector>

using namespace tunica;
using namespace tunica::solid;

namespace {

/// The unit cube, 2 boxes a side, in cells of C; its inner nodes are moved by up to 0.1.
template <mesh::Cell C>
mesh::Mesh<C, 3> distorted() {
  const auto moved = [](auto mesh) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> shift(-0.1, 0.1);
    for (Index k = 0; k < mesh.node_count(); ++k) {
      const Vec3 x = mesh.nodes.col(k);
      if ((x.array() > 1e-9).all() && (x.array() < 1 - 1e-9).all())
        for (int i = 0; i < 3; ++i) mesh.nodes(i, k) += shift(random);
    }
    return mesh;
  };
  if constexpr (std::is_same_v<C, mesh::Tet4>) {
    return moved(meshing::box_tets(2));
  } else if constexpr (std::is_same_v<C, mesh::Tet10>) {
    return mesh::quadratic<C>(moved(meshing::box_tets(2)));
  } else {
    const auto hexes = moved(meshing::box_hexes(2));
    if constexpr (mesh::Quadratic<C>) {
      return mesh::quadratic<C>(hexes);
    } else if constexpr (std::is_same_v<C, mesh::Wedge6>) {
      mesh::Mesh<C, 3> mesh;
      mesh.nodes = hexes.nodes;
      mesh.cells.resize(6, 2 * hexes.cells.cols());
      const int halves[2][6] = {{0, 1, 2, 4, 5, 6}, {0, 2, 3, 4, 6, 7}};
      for (Eigen::Index e = 0; e < mesh.cells.cols(); ++e)
        for (int a = 0; a < 6; ++a) mesh.cells(a, e) = hexes.cells(halves[e % 2][a], e / 2);
      return mesh;
    } else {
      return hexes;
    }
  }
}

struct Ended {
  StaticsReport report{};
  double slope = 0;         // of ln |r| after an iteration against ln |r| before it, near the end
  double contraction = 0;   // largest e_next/e^2 of the last step, once a hundredth of its scale is left
  std::string residuals{};  // of the last step
};

/// Pulled by 20 % and sheared by 10 % of its length between two ends that are held, in two steps. Then the
/// state reached is shaken by 4e-4 and by 1e-4 the same way: where Newton is quadratic, what is left differs
/// 16 times.
template <mesh::Cell C, class Given, class Named>
Ended pulled(const mesh::Mesh<C, 3>& mesh, const Given& given, const Named& named) {
  StaticsOptions options{.first_step = 0.5, .growth = 1};
  options.newton.tolerance = 1e-13;
  options.newton.increment_tolerance = 1e-15;
  Statics<C, Given> wall{mesh, given, options};
  wall.point_field([&](Index, const Vec3& x) {
    typename std::remove_cvref_t<decltype(wall.laws())>::PointData data;
    data.m = named.point(0.2 * x[0]).m;
    return data;
  });
  std::vector<char> held(static_cast<std::size_t>(mesh.node_count()), 0);
  for (Index n = 0; n < mesh.node_count(); ++n)
    for (const double end : {0.0, 1.0})
      if (std::abs(mesh.nodes(0, n) - end) < 1e-9) {
        held[static_cast<std::size_t>(n)] = 1;
        wall.prescribe(n, Axis::x, 0.2 * end);
        wall.prescribe(n, Axis::y, 0.1 * end);
        wall.prescribe(n, Axis::z, 0);
      }
  Ended ended{.report = wall.solve()};
  const auto& h = ended.report.history;
  std::ostringstream text;
  for (std::size_t k = 0; k < h.size(); ++k) {
    text << ' ' << h[k];
    if (k > 0 && h[k - 1] < 1e-2 && h[k - 1] > 1e-7)
      ended.contraction = std::max(ended.contraction, (h[k] - 1e-13) / (h[k - 1] * h[k - 1]));
  }
  ended.residuals = text.str();
  if (!ended.report) return ended;

  const Points<3> reached = wall.displacement();
  double before[2], after[2];
  for (const int k : {0, 1}) {
    Points<3> u = reached;
    for (Index n = 0; n < mesh.node_count(); ++n)
      for (int i = 0; i < 3 && !held[static_cast<std::size_t>(n)]; ++i)
        u(i, n) += (k == 0 ? 4e-4 : 1e-4) * std::sin(3.7 * n + 2.3 * i + 1);
    wall.start(u);
    const auto again = wall.step();
    REQUIRE(again);
    REQUIRE(again.history.size() > 2);
    before[k] = again.history[0], after[k] = again.history[1];
  }
  ended.slope = std::log(after[0] / after[1]) / std::log(before[0] / before[1]);
  return ended;
}

template <mesh::Cell C, class Cure, class Laws>
void check(const std::string& cell, const Laws& laws) {
  const auto mesh = distorted<C>();
  double least = 9, greatest = 0, contraction = 0, last = 9;
  int most = 0;
  for (const auto& named : laws) {
    const Ended ended = pulled(mesh, with<Cure>(named.law), named);
    INFO(cell << ", " << named.name << ": residuals" << ended.residuals);
    CHECK(ended.report);
    CHECK(ended.report.cuts == 0);
    CHECK(ended.report.steps == 2);
    CHECK(ended.slope >= 1.9);
    CHECK(ended.contraction < 10);
    least = std::min(least, ended.slope);
    greatest = std::max(greatest, ended.slope);
    contraction = std::max(contraction, ended.contraction);
    last = std::min(last, la::observed_order(ended.report.history, 5e-14));
    most = std::max(most, ended.report.solve.iterations);
  }
  MESSAGE(cell << ", " << laws.size() << " laws: slopes " << least << " to " << greatest
               << ", e_next/e^2 at most " << contraction << ", at most " << most
               << " iterations in two steps; least slope of three residuals " << last);
}

}  // namespace

TEST_SUITE("convergence") {
  TEST_CASE_TEMPLATE("solid: Newton ends quadratically for every law in every cell", C, mesh::Tet4,
                     mesh::Tet10, mesh::Hex8, mesh::Hex20, mesh::Hex27, mesh::Wedge6) {
    const std::string name = std::to_string(C::nodes) + " nodes, ";
    const auto materials = test::every_material(20);
    const auto pairs = test::every_pair(20);
    check<C, Pointwise>(name + "pointwise", materials);
    check<C, MeanVolume>(name + "mean volume", pairs);
    if constexpr (C::nodes != 4 && C::nodes != 10) {
      check<C, FBar>(name + "F-bar", materials);
      check<C, FBar>(name + "F-bar with its pressure apart", pairs);
    }
    if constexpr (C::nodes == 27) check<C, LinearVolume>(name + "linear volume", pairs);
    if constexpr (C::nodes == 4) check<C, NodalPressure>(name + "nodal pressures", pairs);
  }
}
