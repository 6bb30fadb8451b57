// SPDX-License-Identifier: MIT
// Nodes of a sheet of quadrilaterals that slide on a surface, rims on their curves: plain smoothing, and
// moves that are kept only if they raise the worst corner or the worst distance around a node.
#pragma once

#include "tunica/core/vec.hpp"
#include "tunica/mesh/mesh.hpp"
#include "tunica/meshing/quad_adjacency.hpp"
#include "tunica/meshing/rim_curve.hpp"
#include "tunica/meshing/surface_foot.hpp"
#include "tunica/meshing/wall_quads.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace tunica::meshing {

struct QuadSmoothOptions {
  int sweeps = 12;            // of plain smoothing
  int repairs = 30;           // sweeps over the worst corners at most
  double good_corner = 0.8;   // corners with a scaled Jacobian above this are left alone
  double reach = 0.5;         // how far a node may go from its place in the contour [mean edge lengths]: it
                              // stays on its branch, however small; nodes near a rim are free
  double good_fit = 0.08;     // faces nearer to the surface than this are left alone [mean edge lengths]
  double poor_corner = 0.35;  // around corners below this shape goes before place and fit
  int releases = 5;           // rounds of that, ever wider, at most
  int pins = 3;               // rounds of laying nodes onto points of the surface that are missed, at most
  double missed = 0.2;        // distance of a point that is missed [mean edge lengths]
};

namespace detail {

template <FootSurface S>
class QuadSmoother {
 public:
  QuadSmoother(WallQuads& wall, const S& lumen, const Rims& rims, double reach)
      : wall_(wall),
        lumen_(lumen),
        rims_(rims),
        around_(mesh::cells_of_nodes(wall.cells, static_cast<Index>(wall.nodes.cols()))),
        neighbours_(quad_neighbours(wall.cells, static_cast<Index>(wall.nodes.cols()))),
        fixed_(static_cast<std::size_t>(wall.nodes.cols()), 0),
        normal_(static_cast<std::size_t>(wall.nodes.cols()), Vec3::Zero()) {
    for (const auto& loop : wall.loops)
      for (const Index n : loop) fixed_[static_cast<std::size_t>(n)] = 1;
    for (Index n = 0; n < around_.size(); ++n) {
      const Foot foot = lumen_.nearest(at(n));
      normal_[static_cast<std::size_t>(n)] = foot.normal;
      if (!fixed(n)) vec::set_column(wall_.nodes, n, foot.point);
    }
    home_ = wall.nodes;
    for (Index q = 0; q < static_cast<Index>(wall.cells.cols()); ++q) face_.push_back(face_vector(q));
    idle_.assign(fixed_.size(), 0);
    set_reach(reach);
  }

  /// Each node goes to the mean of its neighbours, and back onto the surface.
  void sweep() {
    for (Index n = 0; n < around_.size(); ++n)
      if (!fixed(n)) place(n, mean(n));
    slide_rims();
  }

  /// Holds a node at a point of the surface from now on.
  void pin(Index n, const Vec3& x) {
    if (fixed(n)) return;
    fixed_[static_cast<std::size_t>(n)] = 1;
    pinned_.push_back(n);
    set(n, x);
    wake(n);
  }
  /// Lets go of those beside corners below `poor`; how many there were.
  std::size_t unpin(double poor) {
    const auto before = pinned_.size();
    std::vector<Index> kept;
    for (const Index n : pinned_) {
      if (worst_corner(n) >= poor) {
        kept.push_back(n);
        continue;
      }
      fixed_[static_cast<std::size_t>(n)] = 0;
      wake(n);
    }
    pinned_ = std::move(kept);
    return before - pinned_.size();
  }
  [[nodiscard]] const std::vector<char>& held() const { return fixed_; }
  [[nodiscard]] double edge() const { return edge_; }
  /// One pass over the nodes whose corners or distances are not good; how many of them moved.
  Index repair(const QuadSmoothOptions& options) {
    const auto score = [&](Index n, double least) {
      const double corner = std::min(worst_corner(n), options.good_corner);
      if (released_ || corner <= least) return corner;
      const double misfit = std::max(0.0, worst_distance(n) / edge_ - options.good_fit);
      return corner - misfit_weight * misfit;
    };
    Index moved = 0;
    for (Index n = 0; n < around_.size(); ++n) {
      if (fixed(n) || (released_ && free_[static_cast<std::size_t>(n)] == 0)) continue;
      if (idle_[static_cast<std::size_t>(n)] != 0) continue;
      idle_[static_cast<std::size_t>(n)] = 1;
      const double before = score(n, -1);
      if (before >= options.good_corner) continue;
      const Vec3 x = at(n), normal = normal_[static_cast<std::size_t>(n)];
      const Vec3 to_mean = vec::minus(mean(n), x);
      double reach = std::numeric_limits<double>::infinity();
      for (const Index m : neighbours_[n]) reach = std::min(reach, vec::distance(at(m), x));
      const Vec3 aside = std::abs(normal[0]) < 0.6 ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
      const Vec3 u = vec::scaled(reach, vec::unit(vec::cross(normal, aside))), v = vec::cross(normal, u);
      const std::array<Vec3, 11> tries{to_mean,
                                       vec::scaled(0.5, to_mean),
                                       vec::scaled(0.25, to_mean),
                                       vec::scaled(0.2, u),
                                       vec::scaled(-0.2, u),
                                       vec::scaled(0.2, v),
                                       vec::scaled(-0.2, v),
                                       vec::scaled(0.05, u),
                                       vec::scaled(-0.05, u),
                                       vec::scaled(0.05, v),
                                       vec::scaled(-0.05, v)};
      double best = before;
      Vec3 best_x = x, best_n = normal;
      for (const Vec3& step : tries) {
        place(n, vec::along(x, 1, step));
        const double quality = score(n, best + 1e-3);
        if (quality > best + 1e-3)
          best = quality, best_x = at(n), best_n = normal_[static_cast<std::size_t>(n)];
      }
      set(n, best_x), normal_[static_cast<std::size_t>(n)] = best_n;
      if (best > before) ++moved, wake(n);
    }
    return moved;
  }

  [[nodiscard]] double worst_corner(Index node) const {
    double worst = 1;
    for (const Index q : around_[node])
      for (int k = 0; k < 4; ++k) worst = std::min(worst, corner(q, k));
    return worst;
  }

  /// Frees the nodes around corners below `poor`, as many rings as asked for, from their places and from
  /// fitting the surface, and smooths them; false when no corner is that poor.
  bool release(double poor, int rings) {
    free_.assign(fixed_.size(), 0);
    for (Index n = 0; n < around_.size(); ++n)
      if (worst_corner(n) < poor) free_[static_cast<std::size_t>(n)] = 1;
    if (std::find(free_.begin(), free_.end(), 1) == free_.end()) return false;
    widen(free_, rings);
    for (std::size_t n = 0; n < free_.size(); ++n)
      if (free_[n] != 0) reach_[n] = std::numeric_limits<double>::infinity();
    released_ = true;
    idle_.assign(fixed_.size(), 0);
    for (int sweep = 0; sweep < 4 * rings; ++sweep)
      for (Index n = 0; n < around_.size(); ++n)
        if (!fixed(n) && free_[static_cast<std::size_t>(n)] != 0) place(n, mean(n));
    return true;
  }

  /// Largest distance from the surface of the middles of the faces at a node and of their edges.
  [[nodiscard]] double worst_distance(Index node) const {
    double worst = 0;
    const auto probe = [&](const Vec3& x) { worst = std::max(worst, lumen_.distance(x)); };
    for (const Index q : around_[node]) {
      const auto x = [&](int k) { return at(wall_.cells(k % 4, q)); };
      probe(vec::between(vec::between(x(0), x(2), 0.5), vec::between(x(1), x(3), 0.5), 0.5));
      for (int k = 0; k < 4; ++k)
        if (wall_.cells(k, q) == node) probe(vec::between(x(k), x(k + 1), 0.5));
    }
    return worst;
  }

 private:
  [[nodiscard]] Vec3 at(Index n) const { return vec::column(wall_.nodes, n); }
  [[nodiscard]] bool fixed(Index n) const { return fixed_[static_cast<std::size_t>(n)] != 0; }

  /// Sum of the area vectors of the faces at a node, normalised.
  [[nodiscard]] Vec3 sheet_normal(Index n) const {
    Vec3 sum = Vec3::Zero();
    for (const Index q : around_[n]) sum = vec::along(sum, 1, face_[static_cast<std::size_t>(q)]);
    return vec::unit(sum);
  }

  /// Sine of the angle at corner k of q about the sheet's normal: 1 square, <= 0 folded. Where one side is
  /// more than twice as long as the other it counts for less.
  [[nodiscard]] double corner(Index q, int k) const {
    const Index n = wall_.cells(k, q);
    const auto x = [&](int c) { return at(wall_.cells(c % 4, q)); };
    const Vec3 u = vec::minus(x(k + 1), x(k)), v = vec::minus(x(k + 3), x(k));
    const double a = vec::length(u), b = vec::length(v), size = a * b;
    const double slender = 2 * std::min(a, b) / std::max(a, b);
    return size > 0 ? vec::dot(vec::cross(u, v), sheet_normal(n)) / size * std::min(1.0, slender) : 0;
  }

  [[nodiscard]] Vec3 mean(Index n) const {
    Vec3 sum = Vec3::Zero();
    for (const Index m : neighbours_[n]) sum += at(m);
    return vec::scaled(1 / static_cast<double>(neighbours_[n].size()), sum);
  }

  /// Marks the neighbours of marked nodes, so many times.
  void widen(std::vector<char>& marked, int rings) const {
    for (int ring = 0; ring < rings; ++ring) {
      const auto before = marked;
      for (Index n = 0; n < neighbours_.size(); ++n)
        for (const Index m : neighbours_[n])
          if (before[static_cast<std::size_t>(m)] != 0) marked[static_cast<std::size_t>(n)] = 1;
    }
  }

  /// Whoever shares a face with a node that moved is looked at again.
  void wake(Index n) {
    for (const Index q : around_[n])
      for (int k = 0; k < 4; ++k)
        for (const Index r : around_[wall_.cells(k, q)])
          for (int j = 0; j < 4; ++j) idle_[static_cast<std::size_t>(wall_.cells(j, r))] = 0;
  }

  void set_reach(double reach) {
    double sum = 0;
    for (Index n = 0; n < neighbours_.size(); ++n)
      for (const Index m : neighbours_[n]) sum += vec::distance(vec::column(home_, n), vec::column(home_, m));
    edge_ = sum / static_cast<double>(std::max<std::size_t>(1, neighbours_.item.size()));
    for (Index n = 0; n < neighbours_.size(); ++n) {
      double longest = 0;
      for (const Index m : neighbours_[n])
        longest = std::max(longest, vec::distance(vec::column(home_, n), vec::column(home_, m)));
      reach_.push_back(reach * std::min(edge_, longest));
    }
    std::vector<char> near = fixed_;
    widen(near, 3);
    for (std::size_t n = 0; n < near.size(); ++n)
      if (near[n] != 0) reach_[n] = std::numeric_limits<double>::infinity();
  }

  [[nodiscard]] Vec3 face_vector(Index q) const {
    const auto x = [&](int k) { return at(wall_.cells(k, q)); };
    return vec::cross(vec::minus(x(2), x(0)), vec::minus(x(3), x(1)));
  }

  /// Every move of a node goes through here: the area vectors of its faces follow.
  void set(Index n, const Vec3& x) {
    vec::set_column(wall_.nodes, n, x);
    for (const Index q : around_[n]) face_[static_cast<std::size_t>(q)] = face_vector(q);
  }

  void place(Index n, Vec3 x) {
    const Vec3 home = vec::column(home_, n), way = vec::minus(x, home);
    const double reach = reach_[static_cast<std::size_t>(n)], far = vec::length(way);
    if (far > reach) x = vec::along(home, reach / far, way);
    const Foot foot = lumen_.nearest_facing(x, normal_[static_cast<std::size_t>(n)]);
    set(n, foot.point);
    normal_[static_cast<std::size_t>(n)] = foot.normal;
  }

  /// Half way between the neighbours on the rim, half below the node inside.
  void slide_rims() {
    for (std::size_t r = 0; r < wall_.loops.size(); ++r) {
      const auto& loop = wall_.loops[r];
      auto& along = wall_.along[r];
      const RimCurve& curve = rims_.curves[r];
      const std::size_t m = loop.size();
      for (std::size_t i = 0; i < m; ++i) {
        const double before = along[(i + m - 1) % m], after = along[(i + 1) % m];
        double target = along[i] + 0.5 * (curve.way(along[i], before) + curve.way(along[i], after));
        int inner = 0;
        Vec3 below = Vec3::Zero();
        for (const Index n : neighbours_[loop[i]])
          if (!fixed(n)) below += at(n), ++inner;
        if (inner > 0) target += 0.5 * curve.way(target, curve.nearest(vec::scaled(1.0 / inner, below)));
        const double lo = curve.way(along[i], before), hi = curve.way(along[i], after);
        along[i] += std::clamp(curve.way(along[i], target), 0.5 * lo, 0.5 * hi);
        set(loop[i], curve.at(along[i]));
        normal_[static_cast<std::size_t>(loop[i])] = lumen_.nearest(at(loop[i])).normal;
      }
    }
  }

  WallQuads& wall_;
  const S& lumen_;
  const Rims& rims_;
  mesh::Rows around_, neighbours_;
  std::vector<char> fixed_, free_, idle_;
  bool released_ = false;
  std::vector<Index> pinned_;
  std::vector<Vec3> normal_, face_;  // of the surface at the nodes; twice the area vectors of the faces
  Points<3> home_;
  std::vector<double> reach_;
  double edge_ = 0;                           // mean length
  static constexpr double misfit_weight = 2;  // a tenth of an edge weighs as a fifth in the sine of a corner
};

}  // namespace detail

}  // namespace tunica::meshing
