// SPDX-License-Identifier: MIT
// Meshes of quadratic cells from those of their corners: each edge, face and cell gets its middle node once.
#pragma once

#include "tunica/core/types.hpp"
#include "tunica/mesh/cell_quadratic.hpp"
#include "tunica/mesh/mesh.hpp"
#include "tunica/mesh/middle_nodes.hpp"

#include <array>
#include <cstddef>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace tunica::mesh {

/// Leaves every point where it is: straight edges.
struct Straight {
  template <int Dim>
  [[nodiscard]] Point<Dim> operator()(const Point<Dim>& x, const std::string&) const {
    return x;
  }
};

namespace detail {

/// x_to = sum of w x over the nodes given so far.
template <int Dim>
struct Blend {
  Points<Dim>& x;
  Point<Dim> sum;

  explicit Blend(Points<Dim>& nodes) : x(nodes) {
    for (int i = 0; i < Dim; ++i) sum[i] = 0;
  }
  void add(double weight, Index n) {
    for (int i = 0; i < Dim; ++i) sum[i] += weight * x(i, n);
  }
  void store(Index n) const {
    for (int i = 0; i < Dim; ++i) x(i, n) = sum[i];
  }
};

/// Moves the nodes of the rows [begin, end) of the faces of all patches, each once a patch, in their order.
template <class Q, int Dim, class Projector>
void project(Mesh<Q, Dim>& mesh, const Projector& projector, int begin, int end) {
  std::vector<Index> last(static_cast<std::size_t>(mesh.node_count()), -1);  // patch that moved it last
  for (std::size_t p = 0; p < mesh.patches.size(); ++p)
    for (Eigen::Index f = 0; f < mesh.patches[p].faces.cols(); ++f)
      for (int k = begin; k < end; ++k) {
        const Index n = mesh.patches[p].faces(k, f);
        if (std::exchange(last[static_cast<std::size_t>(n)], static_cast<Index>(p)) == static_cast<Index>(p))
          continue;
        Point<Dim> x;
        for (int i = 0; i < Dim; ++i) x[i] = mesh.nodes(i, n);
        const Point<Dim> y = projector(x, mesh.patches[p].name);
        for (int i = 0; i < Dim; ++i) mesh.nodes(i, n) = y[i];
      }
}

}  // namespace detail

/// The mesh in cells of Q on the same corners: `quadratic<Tet10>(mesh)`. Corners keep their numbers; then
/// follow the middles of edges, ordered by the lower and then the higher end, those of quadrilateral faces
/// (Hex27) by their sorted corners, and those of cells. Regions and patches come along. `projector(x, patch
/// name)` returns where the middle of an edge or face of that patch shall lie, Point<Dim> to Point<Dim>; on
/// more than one patch it is asked once for each, in their order. Nodes in the middle of other faces and of
/// cells follow the edges around them by transfinite interpolation [GORDON73], so that the map of a curved
/// cell stays of full order.
template <Quadratic Q, int Dim, class Projector = Straight>
requires std::is_invocable_r_v < Point<Dim>,
const Projector&, const Point<Dim>&,
    const std::string& > [[nodiscard]] Mesh<Q, Dim> quadratic(const Mesh<typename Q::Linear, Dim>& mesh,
                                                              const Projector& projector = {}) {
  using Linear = typename Q::Linear;
  constexpr bool face_nodes = Q::face_centres.size() > 0;
  constexpr bool cell_node =
      Q::nodes > Linear::nodes + static_cast<int>(Q::edges.size() + Q::face_centres.size());
  constexpr int edges_of_face = Linear::dim == 3 ? Linear::Face::nodes : 1;
  const Index corners = mesh.node_count();
  const detail::EdgeNumbers edge(mesh.cells, Linear::edges, corners);
  const Index first_face = corners + edge.count();
  const detail::SetNumbers<Linear::Face::nodes> face(mesh.cells, Linear::faces, face_nodes ? corners : 0);
  const Index first_cell = first_face + face.count();
  const Index count = first_cell + (cell_node ? mesh.cell_count() : 0);

  Mesh<Q, Dim> r;
  r.region = mesh.region, r.region_names = mesh.region_names;
  r.nodes.resize(Dim, count), r.cells.resize(Q::nodes, mesh.cells.cols());
  for (Index n = 0; n < corners; ++n)
    for (int i = 0; i < Dim; ++i) r.nodes(i, n) = mesh.nodes(i, n);
  for (Index c = 0; c < mesh.cell_count(); ++c) {
    for (int a = 0; a < Linear::nodes; ++a) r.cells(a, c) = mesh.cells(a, c);
    for (const auto& [a, b, middle] : Q::edges)
      r.cells(middle, c) = corners + edge.find(mesh.cells(a, c), mesh.cells(b, c));
    if constexpr (face_nodes)
      for (std::size_t f = 0; f < Q::face_centres.size(); ++f) {
        std::array<Index, 4> at;
        for (std::size_t k = 0; k < 4; ++k) at[k] = mesh.cells(Linear::faces[f][k], c);
        r.cells(Q::face_centres[f], c) = first_face + face.find(at);
      }
    if constexpr (cell_node) r.cells(Q::nodes - 1, c) = first_cell + c;
  }

  for (const auto& patch : mesh.patches) {
    r.patches.push_back({patch.name, {}});
    auto& faces = r.patches.back().faces;
    faces.resize(Q::Face::nodes, patch.faces.cols());
    for (Eigen::Index f = 0; f < faces.cols(); ++f) {
      constexpr int n = Linear::Face::nodes;
      for (int k = 0; k < n; ++k) faces(k, f) = patch.faces(k, f);
      if constexpr (Linear::dim > 1)
        for (int k = 0; k < edges_of_face; ++k)
          faces(n + k, f) = corners + edge.find(patch.faces(k, f), patch.faces((k + 1) % n, f));
      if constexpr (face_nodes && n == 4)
        faces(8, f) = first_face +
                      face.find({patch.faces(0, f), patch.faces(1, f), patch.faces(2, f), patch.faces(3, f)});
    }
  }

  constexpr int linear_face = Linear::Face::nodes, projected = linear_face + edges_of_face;
  for (Index c = 0; c < r.cell_count(); ++c)
    for (const auto& [a, b, middle] : Q::edges) {
      detail::Blend<Dim> x(r.nodes);
      x.add(0.5, r.cells(a, c)), x.add(0.5, r.cells(b, c));
      x.store(r.cells(middle, c));
    }
  constexpr bool bent = !std::is_same_v<Projector, Straight> && Linear::dim > 1;
  if constexpr (bent) detail::project(r, projector, linear_face, projected);
  const auto blend_quad = [&](const auto& nodes, auto&& number, Index to) {  // eight around a ninth
    detail::Blend<Dim> x(r.nodes);
    for (std::size_t k = 0; k < 8; ++k) x.add(k < 4 ? -0.25 : 0.5, number(nodes[k]));
    x.store(to);
  };
  for (Index c = 0; c < r.cell_count(); ++c) {
    const auto number = [&](int a) { return r.cells(a, c); };
    if constexpr (std::is_same_v<Q, Quad9>)
      blend_quad(std::array{0, 1, 2, 3, 4, 5, 6, 7}, number, r.cells(8, c));
    if constexpr (face_nodes)
      for (std::size_t f = 0; f < Q::face_centres.size(); ++f)
        blend_quad(Q::faces[f], number, r.cells(Q::face_centres[f], c));
  }
  if constexpr (face_nodes) {
    if constexpr (bent) detail::project(r, projector, projected, Q::Face::nodes);
    for (Index c = 0; c < r.cell_count(); ++c) {
      detail::Blend<Dim> x(r.nodes);  // corners 1/8, edges -1/4, faces 1/2
      for (int a = 0; a < 26; ++a) x.add(a < 8 ? 0.125 : a < 20 ? -0.25 : 0.5, r.cells(a, c));
      x.store(r.cells(26, c));
    }
  }
  return r;
}

}  // namespace tunica::mesh
