// SPDX-License-Identifier: MIT
// Edges of the surface that the tetrahedra lack are brought in: by flips along the segment, and
// where these end by Steiner points where it meets a face or an edge, which always succeeds.
#pragma once

#include "tunica/core/vec.hpp"
#include "tunica/mesh/triangle.hpp"
#include "tunica/meshing/cavity_flips.hpp"
#include "tunica/meshing/cavity_insert.hpp"
#include "tunica/meshing/front_surface.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <vector>

namespace tunica::meshing {

/// A part of the surface that could not be recovered: another arrangement of points is tried.
struct RecoveryFailure {
  Vec3 place;
  const char* what;
};

class FrontEdges {
 public:
  FrontEdges(TetComplex& complex, FrontSurface& surface)
      : c_(complex), s_(surface), flips_(complex), insert_(complex, surface) {}

  Index steiner = 0;  // points put on edges

  /// Brings in the edge; with_points: Steiner points may be used. False: it is still missing.
  enum class Means { flips, points };
  bool recover(Index edge, Means means) {
    deep_left_ = means == Means::flips ? most_deep : 0;
    const auto [a, b, triangles] = s_.edges[at(edge)];
    if (s_.chained(edge)) return true;
    for (int turn = 0; turn < 2; ++turn)
      if (turn == 0 ? flip_along(a, b) : flip_along(b, a)) return true;
    if (means == Means::flips) return false;
    if (help(a, b)) return true;
    Index u = a;
    std::vector<Index> goals{b};  // nodes of the chain ahead, the nearest last
    for (int step = 0; step < longest_chain; ++step) {
      const Index goal = goals.back();
      if (flip_along(u, goal)) {
        if (u != a || goal != b) s_.lock_piece(u, goal);
        if (goal == b) return true;
        s_.chain(edge).push_back(goal);
        goals.pop_back();
        u = goal;
        continue;
      }
      const Hit hit = first_hit(u, goal);
      if (hit.kind == Hit::at_node || hit.kind == Hit::nothing)
        throw RecoveryFailure{c_.point(u), "an edge runs into a node"};
      Index p = split_well(u, goal, hit);
      const bool inserted = p < 0 && (p = insert_between(u, goal, hit)) >= 0;
      if (p < 0) p = split(u, goal, hit);
      if (p < 0) throw RecoveryFailure{c_.point(u), "an edge cannot be split off"};
      if (!inserted) {
        s_.chain(edge).push_back(p);
        s_.lock_piece(u, p);
        u = p;
      } else {
        goals.push_back(p);
      }
      s_.own(p, {edge, -1});
      ++steiner;
    }
    throw RecoveryFailure{c_.point(a), "an edge needs too many points"};
  }

  /// Steiner points that the tetrahedra have made superfluous: where an edge skips one, it is let go.
  void shorten_chains() {
    for (std::size_t e = 0; e < s_.edges.size(); ++e) {
      if (!s_.chained(static_cast<Index>(e))) continue;
      auto& inner = s_.chain(static_cast<Index>(e));
      const auto& edge = s_.edges[e];
      const auto node = [&](std::size_t i) {
        return i == 0 ? edge.a : i == inner.size() + 1 ? edge.b : inner[i - 1];
      };
      for (std::size_t span = inner.size() + 1; span >= 2; --span)  // the longest skip first
        for (std::size_t i = 0; i + span <= inner.size() + 1; ++i) {
          if (c_.tet_with(node(i), node(i + span), star_) < 0) continue;
          for (std::size_t k = i; k < i + span; ++k) s_.unlock_piece(node(k), node(k + 1));
          s_.lock_piece(node(i), node(i + span));
          for (std::size_t k = i + 1; k < i + span; ++k) s_.disown(node(k)), --steiner;
          inner.erase(inner.begin() + static_cast<std::ptrdiff_t>(i),
                      inner.begin() + static_cast<std::ptrdiff_t>(i + span - 1));
          span = std::min(span, inner.size() + 1);
        }
    }
  }

 private:
  static constexpr int longest_chain = 60, most_flips = 25, most_deep = 3;
  static constexpr int most_helpers = 12;
  // Six directions, none in a plane that structured surfaces are likely to have.
  static constexpr std::array<std::array<double, 2>, 6> sixths{
      {{0.342, 0.940}, {-0.342, -0.940}, {0.985, 0.174}, {-0.985, -0.174}, {0.643, -0.766}, {-0.643, 0.766}}};
  static constexpr double flat = 1e-6;  // sine of a dihedral angle that rounding may turn over

  struct Hit {
    enum Kind { nothing, at_node, at_edge, at_face } kind = nothing;
    Index tet = -1;
    int face_index = -1;
    Index node = -1;       // kind node
    Index x = -1, y = -1;  // kind edge
  };

  template <class I>
  [[nodiscard]] static std::size_t at(I i) {
    return static_cast<std::size_t>(i);
  }

  /// Where the segment from u to b leaves the star of u.
  [[nodiscard]] Hit first_hit(Index u, Index b) {
    c_.star(u, star_);
    for (const Index t : star_)
      if (c_.has(t, b)) return {Hit::at_node, t, -1, b, -1, -1};
    for (const Index t : star_) {
      const int f = c_.local(t, u);
      const Triple n = c_.face(t, f);  // it turns about the axis from u outward
      std::array<int, 3> side{};
      int zeros = 0, negative = 0;
      for (std::size_t k = 0; k < 3 && negative == 0; ++k) {
        const double v = c_.orient(u, b, n[k], n[(k + 1) % 3]);
        side[k] = (v > 0) - (v < 0);
        zeros += side[k] == 0, negative += side[k] < 0;
      }
      if (negative > 0) continue;
      if (zeros == 0) return {Hit::at_face, t, f, -1, -1, -1};
      for (std::size_t k = 0; k < 3; ++k) {
        if (zeros == 1 && side[k] == 0) return {Hit::at_edge, t, f, -1, n[k], n[(k + 1) % 3]};
        if (zeros == 2 && side[k] != 0) return {Hit::at_node, t, f, n[(k + 2) % 3], -1, -1};
      }
    }
    return {};
  }

  /// Flips what the segment meets, as long as that goes. True: the edge (u, b) is there.
  bool flip_along(Index u, Index b) {
    for (int count = 0; count < most_flips; ++count) {
      const Hit hit = first_hit(u, b);
      if (hit.kind == Hit::at_node) return hit.node == b;
      if (hit.kind == Hit::nothing) return false;
      const bool changed = hit.kind == Hit::at_edge ? remove(hit.tet, hit.x, hit.y) : flip_face(hit, u);
      if (!changed) return false;
    }
    return false;
  }

  /// Points beside the segment, off the surface, that make room for flips.
  bool help(Index a, Index b) {
    const Vec3 along = vec::minus(c_.point(b), c_.point(a));
    const Vec3 u = vec::scaled(vec::length(along), vec::orthogonal(along));
    const Vec3 v = vec::cross(vec::unit(along), u);
    int left = most_helpers;
    for (const double distance : {0.31, 0.11, 0.033})
      for (const double at_segment : {0.48, 0.27, 0.71})
        for (const auto& [cosine, sine] : sixths) {
          const Vec3 beside = vec::along(vec::scaled(cosine, u), sine, v);
          const Vec3 x = vec::along(vec::along(c_.point(a), at_segment, along), distance, beside);
          const std::array<Index, 1> seed{containing(c_, x, c_.tet_of[at(a)])};
          if (seed[0] < 0 || insert_.insert(x, seed, 1e-3) < 0) continue;
          deep_left_ = most_deep;
          if (flip_along(a, b) || flip_along(b, a)) return true;
          if (--left == 0) return false;
        }
    return false;
  }

  bool flip_face(const Hit& hit, Index u) {
    const Side s = c_.across(hit.tet, hit.face_index);
    if (s < 0 || c_.mark(hit.tet, hit.face_index) >= 0) return false;
    if (flips_.face_to_edge(hit.tet, hit.face_index)) return true;
    const Triple n = c_.face(hit.tet, hit.face_index);
    const Index w = c_.nodes(s / 4)[at(s % 4)];
    for (std::size_t k = 0; k < 3; ++k)  // a reflex edge stands in the way
      if (!(c_.orient(u, w, n[k], n[(k + 1) % 3]) > 0) && remove(hit.tet, n[k], n[(k + 1) % 3])) return true;
    return false;
  }

  bool remove(Index t, Index x, Index y) {
    if (s_.locked(x, y)) return false;
    if (!c_.alive(t) || !c_.has(t, x) || !c_.has(t, y)) t = c_.tet_with(x, y, star_);  // changed since
    if (t < 0) return true;
    const auto any = [](Index, Index) { return true; };
    if (flips_.remove_edge(t, x, y, 0, any)) return true;
    if (deep_left_-- <= 0) return false;
    return flips_.remove_edge_deep(t, x, y, any, [&](Index p, Index q) { return s_.locked(p, q); });
  }

  /// The point where the segment meets a face, if no nearly flat tetrahedra come of it.
  Index split_well(Index u, Index b, const Hit& hit) {
    if (hit.kind != Hit::at_face || c_.mark(hit.tet, hit.face_index) >= 0) return -1;
    const Triple n = c_.face(hit.tet, hit.face_index);
    const double du = std::abs(c_.orient(n[0], n[1], n[2], u)), db = std::abs(c_.orient(n[0], n[1], n[2], b));
    const Vec3 segment = vec::minus(c_.point(b), c_.point(u));
    const Index p = c_.add_point(vec::along(c_.point(u), du / (du + db), segment));
    if (flips_.split_face(hit.tet, hit.face_index, p, flat)) return p;
    drop_last_point();
    return -1;
  }

  /// A new point where the segment meets a face or an edge, -1: a part of the surface is there.
  Index split(Index u, Index b, const Hit& hit) {
    const Triple n = c_.face(hit.tet, hit.face_index);
    if (hit.kind == Hit::at_edge) return split_edge(u, b, hit.tet, hit.x, hit.y);
    if (c_.mark(hit.tet, hit.face_index) >= 0) return -1;
    // The weights of the meeting point in the face are as the signs of the three sides.
    Vec3 w;
    for (std::size_t k = 0; k < 3; ++k)
      w[static_cast<Eigen::Index>((k + 2) % 3)] = std::abs(c_.orient(u, b, n[k], n[(k + 1) % 3]));
    w = vec::divided(w, w[0] + w[1] + w[2]);
    const Side beyond = c_.across(hit.tet, hit.face_index);
    const Vec3 far = c_.point(c_.nodes(beyond / 4)[at(beyond % 4)]), near = c_.point(u);
    for (const double margin : {0.0, 1e-12, 1e-9, 1e-6, 1e-4, 1e-2}) {
      const Vec3 held(std::max(w[0], margin), std::max(w[1], margin), std::max(w[2], margin));
      const Vec3 v = vec::divided(held, held[0] + held[1] + held[2]);
      const Vec3 x = mesh::Triangle{c_.point(n[0]), c_.point(n[1]), c_.point(n[2])}.at(v);
      for (const double shift : {0.0, margin, -margin}) {  // a flat tetrahedron is left on its open side
        const Index p = c_.add_point(vec::along(x, std::abs(shift), vec::minus(shift > 0 ? far : near, x)));
        if (flips_.split_face(hit.tet, hit.face_index, p)) return p;
        drop_last_point();
      }
      if (margin > 1e-7) continue;
      if (const Index p = split_near_edge(u, b, hit.tet, n, w); p >= 0) return p;
    }
    return -1;
  }

  /// The meeting point is on an edge of the face to within rounding: that edge is split.
  Index split_near_edge(Index u, Index b, Index t, const Triple& n, const Vec3& w) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (w[static_cast<Eigen::Index>((k + 2) % 3)] > 1e-7) continue;
      const Index q = split_edge(u, b, t, n[k], n[(k + 1) % 3]);
      if (q >= 0) return q;
    }
    return -1;
  }

  Index split_edge(Index u, Index b, Index t, Index x, Index y) {
    if (s_.locked(x, y)) return -1;
    // The point of (x, y) nearest to the line through u and b.
    using vec::dot, vec::minus;
    const Vec3 d = minus(c_.point(b), c_.point(u)), e = minus(c_.point(y), c_.point(x));
    const Vec3 r = minus(c_.point(x), c_.point(u));
    const double dd = dot(d, d), de = dot(d, e), ee = dot(e, e), nn = dd * ee - de * de;
    const double s = nn > 0 ? (de * dot(d, r) - dd * dot(e, r)) / nn : 0.5;
    for (const double margin : {1e-12, 1e-6, 1e-3, 0.1}) {
      const double at_edge = std::clamp(s, margin, 1 - margin);
      if (std::abs(at_edge - s) > 0.01) continue;
      const Index p = c_.add_point(vec::along(c_.point(x), at_edge, e));
      if (flips_.split_edge(t, x, y, p)) return p;
      drop_last_point();
    }
    return -1;
  }

  /// A point of the segment well inside a cavity, where flat tetrahedra leave no room for a split.
  Index insert_between(Index u, Index goal, const Hit& hit) {
    for (const double floor : {1e-3, 1e-6, 1e-10})
      for (const double at_segment : {0.5, 0.3, 0.7, 0.1, 0.9, 0.02, 0.98}) {
        const Vec3 x = vec::along(c_.point(u), at_segment, vec::minus(c_.point(goal), c_.point(u)));
        const std::array<Index, 1> seed{containing(c_, x, hit.tet)};
        if (seed[0] < 0) continue;
        if (const Index p = insert_.insert(x, seed, floor); p >= 0) return p;
      }
    return -1;
  }

  void drop_last_point() { c_.points.pop_back(), c_.tet_of.pop_back(); }

  TetComplex& c_;
  FrontSurface& s_;
  CavityFlips flips_;
  CavityInsert insert_;
  int deep_left_ = 0;  // how often flips may remove other edges to remove one
  std::vector<Index> star_;
};

}  // namespace tunica::meshing
