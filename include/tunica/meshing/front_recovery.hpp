// SPDX-License-Identifier: MIT
// The tetrahedra of a surface's nodes and of points inside it, with every triangle of the surface
// among their faces: triangulate, recover, keep the inside, release the Steiner points.
#pragma once

#include "tunica/core/error.hpp"
#include "tunica/core/text.hpp"
#include "tunica/mesh/triangle.hpp"
#include "tunica/meshing/delaunay.hpp"
#include "tunica/meshing/front_conform.hpp"
#include "tunica/meshing/front_edges.hpp"
#include "tunica/meshing/front_faces.hpp"
#include "tunica/meshing/front_inside.hpp"
#include "tunica/meshing/front_release.hpp"
#include "tunica/meshing/front_surface.hpp"
#include "tunica/meshing/triangles_cross.hpp"
#include "tunica/search/octree.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace tunica::meshing {

struct RecoveryCounts {
  Index missing_edges = 0, missing_faces = 0;  // of the Delaunay triangulation
  Index steiner = 0;                           // points that went through the surface
};

class FrontRecovery {
 public:
  /// How missing edges are brought in: flips first, in ascending or descending order, or halving.
  enum class Way { forward, backward, halving };

  /// Fills the complex with the inside of the surface. MeshError names what is wrong with the
  /// surface; RecoveryFailure asks for other inner points.
  static RecoveryCounts run(TetComplex& complex, const FrontSurface& surface, const std::vector<Vec3>& nodes,
                            const std::vector<Vec3>& inner, Way way = Way::forward) {
    FrontRecovery work(complex, surface);
    work.way_ = way;
    complex.points.assign(nodes.begin(), nodes.end());
    complex.points.insert(complex.points.end(), inner.begin(), inner.end());
    Delaunay delaunay(complex);
    work.recover(delaunay);
    const auto inside = inside_of(complex, work.s_);
    complex.restrict_to([&](Index t) { return inside[static_cast<std::size_t>(t)] != 0; });
    FrontRelease(complex, work.s_).run();
    if (way == Way::halving) Improve::thin(complex, static_cast<Index>(nodes.size() + inner.size()));
    return work.counts_;
  }

 private:
  FrontRecovery(TetComplex& complex, const FrontSurface& surface) : c_(complex), s_(surface) {}

  template <class I>
  [[nodiscard]] static std::size_t at(I i) {
    return static_cast<std::size_t>(i);
  }

  void recover(Delaunay& delaunay) {
    std::vector<Index> edges, faces;
    find_missing(edges, faces);
    counts_.missing_edges = static_cast<Index>(edges.size());
    counts_.missing_faces = static_cast<Index>(faces.size());
    refuse_crossings(faces);
    if (way_ != Way::halving &&
        static_cast<double>(edges.size()) > most_flipped * static_cast<double>(s_.edges.size()))
      throw RecoveryFailure{c_.point(s_.edges[at(edges[0])].a),
                            "the surface is too far from Delaunay for flips"};
    if (way_ == Way::halving) {
      counts_.steiner = FrontConform(c_, s_, delaunay).run();
      edges.clear(), faces.clear();
      find_missing(edges, faces);
      std::erase_if(edges, [&](Index e) { return s_.chained(e); });
    }
    if (way_ == Way::backward)
      std::reverse(edges.begin(), edges.end()), std::reverse(faces.begin(), faces.end());
    FrontEdges by_edge(c_, s_);
    FrontFaces by_face(c_, s_, way_ == Way::halving ? FrontFaces::Trust::signs : FrontFaces::Trust::places);
    using Means = FrontEdges::Means;
    for (int round = 0; round < flip_rounds; ++round)
      std::erase_if(edges, [&](Index e) { return by_edge.recover(e, Means::flips); });
    for (const Index e : edges) by_edge.recover(e, Means::points);
    by_edge.shorten_chains();
    for (int round = 0; round < flip_rounds; ++round)
      std::erase_if(faces, [&](Index f) { return by_face.recover(f, Means::flips); });
    for (const Index f : faces) by_face.recover(f, Means::points);
    counts_.steiner += by_edge.steiner + by_face.steiner;
  }

  /// Marks the triangles that are faces already.
  void find_missing(std::vector<Index>& edges, std::vector<Index>& faces) {
    std::vector<char> edge_found(s_.edges.size(), 0), face_found(s_.triangles.size(), 0);
    for (Index t = 0; t < c_.size(); ++t) {
      if (!c_.alive(t)) continue;
      for (const auto& [i, j] : mesh::Tet4::edges) {
        const Index e = s_.edge_between(c_.nodes(t)[at(i)], c_.nodes(t)[at(j)]);
        if (e >= 0) edge_found[at(e)] = 1;
      }
      for (int f = 0; f < 4; ++f) {
        const Index m = s_.triangle_of(c_.face(t, f));
        if (m < 0) continue;
        face_found[at(m)] = 1;
        c_.mark_both(4 * t + f, s_.triangles[at(m)], m);
      }
    }
    for (std::size_t e = 0; e < edge_found.size(); ++e)
      if (edge_found[e] == 0) edges.push_back(static_cast<Index>(e));
    for (std::size_t f = 0; f < face_found.size(); ++f)
      if (face_found[f] == 0) faces.push_back(static_cast<Index>(f));
  }

  /// Triangles that are faces of the triangulation cannot cross each other: only pairs with a
  /// missing one are tested.
  void refuse_crossings(const std::vector<Index>& missing) const {
    if (missing.empty()) return;
    std::vector<Box> boxes;
    for (const Triple& t : s_.triangles) {
      Box box;
      for (const Index n : t) box.extend(c_.point(n));
      boxes.push_back(box);
    }
    const search::Octree tree(boxes);
    const auto position = [&](Index n) -> const Vec3& { return c_.point(n); };
    for (const Index f : missing)
      tree.overlapping(boxes[at(f)], [&](Index other) {
        if (other == f || !cross(s_.triangles[at(f)], s_.triangles[at(other)], position)) return;
        const Triple& t = s_.triangles[at(f)];
        throw MeshError("the surface crosses itself: triangles " + std::to_string(std::min(f, other)) +
                        " and " + std::to_string(std::max(f, other)) + ", at " +
                        place(mesh::Triangle{c_.point(t[0]), c_.point(t[1]), c_.point(t[2])}.centroid()));
      });
  }

  static constexpr int flip_rounds = 2;
  static constexpr double most_flipped = 0.3;  // share of missing edges; beyond it flips run in circles
  TetComplex& c_;
  FrontSurface s_;
  Way way_ = Way::forward;
  RecoveryCounts counts_;
};

}  // namespace tunica::meshing
