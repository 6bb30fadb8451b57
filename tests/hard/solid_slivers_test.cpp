// SPDX-License-Identifier: MIT
// Walls of sliver tetrahedra, with dihedral angles of a degree: exact where they can be, and hardly stiffer.
#include "tunica/fem/shape_quadratic.hpp"
#include "tunica/mesh/quadratic.hpp"
#include "tunica/meshing/box.hpp"
#include "tunica/solid/laws.hpp"
#include "tunica/solid/statics.hpp"

#include <doctest/doctest.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <string>
#include <type_traits>
#include <vector>

using namespace tunica;
using namespace tunica::solid;

namespace {

/// The least dihedral angle of a tetrahedron [degrees]; negative if it is inverted.
double least_angle(const mesh::TetMesh& mesh, Index e) {
  std::array<Vec3, 4> x;
  for (int a = 0; a < 4; ++a) x[static_cast<std::size_t>(a)] = mesh.nodes.col(mesh.cells(a, e));
  if (!((x[1] - x[0]).cross(x[2] - x[0]).dot(x[3] - x[0]) > 0)) return -1;
  double least = 180;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = i + 1; j < 4; ++j) {
      const std::size_t k = i == 0 ? (j == 1 ? 2 : 1) : 0, l = 6 - i - j - k;
      const Vec3 edge = (x[j] - x[i]).normalized();
      const auto across = [&](std::size_t m) -> Vec3 {
        const Vec3 d = x[m] - x[i];
        return (d - d.dot(edge) * edge).normalized();
      };
      least = std::min(least, std::acos(std::clamp(across(k).dot(across(l)), -1.0, 1.0)));
    }
  return least * 180 / std::numbers::pi;
}

bool inside(const Vec3& x) {
  return (x.array() > 1e-9).all() && (x.array() < 1 - 1e-9).all();
}

struct Slivers {
  mesh::TetMesh mesh = meshing::box_tets(4);
  int count = 0;       // below 2 degrees
  double least = 180;  // [degrees]

  /// Every inner node goes as far in a direction as leaves an angle of a degree.
  Slivers() {
    std::vector<std::vector<Index>> cells(static_cast<std::size_t>(mesh.node_count()));
    for (Index e = 0; e < mesh.cell_count(); ++e)
      for (const Index n : mesh.cells.col(e)) cells[static_cast<std::size_t>(n)].push_back(e);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> draw(-1, 1);
    for (Index n = 0; n < mesh.node_count(); ++n) {
      const Vec3 from = mesh.nodes.col(n), way = Vec3(draw(random), draw(random), draw(random)).normalized();
      if (!inside(from)) continue;
      double low = 0, high = 0.5;
      for (int k = 0; k < 50; ++k) {
        const double middle = 0.5 * (low + high);
        mesh.nodes.col(n) = from + middle * way;
        double angle = 180;
        for (const Index e : cells[static_cast<std::size_t>(n)])
          angle = std::min(angle, least_angle(mesh, e));
        (angle > 1 ? low : high) = middle;
      }
      mesh.nodes.col(n) = from + low * way;
    }
    for (Index e = 0; e < mesh.cell_count(); ++e) {
      const double angle = least_angle(mesh, e);
      least = std::min(least, angle);
      count += angle < 2;
    }
  }
};

const Hyperelastic law{Yeoh{.c10 = 0.5, .c20 = 1}, Quadratic{.kappa = 100}};

template <mesh::Cell C>
mesh::Mesh<C, 3> in_cells(const mesh::TetMesh& mesh) {
  if constexpr (std::is_same_v<C, mesh::Tet10>)
    return mesh::quadratic<C>(mesh);
  else
    return mesh;
}

template <mesh::Cell C, class Given>
void check(const std::string& name, const Slivers& slivers, const Given& given) {
  INFO(name);
  Eigen::Matrix3d H;
  H << 0.2, 0.15, -0.1, 0.1, -0.1, 0.1, -0.05, 0.1, 0.05;
  const auto mesh = in_cells<C>(slivers.mesh);
  Statics wall{mesh, given};
  for (Index n = 0; n < mesh.node_count(); ++n)
    if (!inside(mesh.nodes.col(n)))
      for (const Axis axis : {Axis::x, Axis::y, Axis::z})
        wall.prescribe(n, axis, (H * mesh.nodes.col(n))[static_cast<int>(axis)]);
  const auto report = wall.solve();
  REQUIRE(report);
  const double off = (wall.displacement() - H * mesh.nodes).cwiseAbs().maxCoeff();
  CHECK(report.cuts == 0);
  CHECK(off < 1e-10);

  // Pulled by 20 % and sheared by 10 % between two ends: no worse than good cells of twice the size.
  struct Pull {
    double energy;
    int iterations, cuts;
  };
  const auto pull = [&](const auto& cells) -> Pull {
    Statics pulled{cells, given};
    for (Index n = 0; n < cells.node_count(); ++n) {
      const double end = cells.nodes(0, n);
      if (end > 1e-9 && end < 1 - 1e-9) continue;
      pulled.prescribe(n, Axis::x, 0.2 * end);
      pulled.prescribe(n, Axis::y, 0.1 * end);
      pulled.prescribe(n, Axis::z, 0);
    }
    const auto way = pulled.solve();
    REQUIRE(way);
    CHECK(way.history.back() < 1e-9);
    return {pulled.body().strain_energy(pulled.unknowns()), way.solve.iterations, way.cuts};
  };
  const Pull flat = pull(mesh), good = pull(in_cells<C>(meshing::box_tets(4))),
             coarse = pull(in_cells<C>(meshing::box_tets(2)));
  MESSAGE(name << ": " << slivers.count << " cells below 2 degrees, least " << slivers.least
               << "; affine displacement off by " << off << " in " << report.solve.iterations
               << " iterations; energy of a pull " << flat.energy / good.energy
               << " of that in good cells, of twice the size " << coarse.energy / good.energy << "; "
               << flat.iterations << " and " << good.iterations << " iterations, " << flat.cuts << " and "
               << good.cuts << " cuts");
  CHECK(std::abs(flat.energy - good.energy) < std::abs(coarse.energy - good.energy));
  CHECK(flat.cuts <= 2);
}

}  // namespace

TEST_SUITE("hard") {
  TEST_CASE(
      "solid: sliver tetrahedra pass the patch test and are no worse than good ones of twice their size") {
    const Slivers slivers;
    CHECK(slivers.count > 20);
    CHECK(slivers.least > 0);
    CHECK(slivers.least < 2);
    check<mesh::Tet4>("Tet4 with NodalPressure", slivers, with<NodalPressure>(law));
    check<mesh::Tet4>("Tet4", slivers, with<Pointwise>(law));
    check<mesh::Tet10>("Tet10", slivers, law);
  }
}
