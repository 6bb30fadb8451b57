// SPDX-License-Identifier: MIT
// Faces of the surface that the tetrahedra lack, once all edges are there: the edges that pierce
// them are removed by flips, each of which lowers their number; what is left is filled by a front in
// the triangle that splits them where they pierce it.
#pragma once

#include "tunica/core/vec.hpp"
#include "tunica/meshing/cavity_flips.hpp"
#include "tunica/meshing/cavity_insert.hpp"
#include "tunica/meshing/front_edges.hpp"
#include "tunica/meshing/front_surface.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <utility>
#include <vector>

namespace tunica::meshing {

class FrontFaces {
 public:
  /// Which piece of a split triangle comes next: the one that exact signs tell, or a node that is known
  /// to lie on the triangle. Few Steiner points among coplanar triangles need the latter, many the former.
  enum class Trust { signs, places };
  FrontFaces(TetComplex& complex, FrontSurface& surface, Trust trust)
      : c_(complex), s_(surface), trust_(trust), flips_(complex), insert_(complex, surface) {}

  Index steiner = 0;  // points put on faces

  /// Brings in triangle f and marks its faces. False: it is still missing.
  bool recover(Index f, FrontEdges::Means means) {
    if (!s_.split(f)) {
      if (mark_whole(f)) return true;
      while (remove_piercing_edge(f))
        if (mark_whole(f)) return true;
    }
    if (means == FrontEdges::Means::flips) return false;
    advance(f);
    return true;
  }

 private:
  static constexpr int most_steps = 20000;
  static constexpr double flat = 1e-6;  // sine of a dihedral angle that rounding may turn over
  // Directed edges (p, q) as p << 32 | q, ascending.
  using Front = std::vector<std::uint64_t>;
  static constexpr std::uint64_t low = 0xFFFFFFFFU;

  struct Piercing {
    Index tet = -1, u = -1, v = -1;  // u above the triangle, v below
  };

  template <class I>
  [[nodiscard]] static std::size_t at(I i) {
    return static_cast<std::size_t>(i);
  }

  [[nodiscard]] static std::uint64_t directed(Index p, Index q) {
    return static_cast<std::uint64_t>(p) << 32U | static_cast<std::uint64_t>(q);
  }
  static void put(Front& front, Index p, Index q) {
    const std::uint64_t e = directed(p, q);
    const auto place = std::lower_bound(front.begin(), front.end(), e);
    if (place == front.end() || *place != e) front.insert(place, e);
  }
  /// False: it is not there.
  [[nodiscard]] static bool take(Front& front, Index p, Index q) {
    const std::uint64_t e = directed(p, q);
    const auto place = std::lower_bound(front.begin(), front.end(), e);
    if (place == front.end() || *place != e) return false;
    front.erase(place);
    return true;
  }

  [[nodiscard]] int side(Index node, Index f) const {
    if (s_.on(node, f)) return 0;
    const Triple& t = s_.triangles[at(f)];
    const double v = c_.orient(t[0], t[1], t[2], node);
    return (v > 0) - (v < 0);
  }

  /// Does the edge from u above to v below pass through the inner part of the triangle?
  [[nodiscard]] bool pierces(Index u, Index v, Index f) const {
    const Triple& t = s_.triangles[at(f)];
    int positive = 0, negative = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double o = c_.orient(u, v, t[k], t[(k + 1) % 3]);
      positive += o > 0, negative += o < 0;
    }
    return positive == 3 || negative == 3;
  }

  /// Removes one edge that pierces f without making another, if flips can.
  bool remove_piercing_edge(Index f) {
    find_piercing(f);
    const auto allowed = [&](Index x, Index y) {
      if (const Index e = s_.edge_between(x, y); e >= 0 && s_.chained(e)) return false;
      const int sx = side(x, f), sy = side(y, f);
      return sx * sy >= 0 || !(sx > 0 ? pierces(x, y, f) : pierces(y, x, f));
    };
    return std::any_of(found_.begin(), found_.end(),
                       [&](const Piercing& e) {
                         return !s_.locked(e.u, e.v) && flips_.remove_edge(e.tet, e.u, e.v, 0, allowed);
                       }) ||
           std::any_of(found_.begin(), found_.end(), [&](const Piercing& e) {
             const Index t = c_.tet_with(e.u, e.v, star_);  // the search before may have changed its number
             return t >= 0 && flips_.remove_edge_deep(t, e.u, e.v, allowed,
                                                      [&](Index x, Index y) { return s_.locked(x, y); });
           });
  }

  /// The piercing edges of the tetrahedra at the corners of f.
  void find_piercing(Index f) {
    found_.clear();
    for (const Index n : s_.triangles[at(f)]) {
      c_.star(n, star_);
      for (const Index t : star_)
        for (const auto& [i, j] : mesh::Tet4::edges) {
          Index u = c_.nodes(t)[at(i)], v = c_.nodes(t)[at(j)];
          const int su = side(u, f), sv = side(v, f);
          if (su * sv >= 0) continue;
          if (su < 0) std::swap(u, v);
          const bool known = std::any_of(found_.begin(), found_.end(),
                                         [&](const Piercing& p) { return p.u == u && p.v == v; });
          if (!known && pierces(u, v, f)) found_.push_back({t, u, v});
        }
    }
  }

  bool mark_whole(Index f) {
    const Triple& t = s_.triangles[at(f)];
    return mark(t, f);
  }

  bool mark(const Triple& t, Index f) {
    c_.star(t[0], star_);
    for (const Index tet : star_) {
      if (!c_.has(tet, t[1]) || !c_.has(tet, t[2])) continue;
      const Quad& n = c_.nodes(tet);
      int i = 0;
      while (n[at(i)] == t[0] || n[at(i)] == t[1] || n[at(i)] == t[2]) ++i;
      c_.mark_both(4 * tet + i, t, f);
      return true;
    }
    return false;
  }

  /// A front within the triangle: from each of its directed edges (the rest of the triangle on the
  /// left) the next piece is found among the tetrahedra around that edge, splitting what pierces
  /// the triangle there. Only signs and neighbours decide, so rounded Steiner points do no harm.
  void advance(Index f) {
    const Triple& t = s_.triangles[at(f)];
    Front front;
    for (std::size_t i = 0; i < 3; ++i) {
      const Index e = s_.triangle_edges[at(f)][i];
      std::vector<Index> path{t[i]};
      if (s_.chained(e)) {
        path.insert(path.end(), s_.chain(e).begin(), s_.chain(e).end());
        if (s_.edges[at(e)].a != t[i]) std::reverse(path.begin() + 1, path.end());
      }
      path.push_back(t[(i + 1) % 3]);
      for (std::size_t k = 0; k + 1 < path.size(); ++k) put(front, path[k], path[k + 1]);
    }
    for (int step = 0; !front.empty(); ++step) {
      const auto p = static_cast<Index>(front[0] >> 32U), q = static_cast<Index>(front[0] & low);
      if (step > most_steps) throw RecoveryFailure{c_.point(p), "a face needs too many pieces"};
      const Index w = next_node(f, p, q);
      if (!mark({p, q, w}, f)) throw RecoveryFailure{c_.point(p), "a piece of a face is lost"};
      s_.lock_piece(q, w), s_.lock_piece(w, p);  // no later split or cavity may take them
      (void)take(front, p, q);
      if (!take(front, q, w)) put(front, w, q);
      if (!take(front, w, p)) put(front, p, w);
    }
  }

  /// The node that completes the piece on the left of (p, q); made if nothing is there yet.
  Index next_node(Index f, Index p, Index q) {
    const Index t = c_.tet_with(p, q, star_);
    if (t < 0) throw RecoveryFailure{c_.point(p), "an edge of a face is lost"};
    c_.ring(t, p, q, flips_.ring);
    const auto& link = flips_.ring.link;
    const std::size_t m = link.size();
    const Triple& tri = s_.triangles[at(f)];
    using vec::dot, vec::minus;
    const Vec3 origin = c_.point(p), corner = c_.point(tri[0]);
    const Vec3 normal = vec::cross(minus(c_.point(tri[1]), corner), minus(c_.point(tri[2]), corner));
    const Vec3 up = vec::unit(normal), left = vec::unit(vec::cross(normal, minus(c_.point(q), origin)));
    const auto turn = [&](Index n) {
      const Vec3 x = minus(c_.point(n), origin);
      return std::atan2(dot(up, x), dot(left, x));
    };
    const auto nearest_on = [&](double within) {
      Index nearest = -1;
      for (std::size_t i = 0; i < m; ++i) {
        const Vec3 x = minus(c_.point(link[i]), origin);
        if (!s_.on(link[i], f) || !(dot(left, x) > 1e-6 * vec::length(x)))
          continue;  // none in line with p and q
        if (std::abs(turn(link[i])) < within) within = std::abs(turn(link[i])), nearest = link[i];
      }
      return nearest;
    };
    if (trust_ == Trust::places)
      if (const Index w = nearest_on(1e-11); w >= 0) return w;
    std::vector<int> sign(m);
    for (std::size_t i = 0; i < m; ++i) sign[i] = side(link[i], f);
    // Around (p, q) the left half of the plane is met from below to above.
    for (std::size_t i = 0; i < m; ++i) {
      if (sign[i] >= 0) continue;
      std::size_t gap = 0;
      while (gap < m && sign[(i + 1 + gap) % m] == 0) ++gap;
      if (sign[(i + 1 + gap) % m] < 0) continue;
      for (std::size_t k = 0; k < gap; ++k)
        if (const Index w = link[(i + 1 + k) % m]; dot(left, minus(c_.point(w), origin)) > 0) return w;
      const Index u = link[i], v = link[(i + 1) % m];
      if (gap == 0 && dot(left, minus(meeting(f, u, v, 0), origin)) > 0)
        return split(f, flips_.ring.tets[i], u, v);
    }
    // Rounded Steiner points have spoilt the signs: the directions decide.
    if (const Index w = nearest_on(0.5); w >= 0) return w;
    for (std::size_t i = 0; i < m; ++i) {
      const Index u = link[i], v = link[(i + 1) % m];
      if (turn(u) < 0 && turn(v) >= 0 && turn(v) - turn(u) < std::numbers::pi)
        return split(f, flips_.ring.tets[i], u, v);
    }
    throw RecoveryFailure{c_.point(p), "a face has no inside at an edge"};
  }

  /// Where the edge (u, v) meets the plane of f, at least `margin` of it from both ends.
  [[nodiscard]] Vec3 meeting(Index f, Index u, Index v, double margin) const {
    const Triple& t = s_.triangles[at(f)];
    const double du = std::abs(c_.orient(t[0], t[1], t[2], u)), dv = std::abs(c_.orient(t[0], t[1], t[2], v));
    const double s = std::clamp(du / (du + dv), margin, 1 - margin);
    return vec::along(c_.point(u), s, vec::minus(c_.point(v), c_.point(u)));
  }

  Index split(Index f, Index tet, Index u, Index v) {
    if (s_.locked(u, v)) throw RecoveryFailure{c_.point(u), "an edge of the surface pierces a face"};
    const auto made = [&](Index p) {
      s_.own(p, {-1, f});
      ++steiner;
      return p;
    };
    const auto try_split = [&](double margin, double floor) {
      const Index p = c_.add_point(meeting(f, u, v, margin));
      if (flips_.split_edge(tet, u, v, p, floor)) return p;
      c_.points.pop_back(), c_.tet_of.pop_back();
      return Index{-1};
    };
    if (const Index p = try_split(0, flat); p >= 0) return made(p);
    const std::vector<Index> seed = flips_.ring.tets;
    for (const double floor : {1e-3, 1e-6, 1e-10})
      if (const Index p = insert_.insert(meeting(f, u, v, 0), seed, floor); p >= 0) return made(p);
    for (const double margin : {0.0, 1e-12, 1e-9, 1e-6, 1e-3, 0.1, 0.5})
      if (const Index p = try_split(margin, 0); p >= 0) return made(p);
    throw RecoveryFailure{c_.point(u), "an edge that pierces a face cannot be split"};
  }

  TetComplex& c_;
  FrontSurface& s_;
  Trust trust_;
  CavityFlips flips_;
  CavityInsert insert_;
  std::vector<Index> star_;
  std::vector<Piercing> found_;
};

}  // namespace tunica::meshing
