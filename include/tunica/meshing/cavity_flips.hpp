// SPDX-License-Identifier: MIT
// Local changes of a TetComplex: face to edge (2-3), edge to faces (edge removal), splits of a face
// or an edge. Each is made only when every new tetrahedron has a positive volume by exact signs.
#pragma once

#include "tunica/meshing/cavity_polygon.hpp"
#include "tunica/meshing/tet_complex.hpp"
#include "tunica/meshing/tet_quality.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace tunica::meshing {

class CavityFlips {
 public:
  static constexpr int longest_ring = 12, deep_rounds = 6;

  explicit CavityFlips(TetComplex& complex) : c(complex) {}

  TetComplex& c;
  TetComplex::Ring ring;   // scratch: the last ring
  std::vector<Side> open;  // scratch of replace: sides left open
  std::vector<Quad> fresh;
  std::vector<Index> scratch;

  [[nodiscard]] double quality(const Quad& q) const {
    return sine_quality(c.point(q[0]), c.point(q[1]), c.point(q[2]), c.point(q[3]));
  }

  /// Replaces the face by the edge between its two apexes. False: marked, on the border, or the
  /// five points are not convex; nothing is changed then.
  bool face_to_edge(Index t, int f, double floor = 0) {
    const Side s = c.across(t, f);
    if (s < 0 || c.mark(t, f) >= 0) return false;
    const Triple n = c.face(t, f);  // outward: away from u, towards w
    const Index u = c.nodes(t)[at(f)], w = c.nodes(s / 4)[at(s % 4)];
    fresh.clear();
    for (std::size_t i = 0; i < 3; ++i) {
      fresh.push_back({u, w, n[i], n[(i + 1) % 3]});  // the face turns about the axis from u to w
      if (!(quality(fresh.back()) > floor)) return false;
    }
    const std::array<Index, 2> old{t, s / 4};
    c.replace(old, fresh, open);
    return true;
  }

  /// Replaces the ring of tetrahedra around the edge (a, b) of t by tetrahedra without it; the
  /// best choice by allowed quality. allowed(x, y): may the chord between two link nodes be made?
  template <class Allowed>
  bool remove_edge(Index t, Index a, Index b, double floor, Allowed&& allowed) {
    c.ring(t, a, b, ring);
    const int m = static_cast<int>(ring.link.size());
    if (!ring.closed || m < 3 || m > longest_ring) return false;
    const auto value = [&](int i, int k, int j) {
      const Index x = ring.link[at(i)], y = ring.link[at(k)], z = ring.link[at(j)];
      if (!chord(i, k, m, allowed) || !chord(k, j, m, allowed) || !chord(i, j, m, allowed)) return -1.0;
      const double lower = quality({x, z, y, a});
      return lower > 0 ? std::min(lower, quality({x, y, z, b})) : -1.0;
    };
    if (polygon.triangulate(m, floor, value) < 0) return false;
    fresh.clear();
    for (const auto& [i, k, j] : polygon.triangles) {
      const Index x = ring.link[at(i)], y = ring.link[at(k)], z = ring.link[at(j)];
      fresh.push_back({x, y, z, b});
      fresh.push_back({x, z, y, a});
    }
    c.replace(ring.tets, fresh, open);
    return true;
  }

  /// As remove_edge; when the ring resists, edges from a or b to its nodes are removed first, so
  /// that it gets smaller. locked(x, y): edges that must stay.
  template <class Allowed, class Locked>
  bool remove_edge_deep(Index t, Index a, Index b, Allowed&& allowed, Locked&& locked) {
    if (locked(a, b)) return false;
    for (int round = 0; round < deep_rounds; ++round) {
      if (remove_edge(t, a, b, 0, allowed)) return true;
      const std::vector<Index> link = ring.link;
      bool smaller = false;
      for (std::size_t i = 0; i < link.size() && !smaller; ++i)
        for (const Index end : {a, b}) {
          if (locked(end, link[i])) continue;
          const Index other = end == a ? b : a;
          const auto chord = [&](Index x, Index y) { return x != other && y != other && allowed(x, y); };
          smaller = remove_edge(c.tet_with(end, link[i], scratch), end, link[i], 0, chord);
          if (smaller) break;
        }
      if (!smaller) return false;
      t = c.tet_with(a, b, scratch);
      if (t < 0) return true;
    }
    return false;
  }

  /// Puts node p into the edge (a, b) of t: every tetrahedron of the ring is halved.
  bool split_edge(Index t, Index a, Index b, Index p, double floor = 0) {
    c.ring(t, a, b, ring);
    fresh.clear();
    for (const Index r : ring.tets)
      for (const Index end : {a, b}) {
        Quad q = c.nodes(r);
        q[at(c.local(r, end))] = p;
        if (!(quality(q) > floor)) return false;
        fresh.push_back(q);
      }
    c.replace(ring.tets, fresh, open);
    return true;
  }

  /// Puts node p into the face f of t: three tetrahedra on either side.
  bool split_face(Index t, int f, Index p, double floor = 0) {
    const Side s = c.across(t, f);
    if (s < 0 || c.mark(t, f) >= 0) return false;
    fresh.clear();
    for (const Side side : {4 * t + f, s})
      for (int i = 0; i < 4; ++i) {
        if (i == side % 4) continue;
        Quad q = c.nodes(side / 4);
        q[at(i)] = p;
        if (!(quality(q) > floor)) return false;
        fresh.push_back(q);
      }
    const std::array<Index, 2> old{t, s / 4};
    c.replace(old, fresh, open);
    return true;
  }

  CavityPolygon polygon;

 private:
  template <class I>
  [[nodiscard]] static std::size_t at(I i) {
    return static_cast<std::size_t>(i);
  }

  template <class Allowed>
  [[nodiscard]] bool chord(int i, int j, int m, Allowed& allowed) const {
    return j - i == 1 || j - i == m - 1 || allowed(ring.link[at(i)], ring.link[at(j)]);
  }
};

}  // namespace tunica::meshing
