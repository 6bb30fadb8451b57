// SPDX-License-Identifier: MIT
// Tetrahedra that know their neighbours: the working structure of the filler. Every local change
// (flip, split, collapse, cavity) is one operation: replace some tetrahedra by others.
#pragma once

#include "tunica/core/expect.hpp"
#include "tunica/core/types.hpp"
#include "tunica/mesh/cell.hpp"
#include "tunica/meshing/predicates.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tunica::meshing {

using Quad = std::array<Index, 4>;    // nodes of a tetrahedron, in VTK's order
using Triple = std::array<Index, 3>;  // nodes of a face

/// A face of a tetrahedron as one number: 4 * tet + the local node that it is opposite to.
using Side = Index;

class TetComplex {
 public:
  std::vector<Vec3> points;
  std::vector<Index> tet_of;  // one tetrahedron of each node, -1: none

  [[nodiscard]] Index size() const { return static_cast<Index>(tets_.size()); }
  [[nodiscard]] bool alive(Index t) const { return nodes(t)[0] >= 0; }
  [[nodiscard]] const Quad& nodes(Index t) const { return tets_[at(t)].node; }
  [[nodiscard]] Side across(Index t, int face) const { return tets_[at(t)].next[at(face)]; }
  [[nodiscard]] Side across(Side s) const { return across(s / 4, s % 4); }
  /// Twice the triangle of the surface that this face is (a part of), plus one outside; -1: none.
  [[nodiscard]] Index mark(Index t, int face) const { return tets_[at(t)].mark[at(face)]; }
  void set_mark(Side s, Index m) { tets_[at(s / 4)].mark[at(s % 4)] = m; }
  /// Marks the face on both of its sides as (a part of) triangle f, which turns as `oriented`:
  /// 2 f on the side from which it does so seen from outside, that is inside, and 2 f + 1 beyond.
  void mark_both(Side s, const Triple& oriented, Index f) {
    Triple own = face(s / 4, s % 4);
    while (own[0] != oriented[0]) std::rotate(own.begin(), own.begin() + 1, own.end());
    const bool inner = own[1] == oriented[1];
    set_mark(s, 2 * f + (inner ? 0 : 1));
    if (across(s) >= 0) set_mark(across(s), 2 * f + (inner ? 1 : 0));
  }

  /// The nodes of a face, so that they turn counter-clockwise seen from outside of its tetrahedron.
  [[nodiscard]] Triple face(Index t, int f) const {
    const auto& local = mesh::Tet4::faces[at(f)];
    const Quad& n = nodes(t);
    return {n[at(local[0])], n[at(local[1])], n[at(local[2])]};
  }
  [[nodiscard]] int local(Index t, Index node) const {
    const Quad& n = nodes(t);
    for (int i = 0; i < 4; ++i)
      if (n[at(i)] == node) return i;
    return -1;
  }
  [[nodiscard]] bool has(Index t, Index node) const { return local(t, node) >= 0; }

  [[nodiscard]] const Vec3& point(Index node) const { return points[at(node)]; }
  [[nodiscard]] double orient(Index a, Index b, Index c, Index d) const {
    return orient3d(point(a), point(b), point(c), point(d));
  }
  [[nodiscard]] double orient(const Quad& q) const { return orient(q[0], q[1], q[2], q[3]); }

  Index add_point(const Vec3& x) {
    points.push_back(x);
    tet_of.push_back(-1);
    return static_cast<Index>(points.size() - 1);
  }

  /// A tetrahedron without neighbours yet.
  Index add(const Quad& q) {
    Index t;
    if (free_.empty()) {
      t = size();
      tets_.emplace_back();
      stamp_.push_back(0);
    } else {
      t = free_.back();
      free_.pop_back();
    }
    tets_[at(t)] = {q, {-1, -1, -1, -1}, {-1, -1, -1, -1}};
    for (const Index n : q) tet_of[at(n)] = t;
    return t;
  }
  void remove(Index t) {
    tets_[at(t)].node[0] = -1;
    free_.push_back(t);
  }
  void link_one(Side s, Side other) { tets_[at(s / 4)].next[at(s % 4)] = other; }
  void link(Side s, Side other) {
    link_one(s, other);
    if (other >= 0) link_one(other, s);
  }

  /// A new round of visited() marks.
  void clear_visited() { ++round_; }
  /// True the first time that t is asked in this round.
  bool visit(Index t) {
    if (stamp_[at(t)] == round_) return false;
    stamp_[at(t)] = round_;
    return true;
  }
  [[nodiscard]] bool visited(Index t) const { return stamp_[at(t)] == round_; }

  /// All tetrahedra of a node, those found first first.
  void star(Index node, std::vector<Index>& tets) {
    tets.clear();
    if (tet_of[at(node)] < 0) return;
    clear_visited();
    tets.push_back(tet_of[at(node)]);
    visit(tets[0]);
    for (std::size_t i = 0; i < tets.size(); ++i)
      for (int f = 0; f < 4; ++f) {
        const Side s = across(tets[i], f);
        if (s < 0 || nodes(tets[i])[at(f)] == node || !visit(s / 4)) continue;
        tets.push_back(s / 4);
      }
  }

  /// The tetrahedra around the edge (a, b) from t, which has it, and the nodes of its link in
  /// order: tetrahedron i is (a, b, link[i], link[i + 1]) up to order. closed: false when the edge
  /// lies on the border; then the link has one node more than there are tetrahedra.
  struct Ring {
    std::vector<Index> tets, link;
    bool closed = false;
  };
  void ring(Index t, Index a, Index b, Ring& r) const {
    r.tets.clear(), r.link.clear();
    // In a tetrahedron (a, b, x, y) of positive volume the walk goes from x to y.
    const auto others = [&](Index tet) {
      const Quad& n = nodes(tet);
      std::array<Index, 2> o{-1, -1};
      for (const Index v : n)
        if (v != a && v != b) o[o[0] < 0 ? 0 : 1] = v;
      const int i = local(tet, a), j = local(tet, b);
      int x = 0;
      while (x == i || x == j) ++x;
      const int y = 6 - i - j - x;
      if (!even({i, j, x, y})) std::swap(o[0], o[1]);
      return o;
    };
    Index from = t;
    for (Index at_tet = t;;) {  // backward to the border, or round
      const Side s = across(at_tet, local(at_tet, others(at_tet)[1]));
      if (s < 0 || s / 4 == t) {
        r.closed = s >= 0;
        from = r.closed ? t : at_tet;
        break;
      }
      at_tet = s / 4;
    }
    for (Index at_tet = from;;) {
      const auto o = others(at_tet);
      r.tets.push_back(at_tet);
      r.link.push_back(o[0]);
      const Side s = across(at_tet, local(at_tet, o[0]));
      if (s < 0) {
        r.link.push_back(o[1]);
        return;
      }
      if (s / 4 == from) return;
      at_tet = s / 4;
    }
  }

  /// A tetrahedron with the edge (a, b), -1: there is none.
  [[nodiscard]] Index tet_with(Index a, Index b, std::vector<Index>& scratch) {
    star(a, scratch);
    for (const Index t : scratch)
      if (has(t, b)) return t;
    return -1;
  }

  /// Replaces the tetrahedra `old` by `fresh`, which fill the same place, and returns the numbers
  /// of the new ones. Marks of faces stay. Faces of the fresh ones that are neither shared nor on
  /// the border of the old ones stay without neighbour; their sides are put into `open`.
  const std::vector<Index>& replace(std::span<const Index> old, std::span<const Quad> fresh,
                                    std::vector<Side>& open) {
    std::size_t capacity = 64;
    while (capacity < 8 * (old.size() + fresh.size())) capacity *= 2;
    table_.assign(capacity, Slot{});
    clear_visited();
    for (const Index t : old) visit(t);
    for (const Index t : old)
      for (int f = 0; f < 4; ++f) {
        const Side s = across(t, f);
        if (s >= 0 && visited(s / 4)) continue;
        Slot& slot = find(face(t, f));
        slot.side = s, slot.mark = mark(t, f), slot.used = true;
      }
    for (const Index t : old) remove(t);
    created_.clear();
    for (const Quad& q : fresh) created_.push_back(add(q));
    for (const Index t : created_)
      for (int f = 0; f < 4; ++f) {
        Slot& slot = find(face(t, f));
        const Side mine = 4 * t + f;
        if (!slot.used) {
          slot.side = mine, slot.used = true, slot.fresh = true;
        } else if (slot.side < 0) {  // a face of the border stays one unless a second tetrahedron comes
          set_mark(mine, slot.mark);
          slot.side = mine, slot.border = true;
        } else {
          link(mine, slot.side);
          set_mark(mine, slot.border ? -1 : slot.mark);
          if (slot.border) set_mark(slot.side, -1);
          slot.fresh = false;
        }
      }
    open.clear();
    for (const Index t : created_)
      for (int f = 0; f < 4; ++f)
        if (across(t, f) < 0 && find(face(t, f)).fresh) open.push_back(4 * t + f);
    return created_;
  }

  /// Keeps the tetrahedra for which keep(t) holds; the faces to the others become the border.
  template <class Keep>
  void restrict_to(Keep&& keep) {
    std::vector<Index> number(tets_.size(), -1);
    Index count = 0;
    for (Index t = 0; t < size(); ++t)
      if (alive(t) && keep(t)) number[at(t)] = count++;
    std::fill(tet_of.begin(), tet_of.end(), -1);
    for (Index t = 0; t < size(); ++t) {  // in place: none gets a larger number
      if (number[at(t)] < 0) continue;
      Tet tet = tets_[at(t)];
      for (Side& s : tet.next)
        if (s >= 0) s = number[at(s / 4)] < 0 ? -1 : 4 * number[at(s / 4)] + s % 4;
      for (const Index n : tet.node) tet_of[at(n)] = number[at(t)];
      tets_[at(number[at(t)])] = tet;
    }
    tets_.resize(static_cast<std::size_t>(count));
    free_.clear();
    stamp_.assign(tets_.size(), 0);
    round_ = 0;
  }

  /// True for even permutations of (0, 1, 2, 3).
  [[nodiscard]] static bool even(const std::array<int, 4>& p) {
    int inversions = 0;
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = i + 1; j < 4; ++j) inversions += p[i] > p[j];
    return inversions % 2 == 0;
  }

 private:
  struct Tet {
    Quad node;
    std::array<Side, 4> next;
    std::array<Index, 4> mark;
  };
  struct Slot {
    Triple key{};
    Side side = -1;
    Index mark = -1;
    bool used = false, fresh = false, border = false;
  };

  template <class I>
  [[nodiscard]] static std::size_t at(I i) {
    return static_cast<std::size_t>(i);
  }

  [[nodiscard]] Slot& find(Triple f) {
    if (f[0] > f[1]) std::swap(f[0], f[1]);
    if (f[1] > f[2]) std::swap(f[1], f[2]);
    if (f[0] > f[1]) std::swap(f[0], f[1]);
    std::uint64_t h = static_cast<std::uint64_t>(f[0]) * 0x9e3779b97f4a7c15u;
    h = (h ^ static_cast<std::uint64_t>(f[1])) * 0xbf58476d1ce4e5b9u;
    h = (h ^ static_cast<std::uint64_t>(f[2]) ^ h >> 29) * 0x94d049bb133111ebu;
    std::size_t i = (h >> 32) & (table_.size() - 1);
    while (table_[i].used && table_[i].key != f) i = (i + 1) & (table_.size() - 1);
    table_[i].key = f;
    return table_[i];
  }

  std::vector<Tet> tets_;
  std::vector<Index> free_;
  std::vector<std::uint32_t> stamp_;
  std::uint32_t round_ = 0;
  std::vector<Slot> table_;
  std::vector<Index> created_;
};

}  // namespace tunica::meshing
