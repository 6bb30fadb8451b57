// SPDX-License-Identifier: MIT
// Delaunay tetrahedra of points: incremental insertion into cavities [BOWYER81], [WATSON81] in
// biased random rounds along a Hilbert curve [AMENTA03], every sign exact.
#pragma once

#include "tunica/core/error.hpp"
#include "tunica/core/vec.hpp"
#include "tunica/meshing/hilbert.hpp"
#include "tunica/meshing/tet_complex.hpp"

#include <string>
#include <vector>

namespace tunica::meshing {

class Delaunay {
 public:
  /// Builds the triangulation of complex.points inside one large tetrahedron, whose four nodes are
  /// added at the end. MeshError when two points coincide.
  explicit Delaunay(TetComplex& complex) : c_(complex) { build(); }

  /// Inserts one more node, a point inside of all.
  void insert(Index p) {
    if (!c_.alive(last_)) last_ = c_.tet_of[0];
    insert_at(p);
  }

 private:
  void build() {
    Box box;
    for (const Vec3& p : c_.points) box.extend(p);
    const Index count = static_cast<Index>(c_.points.size());
    const double r = 8 * (box.diagonal() > 0 ? box.diagonal() : 1.0);
    const Vec3 o = box.centre();
    c_.tet_of.assign(c_.points.size(), -1);
    const auto corner = [&](double x, double y, double z) {
      return c_.add_point(vec::along(o, r, Vec3(x, y, z)));
    };
    const Index a = corner(-1, -1, -1), b = corner(3, -1, -1), c = corner(-1, 3, -1), d = corner(-1, -1, 3);
    last_ = c_.add({a, b, c, d});
    const auto order = insertion_order(c_.points, static_cast<std::size_t>(count), box);
    for (const Index p : order) insert_at(p);
  }

  [[nodiscard]] Index locate(const Vec3& x) const {
    Index t = last_;
    for (;;) {
      int f = 0;
      for (; f < 4; ++f) {
        const Triple n = c_.face(t, f);
        if (c_.across(t, f) >= 0 && orient3d(c_.point(n[0]), c_.point(n[1]), c_.point(n[2]), x) > 0) break;
      }
      if (f == 4) return t;
      t = c_.across(t, f) / 4;
    }
  }

  /// Ties count as outside: then the cavity is star-shaped about p whatever is cospherical.
  [[nodiscard]] bool conflicts(Index t, const Vec3& x) const {
    const Quad& n = c_.nodes(t);
    return insphere(c_.point(n[0]), c_.point(n[1]), c_.point(n[2]), c_.point(n[3]), x) > 0;
  }

  void insert_at(Index p) {
    const Vec3 x = c_.point(p);
    const Index first = locate(x);
    for (const Index n : c_.nodes(first))
      if (vec::equal(c_.point(n), x))
        throw MeshError("two nodes of the surface coincide: nodes " + std::to_string(n) + " and " +
                        std::to_string(p));
    cavity_.assign(1, first);
    border_.clear();
    c_.clear_visited();
    c_.visit(first);
    status_.resize(static_cast<std::size_t>(c_.size()));
    status_[s(first)] = in;
    for (std::size_t i = 0; i < cavity_.size(); ++i)
      for (int f = 0; f < 4; ++f) {
        const Side side = c_.across(cavity_[i], f);
        const Index t = side / 4;
        if (side >= 0 && c_.visit(t)) {
          status_[s(t)] = conflicts(t, x) ? in : out;
          if (status_[s(t)] == in) cavity_.push_back(t);
        }
        if (side < 0 || status_[s(t)] == out) border_.push_back(4 * cavity_[i] + f);
      }
    for (const Side side : border_) {  // p takes the place of the node opposite to the face
      Quad q = c_.nodes(side / 4);
      q[s(side % 4)] = p;
      const Side outer = c_.across(side);
      const Index t = c_.add(q);
      c_.link_one(4 * t + side % 4, outer);
      c_.set_mark(side, t);  // of those that vanish: what was made at the face
    }
    for (const Side side : border_) {
      const int f = side % 4;
      for (int g = 0; g < 4; ++g)
        if (g != f) join(side / 4, f, g, made(side));
      const Side outer = c_.across(side);
      if (outer >= 0) c_.link_one(outer, 4 * made(side) + f);
    }
    last_ = made(border_[0]);
    for (const Index t : cavity_) c_.remove(t);
  }
  [[nodiscard]] Index made(Side side) const { return c_.mark(side / 4, side % 4); }

  /// Finds the new neighbour of `fresh` (made at face f of t) across its face g: turn about the
  /// edge opposite to f and g through the cavity until its border is met again.
  void join(Index t, int f, int g, Index fresh) {
    if (c_.across(fresh, g) >= 0) return;
    const Quad& n = c_.nodes(t);
    int e = 0;
    while (e == f || e == g) ++e;
    const Index a = n[s(e)], b = n[s(6 - e - f - g)];
    Index tet = t;
    int leave = g, enter = f;
    for (;;) {
      const Side side = c_.across(tet, leave);
      const Index next = side / 4;
      if (side < 0 || !c_.visited(next) || status_[s(next)] == out) break;
      enter = side % 4;
      tet = next;
      const Quad& m = c_.nodes(tet);
      leave = 0;  // the other face with the edge (a, b)
      while (leave == enter || m[s(leave)] == a || m[s(leave)] == b) ++leave;
    }
    // The border face is `leave` of `tet`; in the tetrahedron made there, the edge's other face is
    // the one opposite to the node at `enter`.
    const Index other = made(4 * tet + leave);
    c_.link(4 * fresh + g, 4 * other + enter);
  }

  template <class I>
  [[nodiscard]] static std::size_t s(I i) {
    return static_cast<std::size_t>(i);
  }

  enum : char { in, out };
  TetComplex& c_;
  Index last_ = 0;
  std::vector<Index> cavity_;
  std::vector<Side> border_;
  std::vector<char> status_;
};

}  // namespace tunica::meshing
