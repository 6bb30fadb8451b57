// SPDX-License-Identifier: MIT
#include "tunica/mesh/adjacency.hpp"

#include "tunica/mesh/cell.hpp"
#include "tunica/mesh/cells_behind.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

using namespace tunica;

namespace {

std::vector<Index> row(const mesh::Rows& rows, Index i) {
  return {rows[i].begin(), rows[i].end()};
}

/// Each edge of the cell lies in exactly `shared` of its faces, and faces are listed without repetition.
template <mesh::Cell C>
void check_tables(int shared) {
  CHECK(C::faces.size() + C::nodes == C::edges.size() + 2);  // Euler's formula of a polyhedron
  for (const auto& e : C::edges) {
    CHECK(e[0] < e[1]);
    int found = 0;
    for (const auto& f : C::faces)
      found += std::count(f.begin(), f.end(), e[0]) == 1 && std::count(f.begin(), f.end(), e[1]) == 1;
    CHECK(found >= shared);
  }
  std::vector<int> uses(C::nodes, 0);
  for (const auto& f : C::faces)
    for (const int n : f) ++uses[static_cast<std::size_t>(n)];
  for (const int u : uses) CHECK(u == 3);  // three faces at each corner
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("mesh: adjacency of two triangles and what is wrong with a third") {
    Connectivity<3> cells(3, 2);
    cells.col(0) << 0, 1, 2;
    cells.col(1) << 2, 1, 3;
    const auto around = mesh::cells_of_nodes(cells, 5);
    CHECK(around.size() == 5);
    CHECK(row(around, 1) == std::vector<Index>{0, 1});
    CHECK(row(around, 0) == std::vector<Index>{0});
    CHECK(row(around, 4).empty());
    CHECK(row(mesh::neighbours_of_nodes(cells, 5), 2) == std::vector<Index>{0, 1, 3});
    const auto twin = mesh::twins(cells, 5);
    CHECK(twin[1] == 3);  // 1 -> 2 against 2 -> 1
    CHECK(twin[3] == 1);
    CHECK(twin[0] == mesh::open_edge);
    CHECK(mesh::next_in_triangle(5) == 3);
    CHECK(mesh::previous_in_triangle(3) == 5);
    Connectivity<3> same = cells;
    same.col(1) << 1, 2, 3;
    CHECK(mesh::twins(same, 5)[1] == mesh::misoriented_edge);
    Connectivity<3> fin(3, 3);
    fin.leftCols(2) = cells;
    fin.col(2) << 1, 2, 4;
    CHECK(mesh::twins(fin, 5)[1] == mesh::nonmanifold_edge);
    CHECK(mesh::twins(fin, 5)[6] == mesh::nonmanifold_edge);
  }

  TEST_CASE("mesh: tables of the cells close") {
    check_tables<mesh::Tet4>(2);
    check_tables<mesh::Hex8>(2);
    for (std::size_t f = 0; f < 4; ++f)  // face i of a tetrahedron is opposite to node i
      CHECK(std::count(mesh::Tet4::faces[f].begin(), mesh::Tet4::faces[f].end(), static_cast<int>(f)) == 0);
  }

  TEST_CASE("mesh: the cell behind a face has all its nodes") {
    Connectivity<4> cells(4, 2);  // two tetrahedra that share the face 1 2 3
    cells.col(0) << 0, 1, 2, 3;
    cells.col(1) << 4, 3, 2, 1;
    const auto around = mesh::cells_of_nodes(cells, 6);
    Connectivity<3> faces(3, 5);
    faces.col(0) << 2, 1, 0;
    faces.col(1) << 4, 1, 3;
    faces.col(2) << 3, 2, 1;  // of both: the first
    faces.col(3) << 0, 1, 4;  // its nodes lie in both but in none together
    faces.col(4) << 5, 1, 2;  // a node of no cell
    CHECK(mesh::cells_behind(cells, around, faces) == std::vector<Index>{0, 1, 0, -1, -1});
    for (std::size_t f = 0; f < 6; ++f) {  // hexahedra in a row: face f of the second
      Connectivity<8> row(8, 2);
      row.col(0) << 0, 1, 2, 3, 4, 5, 6, 7;
      row.col(1) << 4, 5, 6, 7, 8, 9, 10, 11;
      Connectivity<4> face(4, 1);
      for (std::size_t k = 0; k < 4; ++k) face(static_cast<int>(k), 0) = row(mesh::Hex8::faces[f][k], 1);
      CHECK(mesh::cells_behind(row, mesh::cells_of_nodes(row, 12), face) ==
            std::vector<Index>{f == 0 ? 0 : 1});
    }
  }
}
