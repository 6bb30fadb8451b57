// SPDX-License-Identifier: MIT
// Faces of the surface that the tetrahedra lack, once all edges are there: the edges that pierce
// them are removed by flips, each of which lowers their number, or split where they pierce.
#pragma once

#include "tunica/meshing/cavity_flips.hpp"
#include "tunica/meshing/front_edges.hpp"
#include "tunica/meshing/front_surface.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <utility>
#include <vector>

namespace tunica::meshing {

class FrontFaces {
 public:
  FrontFaces(TetComplex& complex, FrontSurface& surface) : c_(complex), s_(surface), flips_(complex) {}

  Index steiner = 0;  // points put on faces

  /// Brings in triangle f and marks its faces. False: it is still missing.
  bool recover(Index f, FrontEdges::Means means) {
    if (!s_.split(f) && mark_whole(f)) return true;
    if (means == FrontEdges::Means::flips && s_.split(f)) return false;
    for (int step = 0; step < most_steps; ++step) {
      const Piercing e = piercing_edge(f);
      if (e.tet < 0) {
        if (mark_pieces(f)) return true;
        throw RecoveryFailure{c_.point(s_.triangles[at(f)][0]), "the pieces of a face do not fit"};
      }
      if (means == FrontEdges::Means::flips) return false;
      split(f, e);
    }
    throw RecoveryFailure{c_.point(s_.triangles[at(f)][0]), "a face needs too many points"};
  }

 private:
  static constexpr int most_steps = 5000;

  struct Piercing {
    Index tet = -1, u = -1, v = -1;  // u above the triangle, v below
  };

  template <class I>
  [[nodiscard]] static std::size_t at(I i) {
    return static_cast<std::size_t>(i);
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

  /// An edge that pierces f; those that flips can remove are removed first.
  Piercing piercing_edge(Index f) {
    for (;;) {
      find_piercing(f);
      if (found_.empty()) return {};
      bool removed = false;
      for (const Piercing& e : found_) {
        if (s_.locked(e.u, e.v)) continue;
        const auto allowed = [&](Index x, Index y) {
          const int sx = side(x, f), sy = side(y, f);
          return sx * sy >= 0 || !(sx > 0 ? pierces(x, y, f) : pierces(y, x, f));
        };
        removed = flips_.remove_edge(e.tet, e.u, e.v, 0, allowed);
        if (removed) break;  // the numbers of tetrahedra have changed
      }
      if (!removed) return found_.front();
    }
  }

  /// The piercing edges of the tetrahedra at the nodes of f.
  void find_piercing(Index f) {
    found_.clear();
    nodes_of(f);
    for (const Index n : on_) {
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

  /// Corners and Steiner points of f, in a fixed order.
  void nodes_of(Index f) {
    on_.assign(s_.triangles[at(f)].begin(), s_.triangles[at(f)].end());
    for (const Index e : s_.triangle_edges[at(f)])
      if (const auto it = s_.chain.find(e); it != s_.chain.end())
        on_.insert(on_.end(), it->second.begin(), it->second.end());
    if (const auto it = inner_.find(f); it != inner_.end())
      on_.insert(on_.end(), it->second.begin(), it->second.end());
  }

  void split(Index f, const Piercing& e) {
    if (s_.locked(e.u, e.v)) throw RecoveryFailure{c_.point(e.u), "an edge of the surface pierces a face"};
    const Triple& t = s_.triangles[at(f)];
    const double du = std::abs(c_.orient(t[0], t[1], t[2], e.u)),
                 dv = std::abs(c_.orient(t[0], t[1], t[2], e.v));
    for (const double margin : {0.0, 1e-12, 1e-6, 1e-3, 0.1, 0.5}) {
      const double s = std::clamp(du / (du + dv), margin, 1 - margin);
      const Index p = c_.add_point(c_.point(e.u) + s * (c_.point(e.v) - c_.point(e.u)));
      if (flips_.split_edge(e.tet, e.u, e.v, p)) {
        s_.own(p, {-1, f});
        inner_[f].push_back(p);
        ++steiner;
        return;
      }
      c_.points.pop_back(), c_.tet_of.pop_back();
    }
    throw RecoveryFailure{c_.point(e.u), "an edge that pierces a face cannot be split"};
  }

  bool mark_whole(Index f) {
    const Triple& t = s_.triangles[at(f)];
    c_.star(t[0], star_);
    for (const Index tet : star_) {
      if (!c_.has(tet, t[1]) || !c_.has(tet, t[2])) continue;
      const Quad& n = c_.nodes(tet);
      int i = 0;
      while (n[at(i)] == t[0] || n[at(i)] == t[1] || n[at(i)] == t[2]) ++i;
      c_.mark_both(4 * tet + i, f);
      return true;
    }
    return false;
  }

  /// All faces between nodes of f, if they are a disc whose rim is the three edges of f.
  bool mark_pieces(Index f) {
    nodes_of(f);
    std::map<Triple, Side> faces;
    for (const Index n : on_) {
      c_.star(n, star_);
      for (const Index t : star_)
        for (int i = 0; i < 4; ++i) {
          Triple key = c_.face(t, i);
          if (!s_.on(key[0], f) || !s_.on(key[1], f) || !s_.on(key[2], f) || on_one_edge(key, f)) continue;
          std::sort(key.begin(), key.end());
          faces.emplace(key, 4 * t + i);
        }
    }
    std::map<std::pair<Index, Index>, int> uses;
    for (const auto& [key, s] : faces)
      for (const auto& [i, j] : {std::pair{0, 1}, {1, 2}, {0, 2}}) ++uses[{key[at(i)], key[at(j)]}];
    std::size_t rim = 0;
    for (const auto& [e, n] : uses) {
      if (n > 2) return false;
      rim += n == 1;
      if (n == 1 && !s_.locked(e.first, e.second)) return false;
    }
    std::size_t expected = 3;
    for (const Index e : s_.triangle_edges[at(f)])
      if (const auto it = s_.chain.find(e); it != s_.chain.end()) expected += it->second.size();
    if (rim != expected) return false;
    for (const auto& [key, s] : faces) c_.mark_both(s, f);
    return true;
  }

  [[nodiscard]] bool on_one_edge(const Triple& n, Index f) const {
    for (const Index e : s_.triangle_edges[at(f)]) {
      int count = 0;
      for (const Index v : n)
        count += v < s_.nodes ? v == s_.edges[at(e)].a || v == s_.edges[at(e)].b : s_.owner(v).edge == e;
      if (count == 3) return true;
    }
    return false;
  }

  TetComplex& c_;
  FrontSurface& s_;
  CavityFlips flips_;
  std::vector<Index> star_, on_;
  std::vector<Piercing> found_;
  std::map<Index, std::vector<Index>> inner_;
};

}  // namespace tunica::meshing
