// SPDX-License-Identifier: MIT
// How high layers grow above each node of a sheet: what is asked for, less where the opposite wall is near,
// where neighbours are lower, where a prism would be poor.
#pragma once

#include "tunica/core/vec.hpp"
#include "tunica/mesh/triangle.hpp"
#include "tunica/meshing/layer_directions.hpp"
#include "tunica/meshing/layer_options.hpp"
#include "tunica/meshing/layer_sheet.hpp"
#include "tunica/meshing/split_prisms.hpp"
#include "tunica/search/octree.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <queue>
#include <utility>
#include <vector>

namespace tunica::meshing {

class LayerHeights {
 public:
  LayerHeights(const LayerSheet& sheet, const LayerDirections& directions, const LayerOptions& options)
      : sheet_(sheet),
        way_(directions.way),
        cosine_(directions.cosine),
        options_(options),
        stale_(at(sheet.surface.cell_count()), 1) {
    find_edges();
    for (Index n = 0; n < sheet.surface.node_count(); ++n) {
      full_.push_back(sum_to(n, options.layers));
      wanted_.push_back(sheet.grows(n) ? full_.back() : 0);
    }
    if (!(options.first > 0)) converge();
    height_ = wanted_;
    leave_room();
    const double least_angle = options.least_angle * std::numbers::pi / 180;
    std::vector<Index> all;
    for (Index n = 0; n < sheet.surface.node_count(); ++n) all.push_back(n);
    limit_slope(all);
    for (const Index t : sheet.triangles) {
      const mesh::Triangle wall = mesh::triangle(sheet.surface, t);
      base_.push_back(2 * wall.area());
      angle_.push_back(std::min(least_angle, 0.5 * wall.smallest_angle()));
      double seen = 1;
      for (const Index n : sheet.corners(t))
        if (sheet.grows(n)) seen = std::min(seen, vec::dot(sheet.inward[at(t)], way_[at(n)]));
      good_.push_back(std::min(options.good, 0.5 * seen));
    }
  }

  [[nodiscard]] double wanted(Index n) const { return wanted_[at(n)]; }
  [[nodiscard]] double height(Index n) const { return height_[at(n)]; }
  [[nodiscard]] double edge(Index n) const { return edge_[at(n)]; }

  /// The node of level k (0: the foot) above a node.
  [[nodiscard]] Vec3 place(Index n, int level) const {
    const double h = height(n);
    if (!(h > 0) || level == 0) return sheet_.node(n);
    const double part = level == options_.layers ? 1 : sum_to(n, level) / full_[at(n)];
    return vec::along(sheet_.node(n), part * h, way_[at(n)]);
  }

  /// Lowers the columns of these nodes by a factor, those beside them as the slope asks. A column below the
  /// least height vanishes. False where none of them has a height.
  bool lower(const std::vector<Index>& nodes, double factor) {
    bool some = false;
    for (const Index n : nodes) {
      const double h = factor * height_[at(n)];
      some = some || height_[at(n)] > 0;
      set(n, h < options_.least * edge_[at(n)] ? 0 : h);
    }
    limit_slope(nodes);
    return some;
  }

  /// The nodes of prisms that are poor as the heights are now, ascending. Looks at those that were poor the
  /// last time or have changed since.
  [[nodiscard]] std::vector<Index> poor() {
    std::vector<Index> nodes;
    for (std::size_t i = 0; i < sheet_.triangles.size(); ++i) {
      if (stale_[at(sheet_.triangles[i])] == 0) continue;
      const auto c = sheet_.corners(sheet_.triangles[i]);
      const std::array<Index, 3> turned{c[0], c[2], c[1]};  // the normal to the inside
      PrismCorners x{sheet_.node(turned[0]), sheet_.node(turned[1]), sheet_.node(turned[2])};
      bool bad = false;
      for (int level = 1; level <= options_.layers && !bad; ++level) {
        for (std::size_t k = 0; k < 3; ++k) x[3 + k] = place(turned[k], level);
        bad = !(prism_quality(x, base_[i]) > good_[i]);
        for (std::size_t k = 0; k < 3; ++k) x[k] = x[3 + k];
      }
      bad = bad || mesh::Triangle{x[0], x[1], x[2]}.smallest_angle() < angle_[i];
      if (bad)
        nodes.insert(nodes.end(), c.begin(), c.end());
      else
        stale_[at(sheet_.triangles[i])] = 0;
    }
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    return nodes;
  }

 private:
  [[nodiscard]] static std::size_t at(Index i) { return static_cast<std::size_t>(i); }

  void set(Index n, double height) {
    height_[at(n)] = height;
    for (const Index t : sheet_.around[n]) stale_[at(t)] = 1;
  }

  /// Mean length of the edges at a node, averaged along the sheet.
  void find_edges() {
    const Index count = sheet_.surface.node_count();
    edge_.assign(at(count), 0);
    for (Index n = 0; n < count; ++n) {
      for (const Index m : sheet_.neighbours[n])
        edge_[at(n)] += vec::distance(sheet_.node(n), sheet_.node(m));
      edge_[at(n)] /= std::max(1.0, static_cast<double>(sheet_.neighbours[n].size()));
    }
    even_out(edge_);
  }

  void even_out(std::vector<double>& value) const {
    constexpr int sweeps = 5;
    for (int sweep = 0; sweep < sweeps; ++sweep) {
      const std::vector<double> old = value;
      for (Index n = 0; n < sheet_.surface.node_count(); ++n) {
        const auto near = sheet_.neighbours[n];
        if (near.empty()) continue;
        double sum = 0;
        for (const Index m : near) sum += old[at(m)];
        value[at(n)] = 0.5 * (old[at(n)] + sum / static_cast<double>(near.size()));
      }
    }
  }

  /// Where columns converge, edges shrink by 1 - kappa H: the height at which the last layer is its share of
  /// the edge that it meets is H / (1 + kappa H), kappa the most of -(dv . dx) / dx^2 over the edges.
  void converge() {
    std::vector<double> kappa(edge_.size(), 0);
    for (Index n = 0; n < sheet_.surface.node_count(); ++n)
      for (const Index m : sheet_.neighbours[n]) {
        if (!sheet_.grows(n) || !sheet_.grows(m)) continue;
        const Vec3 dx = vec::minus(sheet_.node(m), sheet_.node(n)), dv = vec::minus(way_[at(m)], way_[at(n)]);
        kappa[at(n)] = std::max(kappa[at(n)], -vec::dot(dv, dx) / vec::squared(dx));
      }
    even_out(kappa);
    for (std::size_t i = 0; i < kappa.size(); ++i) wanted_[i] /= 1 + kappa[i] * wanted_[i];
  }

  /// Height of the first `levels` layers asked for: t_k = t_1 g^(k-1), none above its share of the edge.
  [[nodiscard]] double sum_to(Index n, int levels) const {
    const double most = options_.last * edge_[at(n)], g = options_.growth;
    double t = options_.first > 0 ? options_.first : most / std::pow(g, options_.layers - 1), sum = 0;
    for (int k = 0; k < levels; ++k, t *= g) sum += std::min(t, most);
    return sum;
  }

  /// No column beyond its share of the way across. Half of that way is where the end of a column is nearer
  /// to some other part of the sheet than to its own foot.
  void leave_room() {
    constexpr double nearer = 0.9;
    constexpr int halvings = 6;
    std::vector<Box> boxes;
    std::vector<mesh::Triangle> shapes;
    const mesh::Surface& s = sheet_.surface;
    for (const Index t : sheet_.triangles)
      shapes.push_back(mesh::triangle(s, t)), boxes.push_back(shapes.back().box());
    const search::Octree tree(boxes);
    for (Index n = 0; n < s.node_count(); ++n) {
      if (!sheet_.grows(n)) continue;
      const auto free = [&](double reach) {
        const Vec3 x = vec::along(sheet_.node(n), reach, way_[at(n)]);
        const double clear = nearer * cosine_[at(n)] * reach;
        const auto hit = tree.nearest(
            x,
            [&](Index i) {
              const mesh::Triangle& t = shapes[at(i)];
              return vec::squared(vec::minus(t.at(t.nearest(x)), x));
            },
            clear * clear);
        return hit.item < 0;
      };
      const double whole = height_[at(n)] / (2 * options_.room);
      if (free(whole)) continue;
      double lo = 0, hi = 1;
      for (int i = 0; i < halvings; ++i) (free(0.5 * (lo + hi) * whole) ? lo : hi) = 0.5 * (lo + hi);
      height_[at(n)] *= lo;
    }
  }

  /// No column higher than its neighbour by more than the slope times the edge between them.
  void limit_slope(const std::vector<Index>& from) {
    using Entry = std::pair<double, Index>;  // lowest first: each node is settled once
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    for (const Index n : from)
      if (sheet_.foot[at(n)] != ColumnFoot::none) queue.push({height_[at(n)], n});
    while (!queue.empty()) {
      const auto [h, n] = queue.top();
      queue.pop();
      if (h > height_[at(n)]) continue;
      for (const Index m : sheet_.neighbours[n]) {
        const double most = h + options_.slope * vec::distance(sheet_.node(n), sheet_.node(m));
        if (!(height_[at(m)] > most)) continue;
        set(m, most);
        queue.push({most, m});
      }
    }
  }

  const LayerSheet& sheet_;
  const std::vector<Vec3>& way_;
  const std::vector<double>& cosine_;
  const LayerOptions& options_;
  std::vector<double> edge_, full_, wanted_, height_;  // one a node; full: on a flat wall
  std::vector<double> base_, good_, angle_;            // one a triangle of the sheet
  std::vector<char> stale_;                            // one a triangle of the surface
};

}  // namespace tunica::meshing
