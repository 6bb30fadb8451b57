// SPDX-License-Identifier: MIT
// By how much a sheet of quadrilaterals and a surface lie farther apart than a tolerance, both ways, kept up
// to date while nodes of the sheet move one at a time: only what a move can change is measured again.
#pragma once

#include "tunica/core/vec.hpp"
#include "tunica/mesh/adjacency.hpp"
#include "tunica/mesh/mesh.hpp"
#include "tunica/meshing/interface_distance.hpp"
#include "tunica/meshing/quad_face.hpp"
#include "tunica/meshing/quad_fans.hpp"
#include "tunica/meshing/surface_foot.hpp"
#include "tunica/meshing/wall_quads.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace tunica::meshing {

/// Sums of (d / tau - 1)^2 over distances d > tau: of 5 x 5 places of each face from the surface (finer:
/// (4 finer + 1)^2 where those are suspect), and of the targets, points of the surface, from the sheet.
template <FootSurface S>
class QuadMisfit {
 public:
  /// A point of the surface, the square of its distance from the sheet, and the face that lies there; where
  /// they are within the tolerance any face that is.
  struct Target {
    Vec3 place;
    Index quad;
    double square;
  };
  /// What a move of a node changes: its faces, and targets, as they lie to the faces that it does not move.
  struct Around {
    Index node;
    std::vector<Index> faces;
    std::vector<std::size_t> targets;
    std::vector<Target> otherwise;
  };

  /// Looks at the faces of the nodes in reach (one entry a node) and at the targets given.
  QuadMisfit(const WallQuads& wall, const S& surface, const std::vector<Vec3>& targets, double tolerance,
             const std::vector<char>& reach, int finer = 1)
      : parts_(4 * static_cast<std::size_t>(finer)),
        every_(static_cast<std::size_t>(finer)),
        wall_(wall),
        surface_(surface),
        tolerance_(tolerance),
        around_(mesh::cells_of_nodes(wall.cells, static_cast<Index>(wall.nodes.cols()))),
        away_(static_cast<std::size_t>(wall.cells.cols()), Distances(places(), 0.0)) {
    for (Index q = 0; q < quads(); ++q)
      for (int k = 0; k < 4; ++k)
        if (reach[at(wall.cells(k, q))] != 0) {
          away_[at(q)] = distances(q);
          break;
        }
    const mesh::Surface fans = fans_of_quads(wall.nodes, wall.cells);
    const TriangleFinder sheet(fans);
    for (const Vec3& x : targets) {
      const Index q = quad_foot(sheet, x).quad;
      targets_.push_back({x, q, face(q).squared_distance(x)});
    }
  }

  [[nodiscard]] double sum() const {
    double sum = 0;
    for (Index q = 0; q < quads(); ++q) sum += misfit(q);
    for (const Target& t : targets_) sum += misfit(t);
    return sum;
  }

  /// Marks the corners of the faces that lie too far, and of those nearest to targets that do.
  void mark(std::vector<char>& nodes) const {
    const auto corners = [&](Index q) {
      for (int k = 0; k < 4; ++k) nodes[at(wall_.cells(k, q))] = 1;
    };
    for (Index q = 0; q < quads(); ++q)
      if (misfit(q) > 0) corners(q);
    for (const Target& t : targets_)
      if (misfit(t) > 0) corners(t.quad);
  }

  /// Faces farther than two rings from the node are not asked for targets: those are nearer to other nodes.
  [[nodiscard]] Around around(Index n) const {
    Around a{n, {}, {}, {}};
    a.faces.assign(around_[n].begin(), around_[n].end());
    std::vector<Index> faces = a.faces;
    std::size_t first = 0;
    for (int ring = 0; ring < rings; ++ring)
      for (const std::size_t end = faces.size(); first < end; ++first)
        for (int k = 0; k < 4; ++k)
          for (const Index q : around_[wall_.cells(k, faces[first])])
            if (std::find(faces.begin(), faces.end(), q) == faces.end()) faces.push_back(q);
    const std::vector<Index> others(faces.begin() + static_cast<std::ptrdiff_t>(a.faces.size()), faces.end());
    const Vec3 x = vec::column(wall_.nodes, n);
    double size = 0;
    for (const Index q : a.faces)
      for (const Vec3& corner : face(q).x) size = std::max(size, vec::distance(x, corner));
    for (std::size_t i = 0; i < targets_.size(); ++i) {
      Target t = targets_[i];
      const bool own = std::find(a.faces.begin(), a.faces.end(), t.quad) != a.faces.end();
      if (!own && (misfit(t) == 0 || vec::distance(t.place, x) >= size + std::sqrt(t.square))) continue;
      if (own) {
        t.square = std::numeric_limits<double>::infinity();
        bring_near(t, others);
      }
      a.targets.push_back(i);
      a.otherwise.push_back(t);
    }
    return a;
  }

  /// The sum around a node that has moved that far since it was last updated; at least the bound if it is
  /// not less.
  [[nodiscard]] double sum(const Around& a, double moved, double bound) const {
    double sum = 0;
    for (std::size_t i = 0; i < a.otherwise.size() && sum < bound; ++i) {
      Target t = a.otherwise[i];
      bring_near(t, a.faces);
      sum += misfit(t);
    }
    for (std::size_t i = 0; i < a.faces.size() && sum < bound; ++i)
      sum += misfit(a.faces[i], a.node, moved, bound - sum);
    return sum;
  }

  /// Takes note that the node has moved.
  void update(const Around& a) {
    for (const Index q : a.faces) away_[at(q)] = distances(q);
    for (std::size_t i = 0; i < a.targets.size(); ++i) {
      targets_[a.targets[i]] = a.otherwise[i];
      bring_near(targets_[a.targets[i]], a.faces);
    }
  }

 private:
  static constexpr double target_weight = 4;  // there are fewer targets than places
  static constexpr int rings = 2;             // of faces around a node's own that are asked for targets
  using Distances = std::vector<double>;      // of the places of a face
  [[nodiscard]] std::size_t places() const { return (parts_ + 1) * (parts_ + 1); }
  [[nodiscard]] std::size_t column(std::size_t i) const { return i % (parts_ + 1); }
  [[nodiscard]] std::size_t row(std::size_t i) const { return i / (parts_ + 1); }
  [[nodiscard]] bool coarse(std::size_t i) const { return column(i) % every_ == 0 && row(i) % every_ == 0; }
  [[nodiscard]] double u(std::size_t i) const {
    return static_cast<double>(column(i)) / static_cast<double>(parts_);
  }
  [[nodiscard]] double v(std::size_t i) const {
    return static_cast<double>(row(i)) / static_cast<double>(parts_);
  }
  [[nodiscard]] static std::size_t at(Index i) { return static_cast<std::size_t>(i); }
  [[nodiscard]] Index quads() const { return static_cast<Index>(wall_.cells.cols()); }
  [[nodiscard]] QuadFace face(Index q) const { return quad_face(wall_.nodes, wall_.cells, q); }

  [[nodiscard]] double excess(double distance) const {
    const double e = distance / tolerance_ - 1;
    return e > 0 ? e * e : 0;
  }
  [[nodiscard]] double misfit(const Target& t) const { return target_weight * excess(std::sqrt(t.square)); }
  [[nodiscard]] double misfit(Index q) const {
    double sum = 0;
    for (const double d : away_[at(q)]) sum += excess(d);
    return sum;
  }
  /// With its corner at node n moved; a place that has moved less than it may is not measured again.
  [[nodiscard]] double misfit(Index q, Index n, double moved, double bound) const {
    const QuadFace f = face(q);
    int k = 0;
    while (wall_.cells(k, q) != n) ++k;
    double sum = 0;
    for (std::size_t i = 0; i < places() && sum < bound; ++i) {
      const double weight = (k == 0 || k == 3 ? 1 - u(i) : u(i)) * (k < 2 ? 1 - v(i) : v(i)),
                   known = away_[at(q)][i];
      if (known + weight * moved <= tolerance_) continue;
      sum += excess(weight > 0 ? distance_above(surface_, f.at(u(i), v(i)), tolerance_) : known);
    }
    return sum;
  }
  [[nodiscard]] Distances distances(Index q) const {
    const QuadFace f = face(q);
    Distances d(places(), suspect * tolerance_);
    double worst = 0;
    for (std::size_t i = 0; i < places(); ++i)
      if (coarse(i)) d[i] = surface_.distance(f.at(u(i), v(i))), worst = std::max(worst, d[i]);
    if (worst > suspect * tolerance_)
      for (std::size_t i = 0; i < places(); ++i)
        if (!coarse(i)) d[i] = surface_.distance(f.at(u(i), v(i)));
    return d;
  }

  /// To the nearest of the faces, or to one within the tolerance.
  void bring_near(Target& t, const std::vector<Index>& faces) const {
    for (const Index q : faces) {
      if (t.square <= tolerance_ * tolerance_) return;
      const QuadFace f = face(q);
      if (f.squared_distance_of_box(t.place) >= t.square) continue;
      const double square = f.squared_distance(t.place);
      if (square < t.square) t.square = square, t.quad = q;
    }
  }

  const std::size_t parts_, every_;  // of a side; which of them are always looked at
  const WallQuads& wall_;
  const S& surface_;
  const double tolerance_;
  mesh::Rows around_;
  std::vector<Distances> away_;
  std::vector<Target> targets_;
};

}  // namespace tunica::meshing
