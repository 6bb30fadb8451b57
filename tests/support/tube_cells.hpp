// SPDX-License-Identifier: MIT
// A quarter of the thick tube in any cell, its wall, and how far stresses are off those of the closed form.
#pragma once

#include "support/thick_tube.hpp"
#include "tunica/fem/shape_quadratic.hpp"
#include "tunica/fem/shape_wedge.hpp"
#include "tunica/mesh/quadratic.hpp"
#include "tunica/meshing/box.hpp"
#include "tunica/solid/laws.hpp"
#include "tunica/solid/statics.hpp"
#include "tunica/solid/stress.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <type_traits>

namespace tunica::test {

/// A box of cells of C; of wedges, each hexahedron cut in two.
template <mesh::Cell C>
[[nodiscard]] mesh::Mesh<C, 3> box_of(const meshing::Block& block) {
  if constexpr (std::is_same_v<C, mesh::Hex8>) {
    return meshing::box_hexes(block);
  } else if constexpr (std::is_same_v<C, mesh::Tet4>) {
    return meshing::box_tets(block);
  } else if constexpr (std::is_same_v<C, mesh::Tet10>) {
    return mesh::quadratic<C>(meshing::box_tets(block));
  } else if constexpr (std::is_same_v<C, mesh::Wedge6>) {
    const auto hexes = meshing::box_hexes(block);
    mesh::Mesh<C, 3> mesh;
    mesh.nodes = hexes.nodes;
    mesh.cells.resize(6, 2 * hexes.cells.cols());
    const int halves[2][6] = {{0, 1, 2, 4, 5, 6}, {0, 2, 3, 4, 6, 7}};
    for (Eigen::Index e = 0; e < mesh.cells.cols(); ++e)
      for (int a = 0; a < 6; ++a) mesh.cells(a, e) = hexes.cells(halves[e % 2][a], e / 2);
    return mesh;
  } else {
    return mesh::quadratic<C>(meshing::box_hexes(block));
  }
}

/// n cells through the wall and 4 n around, one along an axis; all nodes are bent onto circles. Patches: x0
/// inside, x1 outside, y0 and y1 the planes y = 0 and x = 0, z0 and z1 the ends.
template <mesh::Cell C>
[[nodiscard]] mesh::Mesh<C, 3> quarter_of_tube(int n, double inner, double outer) {
  mesh::Mesh<C, 3> mesh =
      box_of<C>(meshing::Block{.cells = {n, 4 * n, 1}, .hi = Vec3(1, 1, (outer - inner) / n)});
  for (Index k = 0; k < mesh.node_count(); ++k) {
    const double r = inner + (outer - inner) * mesh.nodes(0, k),
                 angle = 0.5 * std::numbers::pi * mesh.nodes(1, k);
    mesh.nodes(0, k) = r * std::cos(angle);
    mesh.nodes(1, k) = r * std::sin(angle);
  }
  return mesh;
}

/// Its wall in plane strain under a pressure inside [Pa].
template <mesh::Cell C, class Given>
[[nodiscard]] solid::Statics<C, Given> wall_of_tube(const mesh::Mesh<C, 3>& mesh, const Given& law,
                                                    double pressure) {
  solid::Statics<C, Given> wall{mesh, law};
  for (const char* end : {"z0", "z1"}) wall.fix(mesh.patch(end), solid::Axis::z);
  wall.fix(mesh.patch("y0"), solid::Axis::y);
  wall.fix(mesh.patch("y1"), solid::Axis::x);
  wall.pressure(mesh.patch("x0"), pressure);
  return wall;
}

struct StressError {
  double largest, mean;  // of s_rr, s_tt and s_zz, of the largest hoop stress; mean: root of the mean square
};

/// sigma: a column at each of the deformed points x, 3 x columns [m].
[[nodiscard]] inline StressError stress_error(const ThickTube& tube, double inner_stretch, const Points<3>& x,
                                              const solid::StressField& sigma) {
  StressError e{0, 0};
  for (Eigen::Index k = 0; k < x.cols(); ++k) {
    const double r = std::max(x.col(k).head<2>().norm(), inner_stretch * tube.inner), c = x(0, k) / r,
                 s = x(1, k) / r;
    const auto exact = tube.stress_at(r, inner_stretch);
    const auto at = sigma.col(k);
    for (const double off :
         {c * c * at[0] + s * s * at[1] + 2 * c * s * at[3] - exact.rr,
          s * s * at[0] + c * c * at[1] - 2 * c * s * at[3] - exact.tt, at[2] - exact.zz}) {
      e.largest = std::max(e.largest, std::abs(off));
      e.mean += off * off / (3 * static_cast<double>(x.cols()));
    }
  }
  const double hoop = tube.stress_at(inner_stretch * tube.inner, inner_stretch).tt;
  return {e.largest / hoop, std::sqrt(e.mean) / hoop};
}

/// The means of the nodes of the cells.
template <mesh::Cell C>
[[nodiscard]] Points<3> middles(const mesh::Mesh<C, 3>& mesh, const Points<3>& nodes) {
  Points<3> x = Points<3>::Zero(3, mesh.cell_count());
  for (Index e = 0; e < mesh.cell_count(); ++e)
    for (const Index k : mesh.cells.col(e)) x.col(e) += nodes.col(k) / C::nodes;
  return x;
}

}  // namespace tunica::test
