// SPDX-License-Identifier: MIT
#include "support/tube_cells.hpp"
#include "tunica/solid/output.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

using namespace tunica;
using namespace tunica::solid;

namespace {

constexpr double stretch = 1.10;

struct Errors {
  test::StressError cells, nodes;
  double mises = 0, hoop = 0, fibre = 0, J = 0;  // largest at the nodes; hoop: of the first principal stress
};

/// Errors of the fields of the thick tube under law (17), fibres around it.
template <mesh::Cell C, class Locking>
Errors errors(const test::ThickTube& tube, int n, double kappa) {
  const auto mesh = test::quarter_of_tube<C>(n, tube.inner, tube.outer);
  const Hyperelastic law{Yeoh{.c10 = tube.c10, .c20 = tube.c20}, Quadratic{.kappa = kappa}};
  auto wall = test::wall_of_tube(mesh, with<Locking>(law), tube.pressure(stretch));
  const auto report = wall.solve();
  REQUIRE(report);
  Points<3> around = test::middles(mesh, mesh.nodes);
  for (Eigen::Index e = 0; e < around.cols(); ++e)
    around.col(e) = Vec3(-around(1, e), around(0, e), 0).eval();
  const Points<3> x = mesh.nodes + wall.displacement();
  const auto cells = cell_fields(wall.body(), wall.unknowns(), around),
             nodes = nodal_fields(wall.body(), wall.unknowns(), around);
  Errors out{.cells = test::stress_error(tube, stretch, test::middles(mesh, x), cells.cauchy),
             .nodes = test::stress_error(tube, stretch, x, nodes.cauchy)};
  const double largest = tube.stress_at(stretch * tube.inner, stretch).tt;
  for (Eigen::Index k = 0; k < x.cols(); ++k) {
    const double R = mesh.nodes.col(k).template head<2>().norm(),
                 r = std::sqrt(R * R + (stretch * stretch - 1) * tube.inner * tube.inner);
    const auto s = tube.stress_at(r, stretch);
    const double mises =
        std::sqrt(0.5 * (std::pow(s.rr - s.tt, 2) + std::pow(s.tt - s.zz, 2) + std::pow(s.zz - s.rr, 2)));
    out.mises = std::max(out.mises, std::abs(nodes.von_mises[k] - mises) / largest);
    out.hoop = std::max(out.hoop, std::abs(nodes.principal(0, k) - s.tt) / largest);
    out.fibre = std::max(out.fibre, std::abs(nodes.fibre_stretch[k] - r / R));
    out.J = std::max(out.J, std::abs(nodes.J[k] - 1));
  }
  return out;
}

double order(double coarse, double fine) {
  return std::log2(coarse / fine);
}

/// Errors of n/2 and n cells: the largest at the nodes fall with `least` at least, as their mean does, and
/// the stresses of the cells are off by less than 1 % in the mean.
template <mesh::Cell C, class Locking>
void ladder(const std::string& name, int finest, double kappa_over_mu, double least) {
  const test::ThickTube tube;
  std::vector<Errors> all;
  for (const int n : {finest / 2, finest}) {
    all.push_back(errors<C, Locking>(tube, n, kappa_over_mu * 2 * tube.c10));
    const Errors& e = all.back();
    MESSAGE(name << ", " << n << " cells: stresses of cells off by " << 100 * e.cells.mean
                 << " %, at nodes by " << 100 * e.nodes.mean << " % (at most " << 100 * e.nodes.largest
                 << " %), von Mises " << 100 * e.mises << " %, first principal " << 100 * e.hoop
                 << " %, stretch " << e.fibre << ", J " << e.J);
  }
  const Errors &a = all[0], &b = all[1];
  const double mean = order(a.nodes.mean, b.nodes.mean), largest = order(a.nodes.largest, b.nodes.largest),
               mises = order(a.mises, b.mises), hoop = order(a.hoop, b.hoop), fibre = order(a.fibre, b.fibre);
  MESSAGE(name << ": order of cells " << order(a.cells.mean, b.cells.mean) << ", nodes " << mean
               << ", of the largest error there " << largest << ", von Mises " << mises
               << ", first principal " << hoop << ", stretch " << fibre);
  for (const double o : {mean, largest, mises, hoop, fibre}) CHECK(o > least);
  CHECK(b.cells.mean < 0.01);
}

}  // namespace

TEST_SUITE("convergence") {
  TEST_CASE("solid: all fields at the nodes of the thick tube converge in every cell") {
    using namespace mesh;
    // Recovered by linear fields: second order on grids of hexahedra; of tetrahedra the patches at the
    // boundary are lopsided, and 3/2 is left; linear tetrahedra have stresses of first order.
    ladder<Hex8, MeanVolume>("Hex8, MeanVolume", 8, 1e4, 1.7);
    ladder<Hex8, FBar>("Hex8, FBar", 8, 1e4, 1.7);
    ladder<Hex20, MeanVolume>("Hex20, MeanVolume", 4, 1e4, 1.7);
    ladder<Hex27, MeanVolume>("Hex27, MeanVolume", 4, 1e4, 1.7);
    ladder<Hex27, Pointwise>("Hex27, Pointwise", 4, 1e3, 1.7);
    ladder<Tet10, MeanVolume>("Tet10, MeanVolume", 8, 1e4, 1.4);
    ladder<Tet4, NodalPressure>("Tet4, NodalPressure", 8, 1e4, 1.1);
  }
}
