// SPDX-License-Identifier: MIT
// Structured tubes and boxes: orientation, volume, patches that close the boundary, matching nodes.
#include "tunica/meshing/tube.hpp"

#include "tunica/mesh/patch_nodes.hpp"
#include "tunica/meshing/box.hpp"

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <string>
#include <vector>

using namespace tunica;
using meshing::Block, meshing::Lumen, meshing::Tube;

namespace {

double tet_volume(const mesh::TetMesh& m, Index c) {
  const Vec3 a = m.nodes.col(m.cells(0, c));
  Eigen::Matrix3d e;
  for (int k = 0; k < 3; ++k) e.col(k) = m.nodes.col(m.cells(k + 1, c)) - a;
  return e.determinant() / 6;
}

// Smallest dihedral angle [degrees]: between the outward normals of two faces.
double smallest_dihedral(const mesh::TetMesh& m) {
  double smallest = 180;
  for (Index c = 0; c < m.cell_count(); ++c) {
    std::array<Vec3, 4> n;
    for (std::size_t f = 0; f < 4; ++f) {
      const auto& face = mesh::Tet4::faces[f];
      const Vec3 a = m.nodes.col(m.cells(face[0], c)), b = m.nodes.col(m.cells(face[1], c)),
                 d = m.nodes.col(m.cells(face[2], c));
      n[f] = (b - a).cross(d - a).normalized();
    }
    for (std::size_t f = 0; f < 4; ++f)
      for (std::size_t g = 0; g < f; ++g)
        smallest =
            std::min(smallest, std::acos(std::clamp(-n[f].dot(n[g]), -1.0, 1.0)) * 180 / std::numbers::pi);
  }
  return smallest;
}

double smallest_corner_jacobian(const mesh::HexMesh& m) {
  static constexpr std::array<std::array<int, 4>, 8> corner{{{0, 1, 3, 4},
                                                             {1, 2, 0, 5},
                                                             {2, 3, 1, 6},
                                                             {3, 0, 2, 7},
                                                             {4, 7, 5, 0},
                                                             {5, 4, 6, 1},
                                                             {6, 5, 7, 2},
                                                             {7, 6, 4, 3}}};
  double smallest = 1e300;
  for (Index c = 0; c < m.cell_count(); ++c)
    for (const auto& k : corner) {
      Eigen::Matrix3d e;
      for (int i = 0; i < 3; ++i)
        e.col(i) =
            m.nodes.col(m.cells(k[static_cast<std::size_t>(i) + 1], c)) - m.nodes.col(m.cells(k[0], c));
      smallest = std::min(smallest, e.determinant());
    }
  return smallest;
}

// The faces that only one cell has, as sorted node lists.
template <class C>
std::set<std::vector<Index>> boundary(const mesh::Mesh<C>& m) {
  std::map<std::vector<Index>, int> count;
  for (Index c = 0; c < m.cell_count(); ++c)
    for (const auto& face : C::faces) {
      std::vector<Index> key;
      for (const int k : face) key.push_back(m.cells(k, c));
      std::sort(key.begin(), key.end());
      ++count[key];
    }
  std::set<std::vector<Index>> once;
  for (const auto& [face, n] : count) {
    CHECK(n <= 2);
    if (n == 1) once.insert(face);
  }
  return once;
}

// The patches cover the boundary, each face once; volume by the divergence theorem over them.
template <class C>
double checked_volume(const mesh::Mesh<C>& m, const std::set<std::string>& leave_out = {}) {
  const auto expected = boundary(m);
  std::set<std::vector<Index>> found;
  std::size_t faces = 0;
  double volume = 0;
  for (const auto& patch : m.patches) {
    if (leave_out.count(patch.name) != 0) continue;
    CHECK(patch.faces.cols() > 0);
    for (Eigen::Index f = 0; f < patch.faces.cols(); ++f) {
      std::vector<Index> key(patch.faces.col(f).data(), patch.faces.col(f).data() + patch.faces.rows());
      for (std::size_t k = 2; k < key.size(); ++k) {
        const Vec3 a = m.nodes.col(key[0]), b = m.nodes.col(key[k - 1]), c = m.nodes.col(key[k]);
        volume += a.dot(b.cross(c)) / 6;
      }
      std::sort(key.begin(), key.end());
      found.insert(key);
      ++faces;
    }
  }
  CHECK(found == expected);
  CHECK(faces == expected.size());
  return volume;
}

// Area of a regular polygon of n corners on a circle.
double polygon(double r, int n) {
  return 0.5 * n * r * r * std::sin(2 * std::numbers::pi / n);
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("meshing: tube wall is positive and closed with its polygon volume") {
    const Tube shape{.inner_radius = 5e-3, .thickness = 1e-3, .length = 50e-3, .cells = {2, 24, 40}};
    const auto wall = meshing::tube(shape);
    CHECK(wall.cell_count() == 2 * 24 * 40);
    CHECK(smallest_corner_jacobian(wall) > 0);
    const double exact = (polygon(6e-3, 24) - polygon(5e-3, 24)) * 50e-3;
    CHECK(checked_volume(wall, {"ends"}) == doctest::Approx(exact).epsilon(1e-12));
    CHECK(wall.patch("ends").faces.cols() == 2 * 2 * 24);
    for (const Index n : mesh::patch_nodes(wall.patch("inner")))
      CHECK(std::abs(wall.nodes.col(n).head<2>().norm() - 5e-3) < 1e-17);
    for (const Index n : mesh::patch_nodes(wall.patch("end1"))) CHECK(wall.nodes(2, n) == 50e-3);
  }

  TEST_CASE("meshing: quarter tube has exact symmetry planes") {
    const auto wall =
        meshing::quarter_tube({.inner_radius = 1, .thickness = 0.5, .length = 0.3, .cells = {4, 8, 1}});
    CHECK(smallest_corner_jacobian(wall) > 0);
    const double exact = (polygon(1.5, 32) - polygon(1, 32)) * 0.3 / 4;
    CHECK(checked_volume(wall, {"ends"}) == doctest::Approx(exact).epsilon(1e-12));
    for (const Index n : mesh::patch_nodes(wall.patch("sym_x"))) CHECK(wall.nodes(0, n) == 0);
    for (const Index n : mesh::patch_nodes(wall.patch("sym_y"))) CHECK(wall.nodes(1, n) == 0);
    CHECK(wall.nodes.row(0).minCoeff() == 0);
    CHECK(wall.nodes.row(1).minCoeff() == 0);
  }

  TEST_CASE("meshing: lumen of a tube is conforming and well shaped") {
    for (const auto& cells : {std::array{4, 24, 30}, std::array{5, 24, 20}, std::array{8, 48, 60},
                              std::array{1, 6, 2}, std::array{10, 40, 50}}) {
      CAPTURE(cells[0]);
      const Lumen shape{.radius = 5e-3, .length = 30e-3, .cells = cells};
      const auto mesh = meshing::lumen(shape);
      double volume = 0, smallest = 1;
      for (Index c = 0; c < mesh.cell_count(); ++c) {
        const double v = tet_volume(mesh, c);
        volume += v, smallest = std::min(smallest, v);
      }
      CHECK(smallest > 0);
      const double exact = polygon(5e-3, cells[1]) * 30e-3;
      CHECK(volume == doctest::Approx(exact).epsilon(1e-12));
      CHECK(checked_volume(mesh) == doctest::Approx(exact).epsilon(1e-12));
      for (const Index n : mesh::patch_nodes(mesh.patch("wall")))
        CHECK(std::abs(mesh.nodes.col(n).head<2>().norm() - 5e-3) < 1e-17);
      const double dihedral = smallest_dihedral(mesh);
      MESSAGE("lumen " << cells[0] << " x " << cells[1] << " x " << cells[2] << ": " << mesh.cell_count()
                       << " tetrahedra, smallest dihedral angle " << dihedral << " degrees");
      if (cells[0] > 1) CHECK(dihedral > 15);
    }
  }

  TEST_CASE("meshing: lumen and wall of one tube share their interface nodes") {
    const Tube shape{.inner_radius = 5e-3, .thickness = 1e-3, .length = 50e-3, .cells = {1, 24, 40}};
    const auto wall = meshing::tube(shape);
    const auto blood = meshing::lumen(shape);
    const auto place = [](const auto& m, const std::string& patch) {
      std::set<std::array<double, 3>> points;
      for (const Index n : mesh::patch_nodes(m.patch(patch)))
        points.insert({m.nodes(0, n), m.nodes(1, n), m.nodes(2, n)});
      return points;
    };
    CHECK(place(wall, "inner") == place(blood, "wall"));
  }

  TEST_CASE("meshing: boxes of tetrahedra and hexahedra fill their block") {
    const Block block{.cells = {3, 4, 2}, .lo = {-1, 0, 2}, .hi = {1, 1, 5}};
    const auto hexes = meshing::box_hexes(block);
    CHECK(smallest_corner_jacobian(hexes) > 0);
    CHECK(checked_volume(hexes) == doctest::Approx(6).epsilon(1e-12));
    const auto tets = meshing::box_tets(block);
    CHECK(tets.cell_count() == 6 * 24);
    for (Index c = 0; c < tets.cell_count(); ++c) CHECK(tet_volume(tets, c) == doctest::Approx(6.0 / 144));
    CHECK(checked_volume(tets) == doctest::Approx(6).epsilon(1e-12));
    for (const Index n : mesh::patch_nodes(tets.patch("z1"))) CHECK(tets.nodes(2, n) == 5);
    CHECK(meshing::box_tets(5).cell_count() == 750);
    CHECK(meshing::box_hexes(5).node_count() == 216);
  }
}
