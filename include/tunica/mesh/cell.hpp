// SPDX-License-Identifier: MIT
// Reference cells: node count, faces and edges as named tables, in VTK's numbering.
#pragma once

#include <array>
#include <concepts>

namespace tunica::mesh {

/// A reference cell, all at compile time. Faces point outward, edges run from low to high node.
///   struct Line2 { static constexpr int dim = 1, nodes = 2, vtk_type = 3; ... };
template <class C>
concept Cell = requires {
  { C::dim } -> std::convertible_to<int>;       // a cell states its dimension
  { C::nodes } -> std::convertible_to<int>;     // a cell states how many nodes it has
  { C::vtk_type } -> std::convertible_to<int>;  // a cell states its number in VTK
  typename C::Face;                             // a cell names the cell that its faces are
  C::faces;                                     // a cell lists its faces, outward
  C::edges;                                     // a cell lists each edge once, from low to high node
};

struct Node1 {
  static constexpr int dim = 0, nodes = 1, vtk_type = 1;
};

struct Line2 {
  static constexpr int dim = 1, nodes = 2, vtk_type = 3;
  using Face = Node1;
  static constexpr std::array<std::array<int, 1>, 2> faces{{{0}, {1}}};
  static constexpr std::array<std::array<int, 2>, 1> edges{{{0, 1}}};
};

struct Tri3 {
  static constexpr int dim = 2, nodes = 3, vtk_type = 5;
  using Face = Line2;
  static constexpr std::array<std::array<int, 2>, 3> faces{{{0, 1}, {1, 2}, {2, 0}}};
  static constexpr std::array<std::array<int, 2>, 3> edges{{{0, 1}, {1, 2}, {0, 2}}};
};

struct Quad4 {
  static constexpr int dim = 2, nodes = 4, vtk_type = 9;
  using Face = Line2;
  static constexpr std::array<std::array<int, 2>, 4> faces{{{0, 1}, {1, 2}, {2, 3}, {3, 0}}};
  static constexpr std::array<std::array<int, 2>, 4> edges{{{0, 1}, {1, 2}, {2, 3}, {0, 3}}};
};

struct Tet4 {
  static constexpr int dim = 3, nodes = 4, vtk_type = 10;
  using Face = Tri3;
  static constexpr std::array<std::array<int, 3>, 4> faces{// face i is opposite to node i
                                                           {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
  static constexpr std::array<std::array<int, 2>, 6> edges{{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};
};

struct Hex8 {
  static constexpr int dim = 3, nodes = 8, vtk_type = 12;
  using Face = Quad4;
  static constexpr std::array<std::array<int, 4>, 6> faces{
      {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}};
  static constexpr std::array<std::array<int, 2>, 12> edges{
      {{0, 1}, {1, 2}, {2, 3}, {0, 3}, {4, 5}, {5, 6}, {6, 7}, {4, 7}, {0, 4}, {1, 5}, {2, 6}, {3, 7}}};
};

}  // namespace tunica::mesh
