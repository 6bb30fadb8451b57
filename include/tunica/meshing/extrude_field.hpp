// SPDX-License-Identifier: MIT
// Directions and lengths of an extrusion: most normal directions, lengths that give the faces their
// thickness; then the ends are moved where the sheet's own folds are in the way.
#pragma once

#include "tunica/core/error.hpp"
#include "tunica/core/text.hpp"
#include "tunica/core/vec.hpp"
#include "tunica/mesh/adjacency.hpp"
#include "tunica/mesh/mesh.hpp"
#include "tunica/meshing/extrude_ends.hpp"
#include "tunica/meshing/extrude_options.hpp"
#include "tunica/meshing/most_normal.hpp"
#include "tunica/meshing/quad_adjacency.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace tunica::meshing {

namespace detail {

template <Thickness T>
class ExtrudeField {
 public:
  ExtrudeField(const mesh::QuadSurface& sheet, std::span<const SheetRim> rims,
               const ExtrudeOptions<T>& options)
      : sheet_(sheet),
        options_(options),
        around_(mesh::cells_of_nodes(sheet.cells, sheet.node_count())),
        neighbours_(quad_neighbours(sheet.cells, sheet.node_count())),
        thickness_(count()),
        plane_(count(), Vec3::Zero()),
        direction_(count()),
        length_(count(), 0.0),
        share_(count(), 1.0) {
    for (Index n = 0; n < sheet.node_count(); ++n) {
      thickness_[at(n)] = thickness_at(options.thickness, node(n));
      if (!(thickness_[at(n)] > 0 && std::isfinite(thickness_[at(n)])))
        throw MeshError("the wall would have a thickness of " + seven_digits(thickness_[at(n)]) + " at " +
                        place(node(n)));
    }
    for (const SheetRim& rim : rims)
      for (const Index n : rim.loop) plane_[at(n)] = rim.normal;
    for (Index q = 0; q < sheet.cell_count(); ++q) {
      const Vec3 n = vec::cross(vec::minus(x(q, 2), x(q, 0)), vec::minus(x(q, 3), x(q, 1)));
      face_normal_.push_back(vec::unit(n));
    }
  }

  void solve() {
    for (Index n = 0; n < sheet_.node_count(); ++n) {
      const auto normals = normals_at(n);
      const MostNormal best = most_normal(normals);
      if (!(best.cosine > 0)) fail(n);
      direction_[at(n)] = in_plane(n, best.direction);
    }
    for (Index n = 0; n < sheet_.node_count(); ++n) length_[at(n)] = fitted_length(n);
    even_out();
    for (Index n = 0; n < sheet_.node_count(); ++n)
      offset_.push_back(vec::scaled(length_[at(n)], direction_[at(n)]));
    const Columns columns{sheet_, around_,         neighbours_,           thickness_,
                          plane_, options_.layers, options_.good_quality, options_.rounds};
    ColumnEnds ends(columns, offset_);
    ends.settle();
    for (Index n = 0; n < sheet_.node_count(); ++n) share_[at(n)] = ends.share(n);
  }

  /// From a node of the sheet to its outermost node.
  [[nodiscard]] Vec3 offset(Index n) const { return offset_[at(n)]; }
  [[nodiscard]] double share(Index n) const { return share_[at(n)]; }

  /// The thickness asked for at the middle of a face.
  [[nodiscard]] double wanted(Index q) const {
    double sum = 0;
    for (int k = 0; k < 4; ++k) sum += thickness_[at(sheet_.cells(k, q))] / 4;
    return sum;
  }

  /// Relative deviation of a face's thickness from that asked for; none where it gave way.
  [[nodiscard]] std::optional<double> deviation(Index q) const {
    double sum = 0;
    for (int k = 0; k < 4; ++k) {
      const Index n = sheet_.cells(k, q);
      if (share(n) < 1) return std::nullopt;
      sum += vec::dot(offset(n), face_normal_[at(q)]) / 4;
    }
    return sum / wanted(q) - 1;
  }

 private:
  [[nodiscard]] static std::size_t at(Index i) { return static_cast<std::size_t>(i); }
  [[nodiscard]] std::size_t count() const { return static_cast<std::size_t>(sheet_.node_count()); }
  [[nodiscard]] Vec3 x(Index q, int k) const { return node(sheet_.cells(k, q)); }
  [[nodiscard]] Vec3 node(Index n) const { return vec::column(sheet_.nodes, n); }

  [[noreturn]] void fail(Index n) const {
    const Vec3 p = node(n);
    throw MeshError("no direction sees all faces around the node at " + place(p) +
                    ": the sheet is folded there");
  }

  /// Unit normals of the faces at a node, and of their corners there: a cell is positive at its inner corner
  /// exactly if the direction lies on the same side as the corner's normal.
  [[nodiscard]] std::vector<Vec3> normals_at(Index n) const {
    std::vector<Vec3> normals;
    for (const Index q : around_[n]) {
      normals.push_back(face_normal_[at(q)]);
      for (int k = 0; k < 4; ++k) {
        if (sheet_.cells(k, q) != n) continue;
        const Vec3 c =
            vec::cross(vec::minus(x(q, (k + 1) % 4), x(q, k)), vec::minus(x(q, (k + 3) % 4), x(q, k)));
        normals.push_back(vec::unit(c));
      }
    }
    return normals;
  }

  [[nodiscard]] Vec3 in_plane(Index n, const Vec3& direction) const {
    const Vec3& p = plane_[at(n)];
    const Vec3 d = vec::along(direction, -vec::dot(p, direction), p);
    if (!(vec::length(d) > 0.1)) fail(n);
    return vec::unit(d);
  }

  /// min over s of sum w (s m.n - t)^2 over the faces at the node, w the angle of the face there.
  [[nodiscard]] double fitted_length(Index n) const {
    double sum = 0, square = 0;
    for (const Index q : around_[n])
      for (int k = 0; k < 4; ++k) {
        if (sheet_.cells(k, q) != n) continue;
        const double w = corner_angle(x(q, k), x(q, (k + 1) % 4), x(q, (k + 3) % 4));
        const double c = vec::dot(direction_[at(n)], face_normal_[at(q)]);
        sum += w * c, square += w * c * c;
      }
    return square > 0 ? thickness_[at(n)] * sum / square : thickness_[at(n)];
  }

  /// A few damped steps towards the right thickness at the middle of every face.
  void even_out() {
    std::vector<double> residual(face_normal_.size());
    for (int step = 0; step < 20; ++step) {
      for (Index q = 0; q < sheet_.cell_count(); ++q) {
        double sum = 0;
        for (int k = 0; k < 4; ++k) {
          const Index n = sheet_.cells(k, q);
          sum += length_[at(n)] * vec::dot(direction_[at(n)], face_normal_[at(q)]) / 4;
        }
        residual[at(q)] = wanted(q) - sum;
      }
      for (Index n = 0; n < sheet_.node_count(); ++n) {
        double sum = 0;
        for (const Index q : around_[n]) sum += residual[at(q)];
        const double limit = 0.05 * thickness_[at(n)];
        length_[at(n)] += std::clamp(sum / static_cast<double>(around_[n].size()), -limit, limit);
      }
    }
  }

  const mesh::QuadSurface& sheet_;
  const ExtrudeOptions<T>& options_;
  mesh::Rows around_, neighbours_;
  std::vector<double> thickness_;  // asked for
  std::vector<Vec3> plane_;        // normal of the end's plane of a rim node, else zero
  std::vector<Vec3> direction_, face_normal_;
  std::vector<double> length_, share_;  // length before giving way, and what is left of the thickness
  std::vector<Vec3> offset_;
};

}  // namespace detail

}  // namespace tunica::meshing
