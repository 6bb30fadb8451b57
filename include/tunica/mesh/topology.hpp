// SPDX-License-Identifier: MIT
// Topology of a triangle surface: open and non-manifold places, components with their genus, boundary loops.
// Euler's formula: V - E + F = 2 - 2 g - b for each component with b boundary loops.
#pragma once

#include "tunica/mesh/adjacency.hpp"
#include "tunica/mesh/measures.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

namespace tunica::mesh {

/// A closed chain of open edges, run with the surface on its left.
struct BoundaryLoop {
  std::vector<Index> nodes;  // as many as edges
  Vec3 centre{0, 0, 0};
  double length = 0;
  Index component = 0;
};

/// A set of triangles joined by edges.
struct Component {
  Index nodes = 0, edges = 0, triangles = 0, loops = 0;
  double volume = 0;     // enclosed, signed; of no meaning when loops > 0
  Vec3 centre{0, 0, 0};  // mean of the centroids of its triangles
  [[nodiscard]] Index euler() const { return nodes - edges + triangles; }
  [[nodiscard]] Index genus() const { return (2 - loops - euler()) / 2; }
};

struct [[nodiscard]] Topology {
  Index nodes = 0, edges = 0, triangles = 0;  // nodes in use
  Index unused_nodes = 0;
  Index open_edges = 0;               // of one triangle
  Index nonmanifold_edges = 0;        // of more than two
  Index misoriented_edges = 0;        // of two triangles that run it the same way
  Index nonmanifold_nodes = 0;        // whose triangles are not one fan (two surfaces touch there)
  std::vector<Component> components;  // in the order of their first triangle
  std::vector<Index> component_of;    // of each triangle
  std::vector<BoundaryLoop> loops;    // in the order of their first half-edge; only of manifold surfaces

  [[nodiscard]] bool manifold() const { return nonmanifold_edges + nonmanifold_nodes == 0; }
  [[nodiscard]] bool oriented() const { return misoriented_edges == 0; }
  /// A boundary of a volume: closed, manifold, oriented.
  [[nodiscard]] bool closed() const { return triangles > 0 && open_edges == 0 && manifold() && oriented(); }
  [[nodiscard]] Index euler() const { return nodes - edges + triangles; }
  [[nodiscard]] Index genus() const {
    Index g = 0;
    for (const Component& c : components) g += c.genus();
    return g;
  }
};

namespace detail {

/// Number of fans of triangles around node n: sets joined by edges at n.
[[nodiscard]] inline Index fans(const Connectivity<3>& cells, const Rows& around,
                                const std::vector<Index>& twin, Index n) {
  const auto ring = around[n];
  std::vector<Index> parent(ring.size());
  std::iota(parent.begin(), parent.end(), Index{0});
  const auto root = [&](Index i) {
    while (parent[static_cast<std::size_t>(i)] != i) i = parent[static_cast<std::size_t>(i)];
    return i;
  };
  auto sets = static_cast<Index>(ring.size());
  for (Index i = 0; i < static_cast<Index>(ring.size()); ++i)
    for (Index h = 3 * ring[static_cast<std::size_t>(i)], end = h + 3; h < end; ++h) {
      const auto [from, to] = half_edge(cells, h);
      if ((from != n && to != n) || twin[static_cast<std::size_t>(h)] < 0) continue;
      const Index across = twin[static_cast<std::size_t>(h)] / 3;
      const auto j = static_cast<Index>(std::lower_bound(ring.begin(), ring.end(), across) - ring.begin());
      const Index a = root(i), b = root(j);
      if (a != b) parent[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b), --sets;
    }
  return sets;
}

/// Chains of open half-edges of a manifold surface.
[[nodiscard]] inline std::vector<BoundaryLoop> boundary_loops(const Surface& s,
                                                              const std::vector<Index>& twin,
                                                              const std::vector<Index>& component_of) {
  std::vector<Index> leaves(static_cast<std::size_t>(s.node_count()),
                            -1);  // open half-edge that leaves a node
  for (Index h = 0; h < static_cast<Index>(twin.size()); ++h)
    if (twin[static_cast<std::size_t>(h)] == open_edge)
      leaves[static_cast<std::size_t>(half_edge(s.cells, h).from)] = h;
  std::vector<BoundaryLoop> loops;
  std::vector<char> done(twin.size(), 0);
  for (Index first = 0; first < static_cast<Index>(twin.size()); ++first) {
    if (twin[static_cast<std::size_t>(first)] != open_edge || done[static_cast<std::size_t>(first)]) continue;
    BoundaryLoop loop;
    loop.component = component_of[static_cast<std::size_t>(first / 3)];
    for (Index h = first; h >= 0 && !done[static_cast<std::size_t>(h)];) {
      done[static_cast<std::size_t>(h)] = 1;
      const auto [from, to] = half_edge(s.cells, h);
      const Vec3 x = node(s, from), y = node(s, to);
      const double l = vec::distance(x, y);
      loop.nodes.push_back(from);
      loop.centre = vec::along(loop.centre, 0.5 * l, vec::plus(x, y));
      loop.length += l;
      h = leaves[static_cast<std::size_t>(to)];
    }
    if (loop.length > 0) loop.centre = vec::divided(loop.centre, loop.length);
    loops.push_back(std::move(loop));
  }
  return loops;
}

}  // namespace detail

/// Counts everything that can be wrong with a surface, and what it is: O(n).
[[nodiscard]] inline Topology topology(const Surface& s) {
  Topology r;
  const Rows around = cells_of_nodes(s.cells, s.node_count());
  const std::vector<Index> twin = twins(s.cells, s.node_count());
  const auto index = [](Index i) { return static_cast<std::size_t>(i); };
  r.triangles = s.cell_count();

  // components: triangles joined over any shared edge that has a twin
  r.component_of.assign(index(r.triangles), -1);
  std::vector<Index> stack;
  for (Index seed = 0; seed < r.triangles; ++seed) {
    if (r.component_of[index(seed)] >= 0) continue;
    const auto label = static_cast<Index>(r.components.size());
    r.components.emplace_back();
    stack.assign(1, seed);
    r.component_of[index(seed)] = label;
    while (!stack.empty()) {
      const Index t = stack.back();
      stack.pop_back();
      for (Index h = 3 * t; h < 3 * t + 3; ++h)
        if (const Index g = twin[index(h)]; g >= 0 && r.component_of[index(g / 3)] < 0)
          r.component_of[index(g / 3)] = label, stack.push_back(g / 3);
    }
  }

  // edges: each counted once at its first half-edge
  for (Index h = 0; h < 3 * r.triangles; ++h) {
    const Index g = twin[index(h)];
    bool first = g == open_edge || g > h;
    if (g == nonmanifold_edge || g == misoriented_edge) {
      const auto [from, to] = half_edge(s.cells, h);
      first = true;
      for (const Index t : around[from])
        for (Index f = 3 * t; f < 3 * t + 3 && f < h; ++f) {
          const auto [p, q] = half_edge(s.cells, f);
          if ((p == from && q == to) || (p == to && q == from)) first = false;
        }
    }
    if (!first) continue;
    ++r.edges, ++r.components[index(r.component_of[index(h / 3)])].edges;
    r.open_edges += g == open_edge;
    r.nonmanifold_edges += g == nonmanifold_edge;
    r.misoriented_edges += g == misoriented_edge;
  }

  const Vec3 o = s.node_count() > 0 ? bounding_box(s.nodes).centre() : Vec3(0, 0, 0);
  for (Index t = 0; t < r.triangles; ++t) {
    Component& c = r.components[index(r.component_of[index(t)])];
    const Triangle f = triangle(s, t);
    ++c.triangles;
    c.centre = vec::plus(c.centre, f.centroid());
    c.volume += cone_volume(f, o);
  }
  for (Component& c : r.components) c.centre = vec::divided(c.centre, c.triangles);
  for (Index n = 0; n < s.node_count(); ++n) {
    const auto ring = around[n];
    if (ring.empty()) {
      ++r.unused_nodes;
      continue;
    }
    ++r.nodes;
    Index last = -1;  // a node where components touch counts for each of them
    std::vector<Index> labels;
    for (const Index t : ring)
      if (const Index l = r.component_of[index(t)]; l != last) labels.push_back(last = l);
    std::sort(labels.begin(), labels.end());
    labels.erase(std::unique(labels.begin(), labels.end()), labels.end());
    for (const Index l : labels) ++r.components[index(l)].nodes;
    r.nonmanifold_nodes += detail::fans(s.cells, around, twin, n) > 1;
  }

  if (r.manifold() && r.oriented() && r.open_edges > 0) {
    r.loops = detail::boundary_loops(s, twin, r.component_of);
    for (const BoundaryLoop& l : r.loops) ++r.components[index(l.component)].loops;
  }
  return r;
}

}  // namespace tunica::mesh
