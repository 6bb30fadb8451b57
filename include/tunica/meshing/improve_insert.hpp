// SPDX-License-Identifier: MIT
// A new node where no flip helps: a cavity grows around a bad tetrahedron as long as that makes the
// tetrahedra between its border and the node better [KLINGNER07]. The inverse: a node is taken out.
#pragma once

#include "tunica/core/vec.hpp"
#include "tunica/meshing/improve_mesh.hpp"
#include "tunica/meshing/improve_smooth.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace tunica::meshing {

class ImproveInsert {
 public:
  explicit ImproveInsert(ImproveMesh& mesh) : m_(mesh) {}

  /// Puts a node into t or onto one of its edges. True when the worst of the cavity got better.
  bool insert(Index t) {
    TetComplex& c = m_.c;
    const Quad n = c.nodes(t);
    std::array<Index, 1> seed{t};
    if (try_at(seed, centroid(t))) return true;
    for (const auto& [i, j] : mesh::Tet4::edges) {
      const Index a = n[at(i)], b = n[at(j)];
      c.ring(t, a, b, ring_);
      if (ring_.closed && try_at(ring_.tets, vec::scaled(0.5, vec::plus(c.point(a), c.point(b)))))
        return true;
    }
    return false;
  }

  /// As insert, for a nearly flat t whose own places lie in the planes of its faces, where no node sees
  /// those on the surface: the node goes into a neighbour, or among the tetrahedra around an edge.
  bool insert_beside(Index t) {
    TetComplex& c = m_.c;
    const Quad n = c.nodes(t);
    for (int f = 0; f < 4; ++f) {
      const Side s = c.across(t, f);
      if (s < 0) continue;
      const std::array<Index, 2> seed{t, s / 4};
      const Vec3 there = centroid(s / 4);
      for (const double share : {1.0, 0.3})
        if (try_at(seed, vec::between(centroid(t), there, share))) return true;
    }
    for (const auto& [i, j] : mesh::Tet4::edges) {
      c.ring(t, n[at(i)], n[at(j)], ring_);
      Vec3 middle(0, 0, 0);
      for (const Index r : ring_.tets) middle = vec::plus(middle, centroid(r));
      if (try_at(ring_.tets, vec::divided(middle, static_cast<double>(ring_.tets.size())))) return true;
    }
    return false;
  }

  /// Removes a free node of t by contracting an edge. True when the worst around it got better.
  bool contract(Index t) {
    const Quad n = m_.c.nodes(t);
    for (const Index v : n)
      if (m_.free(v) && take_out(v, 1.02)) return true;
    return false;
  }

  /// The star of v as a fan from one of its neighbours, the best of them. The worst must get better by that
  /// factor.
  bool take_out(Index v, double factor) {
    TetComplex& c = m_.c;
    if (at(v) >= in_vain_.size()) in_vain_.resize(c.points.size());
    if (in_vain_[at(v)] > 0 && !m_.changed(v, in_vain_[at(v)])) return false;
    c.star(v, cavity_);
    const double before = m_.worst(cavity_);
    place_.faces.clear();
    ends_.clear();
    for (const Index t : cavity_) {
      const Triple n = c.face(t, c.local(t, v));
      place_.faces.push_back({n[0], n[2], n[1]});
      for (const Index w : n)
        if (std::find(ends_.begin(), ends_.end(), w) == ends_.end()) ends_.push_back(w);
    }
    double best = before * factor + 1e-9;
    Index end = -1;
    for (const Index w : ends_) {
      double least = 2;
      for (const Triple& f : place_.faces) {
        if (f[0] == w || f[1] == w || f[2] == w) continue;
        least = std::min(least, m_.quality(Quad{f[0], f[1], f[2], w}));
        if (least <= best) break;
      }
      if (least > best && least <= 1) best = least, end = w;
    }
    if (end < 0) {
      in_vain_[at(v)] = m_.moment();
      return false;
    }
    fresh_.clear();
    for (const Triple& f : place_.faces)
      if (f[0] != end && f[1] != end && f[2] != end) fresh_.push_back({f[0], f[1], f[2], end});
    m_.replace(cavity_, fresh_);
    c.tet_of[at(v)] = -1;
    return true;
  }

 private:
  static constexpr std::size_t most_tets = 60;

  template <class I>
  [[nodiscard]] static std::size_t at(I i) {
    return static_cast<std::size_t>(i);
  }

  [[nodiscard]] Vec3 centroid(Index t) const {
    Vec3 middle(0, 0, 0);
    for (const Index v : m_.c.nodes(t)) middle = vec::along(middle, 0.25, m_.c.point(v));
    return middle;
  }

  template <class Seed>
  bool try_at(const Seed& seed, Vec3 x) {
    TetComplex& c = m_.c;
    cavity_.assign(seed.begin(), seed.end());
    grow(x);
    double before = m_.worst(cavity_);
    double value = border_worst(x);
    // A place on a face or an edge of the cavity may be poor at first: any valid one will do.
    if (!(value > 0)) return false;
    double scale = 0;
    for (const Triple& f : place_.faces) scale = std::max(scale, vec::distance(c.point(f[0]), x));
    x = place_.climb(c, x, value, 0.15 * scale, 12);
    if (!(value > before * 1.1 + 1e-6)) return false;
    const Index p = c.add_point(x);
    fresh_.clear();
    for (const Triple& f : place_.faces) fresh_.push_back({f[0], f[1], f[2], p});
    forget_inner_nodes();
    m_.replace(cavity_, fresh_);
    return true;
  }

  /// Adds the neighbour over the worst face of the border while its three other faces are better.
  void grow(const Vec3& x) {
    TetComplex& c = m_.c;
    const auto value = [&](const Triple& f) {  // f as seen from its own tetrahedron, outward
      return sine_quality(c.point(f[0]), c.point(f[2]), c.point(f[1]), x);
    };
    c.clear_visited();
    for (const Index t : cavity_) c.visit(t);
    for (std::size_t i = 0; i < cavity_.size() && cavity_.size() < most_tets; ++i)
      for (int f = 0; f < 4; ++f) {
        const Side s = c.across(cavity_[i], f);
        if (s < 0 || c.visited(s / 4)) continue;
        const double own = value(c.face(cavity_[i], f));
        double others = 2;
        for (int g = 0; g < 4; ++g) {
          const Side beyond = c.across(s / 4, g);
          if (g != s % 4 && (beyond < 0 || !c.visited(beyond / 4)))
            others = std::min(others, value(c.face(s / 4, g)));
        }
        if (others <= own || cavity_.size() >= most_tets) continue;
        c.visit(s / 4);
        cavity_.push_back(s / 4);
      }
    place_.faces.clear();
    for (const Index t : cavity_)
      for (int f = 0; f < 4; ++f) {
        const Side s = c.across(t, f);
        if (s >= 0 && c.visited(s / 4)) continue;
        const Triple n = c.face(t, f);
        place_.faces.push_back({n[0], n[2], n[1]});
      }
  }

  [[nodiscard]] double border_worst(const Vec3& x) { return place_.worst(m_.c, x, -1); }

  /// Free nodes that only the cavity has vanish with it.
  void forget_inner_nodes() {
    TetComplex& c = m_.c;
    for (const Index t : cavity_)
      for (const Index n : c.nodes(t)) {
        const bool on_border = std::any_of(place_.faces.begin(), place_.faces.end(), [&](const Triple& f) {
          return f[0] == n || f[1] == n || f[2] == n;
        });
        if (!on_border) c.tet_of[at(n)] = -1;
      }
  }

  ImproveMesh& m_;
  ImprovePlace place_;
  TetComplex::Ring ring_;
  std::vector<ImproveMesh::Moment> in_vain_;  // of each node: when taking it out failed last
  std::vector<Index> cavity_, ends_;
  std::vector<Quad> fresh_;
};

}  // namespace tunica::meshing
