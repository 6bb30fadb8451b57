// SPDX-License-Identifier: MIT
#include "tunica/mesh/topology.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <numbers>

using namespace tunica;

namespace {

/// A torus of m x n quads split into triangles, outward normals.
mesh::Surface torus(Index m, Index n) {
  mesh::Surface s;
  s.nodes.resize(3, m * n);
  s.cells.resize(3, 2 * m * n);
  for (Index i = 0; i < m; ++i)
    for (Index j = 0; j < n; ++j) {
      const double u = 2 * std::numbers::pi * i / m, v = 2 * std::numbers::pi * j / n;
      s.nodes.col(i * n + j) << (3 + std::cos(v)) * std::cos(u), (3 + std::cos(v)) * std::sin(u), std::sin(v);
      const Index a = i * n + j, b = (i + 1) % m * n + j, c = (i + 1) % m * n + (j + 1) % n,
                  d = i * n + (j + 1) % n;
      s.cells.col(2 * a) << a, b, c;
      s.cells.col(2 * a + 1) << a, c, d;
    }
  return s;
}

mesh::Surface tetrahedron() {
  mesh::Surface s;
  s.nodes.resize(3, 4);
  s.nodes << 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1;
  s.cells.resize(3, 4);
  for (std::size_t f = 0; f < 4; ++f)
    for (std::size_t k = 0; k < 3; ++k)
      s.cells(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(f)) = mesh::Tet4::faces[f][k];
  return s;
}

mesh::Surface without_triangles(const mesh::Surface& s, Index dropped) {
  mesh::Surface r = s;
  r.cells = s.cells.rightCols(s.cells.cols() - dropped).eval();
  return r;
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("mesh: topology of a tetrahedron and of a torus") {
    const auto tet = mesh::topology(tetrahedron());
    CHECK(tet.closed());
    CHECK(tet.euler() == 2);
    CHECK(tet.genus() == 0);
    CHECK(tet.components[0].volume == doctest::Approx(1.0 / 6));
    CHECK(mesh::enclosed_volume(tetrahedron()) == doctest::Approx(1.0 / 6).epsilon(1e-15));
    const auto ring = mesh::topology(torus(12, 8));
    CHECK(ring.closed());
    CHECK(ring.euler() == 0);
    CHECK(ring.genus() == 1);
    CHECK(ring.edges == 3 * 96);
    CHECK(mesh::enclosed_volume(torus(400, 200)) == doctest::Approx(2 * 9.8696044 * 3).epsilon(1e-3));
    CHECK(mesh::area(torus(400, 200)) == doctest::Approx(4 * 9.8696044 * 3).epsilon(1e-3));
  }

  TEST_CASE("mesh: topology finds boundary loops with their place") {
    const auto t = mesh::topology(without_triangles(torus(12, 8), 1));
    CHECK(t.open_edges == 3);
    CHECK_FALSE(t.closed());
    REQUIRE(t.loops.size() == 1);
    CHECK(t.loops[0].nodes.size() == 3);
    CHECK(t.loops[0].centre.norm() == doctest::Approx(4).epsilon(0.1));
    CHECK(t.genus() == 1);
    const auto ring = mesh::topology(without_triangles(torus(12, 8), 16));  // one ring of quads: a tube
    CHECK(ring.loops.size() == 2);
    CHECK(ring.genus() == 0);
    CHECK(ring.open_edges == 16);
  }

  TEST_CASE("mesh: topology counts what is wrong") {
    auto s = tetrahedron();
    std::swap(s.cells(0, 2), s.cells(1, 2));
    const auto turned = mesh::topology(s);
    CHECK(turned.misoriented_edges == 3);
    CHECK_FALSE(turned.closed());

    s = tetrahedron();  // two tetrahedra that share an edge
    s.nodes.conservativeResize(3, 6);
    s.nodes.col(4) << 0, -1, 0;
    s.nodes.col(5) << 0, 0, -1;
    s.cells.conservativeResize(3, 8);
    const std::array<Index, 4> second{0, 1, 4, 5};
    for (Index f = 0; f < 4; ++f)
      for (Index k = 0; k < 3; ++k) s.cells(k, 4 + f) = second[static_cast<std::size_t>(s.cells(k, f))];
    const auto edge = mesh::topology(s);
    CHECK(edge.nonmanifold_edges == 1);
    CHECK(edge.edges == 11);
    CHECK(edge.open_edges == 0);
    CHECK_FALSE(edge.manifold());

    const std::array<Index, 7> apart{0, 6, 4, 5};  // two tetrahedra that share a node
    s.nodes.conservativeResize(3, 7);
    s.nodes.col(6) << -1, 0, 0;
    for (Index f = 0; f < 4; ++f)
      for (Index k = 0; k < 3; ++k) {
        const Index n = s.cells(k, f);
        s.cells(k, 4 + f) = apart[static_cast<std::size_t>(n)];
      }
    const auto node = mesh::topology(s);
    CHECK(node.nonmanifold_edges == 0);
    CHECK(node.nonmanifold_nodes == 1);
    CHECK(node.components.size() == 2);
    CHECK(node.components[1].genus() == 0);
    CHECK_FALSE(node.closed());
  }

  TEST_CASE("mesh: twins and neighbours agree") {
    const auto s = torus(9, 7);
    const auto twin = mesh::twins(s.cells, s.node_count());
    for (Index h = 0; h < static_cast<Index>(twin.size()); ++h) {
      const Index g = twin[static_cast<std::size_t>(h)];
      REQUIRE(g >= 0);
      CHECK(twin[static_cast<std::size_t>(g)] == h);
      CHECK(mesh::half_edge(s.cells, h).from == mesh::half_edge(s.cells, g).to);
    }
    const auto near = mesh::neighbours_of_nodes(s.cells, s.node_count());
    for (Index n = 0; n < s.node_count(); ++n) CHECK(near[n].size() == 6);
  }
}
