// SPDX-License-Identifier: MIT
// Where the columns of an extrusion end: at the thickness asked for from the whole sheet. In a valley the
// ends are slid along the offset surface until the columns of both flanks stand side by side.
#pragma once

#include "tunica/core/vec.hpp"
#include "tunica/mesh/adjacency.hpp"
#include "tunica/mesh/mesh.hpp"
#include "tunica/mesh/quality.hpp"
#include "tunica/meshing/quad_diagonals.hpp"
#include "tunica/meshing/surface_foot.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace tunica::meshing::detail {

/// A sheet with what is known of its nodes: the faces and nodes around each, the thickness asked for, and
/// the normal of the plane in which the node's column stays (zero: in none).
struct Columns {
  const mesh::QuadSurface& sheet;
  const mesh::Rows &around, &neighbours;
  const std::vector<double>& thickness;
  const std::vector<Vec3>& plane;
  int layers;
  double good;  // scaled Jacobian from which a cell needs no help
  int rounds;   // of help at most
};

class ColumnEnds {
 public:
  /// offset: from the nodes to the ends of their columns, moved where the wall would not be thick enough.
  ColumnEnds(const Columns& columns, std::vector<Vec3>& offset)
      : c_(columns),
        offset_(offset),
        normal_(offset),
        slid_(offset.size(), 0),
        triangles_(triangles_of(columns.sheet)),
        finder_(triangles_) {}

  void settle() {
    std::vector<Index> valley, tight = held_back();
    for (int pass = 0; pass < passes && !tight.empty(); ++pass) {
      widen(valley, tight, (1 + pass) * beyond);
      for (int round = 0; round < sliding_rounds; ++round) slide(valley);
      tight.clear();
      for (const Index n : valley)
        if (share(n) < tightest) tight.push_back(n);
    }
    mend(c_.good);
    for (int pass = 0; pass < passes && give_way(); ++pass) mend(c_.good);
  }

  /// Distance of the column's end from the sheet over the thickness asked for; 1 where it is all there.
  [[nodiscard]] double share(Index n) const {
    const double share = share_of(n, offset_[at(n)]);
    return share > 0.995 ? 1 : std::max(share, 0.0);
  }

 private:
  /// Positive on the side of the sheet's normals, with the direction in which it grows.
  struct Height {
    double value;
    Vec3 up;
  };

  [[nodiscard]] static std::size_t at(Index i) { return static_cast<std::size_t>(i); }
  [[nodiscard]] Vec3 node(Index n) const { return vec::column(c_.sheet.nodes, n); }

  [[nodiscard]] Height height(const Vec3& p) const {
    const Foot foot = finder_.nearest(p);
    const Vec3 way = vec::minus(p, foot.point);
    if (!(foot.distance > 0)) return {0, foot.normal};
    const double side = vec::dot(way, foot.normal) < 0 ? -1 : 1;
    return {side * foot.distance, vec::scaled(side / foot.distance, way)};
  }
  [[nodiscard]] double share_of(Index n, const Vec3& offset) const {
    return height(vec::along(node(n), 1, offset)).value / c_.thickness[at(n)];
  }
  [[nodiscard]] Vec3 in_plane(Index n, const Vec3& v) const {
    const Vec3& p = c_.plane[at(n)];
    return vec::along(v, -vec::dot(p, v), p);
  }

  /// The nodes whose columns come too near to another part of the sheet, shortened to where they do not.
  std::vector<Index> held_back() {
    std::vector<Index> list;
    for (Index n = 0; n < c_.sheet.node_count(); ++n) {
      const auto free = [&](double part) {
        const double reach = std::min(part * vec::length(offset_[at(n)]), part * c_.thickness[at(n)]);
        return height(vec::along(node(n), part, offset_[at(n)])).value >= clear * reach;
      };
      if (free(1)) continue;
      double lo = 0, hi = 1;
      for (int i = 0; i < 5; ++i) (free(0.5 * (lo + hi)) ? lo : hi) = 0.5 * (lo + hi);
      offset_[at(n)] = vec::scaled(lo, offset_[at(n)]);
      list.push_back(n);
    }
    return list;
  }

  /// Adds the nodes within that many thicknesses of the tight ones along the sheet.
  void widen(std::vector<Index>& valley, std::vector<Index> list, double reach) {
    std::vector<double> way(offset_.size(), -1);
    for (const Index n : list) way[at(n)] = 0;
    for (std::size_t i = 0; i < list.size(); ++i)
      for (const Index m : c_.neighbours[list[i]]) {
        const double far = way[at(list[i])] + vec::distance(node(list[i]), node(m));
        if (way[at(m)] >= 0 || far > reach * c_.thickness[at(m)]) continue;
        way[at(m)] = far;
        list.push_back(m);
      }
    for (const Index n : list)
      if (slid_[at(n)] == 0) slid_[at(n)] = 1, valley.push_back(n);
  }

  /// Each offset goes towards the mean of those around it, and its end then to the thickness asked for.
  void slide(const std::vector<Index>& valley) {
    std::vector<Vec3> next;
    for (const Index n : valley) {
      Vec3 mean = Vec3::Zero();
      for (const Index m : c_.neighbours[n]) mean += offset_[at(m)];
      Vec3 e = vec::along(vec::scaled(0.5, offset_[at(n)]),
                          0.5 / static_cast<double>(c_.neighbours[n].size()), mean);
      const Height h = height(vec::along(node(n), 1, e));
      const double t = c_.thickness[at(n)];
      e = vec::along(e, std::clamp(t - h.value, -0.5 * t, 0.5 * t), h.up);
      next.push_back(in_plane(n, e));
    }
    for (std::size_t i = 0; i < valley.size(); ++i) offset_[at(valley[i])] = next[i];
  }

  /// Worst scaled Jacobian of the cells above a face.
  [[nodiscard]] double column_quality(Index q) const {
    double worst = 1;
    for (int l = 0; l < c_.layers; ++l) {
      mesh::HexCorners corners;
      for (std::size_t k = 0; k < 4; ++k) {
        const Index n = c_.sheet.cells(static_cast<Eigen::Index>(k), q);
        corners[k] = vec::along(node(n), static_cast<double>(l) / c_.layers, offset_[at(n)]);
        corners[k + 4] = vec::along(node(n), static_cast<double>(l + 1) / c_.layers, offset_[at(n)]);
      }
      worst = std::min(worst, mesh::scaled_jacobian(corners));
    }
    return worst;
  }

  /// What a node's offset is worth: the worst of the cells around it, most of all below two thirds of the
  /// good quality, then its thickness, most of all below half of that asked for.
  [[nodiscard]] double worth(Index n) const {
    double worst = 1, sum = 0;
    for (const Index q : c_.around[n]) {
      const double quality = column_quality(q) / c_.good;
      worst = std::min(worst, quality);
      sum += std::min(quality, 1.0);
    }
    const double share = std::min(share_of(n, offset_[at(n)]), 1.0);
    return std::min(worst, 1.0) + 4 * std::min(worst / poor, 1.0) + 1.5 * share + std::min(2 * share, 1.0) +
           0.1 * sum / static_cast<double>(c_.around[n].size());
  }

  /// Around cells below that quality and where the wall is too thin the ends try a step to all sides, and
  /// keep the best.
  void mend(double quality) {
    std::vector<double> step(offset_.size(), first_step);
    std::vector<char> bad(offset_.size());
    for (int round = 0; round < c_.rounds; ++round) {
      std::fill(bad.begin(), bad.end(), 0);
      for (Index q = 0; q < c_.sheet.cell_count(); ++q) {
        if (column_quality(q) >= quality) continue;
        for (int k = 0; k < 4; ++k) bad[at(c_.sheet.cells(k, q))] = 1;
      }
      bool any = false;
      for (Index n = 0; n < c_.sheet.node_count(); ++n) {
        if (!(step[at(n)] >= last_step)) continue;
        if (bad[at(n)] == 0 && (slid_[at(n)] == 0 || share(n) >= clear)) continue;
        any = true;
        mend(n, step[at(n)]);
      }
      if (!any) break;
    }
  }

  void mend(Index n, double& step) {
    const Vec3 start = offset_[at(n)];
    Vec3 mean = Vec3::Zero(), best = start;
    for (const Index m : c_.neighbours[n]) mean += offset_[at(m)];
    mean = vec::scaled(1 / static_cast<double>(c_.neighbours[n].size()), mean);
    const double before = worth(n), h = step * c_.thickness[at(n)];
    double most = before + 1e-3;
    const auto attempt = [&](const Vec3& offset) {
      offset_[at(n)] = in_plane(n, offset);
      const double value = worth(n);
      if (value > most) most = value, best = offset_[at(n)];
    };
    const Vec3 up = vec::unit(start), side = vec::unit(across(up)), third = vec::cross(up, side);
    for (const Vec3& way : {side, third, up})
      for (const double sign : {1.0, -1.0}) attempt(vec::along(start, sign * h, way));
    attempt(vec::between(start, mean, step));
    attempt(vec::scaled(1 - step, start));
    offset_[at(n)] = best;
    slid_[at(n)] = 1;
    if (!(most > before + 1e-3)) step *= 0.5;
  }

  /// Above poor cells the columns of a face and those around it, half as much, go back together to how they
  /// began, shortened, where that is worth it. False where no cell is poor.
  bool give_way() {
    bool any = false;
    for (Index q = 0; q < c_.sheet.cell_count(); ++q) {
      if (column_quality(q) >= poor * c_.good) continue;
      any = true;
      std::vector<Index> group;
      const auto add = [&](Index n) {
        if (std::find(group.begin(), group.end(), n) == group.end()) group.push_back(n);
      };
      for (int k = 0; k < 4; ++k) add(c_.sheet.cells(k, q));
      for (std::size_t i = 0; i < 4; ++i)
        for (const Index m : c_.neighbours[group[i]]) add(m);
      std::vector<Vec3> start, best;
      for (const Index n : group) start.push_back(offset_[at(n)]);
      best = start;
      const auto value = [&] {
        double sum = 0;
        for (const Index n : group) sum += worth(n);
        return sum;
      };
      double most = value() + 1e-3;
      for (const bool anew : {true, false})
        for (const double part : {1.0, 0.8, 0.6, 0.4, 0.2})
          for (const double around : {0.0, 0.5, 1.0}) {
            for (std::size_t i = 0; i < group.size(); ++i) {
              const double weight = i < 4 ? 1 : around, length = 1 - weight * (1 - part);
              const Vec3& from = anew ? normal_[at(group[i])] : start[i];
              offset_[at(group[i])] = vec::between(start[i], vec::scaled(length, from), weight);
            }
            const double now = value();
            if (!(now > most)) continue;
            most = now;
            for (std::size_t i = 0; i < group.size(); ++i) best[i] = offset_[at(group[i])];
          }
      for (std::size_t i = 0; i < group.size(); ++i) offset_[at(group[i])] = best[i], slid_[at(group[i])] = 1;
    }
    return any;
  }

  /// Some direction across another.
  [[nodiscard]] static Vec3 across(const Vec3& d) {
    const int least = std::abs(d[0]) <= std::abs(d[1]) ? (std::abs(d[0]) <= std::abs(d[2]) ? 0 : 2)
                                                       : (std::abs(d[1]) <= std::abs(d[2]) ? 1 : 2);
    Vec3 axis = Vec3::Zero();
    axis[least] = 1;
    return vec::cross(d, axis);
  }

  static constexpr double clear = 0.95;    // share of the thickness from which a column is left as it is
  static constexpr double tightest = 0.9;  // share below which the columns farther around give room
  static constexpr double beyond = 1.5;    // how far around them columns are slid [thickness]
  static constexpr int sliding_rounds = 40, passes = 3;
  static constexpr double poor = 2.0 / 3;  // share of the good quality below which thickness gives way
  static constexpr double first_step = 0.2, last_step = 0.02;  // [thickness]

  const Columns& c_;
  std::vector<Vec3>& offset_;
  const std::vector<Vec3> normal_;  // offsets as they were
  std::vector<char> slid_;
  mesh::Surface triangles_;
  FootFinder finder_;
};

}  // namespace tunica::meshing::detail
