// SPDX-License-Identifier: MIT
// Tables of the reference cells, patches by name, triangles.
#include "tunica/mesh/mesh.hpp"

#include "tunica/mesh/patch_nodes.hpp"
#include "tunica/mesh/triangle.hpp"

#include <doctest/doctest.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace tunica;

/// Node positions of the reference cells in VTK's numbering.
template <class C>
std::array<Vec3, C::nodes> corners();
template <>
std::array<Vec3, 3> corners<mesh::Tri3>() {
  return {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
}
template <>
std::array<Vec3, 4> corners<mesh::Quad4>() {
  return {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)};
}
template <>
std::array<Vec3, 4> corners<mesh::Tet4>() {
  return {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)};
}
template <>
std::array<Vec3, 8> corners<mesh::Hex8>() {
  return {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0),
          Vec3(0, 0, 1), Vec3(1, 0, 1), Vec3(1, 1, 1), Vec3(0, 1, 1)};
}

/// Normal times measure of a face: of an edge in the plane, or of a polygon in space.
template <std::size_t N>
Vec3 face_vector(const std::array<Vec3, N>& x) {
  if constexpr (N == 2) {
    const Vec3 t = x[1] - x[0];
    return {t[1], -t[0], 0};  // to the right of the run: outward when the cell turns left
  } else {
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = 0; i < N; ++i) sum += 0.5 * x[i].cross(x[(i + 1) % N]);
    return sum;
  }
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE_TEMPLATE("mesh: faces of a cell point outward and close it", C, mesh::Tri3, mesh::Quad4,
                     mesh::Tet4, mesh::Hex8) {
    static_assert(mesh::Cell<C>);
    const auto x = corners<C>();
    Vec3 centre = Vec3::Zero();
    for (const Vec3& p : x) centre += p / C::nodes;
    Vec3 sum = Vec3::Zero();
    std::set<int> seen;
    for (const auto& face : C::faces) {
      static_assert(std::tuple_size_v<std::remove_cvref_t<decltype(face)>> ==
                    static_cast<std::size_t>(C::Face::nodes));
      std::array<Vec3, static_cast<std::size_t>(C::Face::nodes)> points;
      Vec3 middle = Vec3::Zero();
      for (std::size_t i = 0; i < face.size(); ++i) {
        points[i] = x[static_cast<std::size_t>(face[i])];
        middle += points[i] / static_cast<double>(face.size());
        seen.insert(face[i]);
      }
      const Vec3 vector = face_vector(points);
      CHECK(vector.dot(middle - centre) > 0);
      sum += vector;
    }
    CHECK(sum.norm() < 1e-14);  // a closed surface
    CHECK(seen.size() == static_cast<std::size_t>(C::nodes));
  }

  TEST_CASE_TEMPLATE("mesh: edges are those of the faces and each is listed once from low to high", C,
                     mesh::Tri3, mesh::Quad4, mesh::Tet4, mesh::Hex8) {
    std::set<std::pair<int, int>> from_faces, listed;
    for (const auto& face : C::faces)
      for (std::size_t i = 0; i < face.size(); ++i) {
        const int a = face[i], b = face[(i + 1) % face.size()];
        from_faces.insert(std::minmax(a, b));
      }
    for (const auto& edge : C::edges) {
      CHECK(edge[0] < edge[1]);
      CHECK(listed.insert({edge[0], edge[1]}).second);
    }
    CHECK(listed == from_faces);
    if constexpr (C::dim == 3)  // Euler: V - E + F = 2
      CHECK(C::nodes - static_cast<int>(C::edges.size()) + static_cast<int>(C::faces.size()) == 2);
  }

  TEST_CASE("mesh: face i of a tetrahedron lies opposite to node i") {
    for (std::size_t i = 0; i < 4; ++i)
      CHECK(std::ranges::count(mesh::Tet4::faces[i], static_cast<int>(i)) == 0);
  }

  TEST_CASE("mesh: a patch is found by its name and a wrong name lists those there are") {
    mesh::TetMesh mesh;
    mesh.patches.push_back({"wall", {}});
    mesh.patches.push_back({"inlet", {}});
    mesh.patches[1].faces.resize(3, 2);
    mesh.patches[1].faces << 5, 5, 9, 1, 1, 7;
    CHECK(&mesh.patch("inlet") == &mesh.patches[1]);
    CHECK(mesh::patch_nodes(mesh.patch("inlet")) == std::vector<Index>{1, 5, 7, 9});
    CHECK(mesh::patch_nodes(mesh.patch("wall")).empty());
    CHECK_THROWS_WITH_AS(static_cast<void>(mesh.patch("outlet")),
                         "no patch named \"outlet\"; there are: wall, inlet", MeshError);
  }

  TEST_CASE("mesh: without labels there is one region") {
    mesh::Surface surface;
    CHECK(surface.region_of(3) == 0);
    surface.region = {0, 2};
    CHECK(surface.region_of(1) == 2);
  }

  TEST_CASE("mesh: the nearest point of a triangle is no farther than any of its points") {
    std::mt19937 random(5);
    const auto uniform = [&] { return static_cast<double>(random()) / 2147483648.0 - 1; };
    for (int k = 0; k < 300; ++k) {
      const auto point = [&] { return Vec3(uniform(), uniform(), uniform()); };
      mesh::Triangle t{point(), point(), point()};
      if (k % 10 == 0) t.c = t.b;             // degenerate: a segment
      if (k % 30 == 0) t.b = t.a, t.c = t.a;  // degenerate: a point
      const Vec3 x = 2 * point();
      const Vec3 w = t.nearest(x);
      CHECK(w.minCoeff() >= 0);
      CHECK(std::abs(w.sum() - 1) < 1e-12);
      const double distance = (t.at(w) - x).norm();
      for (int i = 0; i <= 20; ++i)
        for (int j = 0; i + j <= 20; ++j) {
          const Vec3 other = t.at(Vec3(i, j, 20 - i - j) / 20);
          CHECK(distance <= (other - x).norm() + 1e-12);
        }
    }
  }

  TEST_CASE("mesh: area and smallest angle of a triangle") {
    const mesh::Triangle t{{0, 0, 0}, {std::sqrt(3.0), 0, 0}, {0, 1, 0}};
    CHECK(t.area() == doctest::Approx(std::sqrt(3.0) / 2));
    CHECK(t.smallest_angle() == doctest::Approx(std::acos(-1.0) / 6));
    CHECK((t.area_vector().normalized() - Vec3::UnitZ()).norm() < 1e-15);
    CHECK(mesh::Triangle{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}.smallest_angle() == 0);
  }
}
