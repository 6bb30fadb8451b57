// SPDX-License-Identifier: MIT
// Flat tetrahedra whose nodes lie on interfaces: no filling of one region can mend them, so these nodes are
// moved a little for the tetrahedra of all regions around them.
#pragma once

#include "tunica/mesh/adjacency.hpp"
#include "tunica/meshing/editable_interfaces.hpp"
#include "tunica/meshing/tet_quality.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>
#include <vector>

namespace tunica::meshing {

class InterfaceNudge {
 public:
  /// cells: tetrahedra of all regions; the nodes of the interfaces come first among the points.
  InterfaceNudge(const Interfaces& s, double edge, std::vector<Vec3>& points, const Connectivity<4>& cells)
      : s_(s),
        surface_(s, edge),
        edge_(edge),
        points_(points),
        cells_(cells),
        around_(mesh::cells_of_nodes(cells, static_cast<Index>(points.size()))) {}

  /// Works on tetrahedra with a dihedral angle below `angle` [degrees] or above 180 less it. Returns how many
  /// nodes of interfaces were moved.
  Index run(double angle) {
    constexpr int passes = 8;
    const double target = std::sin(angle * std::numbers::pi / 180);
    std::vector<char> moved(s_.nodes.size(), 0);
    for (int pass = 0; pass < passes; ++pass) {
      std::vector<Bad> bad;
      for (Index t = 0; t < static_cast<Index>(cells_.cols()); ++t)
        if (const double q = quality(t); q < target) bad.push_back({q, t});
      std::sort(bad.begin(), bad.end(), [](const Bad& a, const Bad& b) {
        return a.quality != b.quality ? a.quality < b.quality : a.tet < b.tet;
      });
      bool changed = false;
      for (const Bad& b : bad)
        for (Eigen::Index i = 0; i < 4 && quality(b.tet) < target; ++i) {
          const Index n = cells_(i, b.tet);
          if (!climb(n)) continue;
          changed = true;
          if (n < s_.node_count()) moved[static_cast<std::size_t>(n)] = 1;
        }
      if (!changed) break;
    }
    for (Index n = 0; n < s_.node_count(); ++n) points_[static_cast<std::size_t>(n)] = surface_.x(n);
    return static_cast<Index>(std::count(moved.begin(), moved.end(), char{1}));
  }

 private:
  struct Bad {
    double quality;
    Index tet;
  };
  [[nodiscard]] const Vec3& x(Index n) const { return points_[static_cast<std::size_t>(n)]; }
  [[nodiscard]] double quality(Index t) const {
    return sine_quality(x(cells_(0, t)), x(cells_(1, t)), x(cells_(2, t)), x(cells_(3, t)));
  }
  [[nodiscard]] double worst(Index n) const {
    double least = 2;
    for (const Index t : around_[n]) least = std::min(least, quality(t));
    return least;
  }
  [[nodiscard]] double worst_at(Index n, const Vec3& place) {
    const Vec3 from = std::exchange(points_[static_cast<std::size_t>(n)], place);
    const double q = worst(n);
    points_[static_cast<std::size_t>(n)] = from;
    return q;
  }

  /// Steps to all sides, shorter ones where none helps; a node of an interface stays in reach of the voxels
  /// that it parts, within a part of an edge, and crosses nothing.
  bool climb(Index n) {
    constexpr int rounds = 10;
    constexpr double first_step = 0.1, farthest = 0.25;  // of the edge
    const bool on_interface = n < s_.node_count();
    const auto m = static_cast<std::size_t>(n);
    const double before = worst(n);
    double value = before, step = first_step * edge_;
    Vec3 best = x(n);
    for (int round = 0; round < rounds; ++round) {
      const Vec3 from = best;
      for (int d = 0; d < 27; ++d) {
        Vec3 y = from;
        for (int a = 0; a < 3; ++a) {
          if (on_interface && (s_.frozen[m] >> a & 1) != 0) continue;
          y[a] += step * (d / thirds[static_cast<std::size_t>(a)] % 3 - 1);
          if (on_interface)
            y[a] =
                std::clamp(y[a], std::max(s_.at(n)[a] - farthest * edge_, s_.anchor[m][a] - s_.reach[m][a]),
                           std::min(s_.at(n)[a] + farthest * edge_, s_.anchor[m][a] + s_.reach[m][a]));
        }
        if (const double q = worst_at(n, y); q > value) value = q, best = y;
      }
      if (vec::equal(best, from)) step *= 0.5;
    }
    const Vec3 from = x(n);
    for (const double share : {1.0, 0.5, 0.25}) {  // what folds or crosses may do so no longer half-way
      Vec3 y = best;
      for (int a = 0; a < 3; ++a)
        if (y[a] != from[a]) y[a] = from[a] + share * (best[a] - from[a]);
      if (!(worst_at(n, y) > before * 1.02 + 1e-6)) return false;
      if (on_interface && !surface_.move(n, y)) continue;
      points_[m] = y;
      return true;
    }
    return false;
  }

  static constexpr std::array<int, 3> thirds{1, 3, 9};
  const Interfaces& s_;
  EditableInterfaces surface_;
  double edge_;
  std::vector<Vec3>& points_;
  const Connectivity<4>& cells_;
  mesh::Rows around_;
};

}  // namespace tunica::meshing
