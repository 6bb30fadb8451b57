// SPDX-License-Identifier: MIT
// Directions and lengths of an extrusion: most normal directions, lengths that give the faces their
// thickness, held back before opposite sheets meet and where a cell would become too flat.
#pragma once

#include "tunica/core/error.hpp"
#include "tunica/core/expect.hpp"
#include "tunica/mesh/adjacency.hpp"
#include "tunica/mesh/mesh.hpp"
#include "tunica/mesh/quality.hpp"
#include "tunica/meshing/extrude_options.hpp"
#include "tunica/meshing/most_normal.hpp"
#include "tunica/meshing/quad_adjacency.hpp"
#include "tunica/meshing/split_quads.hpp"
#include "tunica/meshing/surface_foot.hpp"
#include "tunica/meshing/vec.hpp"

#include <algorithm>
#include <array>
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
      TUNICA_EXPECT(thickness_[at(n)] > 0, "a wall has a positive thickness everywhere");
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
    hold_back();
    for (int round = 0; round < fanning_rounds && fan_out(); ++round) hold_back();
    for (int round = 0; round < options_.rounds && give_way(); ++round) {
    }
  }

  /// From a node of the sheet to its outermost node.
  [[nodiscard]] Vec3 offset(Index n) const {
    return vec::scaled(share_[at(n)] * length_[at(n)], direction_[at(n)]);
  }
  [[nodiscard]] double share(Index n) const { return share_[at(n)]; }

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
  /// The thickness asked for at the middle of a face.
  [[nodiscard]] double wanted(Index q) const {
    double sum = 0;
    for (int k = 0; k < 4; ++k) sum += thickness_[at(sheet_.cells(k, q))] / 4;
    return sum;
  }
  [[nodiscard]] Vec3 x(Index q, int k) const { return node(sheet_.cells(k, q)); }
  [[nodiscard]] Vec3 node(Index n) const { return vec::column(sheet_.nodes, n); }

  [[noreturn]] void fail(Index n) const {
    const Vec3 p = node(n);
    throw MeshError("no direction sees all faces around the node at " + std::to_string(p[0]) + " " +
                    std::to_string(p[1]) + " " + std::to_string(p[2]) + ": the sheet is folded there");
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

  /// Shortens an offset whose end is nearer to another part of the sheet than to its own: half the gap is
  /// left to each side.
  void hold_back() {
    const mesh::Surface triangles = split_quads(sheet_);
    const FootFinder finder(triangles);
    std::vector<double> held(count(), 1.0);
    for (Index n = 0; n < sheet_.node_count(); ++n) {
      const double cosine = sees(n, direction_[at(n)]);
      const auto free = [&](double share) {
        const double reach = share * length_[at(n)];
        const Vec3 end = vec::along(node(n), reach, direction_[at(n)]);
        return finder.nearest(end).distance >= 0.97 * reach * cosine;
      };
      if (free(1)) continue;
      double lo = 0, hi = 1;
      for (int i = 0; i < 12; ++i) (free(0.5 * (lo + hi)) ? lo : hi) = 0.5 * (lo + hi);
      held[at(n)] = std::max(0.9 * lo, least_share);
    }
    share_ = held;
    taper();
  }

  /// Least cosine between a direction at a node and the normals there: positive where it sees all faces.
  [[nodiscard]] double sees(Index n, const Vec3& direction) const {
    double cosine = 1;
    for (const Vec3& m : normals_at(n)) cosine = std::min(cosine, vec::dot(m, direction));
    return cosine;
  }

  /// In a crotch the directions that were held back fan out, toward those of their neighbours: so they run
  /// further before they meet those of the other side. False when nothing is held back.
  bool fan_out() {
    std::vector<char> near(count(), 0);
    bool any = false;
    for (Index n = 0; n < sheet_.node_count(); ++n) {
      if (share(n) >= 0.95) continue;
      any = true;
      near[at(n)] = 1;
      for (const Index m : neighbours_[n]) near[at(m)] = 1;
    }
    const auto before = direction_;
    for (Index n = 0; n < sheet_.node_count(); ++n) {
      if (near[at(n)] == 0) continue;
      const Vec3 smooth = smoothed(n, before);
      if (sees(n, smooth) < least_cosine) continue;
      direction_[at(n)] = smooth;
      length_[at(n)] = fitted_length(n);
    }
    return any;
  }

  [[nodiscard]] Vec3 smoothed(Index n, const std::vector<Vec3>& directions) const {
    Vec3 mean = Vec3::Zero();
    for (const Index m : neighbours_[n]) mean += directions[at(m)];
    return in_plane(n, vec::along(directions[at(n)], 0.5 / static_cast<double>(neighbours_[n].size()), mean));
  }

  /// The thickness changes by at most half the way between neighbours.
  void taper() {
    for (bool changed = true; changed;) {
      changed = false;
      for (Index n = 0; n < sheet_.node_count(); ++n)
        for (const Index m : neighbours_[n]) {
          const double way = vec::distance(node(n), node(m));
          const double most = share_[at(m)] + 0.5 * way / thickness_[at(n)];
          if (share_[at(n)] > most + 1e-12) share_[at(n)] = most, changed = true;
        }
    }
  }

  /// Worst scaled Jacobian of the cells above a face.
  [[nodiscard]] double column_quality(Index q) const {
    double worst = 1;
    for (int l = 0; l < options_.layers; ++l) {
      mesh::HexCorners c;
      for (std::size_t k = 0; k < 4; ++k) {
        const Index n = sheet_.cells(static_cast<Eigen::Index>(k), q);
        c[k] = vec::along(node(n), static_cast<double>(l) / options_.layers, offset(n));
        c[k + 4] = vec::along(node(n), static_cast<double>(l + 1) / options_.layers, offset(n));
      }
      worst = std::min(worst, mesh::scaled_jacobian(c));
    }
    return worst;
  }

  /// What the face allows in the limit of no thickness: its corners against the directions.
  [[nodiscard]] double face_quality(Index q) const {
    double worst = 1;
    for (int k = 0; k < 4; ++k) {
      const Vec3 u = vec::minus(x(q, (k + 1) % 4), x(q, k)), v = vec::minus(x(q, (k + 3) % 4), x(q, k));
      worst = std::min(worst, vec::dot(vec::cross(u, v), direction_[at(sheet_.cells(k, q))]) /
                                  (vec::length(u) * vec::length(v)));
    }
    return worst;
  }

  /// Smooths the directions and lowers the thickness around cells that are too flat; false when there is
  /// none.
  bool give_way() {
    std::vector<char> bad(count(), 0);
    bool any = false;
    for (Index q = 0; q < sheet_.cell_count(); ++q) {
      if (column_quality(q) >= std::min(options_.good_quality, 0.7 * face_quality(q))) continue;
      any = true;
      for (int k = 0; k < 4; ++k) bad[at(sheet_.cells(k, q))] = 1;
    }
    if (!any) return false;
    const auto before = direction_;
    for (Index n = 0; n < sheet_.node_count(); ++n) {
      if (bad[at(n)] == 0) continue;
      share_[at(n)] = std::max(least_share, 0.93 * share_[at(n)]);
      const Vec3 smooth = smoothed(n, before);
      if (sees(n, smooth) > std::min(0.5, 0.9 * sees(n, before[at(n)]))) direction_[at(n)] = smooth;
    }
    taper();
    return true;
  }

  static constexpr double least_share = 0.05, least_cosine = 0.35;
  static constexpr int fanning_rounds = 8;

  const mesh::QuadSurface& sheet_;
  const ExtrudeOptions<T>& options_;
  mesh::Rows around_, neighbours_;
  std::vector<double> thickness_;  // asked for
  std::vector<Vec3> plane_;        // normal of the end's plane of a rim node, else zero
  std::vector<Vec3> direction_, face_normal_;
  std::vector<double> length_, share_;  // length before giving way, and what is left of it
};

}  // namespace detail

}  // namespace tunica::meshing
