// SPDX-License-Identifier: MIT
// Interfaces of several regions that can be edited: split, collapse, flip and move, each only if no region's
// boundary changes its topology, no triangle turns over or grows thin, no sheet folds or crosses another.
#pragma once

#include "tunica/meshing/interface_rings.hpp"
#include "tunica/meshing/triangles_cross.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace tunica::meshing {

class EditableInterfaces : public InterfaceRings {
 public:
  using InterfaceRings::InterfaceRings;

  /// A new node on the middle of ab.
  bool split(Index a, Index b) {
    const std::vector<Index> gone = sides(a, b);
    const Index n = node_count();
    std::vector<Made> made;
    for (const Index t : gone)
      for (const Index end : {a, b}) {
        Made m{nodes(t), s_.sides[at(t)]};
        for (Index& v : m.nodes) v = v == end ? n : v;
        made.push_back(m);
      }
    const Before before = measure(gone);
    const auto mean = [](const Vec3& p, const Vec3& q) { return vec::scaled(0.5, vec::plus(p, q)); };
    s_.nodes.push_back(mean(x(a), x(b)));
    s_.anchor.push_back(mean(s_.anchor[at(a)], s_.anchor[at(b)]));
    s_.reach.push_back(mean(s_.reach[at(a)], s_.reach[at(b)]));
    s_.frozen.push_back(s_.frozen[at(a)] & s_.frozen[at(b)]);
    ring_.emplace_back();
    if (allowed(made, gone, before, most_turn, 0.5 * before.angle)) return exchange(gone, made), true;
    s_.nodes.pop_back(), s_.anchor.pop_back(), s_.reach.pop_back(), s_.frozen.pop_back(), ring_.pop_back();
    return false;
  }

  /// Merges the ends of an edge, one into the other or both in the middle.
  bool collapse(Index a, Index b, double least_angle) {
    auto near_a = spokes(a), near_b = spokes(b);
    int kind_a = kind(near_a), kind_b = kind(near_b);
    const auto within = [&](Index p, Index q) { return (s_.frozen[at(p)] & ~s_.frozen[at(q)]) == 0; };
    if (kind_b > kind_a || (kind_b == kind_a && !within(b, a)))
      std::swap(a, b), std::swap(near_a, near_b), std::swap(kind_a, kind_b);
    if (kind_b == corner || !within(b, a)) return false;
    const auto to_b = std::find_if(near_a.begin(), near_a.end(), [&](const Spoke& s) { return s.to == b; });
    if (to_b == near_a.end() || (kind_b == curve && !to_b->junction)) return false;
    // Link condition: only the triangles at ab close between them, and no junction curve does.
    Index common = 0;
    for (const Spoke& p : near_a)
      for (const Spoke& q : near_b)
        if (p.to == q.to) {
          ++common;
          if (p.junction && q.junction) return false;
        }
    if (common != to_b->triangles) return false;
    std::vector<Index> gone = ring_[at(a)];
    for (const Index t : ring_[at(b)])
      if (!has(nodes(t), a)) gone.push_back(t);
    std::vector<Made> made;
    std::vector<std::uint64_t> keys;  // the two nodes beside a, which all new triangles have in common
    for (const Index t : gone) {
      if (has(nodes(t), a) && has(nodes(t), b)) continue;
      Made m{nodes(t), s_.sides[at(t)]};
      for (Index& v : m.nodes) v = v == b ? a : v;
      made.push_back(m);
      const std::size_t k = m.nodes[0] == a ? 0 : m.nodes[1] == a ? 1 : 2;
      const Index p = m.nodes[(k + 1) % 3], q = m.nodes[(k + 2) % 3];
      keys.push_back(static_cast<std::uint64_t>(std::min(p, q)) << 32U |
                     static_cast<std::uint64_t>(std::max(p, q)));
    }
    std::sort(keys.begin(), keys.end());
    if (std::adjacent_find(keys.begin(), keys.end()) != keys.end()) return false;
    const Before before = measure(gone, a);
    const Vec3 from = x(a), other = x(b);
    const bool even = kind_a == kind_b && s_.frozen[at(a)] == s_.frozen[at(b)];
    for (const double share : {0.5, 0.0, 1.0}) {
      if (share > 0 && !even) continue;
      for (int k = 0; k < 3; ++k)
        if ((s_.frozen[at(a)] >> k & 1) == 0) s_.nodes[at(a)][k] = (1 - share) * from[k] + share * other[k];
      const bool good = allowed(made, gone, before, most_turn, std::min(least_angle, before.angle));
      const Vec3 to = x(a);
      auto gained = gains(made, from);
      s_.nodes[at(a)] = from;
      for (const Index t : gone) add_gains(gained, nodes(t), s_.sides[at(t)], from, -1);
      if (!good || wears(gained)) continue;
      for (const auto& [region, gain] : gained) volume_[at(region)] += gain;
      leave(gone);
      s_.nodes[at(a)] = to;
      s_.anchor[at(a)] = vec::between(s_.anchor[at(a)], s_.anchor[at(b)], share);
      put(made);
      return true;
    }
    return false;
  }

  /// Moves a node.
  bool move(Index n, const Vec3& to) {
    const std::vector<Index> gone = ring_[at(n)];
    std::vector<Made> made;
    std::vector<Vec3> normals;
    for (const Index t : gone) {
      made.push_back({nodes(t), s_.sides[at(t)]});
      normals.push_back(triangle(nodes(t)).area_vector());
    }
    const Before before = measure(gone, n);
    const Vec3 from = std::exchange(s_.nodes[at(n)], to);
    bool good = true;  // each triangle turns from itself alone: on rough sheets they differ from their mean
    for (std::size_t i = 0; i < made.size() && good; ++i) {
      const Vec3 area = triangle(made[i].nodes).area_vector();
      good = vec::dot(area, normals[i]) > flip_turn * vec::length(area) * vec::length(normals[i]);
    }
    good = good && allowed(made, gone, before, any_turn, std::min(least_moved, before.angle));
    s_.nodes[at(n)] = from;
    if (!good) return false;
    for (const Index t : gone) grid_.remove(t);
    s_.nodes[at(n)] = to;
    for (const Index t : gone) grid_.add(t, triangle(nodes(t)).box());
    return true;
  }

  /// Turns the edge ab of two triangles between the same regions where that makes the thinner one less thin.
  bool flip(Index a, Index b) {
    const std::vector<Index> gone = sides(a, b);
    if (gone.size() != 2 || s_.sides[at(gone[0])] != s_.sides[at(gone[1])]) return false;
    const Index c = third(nodes(gone[0]), a, b), d = third(nodes(gone[1]), a, b);
    const auto angle = [&](Index p, Index q, Index r) { return triangle({p, q, r}).smallest_angle(); };
    if (!(std::min(angle(a, d, c), angle(d, b, c)) > std::min(angle(a, b, c), angle(b, a, d)) * (1 + 1e-6)))
      return false;
    if (c == d || !sides(c, d).empty()) return false;
    const Before before = measure(gone);
    std::vector<Made> made{{nodes(gone[0]), s_.sides[at(gone[0])]}, {nodes(gone[0]), s_.sides[at(gone[0])]}};
    for (Index& v : made[0].nodes) v = v == a ? d : v;
    for (Index& v : made[1].nodes) v = v == b ? d : v;
    if (!allowed(made, gone, before, flip_turn, before.angle)) return false;
    exchange(gone, made);
    return true;
  }

 private:
  enum Kind { sheet, curve, corner };  // a node inside a sheet, on a junction curve, where such curves end
  // Cosines: a triangle may turn by 75 degrees from the mean of what it replaces, by 45 in a flip or a move;
  // two sheets meet at 20 degrees or more, or as sharply as before.
  static constexpr double any_turn = -2, most_turn = 0.26, flip_turn = 0.7, sharp = 0.94;
  static constexpr double most_worn = 0.03;    // of a region's volume, in one collapse
  static constexpr double least_moved = 0.17;  // [rad] 10 degrees: no move makes thinner triangles

  [[nodiscard]] static int kind(const std::vector<Spoke>& spokes) {
    const auto n = std::count_if(spokes.begin(), spokes.end(), [](const Spoke& s) { return s.junction; });
    return n == 0 ? sheet : n == 2 ? curve : corner;
  }
  /// Would a region lose or gain too much of its volume? Islands of few voxels keep their triangles so. The
  /// outside is open where the image ends: its triangles bound no volume, and what they sum up to is no
  /// limit.
  [[nodiscard]] bool wears(const Gains& gains) const {
    return std::any_of(gains.begin(), gains.end(), [&](const auto& g) {
      return volume_[at(g.region)] > 0 && std::abs(g.volume) > most_worn * volume_[at(g.region)];
    });
  }

  [[nodiscard]] bool allowed(const std::vector<Made>& made, const std::vector<Index>& gone,
                             const Before& before, double least_cosine, double least_angle) {
    for (const Made& m : made) {
      const mesh::Triangle f = triangle(m.nodes);
      const auto n = std::find_if(before.normals.begin(), before.normals.end(),
                                  [&](const SideNormal& p) { return p.sides == m.sides; });
      const Vec3 area = f.area_vector();
      if (least_cosine > any_turn &&
          !(vec::dot(area, n->area) > least_cosine * vec::length(area) * vec::length(n->area)))
        return false;
      if (!(f.smallest_angle() >= least_angle)) return false;
    }
    if (const double fold = sharpest(made, gone); fold > sharp && fold > sharpest(gone, before) + 1e-12)
      return false;
    const auto position = [&](Index n) { return x(n); };
    near_.clear();  // triangles about the edit
    Box about;
    for (const Made& m : made) about.extend(triangle(m.nodes).box());
    (void)grid_.any(about, [&](Index t) {
      if (!in(gone, t)) near_.push_back({t, triangle(nodes(t)).box()});
      return false;
    });
    for (const Made& m : made) {
      const Box box = triangle(m.nodes).box();
      for (const auto& [t, other] : near_)
        if (box.overlaps(other) && cross(m.nodes, nodes(t), position)) return false;
    }
    // Among themselves: those that share a node alone may cross where sheets meet.
    for (std::size_t i = 0; i < made.size(); ++i)
      for (std::size_t j = i + 1; j < made.size(); ++j)
        if (cross(made[i].nodes, made[j].nodes, position)) return false;
    return true;
  }

  struct Near {
    Index triangle;
    Box box;
  };
  std::vector<Near> near_;
};

}  // namespace tunica::meshing
