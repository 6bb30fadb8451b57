// SPDX-License-Identifier: MIT
// Improves the worst tetrahedra, the surface kept: edge removal first, then faces, smoothing, and
// from the third sweep on new nodes and contractions [FREITAG97, KLINGNER07].
#pragma once

#include "tunica/meshing/cavity_polygon.hpp"
#include "tunica/meshing/improve_insert.hpp"
#include "tunica/meshing/improve_mesh.hpp"
#include "tunica/meshing/improve_smooth.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

namespace tunica::meshing {

struct ImproveCounts {
  Index sweeps = 0, edges_removed = 0, faces_removed = 0, moved = 0, inserted = 0, contracted = 0;
};

class Improve {
 public:
  static constexpr int most_sweeps = 14, first_insertion = 2;

  /// target: sine of the dihedral angle that every tetrahedron should exceed. limit[n]: what a
  /// tetrahedron with an edge at node n of the surface can reach; the triangles there bound it.
  static ImproveCounts run(TetComplex& complex, std::vector<double> limit, double target) {
    Improve work(complex, std::move(limit), target);
    for (int sweep = 0; sweep < most_sweeps; ++sweep)
      if (!work.sweep(sweep)) break;
    return work.counts_;
  }

  /// Flips alone: tetrahedra with a sine below the target go where that makes the worst better.
  static void flip(TetComplex& complex, double target) {
    constexpr int most = 4;
    Improve work(complex, {}, target);
    for (int sweep = 0; sweep < most; ++sweep) {
      bool changed = false;
      for (const Index t : work.bad())
        if (complex.alive(t) && work.is_bad(t))
          changed = work.remove_an_edge(t) || work.remove_a_face(t) || changed;
      if (!changed) return;
    }
  }

  /// Takes out nodes from `first` on where that leaves the worst tetrahedra around as good as they were.
  static void thin(TetComplex& complex, Index first) {
    constexpr int most = 4;
    Improve work(complex, {}, 0);
    work.m_.fixed = first;
    const auto end = static_cast<Index>(complex.points.size());
    for (int pass = 0; pass < most; ++pass) {
      bool changed = false;
      for (Index n = first; n < end; ++n)
        if (complex.tet_of[at(n)] >= 0 && work.insert_.take_out(n, 1)) changed = true;
      if (!changed) return;
    }
  }

  /// All means on tetrahedra with a sine below the target; the nodes with held[n] = 1 stay.
  static void loosen(TetComplex& complex, std::vector<char> held, double target) {
    constexpr int most = 6;
    Improve work(complex, {}, target);
    work.m_.held = std::move(held);
    for (int sweep = 0; sweep < most; ++sweep)
      if (!work.sweep(sweep)) return;
  }

 private:
  Improve(TetComplex& complex, std::vector<double> limit, double target)
      : m_(complex, static_cast<Index>(limit.size())),
        smooth_(m_),
        insert_(m_),
        limit_(std::move(limit)),
        target_(target) {}

  [[nodiscard]] bool is_bad(Index t) const { return m_.quality(t) < target_; }

  /// Is t worth a new node, or is the surface itself the limit?
  [[nodiscard]] bool hopeful(Index t) const {
    double bound = target_;
    int on_surface = 0;
    if (limit_.empty()) return true;
    for (const Index n : m_.c.nodes(t))
      if (!m_.free(n)) bound = std::min(bound, limit_[at(n)]), ++on_surface;
    return on_surface < 2 || m_.quality(t) < bound;
  }

  template <class I>
  [[nodiscard]] static std::size_t at(I i) {
    return static_cast<std::size_t>(i);
  }

  /// Tetrahedra below the target, the worst first.
  [[nodiscard]] std::vector<Index> bad() const {
    std::vector<Index> list;
    for (Index t = 0; t < m_.c.size(); ++t)
      if (m_.c.alive(t) && is_bad(t)) list.push_back(t);
    std::sort(list.begin(), list.end(), [&](Index s, Index t) {
      return m_.quality(s) != m_.quality(t) ? m_.quality(s) < m_.quality(t) : s < t;
    });
    return list;
  }

  /// True when another sweep is worth its time. New nodes are rationed: where the surface itself
  /// is the limit, more of them would only make more tetrahedra that miss the target.
  bool sweep(int number) {
    const auto list = bad();
    if (list.empty()) return false;
    if (number == first_insertion) most_inserted_ = 100 + static_cast<Index>(list.size() / 2);
    const double worst = m_.quality(list[0]), count = static_cast<double>(list.size());
    if (number > first_insertion + 1 && count > 0.98 * last_count_ && worst < 1.02 * last_worst_)
      return false;
    last_count_ = count, last_worst_ = worst;
    ++counts_.sweeps;
    bool changed = false;
    for (const Index t : list) {
      if (!m_.c.alive(t) || !is_bad(t)) continue;
      changed = repair(t, number) || changed;
    }
    return changed || number < first_insertion;
  }

  bool repair(Index t, int number) {
    const Quad n = m_.c.nodes(t);
    if (at(t) >= in_vain_.size()) in_vain_.resize(at(m_.c.size()));
    const bool again = in_vain_[at(t)] > 0 && std::none_of(n.begin(), n.end(), [&](Index v) {
                         return m_.changed(v, in_vain_[at(t)]);
                       });
    if (!again) {
      if (remove_an_edge(t)) return ++counts_.edges_removed, true;
      if (remove_a_face(t)) return ++counts_.faces_removed, true;
      in_vain_[at(t)] = m_.moment();
    }
    bool moved = false;
    for (const Index v : n)
      if (smooth_.smooth(v)) ++counts_.moved, moved = true;
    if (number < first_insertion || !is_bad(t)) return moved;
    if (insert_.contract(t)) return ++counts_.contracted, true;
    if (counts_.inserted < most_inserted_ && hopeful(t) &&
        (insert_.insert(t) || (m_.quality(t) < flat && insert_.insert_beside(t))))
      return ++counts_.inserted, true;
    return moved;
  }

  /// The best removal among the six edges of t, if it lifts the worst around that edge.
  bool remove_an_edge(Index t) {
    const Quad n = m_.c.nodes(t);
    double best = 0;
    chosen_.clear();
    for (const auto& [i, j] : mesh::Tet4::edges) {
      const Index a = n[at(i)], b = n[at(j)];
      m_.c.ring(t, a, b, ring_);
      const int corners = static_cast<int>(ring_.link.size());
      if (!ring_.closed || corners > longest_ring) continue;
      const double floor = std::max(best, m_.worst(ring_.tets) * 1.01 + 1e-9);
      const auto value = [&](int p, int q, int r) {
        const Index x = ring_.link[at(p)], y = ring_.link[at(q)], z = ring_.link[at(r)];
        const double upper = m_.quality(Quad{x, y, z, b});
        return upper > floor ? std::min(upper, m_.quality(Quad{x, z, y, a})) : -1.0;
      };
      const double q = polygon_.triangulate(corners, floor, value);
      if (q < 0) continue;
      best = q;
      chosen_ = ring_.tets;
      fresh_.clear();
      for (const auto& [p, k, r] : polygon_.triangles) {
        const Index x = ring_.link[at(p)], y = ring_.link[at(k)], z = ring_.link[at(r)];
        fresh_.push_back({x, y, z, b});
        fresh_.push_back({x, z, y, a});
      }
    }
    if (chosen_.empty()) return false;
    m_.replace(chosen_, fresh_);
    return true;
  }

  /// The best exchange of a face of t for the edge between its two apexes.
  bool remove_a_face(Index t) {
    const Quad n = m_.c.nodes(t);
    double best = 0;
    std::array<Index, 2> pair{-1, -1};
    std::array<Quad, 3> chosen{};
    for (int f = 0; f < 4; ++f) {
      const Side s = m_.c.across(t, f);
      if (s < 0) continue;
      const Triple tri = m_.c.face(t, f);
      const Index u = n[at(f)], w = m_.c.nodes(s / 4)[at(s % 4)];
      const double floor = std::max(best, std::min(m_.quality(t), m_.quality(s / 4)) * 1.01 + 1e-9);
      std::array<Quad, 3> three{};
      double least = 2;
      for (std::size_t i = 0; i < 3 && least > floor; ++i) {
        three[i] = {u, w, tri[i], tri[(i + 1) % 3]};
        least = std::min(least, m_.quality(three[i]));
      }
      if (least > floor) best = least, chosen = three, pair = {t, s / 4};
    }
    if (pair[0] < 0) return false;
    m_.replace(pair, chosen);
    return true;
  }

  static constexpr int longest_ring = 12;
  static constexpr double flat = 0.02;  // sine of a dihedral angle
  ImproveMesh m_;
  ImproveSmooth smooth_;
  ImproveInsert insert_;
  CavityPolygon polygon_;
  TetComplex::Ring ring_;
  std::vector<Index> chosen_;
  std::vector<Quad> fresh_;
  std::vector<ImproveMesh::Moment> in_vain_;  // of each tetrahedron: when no flip helped it last
  std::vector<double> limit_;
  double target_, last_count_ = 0, last_worst_ = 0;
  Index most_inserted_ = 0;
  ImproveCounts counts_;
};

}  // namespace tunica::meshing
