// SPDX-License-Identifier: MIT
// Mesh motion: exact where it must be, without memory, and sound under large motions of a tube.
#include "tunica/motion/laplace.hpp"
#include "tunica/fem/p1_tets.hpp"
#include "tunica/meshing/tube.hpp"
#include "tunica/motion/interleaved_cholesky.hpp"
#include "tunica/motion/levels.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

using namespace tunica;

namespace {

mesh::TetMesh tube() {
  return meshing::lumen(meshing::Lumen{.radius = 5e-3, .length = 40e-3, .cells = {4, 24, 24}});
}

/// A bulge of the wall by a fraction of the radius, zero at the ends, plus a bend.
Points<3> bulge(const mesh::TetMesh& mesh, const std::vector<Index>& wall, double fraction, double bend) {
  Points<3> d(3, static_cast<Eigen::Index>(wall.size()));
  for (std::size_t k = 0; k < wall.size(); ++k) {
    const Vec3 x = mesh.nodes.col(wall[k]);
    const double s = std::sin(std::numbers::pi * x[2] / 40e-3);
    d.col(static_cast<Eigen::Index>(k)) << fraction * s * s * x[0] + bend * s * s, fraction * s * s * x[1], 0;
  }
  return d;
}

double worst_volume_ratio(const mesh::TetMesh& mesh, const Points<3>& d) {
  const Points<3> x = mesh.nodes + d;
  double worst = 1e9;
  for (Index e = 0; e < mesh.cell_count(); ++e)
    worst =
        std::min(worst, fem::p1_tet(x, mesh.cells, e).volume / fem::p1_tet(mesh.nodes, mesh.cells, e).volume);
  return worst;
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("motion: the factors give the three components between given nodes") {
    const int n = 9;  // a chain: -d[i-1] + 2 d[i] - d[i+1] = 0 is linear between its ends
    std::vector<Eigen::Triplet<double>> entries;
    for (int i = 0; i < n; ++i) {
      entries.emplace_back(i, i, 2.0);
      if (i > 0) entries.emplace_back(i, i - 1, -1.0), entries.emplace_back(i - 1, i, -1.0);
    }
    Eigen::SparseMatrix<double> A(n, n);
    A.setFromTriplets(entries.begin(), entries.end());
    std::vector<char> known(n, 0);
    known.front() = known.back() = 1;
    const motion::InterleavedCholesky factors(A, known);
    CHECK(factors.unknowns().size() == 7);
    Points<3> d = Points<3>::Constant(3, n, 99);  // overwritten where it is not given
    d.col(0) = Vec3(1, 2, 3), d.col(n - 1) = Vec3(5, -2, 3);
    factors.solve(d);
    for (int i = 0; i < n; ++i) CHECK((d.col(i) - Vec3(1 + 0.5 * i, 2 - 0.5 * i, 3)).norm() < 1e-14);
    const Eigen::SparseMatrix<double> indefinite = -A;
    CHECK_THROWS_AS(motion::InterleavedCholesky(indefinite, known), MeshError);
  }

  TEST_CASE("motion: laplace without stiffening extends a linear displacement exactly") {
    const auto mesh = tube();
    const motion::Laplace laplace(mesh, {.ends = motion::Ends::follow, .stiffening = 0});
    Eigen::Matrix3d G;
    G << 0.1, 0.02, -0.03, 0.04, -0.05, 0.06, 0.01, 0.03, -0.07;
    Points<3> d(3, static_cast<Eigen::Index>(laplace.wall_nodes().size()));
    for (std::size_t k = 0; k < laplace.wall_nodes().size(); ++k)
      d.col(static_cast<Eigen::Index>(k)) = G * mesh.nodes.col(laplace.wall_nodes()[k]);
    CHECK((laplace.extend(d) - G * mesh.nodes).cwiseAbs().maxCoeff() < 1e-15);
  }

  TEST_CASE_TEMPLATE("motion: the wall gets what it is given and the ends stay", M, motion::Laplace,
                     motion::Levels) {
    const auto mesh = tube();
    const M motion(mesh);
    const Points<3> wall = bulge(mesh, motion.wall_nodes(), 0.3, 2e-3);
    const Points<3> d = motion.extend(wall);
    for (std::size_t k = 0; k < motion.wall_nodes().size(); ++k)
      REQUIRE(d.col(motion.wall_nodes()[k]) == wall.col(static_cast<Eigen::Index>(k)));
    for (const auto* end : {"inlet", "outlet"})
      for (const Index n : mesh::patch_nodes(mesh.patch(end))) CHECK(d.col(n).norm() < 1e-17);
    CHECK((d.array() == motion.extend(wall).array()).all());
    const double grown = worst_volume_ratio(mesh, d);
    const double shrunk = worst_volume_ratio(mesh, motion.extend(bulge(mesh, motion.wall_nodes(), -0.3, 0)));
    MESSAGE("worst volume ratio: radius +30 % and bent " << grown << " radius -30 % " << shrunk);
    CHECK(grown > 0.1);
    CHECK(shrunk > 0.1);
  }

  TEST_CASE("motion: fifty cycles leave no trace") {
    const auto mesh = tube();
    const motion::Laplace laplace(mesh);
    Points<3> d = Points<3>::Ones(3, mesh.node_count());
    for (int n = 0; n <= 50; ++n)
      d = laplace.extend(bulge(mesh, laplace.wall_nodes(), 0.3 * std::sin(n * std::numbers::pi / 5), 0));
    CHECK(d.cwiseAbs().maxCoeff() < 1e-12 * 5e-3);
  }

  TEST_CASE("motion: ends that follow stay in their planes when the rim does") {
    const auto mesh = tube();
    const motion::Laplace laplace(mesh, {.ends = motion::Ends::follow});
    Points<3> wall(3, static_cast<Eigen::Index>(laplace.wall_nodes().size()));
    for (std::size_t k = 0; k < laplace.wall_nodes().size(); ++k) {
      const Vec3 x = mesh.nodes.col(laplace.wall_nodes()[k]);
      wall.col(static_cast<Eigen::Index>(k)) << 0.2 * x[0], 0.2 * x[1], 0;
    }
    const Points<3> d = laplace.extend(wall);
    CHECK(d.row(2).cwiseAbs().maxCoeff() < 1e-17);
    for (const Index n : mesh::patch_nodes(mesh.patch("outlet")))
      CHECK((d.col(n) - Vec3(0.2 * mesh.nodes(0, n), 0.2 * mesh.nodes(1, n), 0)).norm() < 1e-16);
  }

  TEST_CASE("motion: an inverted mesh is refused by name") {
    auto mesh = tube();
    mesh.cells.col(7).head<2>().reverseInPlace();
    CHECK_THROWS_WITH_AS(motion::Laplace{mesh}, "mesh motion: tetrahedron 7 is inverted", MeshError);
  }
}
