// SPDX-License-Identifier: MIT
// Quadratic reference cells in VTK's numbering: corners first, then the middle of each edge, face and cell.
#pragma once

#include "tunica/mesh/cell.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace tunica::mesh {

/// A cell with nodes in the middle of its edges: `Linear` is the cell of its corners, which it shares the
/// order of its faces with. Edges and faces list their corners first and are cells of their own: edges {low,
/// high, middle}. Nodes in the middle of faces are listed in `face_centres`, one in the middle of the cell is
/// last.
template <class C>
concept Quadratic = Cell<C> && Cell<typename C::Linear> && requires {
  C::face_centres;  // a quadratic cell lists the nodes in the middle of its faces, in their order, or none
};

namespace detail {

/// The faces of `Linear` with the middles of their edges, and their own if they have one.
template <class Linear, class Face, std::size_t Edges, std::size_t Centres>
constexpr auto quadratic_faces(const std::array<std::array<int, 3>, Edges>& edges,
                               const std::array<int, Centres>& centres) {
  std::array<std::array<int, Face::nodes>, Linear::faces.size()> faces{};
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const auto& corners = Linear::faces[f];
    const std::size_t n = corners.size();
    for (std::size_t i = 0; i < n; ++i) {
      faces[f][i] = corners[i];
      if (n == 2 && i == 1) break;  // a line has one edge
      const int low = std::min(corners[i], corners[(i + 1) % n]);
      const int high = std::max(corners[i], corners[(i + 1) % n]);
      for (const auto& e : edges)
        if (e[0] == low && e[1] == high) faces[f][n + i] = e[2];
    }
    if constexpr (Centres > 0 && Linear::dim == 3) faces[f][2 * n] = centres[f];
  }
  return faces;
}

}  // namespace detail

struct Line3 {
  static constexpr int dim = 1, nodes = 3, vtk_type = 21;
  using Linear = Line2;
  using Face = Node1;
  static constexpr std::array<std::array<int, 3>, 1> edges{{{0, 1, 2}}};
  static constexpr std::array<int, 0> face_centres{};
  static constexpr std::array<std::array<int, 1>, 2> faces = Line2::faces;
};

struct Tri6 {
  static constexpr int dim = 2, nodes = 6, vtk_type = 22;
  using Linear = Tri3;
  using Face = Line3;
  static constexpr std::array<std::array<int, 3>, 3> edges{{{0, 1, 3}, {1, 2, 4}, {0, 2, 5}}};
  static constexpr std::array<int, 0> face_centres{};
  static constexpr auto faces = detail::quadratic_faces<Tri3, Line3>(edges, face_centres);
};

/// Serendipity: no node in the middle.
struct Quad8 {
  static constexpr int dim = 2, nodes = 8, vtk_type = 23;
  using Linear = Quad4;
  using Face = Line3;
  static constexpr std::array<std::array<int, 3>, 4> edges{{{0, 1, 4}, {1, 2, 5}, {2, 3, 6}, {0, 3, 7}}};
  static constexpr std::array<int, 0> face_centres{};
  static constexpr auto faces = detail::quadratic_faces<Quad4, Line3>(edges, face_centres);
};

/// Biquadratic, node 8 in the middle.
struct Quad9 {
  static constexpr int dim = 2, nodes = 9, vtk_type = 28;
  using Linear = Quad4;
  using Face = Line3;
  static constexpr auto edges = Quad8::edges;
  static constexpr std::array<int, 0> face_centres{};
  static constexpr auto faces = Quad8::faces;
};

struct Tet10 {
  static constexpr int dim = 3, nodes = 10, vtk_type = 24;
  using Linear = Tet4;
  using Face = Tri6;
  static constexpr std::array<std::array<int, 3>, 6> edges{
      {{0, 1, 4}, {0, 2, 6}, {0, 3, 7}, {1, 2, 5}, {1, 3, 8}, {2, 3, 9}}};
  static constexpr std::array<int, 0> face_centres{};
  static constexpr auto faces = detail::quadratic_faces<Tet4, Tri6>(edges, face_centres);
};

/// Serendipity: no nodes in the middle of faces and cell.
struct Hex20 {
  static constexpr int dim = 3, nodes = 20, vtk_type = 25;
  using Linear = Hex8;
  using Face = Quad8;
  static constexpr std::array<std::array<int, 3>, 12> edges{{{0, 1, 8},
                                                             {1, 2, 9},
                                                             {2, 3, 10},
                                                             {0, 3, 11},
                                                             {4, 5, 12},
                                                             {5, 6, 13},
                                                             {6, 7, 14},
                                                             {4, 7, 15},
                                                             {0, 4, 16},
                                                             {1, 5, 17},
                                                             {2, 6, 18},
                                                             {3, 7, 19}}};
  static constexpr std::array<int, 0> face_centres{};
  static constexpr auto faces = detail::quadratic_faces<Hex8, Quad8>(edges, face_centres);
};

/// Triquadratic, node 26 in the middle.
struct Hex27 {
  static constexpr int dim = 3, nodes = 27, vtk_type = 29;
  using Linear = Hex8;
  using Face = Quad9;
  static constexpr auto edges = Hex20::edges;
  static constexpr std::array<int, 6> face_centres{24, 25, 22, 21, 23, 20};  // of Hex8::faces
  static constexpr auto faces = detail::quadratic_faces<Hex8, Quad9>(edges, face_centres);
};

namespace detail {

template <class C>
struct LinearOf {
  using type = C;
};
template <Quadratic C>
struct LinearOf<C> {
  using type = typename C::Linear;
};

}  // namespace detail

/// The cell of the corners: of Hex27 that is Hex8, of Hex8 itself.
template <Cell C>
using Corners = typename detail::LinearOf<C>::type;

}  // namespace tunica::mesh
