// SPDX-License-Identifier: MIT
// Triangles of interfaces with their places and the triangles around each node, to be exchanged one group for
// another; what such a group is like: normals, folds, angles, volumes.
#pragma once

#include "tunica/mesh/measures.hpp"
#include "tunica/meshing/interfaces.hpp"
#include "tunica/meshing/triangle_grid.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace tunica::meshing {

class InterfaceRings {
 public:
  using Nodes = std::array<Index, 3>;
  /// A neighbour of a node, the number of triangles at the edge between them, and whether that is a junction.
  struct Spoke {
    Index to, triangles;
    bool junction;
  };

  InterfaceRings(Interfaces s, double edge)
      : s_(std::move(s)), grid_(box_of(s_), edge), ring_(s_.nodes.size()) {
    Index regions = 0;
    for (const Sides& sides : s_.sides) regions = std::max({regions, sides[0] + 1, sides[1] + 1});
    volume_ = volumes_of(s_, at(regions));
    for (std::size_t t = 0; t < s_.faces.size(); ++t) enter(static_cast<Index>(t));
  }

  [[nodiscard]] Index triangle_count() const { return static_cast<Index>(s_.faces.size()); }
  [[nodiscard]] Index node_count() const { return s_.node_count(); }
  [[nodiscard]] bool alive(Index t) const { return nodes(t)[0] >= 0; }
  [[nodiscard]] bool used(Index n) const { return !ring_[at(n)].empty(); }
  [[nodiscard]] const Nodes& nodes(Index t) const { return s_.faces[at(t)]; }
  [[nodiscard]] const Vec3& x(Index n) const { return s_.nodes[at(n)]; }
  [[nodiscard]] double length(Index a, Index b) const { return vec::distance(x(a), x(b)); }
  [[nodiscard]] mesh::Triangle triangle(const Nodes& n) const { return {x(n[0]), x(n[1]), x(n[2])}; }

  /// The neighbours of a node, ascending.
  [[nodiscard]] std::vector<Spoke> spokes(Index n) const {
    std::vector<std::uint64_t> found;  // neighbour << 32 | triangle
    for (const Index t : ring_[at(n)])
      for (const Index m : nodes(t))
        if (m != n) found.push_back(static_cast<std::uint64_t>(m) << 32U | static_cast<std::uint64_t>(t));
    std::sort(found.begin(), found.end());
    const auto neighbour = [&](std::size_t i) { return static_cast<Index>(found[i] >> 32U); };
    const auto triangle_at = [&](std::size_t i) { return at(found[i] & 0xFFFFFFFFU); };
    std::vector<Spoke> list;
    for (std::size_t i = 0; i < found.size();) {
      Spoke s{neighbour(i), 0, false};
      const Sides& first = s_.sides[triangle_at(i)];
      for (; i < found.size() && neighbour(i) == s.to; ++i) {
        ++s.triangles;
        s.junction = s.junction || s_.sides[triangle_at(i)] != first;
      }
      s.junction = s.junction || s.triangles != 2;
      list.push_back(s);
    }
    return list;
  }

  /// The triangles at the edge ab, ascending in the order of their making.
  [[nodiscard]] std::vector<Index> sides(Index a, Index b) const {
    std::vector<Index> list;
    for (const Index t : ring_[at(a)])
      if (has(nodes(t), b)) list.push_back(t);
    return list;
  }

  /// The interfaces as they are now, without the nodes that are gone.
  [[nodiscard]] Interfaces interfaces() const {
    Interfaces r;
    std::vector<Index> number(s_.nodes.size(), -1);
    for (Index n = 0; n < node_count(); ++n) {
      if (!used(n)) continue;
      number[at(n)] = r.node_count();
      r.nodes.push_back(x(n)), r.anchor.push_back(s_.anchor[at(n)]), r.reach.push_back(s_.reach[at(n)]);
      r.frozen.push_back(s_.frozen[at(n)]);
    }
    for (Index t = 0; t < triangle_count(); ++t) {
      if (!alive(t)) continue;
      const Nodes& n = nodes(t);
      r.faces.push_back({number[at(n[0])], number[at(n[1])], number[at(n[2])]});
      r.sides.push_back(s_.sides[at(t)]);
    }
    return r;
  }

 protected:
  struct Made {
    Nodes nodes;
    Sides sides;
  };
  /// Sum of the area vectors of triangles between two regions.
  struct SideNormal {
    Sides sides;
    Vec3 area;
  };
  /// The triangles that an edit replaces: the sum of their normals by sides, their smallest angle, and where
  /// a node that moves was.
  struct Before {
    std::vector<SideNormal> normals;
    double angle = std::numeric_limits<double>::infinity();
    Index node = -1;
    Vec3 place{0, 0, 0};
  };
  template <class I>
  [[nodiscard]] static std::size_t at(I i) {
    return static_cast<std::size_t>(i);
  }
  [[nodiscard]] static Box box_of(const Interfaces& s) {
    Box box;
    for (const Vec3& p : s.nodes) box.extend(p);
    return box;
  }
  [[nodiscard]] static bool has(const Nodes& n, Index v) { return n[0] == v || n[1] == v || n[2] == v; }
  [[nodiscard]] static Index third(const Nodes& n, Index a, Index b) {
    return n[0] != a && n[0] != b ? n[0] : n[1] != a && n[1] != b ? n[1] : n[2];
  }
  [[nodiscard]] static bool in(const std::vector<Index>& list, Index t) {
    return std::find(list.begin(), list.end(), t) != list.end();
  }

  void enter(Index t) {
    for (const Index n : nodes(t)) ring_[at(n)].push_back(t);
    grid_.add(t, triangle(nodes(t)).box());
  }
  void leave(const std::vector<Index>& gone) {
    for (const Index t : gone) {
      grid_.remove(t);
      for (const Index n : nodes(t))
        ring_[at(n)].erase(std::find(ring_[at(n)].begin(), ring_[at(n)].end(), t));
      s_.faces[at(t)] = {-1, -1, -1};
    }
  }
  void put(const std::vector<Made>& made) {
    for (const Made& m : made) {
      s_.faces.push_back(m.nodes), s_.sides.push_back(m.sides);
      enter(triangle_count() - 1);
    }
  }
  void exchange(const std::vector<Index>& gone, const std::vector<Made>& made) { leave(gone), put(made); }

  /// Volumes that regions gain.
  struct Gain {
    Index region;
    double volume;
  };
  using Gains = std::vector<Gain>;

  void add_gains(Gains& gains, const Nodes& n, const Sides& sides, const Vec3& origin, double sign) const {
    const double v = sign * mesh::cone_volume(triangle(n), origin);
    for (std::size_t k = 0; k < 2; ++k) {
      if (sides[k] < 0) continue;
      std::size_t i = 0;
      while (i < gains.size() && gains[i].region != sides[k]) ++i;
      if (i == gains.size()) gains.push_back({sides[k], 0});
      gains[i].volume += k == 0 ? v : -v;
    }
  }
  [[nodiscard]] Gains gains(const std::vector<Made>& made, const Vec3& origin) const {
    Gains list;
    for (const Made& m : made) add_gains(list, m.nodes, m.sides, origin, 1);
    return list;
  }
  [[nodiscard]] Before measure(const std::vector<Index>& gone, Index node = -1) const {
    Before b;
    b.node = node;
    if (node >= 0) b.place = x(node);
    for (const Index t : gone) {
      const mesh::Triangle f = triangle(nodes(t));
      b.angle = std::min(b.angle, f.smallest_angle());
      std::size_t i = 0;
      while (i < b.normals.size() && b.normals[i].sides != s_.sides[at(t)]) ++i;
      if (i == b.normals.size()) b.normals.push_back({s_.sides[at(t)], Vec3(0, 0, 0)});
      b.normals[i].area = vec::plus(b.normals[i].area, f.area_vector());
    }
    return b;
  }

  /// The sharpest fold of the triangles that an edit replaces, where they were.
  [[nodiscard]] double sharpest(const std::vector<Index>& gone, const Before& before) {
    std::vector<Made> old;
    for (const Index t : gone) old.push_back({nodes(t), s_.sides[at(t)]});
    if (before.node < 0) return sharpest(old, gone);
    const Vec3 now = std::exchange(s_.nodes[at(before.node)], before.place);
    const double fold = sharpest(old, gone);
    s_.nodes[at(before.node)] = now;
    return fold;
  }

  /// The smallest angle between sheets at the edges of the triangles, as a cosine; those gone do not count.
  [[nodiscard]] double sharpest(const std::vector<Made>& made, const std::vector<Index>& gone) const {
    double most = -1;
    std::vector<Vec3> away;
    for (std::size_t i = 0; i < made.size(); ++i)
      for (std::size_t k = 0; k < 3; ++k) {
        const Index a = made[i].nodes[k], b = made[i].nodes[(k + 1) % 3];
        const Vec3 axis = vec::unit(vec::minus(x(b), x(a)));
        away.clear();
        const auto add = [&](const Nodes& n) {
          const Vec3 d = vec::minus(x(third(n, a, b)), x(a));
          away.push_back(vec::unit(vec::along(d, -vec::dot(d, axis), axis)));
        };
        add(made[i].nodes);
        for (std::size_t j = i + 1; j < made.size(); ++j)
          if (has(made[j].nodes, a) && has(made[j].nodes, b)) add(made[j].nodes);
        for (const Index t : ring_[at(a)])
          if (has(nodes(t), b) && !in(gone, t)) add(nodes(t));
        for (std::size_t j = 1; j < away.size(); ++j) most = std::max(most, vec::dot(away[0], away[j]));
      }
    return most;
  }

  Interfaces s_;
  TriangleGrid grid_;
  std::vector<std::vector<Index>> ring_;
  std::vector<double> volume_;  // of each region
};

}  // namespace tunica::meshing
