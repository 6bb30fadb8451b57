// SPDX-License-Identifier: MIT
// Where the handles of a closed surface are: a short non-separating cycle for each, by tree and cotree
// [ERICKSON05], the surface being cut along each cycle found before the next is sought.
#pragma once

#include "tunica/core/error.hpp"
#include "tunica/mesh/topology.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <numeric>
#include <queue>
#include <utility>
#include <vector>

namespace tunica::meshing {

/// One handle: a closed path of edges round its narrowest part.
struct Handle {
  Vec3 place = Vec3::Zero();  // centre of the cycle
  double length = 0;          // of the cycle, in the unit of the surface
};

namespace detail {

/// A surface that is cut open along cycles and closed again by cones, whose edges are too long to be used.
class HandleSearch {
 public:
  explicit HandleSearch(const mesh::Surface& s) : surface_(s), cone_from_(s.node_count()) {
    for (Index h = 0; h < 3 * s.cell_count(); ++h) detour_ += length(mesh::half_edge(s.cells, h));
  }

  struct Cycle {
    std::vector<Index> nodes;
    double length = std::numeric_limits<double>::infinity();
  };

  /// A non-separating cycle: of those through the roots the shortest, moved on to the shortest through
  /// its own nodes while that gets shorter; none on a sphere.
  [[nodiscard]] Cycle shortest(const std::vector<Index>& roots) {
    twin_ = mesh::twins(surface_.cells, surface_.node_count());
    around_ = mesh::cells_of_nodes(surface_.cells, surface_.node_count());
    Cycle best;
    for (const Index root : roots)
      if (Cycle c = through(root); c.length < best.length) best = std::move(c);
    constexpr int most_moves = 16;
    for (int n = 0; n < most_moves && !best.nodes.empty(); ++n) {
      Cycle c = through(best.nodes[best.nodes.size() / 2]);
      if (!(c.length < best.length * (1 - 1e-9))) break;
      best = std::move(c);
    }
    return best;
  }

  /// Opens the surface along the cycle: the genus falls by one.
  void cut(const Cycle& cycle) {
    const auto m = static_cast<Index>(cycle.nodes.size());
    const Index first_copy = surface_.node_count(), left_cone = first_copy + m, right_cone = left_cone + 1;
    std::vector<std::pair<Index, Index>> renamed;  // (corner 3 t + k, new node)
    Vec3 centre = Vec3::Zero();
    for (Index i = 0; i < m; ++i) {
      const Index node = at(cycle.nodes, i), to = at(cycle.nodes, (i + 1) % m),
                  from = at(cycle.nodes, (i + m - 1) % m);
      centre += surface_.nodes.col(node) / m;
      Index h = half_edge_to(node, to);  // its triangle is on the left; go round to the edge of `from`
      for (;;) {
        renamed.emplace_back(h, first_copy + i);
        const Index back = mesh::previous_in_triangle(h);
        if (mesh::half_edge(surface_.cells, back).from == from) break;
        h = twin_[static_cast<std::size_t>(back)];
      }
    }
    for (const auto& [corner, node] : renamed) surface_.cells(corner % 3, corner / 3) = node;
    surface_.nodes.conservativeResize(3, right_cone + 1);
    Index t = surface_.cell_count();
    surface_.cells.conservativeResize(3, t + 2 * m);
    for (Index i = 0; i < m; ++i) {
      const Index j = (i + 1) % m;
      surface_.nodes.col(first_copy + i) = surface_.nodes.col(at(cycle.nodes, i));
      surface_.cells.col(t++) << first_copy + j, first_copy + i, left_cone;
      surface_.cells.col(t++) << at(cycle.nodes, i), at(cycle.nodes, j), right_cone;
    }
    surface_.nodes.col(left_cone) = surface_.nodes.col(right_cone) = centre;
    cones_.resize(static_cast<std::size_t>(right_cone + 1 - cone_from_), 0);
    cones_[static_cast<std::size_t>(left_cone - cone_from_)] =
        cones_[static_cast<std::size_t>(right_cone - cone_from_)] = 1;
  }

  [[nodiscard]] Vec3 position(Index n) const { return surface_.nodes.col(n); }

 private:
  [[nodiscard]] static Index at(const std::vector<Index>& v, Index i) {
    return v[static_cast<std::size_t>(i)];
  }

  [[nodiscard]] Index half_edge_to(Index node, Index to) const {
    for (const Index t : around_[node])
      for (Index h = 3 * t; h < 3 * t + 3; ++h)
        if (const auto e = mesh::half_edge(surface_.cells, h); e.from == node && e.to == to) return h;
    throw MeshError("the surface is not a closed manifold: its handles cannot be found");
  }

  [[nodiscard]] bool cone(Index n) const {
    return n >= cone_from_ && cones_[static_cast<std::size_t>(n - cone_from_)] != 0;
  }

  [[nodiscard]] double length(mesh::HalfEdge e) const {
    if (cone(e.from) || cone(e.to)) return detour_;
    return (surface_.nodes.col(e.to) - surface_.nodes.col(e.from)).norm();
  }

  /// The shortest of the 2 g cycles of the edges that are in neither tree nor cotree.
  [[nodiscard]] Cycle through(Index root) const {
    const auto n = static_cast<std::size_t>(surface_.node_count());
    std::vector<double> distance(n, std::numeric_limits<double>::infinity());
    std::vector<Index> parent(n, -1);
    using Entry = std::pair<double, Index>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    distance[static_cast<std::size_t>(root)] = 0;
    queue.push({0, root});
    while (!queue.empty()) {
      const auto [d, u] = queue.top();
      queue.pop();
      if (d > distance[static_cast<std::size_t>(u)]) continue;
      for (const Index t : around_[u])
        for (Index h = 3 * t; h < 3 * t + 3; ++h) {
          const auto e = mesh::half_edge(surface_.cells, h);
          if (e.from != u) continue;
          const auto v = static_cast<std::size_t>(e.to);
          if (const double dv = d + length(e); dv < distance[v])
            distance[v] = dv, parent[v] = u, queue.push({dv, e.to});
        }
    }
    struct Edge {
      double loop;
      Index h;
    };
    std::vector<Edge> edges;  // off the tree, reached from the root
    for (Index h = 0; h < static_cast<Index>(twin_.size()); ++h) {
      const auto e = mesh::half_edge(surface_.cells, h);
      const auto u = static_cast<std::size_t>(e.from), v = static_cast<std::size_t>(e.to);
      if (twin_[static_cast<std::size_t>(h)] < h || parent[u] == e.to || parent[v] == e.from) continue;
      if (distance[u] < std::numeric_limits<double>::infinity())
        edges.push_back({distance[u] + distance[v] + length(e), h});
    }
    std::sort(edges.begin(), edges.end(),
              [](const Edge& p, const Edge& q) { return p.loop != q.loop ? p.loop > q.loop : p.h < q.h; });
    std::vector<Index> set(static_cast<std::size_t>(surface_.cell_count()));  // cotree: longest loops first
    std::iota(set.begin(), set.end(), Index{0});
    const auto find = [&](Index t) {
      while (at(set, t) != t) t = set[static_cast<std::size_t>(t)] = at(set, at(set, t));
      return t;
    };
    Cycle best;
    for (const Edge& e : edges) {
      const Index p = find(e.h / 3), q = find(twin_[static_cast<std::size_t>(e.h)] / 3);
      if (p != q) {
        set[static_cast<std::size_t>(p)] = q;
        continue;
      }
      Cycle c = trimmed(e.h, parent);
      if (c.length < best.length) best = std::move(c);
    }
    return best;
  }

  /// The edge and the paths from its ends to where they meet.
  [[nodiscard]] Cycle trimmed(Index h, const std::vector<Index>& parent) const {
    const auto e = mesh::half_edge(surface_.cells, h);
    const auto path = [&](Index n) {
      std::vector<Index> p;
      for (; n >= 0; n = at(parent, n)) p.push_back(n);
      return p;
    };
    std::vector<Index> p = path(e.from), q = path(e.to);
    while (p.size() > 1 && q.size() > 1 && p[p.size() - 2] == q[q.size() - 2]) p.pop_back(), q.pop_back();
    Cycle c;
    c.nodes.assign(p.rbegin(), p.rend());                   // from the meeting point to e.from
    c.nodes.insert(c.nodes.end(), q.begin(), q.end() - 1);  // from e.to back, the meeting point left out
    c.length = 0;
    for (std::size_t i = 0; i < c.nodes.size(); ++i)
      c.length += length({c.nodes[i], c.nodes[(i + 1) % c.nodes.size()]});
    return c;
  }

  mesh::Surface surface_;
  double detour_ = 0;  // longer than any path that keeps off the cones, in the unit of the surface
  Index cone_from_;
  std::vector<char> cones_;
  std::vector<Index> twin_;
  mesh::Rows around_;
};

}  // namespace detail

/// The handles of a closed surface, component by component, at most `limit`: O(n log n) each. The topology
/// report gives their true number (genus).
[[nodiscard]] inline std::vector<Handle> handles(const mesh::Surface& s, const mesh::Topology& t,
                                                 std::size_t limit = 16) {
  if (!t.closed())
    throw MeshError("handles are sought on a closed surface; this one has open or non-manifold edges");
  std::vector<Handle> found;
  detail::HandleSearch search(s);
  for (Index c = 0; c < static_cast<Index>(t.components.size()); ++c) {
    const Index genus = t.components[static_cast<std::size_t>(c)].genus();
    std::vector<Index> own;
    for (Index f = 0; f < s.cell_count(); ++f)
      if (t.component_of[static_cast<std::size_t>(f)] == c) own.push_back(s.cells(0, f));
    constexpr std::size_t most_roots = 16;  // spread over the component, so that the thin part is near one
    std::vector<Index> roots;
    for (std::size_t r = 0; r < most_roots; ++r) roots.push_back(own[r * own.size() / most_roots]);
    for (Index g = 0; g < genus && found.size() < limit; ++g) {
      const auto cycle = search.shortest(roots);
      if (cycle.nodes.empty()) break;
      Handle h{.length = cycle.length};
      for (const Index n : cycle.nodes)
        h.place += search.position(n) / static_cast<double>(cycle.nodes.size());
      found.push_back(h);
      search.cut(cycle);
    }
  }
  return found;
}

}  // namespace tunica::meshing
