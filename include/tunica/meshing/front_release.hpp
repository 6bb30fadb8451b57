// SPDX-License-Identifier: MIT
// Steiner points leave the surface: each is drawn into a neighbour on it, or moved inward, where the
// hole that opens is closed by a fan over the triangulation without it: a short move always works.
#pragma once

#include "tunica/core/vec.hpp"
#include "tunica/meshing/cavity_polygon.hpp"
#include "tunica/meshing/front_edges.hpp"
#include "tunica/meshing/front_surface.hpp"
#include "tunica/meshing/improve.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace tunica::meshing {

/// Works on the inside alone: the border of the complex is the surface in pieces.
class FrontRelease {
 public:
  FrontRelease(TetComplex& complex, FrontSurface& surface) : c_(complex), s_(surface) {}

  /// Takes all Steiner points off, those on faces first; one that cannot leave waits for its
  /// neighbours. RecoveryFailure when none of the rest can.
  void run() {
    std::vector<Index> waiting = on_border();
    // Nearly flat tetrahedra pin a point to where it is: flips take them away, and where these do not help,
    // points that have left move on, or others come between.
    if (!waiting.empty()) Improve::flip(c_, pinning[0]);
    std::size_t level = 0;
    for (std::size_t stuck = 0; !waiting.empty();) {
      const std::size_t before = waiting.size();
      level_ = levels[level];
      std::erase_if(waiting, [&](Index node) { return release(node); });
      if (waiting.empty()) return;
      if (waiting.size() < before) {
        Improve::flip(c_, pinning[0]);
        level = 0;
      } else if (level + 1 < levels.size()) {
        ++level;
      } else if (stuck < pinning.size()) {
        Improve::loosen(c_, held(waiting), pinning[stuck++]);
        level = 0;
      } else {
        throw RecoveryFailure{c_.point(waiting[0]), "a point cannot leave the surface"};
      }
    }
  }

 private:
  static constexpr int most_corners = 200;
  struct Level {
    double floor;  // sine of the flattest dihedral angle that a move may leave: those that left by a hair
    int halvings;  // would pin their neighbours on the surface
  };
  static constexpr std::array<Level, 4> levels{{{1e-4, 12}, {1e-7, 22}, {1e-10, 32}, {0, 45}}};
  static constexpr std::array<double, 3> pinning{1e-3, 1e-2, 1e-1};  // sine of a dihedral angle

  template <class I>
  [[nodiscard]] static std::size_t at(I i) {
    return static_cast<std::size_t>(i);
  }

  /// A loop of nodes around the point on one triangle of the surface; it turns as the surface does.
  struct Loop {
    Index face;
    std::vector<Index> nodes;
  };

  /// On a triangle of the surface from a neighbour of the point to the next one around it.
  struct Step {
    Index face, from, to;
  };

  /// Points that are no nodes of the surface but on it, those on its edges last.
  [[nodiscard]] std::vector<Index> on_border() const {
    std::vector<char> met(c_.points.size(), 0);
    for (Index t = 0; t < c_.size(); ++t)
      for (int f = 0; c_.alive(t) && f < 4; ++f)
        if (c_.across(t, f) < 0)
          for (const Index n : c_.face(t, f)) met[at(n)] = 1;
    std::vector<Index> nodes;
    for (const bool of_edges : {false, true})
      for (Index n = s_.nodes; n < static_cast<Index>(met.size()); ++n)
        if (met[at(n)] != 0 && (s_.owner(n).edge >= 0) == of_edges) nodes.push_back(n);
    return nodes;
  }

  /// Nodes of the surface and those that wait.
  [[nodiscard]] std::vector<char> held(const std::vector<Index>& waiting) const {
    std::vector<char> flags(c_.points.size(), 0);
    std::fill_n(flags.begin(), s_.nodes, char{1});
    for (const Index n : waiting) flags[at(n)] = 1;
    return flags;
  }

  bool release(Index node) {
    constexpr double good = 0.05, any = 0;
    const Vec3 origin = c_.point(node);
    find_loops(node, origin);
    if (loops_.empty()) throw RecoveryFailure{origin, "a point has lost the surface"};
    return contract(node, good) || move(node, origin) || contract(node, std::max(any, level_.floor));
  }

  /// Draws the point into a neighbour on the surface, on its edge if it has one.
  bool contract(Index node, double floor) {
    std::vector<Index> ends = loops_[0].nodes;
    if (loops_.size() > 1) ends = {loops_[0].nodes.front(), loops_[0].nodes.back()};
    double best = floor;
    Index end = -1;
    for (const Index w : ends) {
      double least = 2;
      for (const Index t : star_) {
        if (c_.has(t, w)) continue;
        const Triple f = c_.face(t, c_.local(t, node));
        least = std::min(least, sine_quality(c_.point(f[0]), c_.point(f[2]), c_.point(f[1]), c_.point(w)));
        if (least <= best) break;
      }
      if (least > best && least <= 1) best = least, end = w;
    }
    if (end < 0) return false;
    fresh_.clear();
    for (const Index t : star_) {
      if (c_.has(t, end)) continue;
      const Triple f = c_.face(t, c_.local(t, node));
      fresh_.push_back({f[0], f[2], f[1], end});
    }
    c_.replace(star_, fresh_, open_);
    c_.tet_of[at(node)] = -1;
    for (const Side s : open_)
      for (const Loop& loop : loops_) {
        const Triple f = c_.face(s / 4, s % 4);
        const auto in_loop = [&](Index n) {
          return std::find(loop.nodes.begin(), loop.nodes.end(), n) != loop.nodes.end();
        };
        if (in_loop(f[0]) && in_loop(f[1]) && in_loop(f[2])) c_.set_mark(s, 2 * loop.face);
      }
    return true;
  }

  /// Moves the point inward, as far as the fans over its loops allow.
  bool move(Index node, const Vec3& origin) {
    std::vector<Vec3> ways;
    Vec3 inward(0, 0, 0), middle(0, 0, 0);
    double reach = 0;
    for (const Loop& loop : loops_) inward = vec::minus(inward, normal(loop.face));
    int count = 0;
    for (const Index t : star_)
      for (const Index n : c_.nodes(t)) {
        if (n == node) continue;
        const Vec3 arm = vec::minus(c_.point(n), origin);
        middle = vec::plus(middle, arm), ++count;
        reach = std::max(reach, vec::length(arm));
      }
    middle = vec::divided(middle, count);
    if (const double size = vec::length(inward); size > 0) inward = vec::scaled(0.5 * reach / size, inward);
    ways = {middle, vec::scaled(0.5, vec::plus(middle, inward)), inward};
    for (const Index t : star_) {  // towards the tetrahedra themselves, for narrow wedges
      Vec3 m(0, 0, 0);
      for (const Index n : c_.nodes(t)) m = vec::along(m, 0.25, vec::minus(c_.point(n), origin));
      if (ways.size() < 40) ways.push_back(m);
    }
    double step = 1;
    for (int i = 0; i < level_.halvings; ++i, step *= 0.5) {
      for (const Vec3& way : ways)
        if (close(node, vec::along(origin, step, way))) return true;
    }
    c_.points[at(node)] = origin;
    return false;
  }

  [[nodiscard]] Vec3 normal(Index f) const {
    const Triple& t = s_.triangles[at(f)];
    const Vec3& a = c_.point(t[0]);
    return vec::unit(vec::cross(vec::minus(c_.point(t[1]), a), vec::minus(c_.point(t[2]), a)));
  }

  /// The border faces at the node, chained: one loop for a point on a face, two paths for one on an
  /// edge, which the edge closes.
  void find_loops(Index node, const Vec3& place) {
    c_.star(node, star_);
    steps_.clear();
    for (const Index t : star_)
      for (int f = 0; f < 4; ++f) {
        if (c_.across(t, f) >= 0 || c_.nodes(t)[at(f)] == node) continue;
        const Triple n = c_.face(t, f);
        std::size_t i = 0;
        while (n[i] != node) ++i;
        enter({c_.mark(t, f) / 2, n[(i + 1) % 3], n[(i + 2) % 3]});
      }
    loops_.clear();
    for (std::size_t first = 0, last = 0; first < steps_.size(); first = last) {
      while (last < steps_.size() && steps_[last].face == steps_[first].face) ++last;
      const auto step_with = [&](Index Step::*end, Index node_there) {
        for (std::size_t s = first; s < last; ++s)
          if (steps_[s].*end == node_there) return s;
        return last;
      };
      Index start = steps_[first].from;
      for (std::size_t s = first; s < last; ++s)  // the start of a path is nobody's end
        if (step_with(&Step::to, steps_[s].from) == last) start = steps_[s].from;
      Loop loop{steps_[first].face, {start}};
      Index n = start;
      std::size_t used = 0;
      for (; used < last - first; ++used) {
        const std::size_t s = step_with(&Step::from, n);
        if (s == last) break;
        n = steps_[s].to;
        if (n != start) loop.nodes.push_back(n);
      }
      // Two nodes: on this triangle the point stands in a sliver beside its edge, which just closes.
      const bool whole = loop.nodes.size() > (last - first == steps_.size() ? 2 : 1);
      if (used != last - first || !whole || loop.nodes.size() > most_corners)
        throw RecoveryFailure{place, "the surface around a point is not a disc"};
      loops_.push_back(std::move(loop));
    }
  }

  /// Steps lie by triangle and by the node that they leave, which has one on each.
  void enter(const Step& step) {
    std::size_t i = steps_.size();
    const auto after = [&](const Step& s) {
      return s.face != step.face ? s.face > step.face : s.from > step.from;
    };
    while (i > 0 && after(steps_[i - 1])) --i;
    if (i > 0 && steps_[i - 1].face == step.face && steps_[i - 1].from == step.from)
      steps_[i - 1] = step;
    else
      steps_.insert(steps_.begin() + static_cast<std::ptrdiff_t>(i), step);
  }

  /// Tries the new place: the star and the fans over the loops must have positive volumes.
  bool close(Index node, const Vec3& x) {
    const Vec3 before = c_.point(node);
    c_.points[at(node)] = x;
    fresh_.clear();
    bool valid = true;
    for (const Index t : star_) {
      const Quad& n = c_.nodes(t);
      valid = valid &&
              sine_quality(c_.point(n[0]), c_.point(n[1]), c_.point(n[2]), c_.point(n[3])) > level_.floor;
      fresh_.push_back(n);
      if (!valid) break;
    }
    faces_.clear();
    for (std::size_t l = 0; valid && l < loops_.size(); ++l) {
      const Loop& loop = loops_[l];
      if (loop.nodes.size() == 2) continue;
      const auto quality = [&](int i, int k, int j) {
        return sine_quality(x, c_.point(loop.nodes[at(i)]), c_.point(loop.nodes[at(k)]),
                            c_.point(loop.nodes[at(j)]));
      };
      valid = polygon_.triangulate(static_cast<int>(loop.nodes.size()), level_.floor, quality) > 0;
      for (const auto& [i, k, j] : polygon_.triangles) {
        const Triple tri{loop.nodes[at(i)], loop.nodes[at(k)], loop.nodes[at(j)]};
        fresh_.push_back({node, tri[0], tri[1], tri[2]});
        faces_.push_back({tri, loop.face});
      }
    }
    if (!valid) {
      c_.points[at(node)] = before;
      return false;
    }
    c_.replace(star_, fresh_, open_);
    for (const Side s : open_)
      for (const auto& [tri, face] : faces_) {
        const Quad& n = c_.nodes(s / 4);
        if (n[at(s % 4)] == node && c_.has(s / 4, tri[0]) && c_.has(s / 4, tri[1]) && c_.has(s / 4, tri[2]))
          c_.set_mark(s, 2 * face);
      }
    return true;
  }

  struct NewFace {
    Triple nodes;
    Index mark;
  };
  TetComplex& c_;
  FrontSurface& s_;
  CavityPolygon polygon_;
  Level level_ = levels[0];
  std::vector<Index> star_;
  std::vector<Loop> loops_;
  std::vector<Step> steps_;
  std::vector<Quad> fresh_;
  std::vector<NewFace> faces_;
  std::vector<Side> open_;
};

}  // namespace tunica::meshing
