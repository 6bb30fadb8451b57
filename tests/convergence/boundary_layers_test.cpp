// SPDX-License-Identifier: MIT
// What boundary layers are for: the shear at the wall of a tube, with layers and without, at equal numbers of
// nodes.
#include "tunica/meshing/boundary_layers.hpp"

#include "support/flow.hpp"
#include "support/surfaces.hpp"
#include "tunica/fluid/projection.hpp"
#include "tunica/mesh/adjacency.hpp"
#include "tunica/mesh/cells_behind.hpp"
#include "tunica/meshing/remesh.hpp"
#include "tunica/meshing/tetrahedra.hpp"

#include <doctest/doctest.h>

#include <Eigen/Geometry>

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

using namespace tunica;

namespace {

constexpr double R = 5e-3, L = 15e-3, U = 2e-3;  // [m], [m], [m/s]

mesh::Surface tube(double edge) {
  return meshing::remesh(test::tube_surface(96, 48, 10, R, L), {.edge = edge}).surface;
}

/// RMS over the middle of the wall of (du/dn) / (4 U / R) - 1 in the tetrahedra at it, in Poiseuille flow.
double shear_error(const std::string& name, const mesh::TetMesh& mesh) {
  constexpr fluid::Newtonian blood{.density = 1050, .viscosity = 0.0035};
  const double G = 8 * blood.viscosity * U / (R * R);  // -dp/dz
  const auto exact = [&](const Vec3& x) {
    return Vec3(0, 0, 2 * U * (1 - x.head<2>().squaredNorm() / (R * R)));
  };
  const auto drop = [&](const Vec3& x) { return G * (L - x[2]); };
  fluid::Projection flow{mesh, blood, fluid::Fic{}, fluid::FixedMesh{}};
  flow.pressure("inlet", G * L);
  flow.pressure("outlet", 0.0);
  flow.interface("wall");
  flow.set(test::nodal_values(mesh.nodes, exact), test::nodal_scalars(mesh.nodes, drop));
  for (int k = 0; k < 60; ++k) REQUIRE(flow.step(0.2));

  const auto& wall = mesh.patch("wall").faces;
  const auto behind =
      mesh::cells_behind(mesh.cells, mesh::cells_of_nodes(mesh.cells, mesh.node_count()), wall);
  double sum = 0, area = 0;
  for (Eigen::Index f = 0; f < wall.cols(); ++f) {
    const Vec3 a = mesh.nodes.col(wall(0, f)), b = mesh.nodes.col(wall(1, f)), c = mesh.nodes.col(wall(2, f));
    const double z = (a + b + c)[2] / 3;
    if (z < 0.3 * L || z > 0.7 * L) continue;
    const Vec3 twice = (b - a).cross(c - a);
    for (int k = 0; k < 4; ++k) {
      const Index n = mesh.cells(k, behind[static_cast<std::size_t>(f)]);
      if (n == wall(0, f) || n == wall(1, f) || n == wall(2, f)) continue;
      const double height = -twice.normalized().dot(Vec3(mesh.nodes.col(n)) - a);
      const double error = flow.velocity()(2, n) / height / (4 * U / R) - 1;  // u = 0 on the wall
      sum += twice.norm() * error * error, area += twice.norm();
    }
  }
  const double rms = std::sqrt(sum / area);
  MESSAGE(name << ": " << mesh.node_count() << " nodes, " << mesh.cell_count()
               << " tetrahedra, shear at the wall wrong by " << rms << " (rms)");
  return rms;
}

}  // namespace

TEST_SUITE("convergence") {
  TEST_CASE("meshing: boundary layers resolve the shear at the wall with fewer nodes") {
    struct Pair {
      double with, without;  // edges [m]
    };
    for (const auto& [with, without] : std::vector<Pair>{{2e-3, 1.3e-3}, {1.5e-3, 1.05e-3}, {1e-3, 0.7e-3}}) {
      const auto thin =
          meshing::layered_tetrahedra(tube(with), {.layers = 4, .first = 0.12 * with, .growth = 1.4});
      const auto even = meshing::layered_tetrahedra(tube(with), {.layers = 4});
      const auto plain = meshing::tetrahedra(tube(without));
      CHECK(plain.mesh.node_count() >= thin.mesh.node_count());
      const double a = shear_error("layers, the first of 0.12 of the edge", thin.mesh),
                   b = shear_error("layers, the last of 0.8 of the edge", even.mesh),
                   c = shear_error("without", plain.mesh);
      CHECK(a < 0.4 * c);
      CHECK(b < 0.8 * c);
    }
  }
}
