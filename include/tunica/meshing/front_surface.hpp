// SPDX-License-Identifier: MIT
// The surface as the filler sees it: its edges, which of them the tetrahedra already have, and the
// Steiner points that edges and faces received on the way. Open or non-manifold ones are refused.
#pragma once

#include "tunica/core/error.hpp"
#include "tunica/core/text.hpp"
#include "tunica/core/types.hpp"
#include "tunica/core/vec.hpp"
#include "tunica/mesh/sorted_halves.hpp"
#include "tunica/meshing/tet_complex.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace tunica::meshing {

class FrontSurface {
 public:
  struct Edge {
    Index a, b;                              // a < b
    std::array<Index, 2> triangles{-1, -1};  // the one that runs from a to b, the one from b to a
  };
  struct Owner {
    Index edge = -1, face = -1;
  };

  std::vector<Triple> triangles;
  std::vector<Edge> edges;                           // sorted by (a, b)
  std::vector<std::array<Index, 3>> triangle_edges;  // edge i runs from corner i to corner i + 1
  Index nodes = 0;

  /// MeshError when a triangle is degenerate, an edge has not exactly two triangles of opposite
  /// sense, a node has two fans or none.
  FrontSurface(const Points<3>& points, const Connectivity<3>& faces)
      : nodes(static_cast<Index>(points.cols())) {
    if (faces.cols() == 0) throw MeshError("the surface has no triangles");
    for (Eigen::Index i = 0; i < points.size(); ++i)
      if (!std::isfinite(points.data()[i])) throw MeshError("a node of the surface is not finite");
    triangles.resize(at(faces.cols()));
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      for (int i = 0; i < 3; ++i) {
        const Index n = faces(i, static_cast<Eigen::Index>(t));
        if (n < 0 || n >= nodes)
          throw MeshError("triangle " + std::to_string(t) + " of the surface has node " + std::to_string(n) +
                          ", which does not exist");
        triangles[t][at(i)] = n;
      }
      refuse_degenerate(t, points);
    }
    find_edges(points);
    find_fans(points);
  }

  /// The edge between two nodes of the surface, -1: none.
  [[nodiscard]] Index edge_between(Index a, Index b) const {
    if (a > b) std::swap(a, b);
    if (b >= nodes) return -1;
    for (Index e = first_edge_[at(a)]; e < first_edge_[at(a) + 1]; ++e)
      if (edges[at(e)].b == b) return e;
    return -1;
  }
  /// The triangle with these three nodes, -1: none.
  [[nodiscard]] Index triangle_of(const Triple& n) const {
    const Index e = edge_between(n[0], n[1]);
    if (e < 0) return -1;
    for (const Index t : edges[at(e)].triangles)
      for (const Index v : triangles[at(t)])
        if (v == n[2]) return t;
    return -1;
  }

  /// Must the complex keep the edge (a, b)?
  [[nodiscard]] bool locked(Index a, Index b) const { return edge_between(a, b) >= 0 || piece(a, b); }
  void lock_piece(Index a, Index b) {
    if (piece(a, b)) return;
    if (pieces_.size() <= at(std::min(a, b))) pieces_.resize(at(std::min(a, b)) + 1);
    pieces_[at(std::min(a, b))].push_back(std::max(a, b));
  }
  void unlock_piece(Index a, Index b) {
    if (piece(a, b)) std::erase(pieces_[at(std::min(a, b))], std::max(a, b));
  }

  void own(Index node, const Owner& owner) {
    if (owners_.size() <= at(node - nodes)) owners_.resize(at(node - nodes) + 1);
    owners_[at(node - nodes)] = owner;
  }
  [[nodiscard]] Owner owner(Index node) const {
    return node < nodes || at(node - nodes) >= owners_.size() ? Owner{} : owners_[at(node - nodes)];
  }
  void disown(Index node) { own(node, {}); }

  /// Steiner points of an edge, in order from a to b.
  [[nodiscard]] const std::vector<Index>& chain(Index e) const {
    return chains_.empty() ? no_chain_ : chains_[at(e)];
  }
  [[nodiscard]] std::vector<Index>& chain(Index e) {
    if (chains_.empty()) chains_.resize(edges.size());
    return chains_[at(e)];
  }
  /// Has the edge Steiner points?
  [[nodiscard]] bool chained(Index e) const { return !chains_.empty() && !chains_[at(e)].empty(); }

  /// Is the node a corner of triangle f or a Steiner point on it or on its edges?
  [[nodiscard]] bool on(Index node, Index f) const {
    const Triple& t = triangles[at(f)];
    if (node < nodes) return node == t[0] || node == t[1] || node == t[2];
    const Owner o = owner(node);
    if (o.face >= 0) return o.face == f;
    const auto& e = triangle_edges[at(f)];
    return o.edge >= 0 && (o.edge == e[0] || o.edge == e[1] || o.edge == e[2]);
  }
  [[nodiscard]] bool split(Index f) const {
    for (const Index e : triangle_edges[at(f)])
      if (chained(e)) return true;
    return false;
  }

 private:
  template <class I>
  [[nodiscard]] static std::size_t at(I i) {
    return static_cast<std::size_t>(i);
  }

  [[nodiscard]] bool piece(Index a, Index b) const {
    const std::size_t low = at(std::min(a, b));
    if (low >= pieces_.size()) return false;
    for (const Index n : pieces_[low])
      if (n == std::max(a, b)) return true;
    return false;
  }

  void refuse_degenerate(std::size_t t, const Points<3>& points) const {
    const Vec3 a = vec::column(points, triangles[t][0]), b = vec::column(points, triangles[t][1]),
               c = vec::column(points, triangles[t][2]);
    for (int k = 0; k < 3; ++k) {
      const auto flat = [&](const Vec3& x) { return std::array{x[(k + 1) % 3], x[(k + 2) % 3]}; };
      if (orient2d(flat(a), flat(b), flat(c)) != 0) return;
    }
    throw MeshError("triangle " + std::to_string(t) + " of the surface has no area, at " + place(a));
  }

  void find_edges(const Points<3>& points) {
    const auto halves = mesh::sorted_halves(static_cast<Index>(triangles.size()), nodes,
                                            [&](Index t, Index i) { return triangles[at(t)][at(i)]; });
    triangle_edges.resize(triangles.size());
    for (std::size_t i = 0; i < halves.size();) {
      std::size_t end = i;
      while (end < halves.size() && halves[end].a == halves[i].a && halves[end].b == halves[i].b) ++end;
      const Vec3 middle =
          vec::scaled(0.5, vec::plus(vec::column(points, halves[i].a), vec::column(points, halves[i].b)));
      if (end - i == 1) throw MeshError("the surface is open: an edge has one triangle, at " + place(middle));
      if (end - i > 2)
        throw MeshError("the surface is not manifold: an edge has " + std::to_string(end - i) +
                        " triangles, at " + place(middle));
      if (halves[i].forward == halves[i + 1].forward)
        throw MeshError("the surface is not oriented: two neighbours have opposite senses, at " +
                        place(middle));
      Edge e{halves[i].a, halves[i].b, {}};
      for (std::size_t k = i; k < end; ++k) {
        e.triangles[halves[k].forward ? 0 : 1] = halves[k].triangle;
        triangle_edges[at(halves[k].triangle)][at(halves[k].corner)] = static_cast<Index>(edges.size());
      }
      edges.push_back(e);
      i = end;
    }
    first_edge_.assign(at(nodes) + 1, 0);
    for (const Edge& e : edges) ++first_edge_[at(e.a) + 1];
    for (std::size_t n = 0; n < at(nodes); ++n) first_edge_[n + 1] += first_edge_[n];
  }

  /// Every node must have exactly one fan of triangles.
  void find_fans(const Points<3>& points) const {
    std::vector<Index> count(at(nodes), 0), seed(at(nodes), -1);
    for (std::size_t t = 0; t < triangles.size(); ++t)
      for (const Index n : triangles[t]) ++count[at(n)], seed[at(n)] = static_cast<Index>(t);
    for (Index n = 0; n < nodes; ++n) {
      if (count[at(n)] == 0)
        throw MeshError("node " + std::to_string(n) + " of the surface belongs to no triangle");
      Index fan = 0, t = seed[at(n)];
      do {  // over the edge that leaves n, to the triangle on its other side
        std::size_t i = 0;
        while (triangles[at(t)][i] != n) ++i;
        const auto& pair = edges[at(triangle_edges[at(t)][i])].triangles;
        t = pair[0] == t ? pair[1] : pair[0];
        ++fan;
      } while (t != seed[at(n)] && fan <= count[at(n)]);
      if (fan != count[at(n)])
        throw MeshError("the surface is not manifold: it touches itself at node " + std::to_string(n) +
                        ", at " + place(vec::column(points, n)));
    }
  }

  std::vector<Index> first_edge_;
  std::vector<std::vector<Index>> pieces_;  // of edges and faces that must stay: of a node to higher ones
  std::vector<Owner> owners_;               // of the points after the nodes
  std::vector<std::vector<Index>> chains_;  // of the edges; empty until one has Steiner points
  std::vector<Index> no_chain_;
};

}  // namespace tunica::meshing
