// SPDX-License-Identifier: MIT
// Smoothing of interfaces: lambda-mu sweeps [TAUBIN95] within reach of the voxels' faces, junction curves
// along themselves, the volumes of the regions brought back, and no crossing made (exact test).
#pragma once

#include "tunica/mesh/adjacency.hpp"
#include "tunica/meshing/interface_volumes.hpp"
#include "tunica/meshing/intersections.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace tunica::meshing {

struct RelaxReport {
  double deviation = 0;  // of a region's volume from its target, relative, the largest
  Index held = 0;        // nodes that could not go all the way: triangles would have crossed or folded
};

class InterfaceRelax {
 public:
  explicit InterfaceRelax(Interfaces& s)
      : s_(s), edges_(edges_of(s)), start_(s.nodes), share_(s.nodes.size(), 1) {
    find_neighbours();
    ring_ = mesh::cells_of_nodes(s.surface().cells, s.node_count());
    for (const InterfaceEdge& e : edges_.edges) folded_.push_back(folded(e));
    for (std::size_t t = 0; t < s.faces.size(); ++t) thin_.push_back(s.triangle(t).smallest_angle());
  }

  /// Sweeps, then the volumes; what would cross or fold goes back until nothing does.
  RelaxReport run(int sweeps, const std::vector<double>& target) {
    constexpr int rounds = 6, volume_steps = 8;
    constexpr double enough = 1e-10;
    for (int n = 0; n < sweeps; ++n) sweep(lambda), sweep(mu);
    InterfaceVolumes volumes(s_, target);
    RelaxReport report;
    const double most = 0.25 * shortest_reach();
    std::fill(share_.begin(), share_.end(), 1.0);
    std::vector<double> free = share_;  // 0: a node that has been sent back takes no part in the volumes
    for (int round = 0; round < rounds; ++round) {
      for (int i = 0; i < volume_steps && volumes.deviation(s_) > enough; ++i) {
        const auto move = volumes.moves(s_, free, most);
        for (std::size_t n = 0; n < move.size(); ++n)
          s_.nodes[n] = bounded(n, vec::plus(s_.nodes[n], move[n]));
      }
      if (!send_back()) break;
      for (std::size_t n = 0; n < free.size(); ++n)
        if (share_[n] < 1) free[n] = 0;
    }
    report.deviation = volumes.deviation(s_);
    for (const double share : share_) report.held += share < 1;
    return report;
  }

 private:
  // lambda and mu of the filter [TAUBIN95]: 1/lambda + 1/mu = 0.1, the pass band.
  static constexpr double lambda = 0.5, mu = -0.5263;

  void find_neighbours() {
    std::vector<std::vector<Index>> plain(s_.nodes.size()), curve(s_.nodes.size());
    for (const InterfaceEdge& e : edges_.edges)
      for (const Index from : {e.a, e.b}) {
        const Index to = e.a + e.b - from;
        plain[static_cast<std::size_t>(from)].push_back(to);
        if (e.junction) curve[static_cast<std::size_t>(from)].push_back(to);
      }
    offset_.assign(1, 0);
    for (std::size_t n = 0; n < plain.size(); ++n) {
      const auto& list = curve[n].empty() ? plain[n] : curve[n];
      near_.insert(near_.end(), list.begin(), list.end());
      offset_.push_back(near_.size());
    }
  }

  [[nodiscard]] Vec3 bounded(std::size_t n, Vec3 x) const {
    for (int a = 0; a < 3; ++a) {
      const double o = s_.anchor[n][a], r = s_.reach[n][a];
      x[a] = (s_.frozen[n] >> a & 1) != 0 ? s_.nodes[n][a] : std::clamp(x[a], o - r, o + r);
    }
    return x;
  }

  void sweep(double factor) {
    std::vector<Vec3> next(s_.nodes.size());
    for (std::size_t n = 0; n < next.size(); ++n) {
      Vec3 mean(0, 0, 0);
      for (std::size_t k = offset_[n]; k < offset_[n + 1]; ++k) mean = vec::plus(mean, s_.at(near_[k]));
      const double count = static_cast<double>(offset_[n + 1] - offset_[n]);
      next[n] =
          count > 0 ? bounded(n, vec::between(s_.nodes[n], vec::divided(mean, count), factor)) : s_.nodes[n];
    }
    s_.nodes = std::move(next);
  }

  [[nodiscard]] double shortest_reach() const {
    double least = std::numeric_limits<double>::infinity();
    for (const Vec3& r : s_.reach) least = std::min({least, r[0], r[1], r[2]});
    return least;
  }

  /// The smallest angle between two sheets at an edge, as a cosine: 1 folded flat.
  [[nodiscard]] double folded(const InterfaceEdge& e) const {
    const Vec3 axis = vec::unit(vec::minus(s_.at(e.b), s_.at(e.a)));
    double most = -1;
    std::array<Vec3, 16> away;
    std::size_t count = 0;
    for (Index k = e.first; k < e.last && count < away.size(); ++k) {
      for (const Index n : s_.faces[static_cast<std::size_t>(edges_.triangle[static_cast<std::size_t>(k)])]) {
        if (n == e.a || n == e.b) continue;
        const Vec3 d = vec::minus(s_.at(n), s_.at(e.a));
        away[count] = vec::unit(vec::along(d, -vec::dot(d, axis), axis));
        for (std::size_t i = 0; i < count; ++i) most = std::max(most, vec::dot(away[i], away[count]));
        ++count;
        break;
      }
    }
    return most;
  }

  /// Nodes of triangles that cross, that fold more sharply than before and than `sharp`, or that are thinner
  /// than before and than `thin`, go half of the way back to the start, after four times all of it. True when
  /// any did.
  bool send_back() {
    constexpr double sharp = 0.94;  // cosine of 20 degrees
    constexpr double thin = 0.26;   // [rad] 15 degrees
    constexpr double least_share = 0.1;
    const std::vector<Vec3> moved = s_.nodes;
    std::vector<double> whole(moved.size(), 1);     // the part of the way that each node goes
    std::vector<char> fresh(moved.size(), 1), bad;  // nodes that have moved since the last look
    bool any = false;
    for (bool again = true; again;) {
      again = false;
      bad.assign(moved.size(), 0);
      const auto is_fresh = [&](std::size_t t) {
        const auto& f = s_.faces[t];
        return (fresh[at(f[0])] | fresh[at(f[1])] | fresh[at(f[2])]) != 0;
      };
      const auto mark = [&](Index n) {
        for (const Index t : ring_[n])
          for (const Index m : s_.faces[at(t)]) bad[at(m)] = 1;
      };
      crossings(is_fresh, [&](std::size_t t) {
        for (const Index n : s_.faces[t]) mark(n);
      });
      for (std::size_t e = 0; e < edges_.edges.size(); ++e) {
        const auto of_edge = [&](Index k) { return at(edges_.triangle[at(k)]); };
        const InterfaceEdge& edge = edges_.edges[e];
        bool look = false;
        for (Index k = edge.first; k < edge.last; ++k) look = look || is_fresh(of_edge(k));
        if (!look) continue;
        const double now = folded(edge);
        if (!(now > sharp && now > folded_[e] + 1e-9)) continue;
        mark(edge.a), mark(edge.b);
        for (Index k = edge.first; k < edge.last; ++k)
          for (const Index n : s_.faces[of_edge(k)]) bad[at(n)] = 1;
      }
      for (std::size_t t = 0; t < thin_.size(); ++t)
        if (is_fresh(t))
          if (const double now = s_.triangle(t).smallest_angle(); now < thin && now < thin_[t] - 1e-9)
            for (const Index n : s_.faces[t]) bad[at(n)] = 1;
      for (std::size_t n = 0; n < bad.size(); ++n) {
        fresh[n] = bad[n] != 0 && whole[n] > 0;
        if (fresh[n] == 0) continue;
        whole[n] = whole[n] < least_share ? 0 : 0.5 * whole[n];
        share_[n] = std::min(share_[n], 0.5);
        for (int a = 0; a < 3; ++a)
          if ((s_.frozen[n] >> a & 1) == 0)
            s_.nodes[n][a] = start_[n][a] + whole[n] * (moved[n][a] - start_[n][a]);
        any = again = true;
      }
    }
    return any;
  }

  /// Calls act(t) for the triangles that cross another one or have no area, where one of the two is fresh.
  template <class Fresh, class Act>
  void crossings(const Fresh& is_fresh, const Act& act) const {
    std::vector<Box> boxes(s_.faces.size());
    for (std::size_t t = 0; t < boxes.size(); ++t) boxes[t] = s_.triangle(t).box();
    const search::Octree tree(boxes);
    const auto position = [&](Index n) { return s_.at(n); };
    for (std::size_t t = 0; t < boxes.size(); ++t) {
      if (!is_fresh(t)) continue;
      if (detail::projection_axis(s_.triangle(t)) < 0) {
        act(t);
        continue;
      }
      tree.overlapping(boxes[t], [&](Index other) {
        const std::size_t u = at(other);
        if (u == t || (u < t && is_fresh(u)) || detail::projection_axis(s_.triangle(u)) < 0) return;
        if (cross(s_.faces[t], s_.faces[u], position)) act(t), act(u);
      });
    }
  }

  template <class I>
  [[nodiscard]] static std::size_t at(I i) {
    return static_cast<std::size_t>(i);
  }

  Interfaces& s_;
  InterfaceEdges edges_;
  std::vector<Vec3> start_;
  std::vector<double> share_;   // 1: nodes that never had to go back
  std::vector<double> folded_;  // of each edge at the start
  std::vector<double> thin_;    // smallest angle of each triangle at the start [rad]
  std::vector<std::size_t> offset_;
  std::vector<Index> near_;
  mesh::Rows ring_;  // triangles of each node
};

}  // namespace tunica::meshing
