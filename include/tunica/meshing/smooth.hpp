// SPDX-License-Identifier: MIT
// Volume-preserving Laplacian smoothing [PEREZ08, 3.2.1]: a Laplace sweep, its normal part taken back where
// it moves the neighbourhood as a whole (after [VOLLMER99]), then the offset that keeps the volume to
// rounding.
#pragma once

#include "tunica/core/expect.hpp"
#include "tunica/meshing/flat_regions.hpp"
#include "tunica/meshing/intersections.hpp"
#include "tunica/meshing/keep_volume.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

namespace tunica::meshing {

struct SmoothOptions {
  int sweeps = 20;
  double factor = 0.5;  // of the way to the mean of the neighbours in a sweep, 0 < factor <= 0.5 [-]
};

struct [[nodiscard]] SmoothReport {
  double volume_before = 0, volume_after = 0;  // in the unit of the surface cubed
  Index held_back = 0;      // moves left out because a triangle would have turned over, over all sweeps
  Index frozen = 0;         // nodes that stayed because the smoothed surface would have crossed itself there
  double largest_move = 0;  // from the start, in the unit of the surface
};

namespace detail {

class Smoother {
 public:
  Smoother(mesh::Surface& s, const SmoothOptions& options)
      : s_(s),
        options_(options),
        planes_(flat_regions(s)),
        bonds_(bonds(s, planes_)),
        near_(mesh::neighbours_of_nodes(s.cells, s.node_count())),
        around_(mesh::cells_of_nodes(s.cells, s.node_count())),
        start_(s.nodes),
        held_(static_cast<std::size_t>(s.node_count()), 0) {
    if (s.node_count() > 0) origin_ = mesh::bounding_box(s.nodes).centre();
    label_parts();
    normals();
    for (const VolumeCubic& c : cubics()) target_.push_back(c.c[0]);
  }

  [[nodiscard]] SmoothReport run() {
    SmoothReport report{.volume_before = mesh::enclosed_volume(s_)};
    const bool crossing_before = options_.sweeps > 0 && !self_intersections(s_, 1).empty();
    constexpr int most_rounds = 20;
    for (int round = 0;; ++round) {
      report.held_back = 0;
      for (int n = 0; n < options_.sweeps; ++n) report.held_back += sweep();
      if (options_.sweeps == 0 || crossing_before) break;
      const auto pairs = self_intersections(s_);
      if (pairs.empty()) break;
      // begin again, with the places that would cross, and a ring about them, held where they were
      if (round < most_rounds)
        hold(pairs);
      else
        std::fill(held_.begin(), held_.end(), char{1});
      s_.nodes = start_;
      normals();
    }
    report.frozen = static_cast<Index>(std::count(held_.begin(), held_.end(), char{1}));
    report.volume_after = mesh::enclosed_volume(s_);
    report.largest_move = std::sqrt((s_.nodes - start_).colwise().squaredNorm().maxCoeff());
    return report;
  }

 private:
  [[nodiscard]] bool held(Index n) const { return held_[static_cast<std::size_t>(n)] != 0; }

  void label_parts() {
    part_of_node_.assign(static_cast<std::size_t>(s_.node_count()), -1);
    std::vector<Index> stack;
    for (Index n = 0; n < s_.node_count(); ++n) {
      if (part_of_node_[static_cast<std::size_t>(n)] >= 0) continue;
      stack.assign(1, n);
      part_of_node_[static_cast<std::size_t>(n)] = parts_;
      while (!stack.empty()) {
        const Index m = stack.back();
        stack.pop_back();
        for (const Index o : near_[m])
          if (part_of_node_[static_cast<std::size_t>(o)] < 0)
            part_of_node_[static_cast<std::size_t>(o)] = parts_, stack.push_back(o);
      }
      ++parts_;
    }
    part_of_.resize(static_cast<std::size_t>(s_.cell_count()));
    for (Index t = 0; t < s_.cell_count(); ++t)
      part_of_[static_cast<std::size_t>(t)] = part_of_node_[static_cast<std::size_t>(s_.cells(0, t))];
  }

  [[nodiscard]] Vec3 bound(Index n, const Vec3& v) const {
    switch (bonds_.of(n)) {
      case Bond::none: return v;
      case Bond::corner: return Vec3::Zero();
      case Bond::plane:
      case Bond::rim: break;
    }
    const Vec3& m = planes_[static_cast<std::size_t>(bonds_.region[static_cast<std::size_t>(n)])]->normal;
    return v - m.dot(v) * m;
  }

  /// Unit normals of the curved regions at the nodes, in the plane for rim nodes; 0 where a node may not
  /// move.
  void normals() {
    normal_.setZero(3, s_.node_count());
    for (Index t = 0; t < s_.cell_count(); ++t) {
      if (planes_[static_cast<std::size_t>(s_.region_of(t))]) continue;
      const Vec3 a = mesh::triangle(s_, t).area_vector();
      for (int k = 0; k < 3; ++k) normal_.col(s_.cells(k, t)) += a;
    }
    for (Index n = 0; n < s_.node_count(); ++n) {
      const Vec3 v = held(n) ? Vec3::Zero().eval() : bound(n, normal_.col(n));
      const double l = v.norm();
      normal_.col(n) = l > 0 ? (v / l).eval() : Vec3::Zero().eval();
    }
  }

  [[nodiscard]] std::vector<VolumeCubic> cubics() const {
    return volume_cubics(s_.cells, s_.nodes, normal_, part_of_, parts_, origin_);
  }

  /// One sweep; the number of moves that were left out.
  Index sweep() {
    const Index count = s_.node_count();
    const auto mean = [&](Index n, const auto& value) {
      auto sum = value(n);
      sum *= 0.0;
      if (bonds_.of(n) == Bond::rim) {
        const auto& [p, q] = bonds_.along[static_cast<std::size_t>(n)];
        sum += value(p), sum += value(q);
        return sum *= 0.5;
      }
      for (const Index m : near_[n]) sum += value(m);
      return sum *= 1.0 / static_cast<double>(std::max<std::size_t>(1, near_[n].size()));
    };
    move_.setZero(3, count);
    rise_.setZero(count);
    for (Index n = 0; n < count; ++n) {
      if (held(n) || near_[n].empty()) continue;
      const Vec3 to = mean(n, [&](Index m) -> Vec3 { return s_.nodes.col(m); });
      move_.col(n) = bound(n, options_.factor * (to - s_.nodes.col(n)));
      rise_[n] = move_.col(n).dot(normal_.col(n));
    }
    // what half the node and half its neighbours rise together is no roughness: it is taken back, so a mode
    // of the Laplacian of eigenvalue k is damped by 1 - factor k^2 / 2 and large shapes stay
    trial_ = s_.nodes + move_;
    for (Index n = 0; n < count; ++n) {
      if (normal_.col(n).isZero()) continue;
      trial_.col(n) -= (0.5 * rise_[n] + 0.5 * mean(n, [&](Index m) { return rise_[m]; })) * normal_.col(n);
    }
    const Index kept_back = hold_back();
    s_.nodes = trial_;
    normals();
    keep_volume();
    return kept_back;
  }

  /// Takes back the moves of triangles that would turn over.
  Index hold_back() {
    Index kept_back = 0;
    std::vector<Index> todo(static_cast<std::size_t>(s_.cell_count()));
    for (Index t = 0; t < s_.cell_count(); ++t) todo[static_cast<std::size_t>(t)] = t;
    while (!todo.empty()) {
      std::vector<Index> again;
      for (const Index t : todo) {
        const auto v = s_.cells.col(t);
        const mesh::Triangle was{s_.nodes.col(v[0]), s_.nodes.col(v[1]), s_.nodes.col(v[2])};
        const mesh::Triangle is{trial_.col(v[0]), trial_.col(v[1]), trial_.col(v[2])};
        const Vec3 a = was.area_vector(), b = is.area_vector();
        const Vec3 n = normal_.col(v[0]) + normal_.col(v[1]) + normal_.col(v[2]);
        const bool turned = a.dot(b) <= 0 && (n.isZero() || n.dot(b) <= 0.1 * n.norm() * b.norm());
        if (!turned) continue;
        for (int k = 0; k < 3; ++k) {
          if (trial_.col(v[k]) == s_.nodes.col(v[k])) continue;
          trial_.col(v[k]) = s_.nodes.col(v[k]);
          ++kept_back;
          again.insert(again.end(), around_[v[k]].begin(), around_[v[k]].end());
        }
      }
      std::sort(again.begin(), again.end());
      again.erase(std::unique(again.begin(), again.end()), again.end());
      todo = std::move(again);
    }
    return kept_back;
  }

  void keep_volume() {
    constexpr int corrections = 2;  // the second takes up the rounding of the first
    for (int pass = 0; pass < corrections; ++pass) {
      const auto all = cubics();
      std::vector<double> offset(all.size());
      for (std::size_t p = 0; p < all.size(); ++p) {
        const double reach = std::cbrt(std::abs(target_[p]));
        offset[p] = all[p].offset(target_[p], reach);
      }
      for (Index n = 0; n < s_.node_count(); ++n)
        s_.nodes.col(n) +=
            offset[static_cast<std::size_t>(part_of_node_[static_cast<std::size_t>(n)])] * normal_.col(n);
    }
  }

  void hold(const std::vector<std::pair<Index, Index>>& pairs) {
    std::vector<Index> nodes;
    for (const auto& [t, u] : pairs)
      for (const Index f : {t, u})
        for (int k = 0; k < 3; ++k) nodes.push_back(s_.cells(k, f));
    for (const Index n : nodes) {
      held_[static_cast<std::size_t>(n)] = 1;
      for (const Index m : near_[n]) held_[static_cast<std::size_t>(m)] = 1;
    }
  }

  mesh::Surface& s_;
  SmoothOptions options_;
  std::vector<std::optional<Plane>> planes_;
  Bonds bonds_;
  mesh::Rows near_, around_;
  Points<3> start_, normal_, move_, trial_;
  Eigen::VectorXd rise_;
  std::vector<char> held_;
  std::vector<Index> part_of_node_, part_of_;
  std::vector<double> target_;  // 6 V of each part
  Index parts_ = 0;
  Vec3 origin_ = Vec3::Zero();
};

}  // namespace detail

/// Smooths a closed surface in place. The volume of each component is kept to rounding in every sweep; flat
/// regions stay in their planes and their rims on them; a surface that does not cross itself does not
/// afterwards.
inline SmoothReport smooth(mesh::Surface& s, const SmoothOptions& options = {}) {
  TUNICA_EXPECT(options.factor > 0 && options.factor <= 0.5, "the factor of a sweep is in (0, 0.5]");
  return detail::Smoother(s, options).run();
}

}  // namespace tunica::meshing
