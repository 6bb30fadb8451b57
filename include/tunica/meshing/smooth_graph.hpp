// SPDX-License-Identifier: MIT
// The nodes of a closed surface in the order in which a sweep visits them: by component, by colour (no two
// neighbours have the same), by the number of neighbours; with each the ring of its neighbours in order.
#pragma once

#include "tunica/mesh/adjacency.hpp"
#include "tunica/meshing/lanes.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

namespace tunica::meshing::detail {

/// What a sweep does with a node: move it by its ring alone, look at its bonds and triangles, or leave it.
enum class Visit : std::uint8_t { ring, special, none };

/// Slots first .. first + count of one component, colour and size of ring.
struct RingGroup {
  std::uint32_t first = 0, count = 0;
  std::uint32_t valence = 0;  // neighbours of a node; 0: nodes of Visit::special
  std::size_t ring = 0;       // of ring_slots: pack by pack, neighbour by neighbour, node by node
};

/// Where the groups of a component lie: those of the closing colour come last.
struct ComponentGroups {
  std::size_t begin = 0, closing = 0, end = 0;
};

struct SmoothGraph {
  mesh::Rows around;                      // triangles of a node
  std::vector<std::uint32_t> slot;        // of a node: its place in the order
  std::vector<Index> node;                // of a slot
  std::vector<Index> component;           // of a node; a node without a triangle is one of its own
  std::vector<std::uint32_t> ring_slots;  // times lane_stride
  std::vector<RingGroup> groups;
  std::vector<ComponentGroups> components;
};

inline constexpr std::size_t most_ring = 24;  // neighbours; a node of more is a special one

/// The ring of node n, counter-clockwise seen from outside, into `ring`; false where its triangles are no
/// single closed fan.
[[nodiscard]] inline bool ring_of(const Connectivity<3>& cells, std::span<const Index> triangles, Index n,
                                  Index* ring) {
  const std::size_t k = triangles.size();
  if (k < 3 || k > most_ring) return false;
  std::array<Index, most_ring> from, to;
  for (std::size_t i = 0; i < k; ++i) {
    const Index* t = cells.data() + 3 * static_cast<std::ptrdiff_t>(triangles[i]);
    const int at = t[0] == n ? 0 : t[1] == n ? 1 : 2;
    from[i] = t[(at + 1) % 3], to[i] = t[(at + 2) % 3];
  }
  Index next = from[0];
  for (std::size_t step = 0; step < k; ++step) {
    if (step > 0 && next == from[0]) return false;
    ring[step] = next;
    std::size_t i = 0;
    while (i < k && from[i] != next) ++i;
    if (i == k) return false;
    next = to[i];
  }
  return next == from[0];
}

/// Component of each node, numbered by their first nodes.
[[nodiscard]] inline std::vector<Index> components_of_nodes(const Connectivity<3>& cells, Index node_count) {
  std::vector<Index> parent(static_cast<std::size_t>(node_count));
  std::iota(parent.begin(), parent.end(), Index{0});
  const auto root = [&](Index n) {
    while (parent[static_cast<std::size_t>(n)] != n) {
      auto& up = parent[static_cast<std::size_t>(n)];
      up = parent[static_cast<std::size_t>(up)];
      n = up;
    }
    return n;
  };
  for (Eigen::Index t = 0; t < cells.cols(); ++t) {
    const Index a = root(cells(0, t));
    const Index b = root(cells(1, t));
    const Index c = root(cells(2, t));
    const Index least = std::min(a, std::min(b, c));
    for (const Index r : {a, b, c}) parent[static_cast<std::size_t>(r)] = least;
  }
  Index count = 0;  // a root is the least of its nodes, so it is met first
  for (Index n = 0; n < node_count; ++n) {
    const Index r = parent[static_cast<std::size_t>(n)];
    parent[static_cast<std::size_t>(n)] = r == n ? count++ : parent[static_cast<std::size_t>(r)];
  }
  return parent;
}

/// A colour for each node that moves (-1 for others), none that a neighbour has.
[[nodiscard]] inline std::vector<Index> coloured(const Connectivity<3>& cells, const mesh::Rows& around,
                                                 const std::vector<Visit>& visit) {
  std::vector<Index> colour(visit.size(), -1), seen;
  for (Index n = 0; n < around.size(); ++n) {
    if (visit[static_cast<std::size_t>(n)] == Visit::none) continue;
    for (const Index t : around[n])
      for (int k = 0; k < 3; ++k) {
        const Index c = colour[static_cast<std::size_t>(cells(k, t))];
        if (c >= 0) seen[static_cast<std::size_t>(c)] = n;
      }
    std::size_t free = 0;
    while (free < seen.size() && seen[free] == n) ++free;
    if (free == seen.size()) seen.push_back(-1);
    colour[static_cast<std::size_t>(n)] = static_cast<Index>(free);
  }
  return colour;
}

/// Stable sort of items by key(item) in [0, keys).
template <class Key>
void sort_by(std::vector<Index>& items, std::size_t keys, const Key& key) {
  std::vector<std::uint32_t> at(keys + 1, 0);
  for (const Index i : items) ++at[static_cast<std::size_t>(key(i)) + 1];
  for (std::size_t k = 1; k <= keys; ++k) at[k] += at[k - 1];
  std::vector<Index> sorted(items.size());
  for (const Index i : items) sorted[at[static_cast<std::size_t>(key(i))]++] = i;
  items = std::move(sorted);
}

/// The colour of each component that is visited last and brings the volume back: the largest, so that its
/// offset is the smallest.
[[nodiscard]] inline std::vector<Index> closing_colours(const SmoothGraph& g, const std::vector<Visit>& visit,
                                                        const std::vector<Index>& colour,
                                                        std::size_t components, std::size_t colours) {
  std::vector<double> members(components * colours, 0.0);
  for (std::size_t n = 0; n < visit.size(); ++n) {
    constexpr double little = 1e-9;  // nodes on rims serve where there are no others
    if (visit[n] == Visit::none) continue;
    const auto row = static_cast<std::size_t>(g.component[n]) * colours;
    members[row + static_cast<std::size_t>(colour[n])] += visit[n] == Visit::ring ? 1 : little;
  }
  std::vector<Index> closing(components, 0);
  for (std::size_t c = 0; c < components && colours > 0; ++c) {
    const auto row = members.begin() + static_cast<std::ptrdiff_t>(c * colours);
    closing[c] = static_cast<Index>(std::max_element(row, row + static_cast<std::ptrdiff_t>(colours)) - row);
  }
  return closing;
}

/// The order for a surface. `visit` says what may move at all; nodes of Visit::ring whose triangles are no
/// single closed fan become special.
[[nodiscard]] inline SmoothGraph smooth_graph(const Connectivity<3>& cells, std::vector<Visit> visit) {
  SmoothGraph g;
  const auto count = static_cast<Index>(visit.size());
  const auto at = [](Index i) { return static_cast<std::size_t>(i); };
  g.around = mesh::cells_of_nodes(cells, count);
  g.component = components_of_nodes(cells, count);
  std::vector<Index> rings(g.around.item.size());
  std::vector<std::uint8_t> valence(visit.size(), 0);
  for (Index n = 0; n < count; ++n) {
    if (g.around[n].empty()) visit[at(n)] = Visit::none;
    if (visit[at(n)] != Visit::ring) continue;
    if (ring_of(cells, g.around[n], n, rings.data() + g.around.offset[at(n)]))
      valence[at(n)] = static_cast<std::uint8_t>(g.around[n].size());
    else
      visit[at(n)] = Visit::special;
  }
  const auto most = [](const std::vector<Index>& v) {
    return static_cast<std::size_t>(v.empty() ? 0 : *std::max_element(v.begin(), v.end()) + 1);
  };
  const std::vector<Index> colour = coloured(cells, g.around, visit);
  const std::size_t components = most(g.component), colours = most(colour);
  const auto closing = closing_colours(g, visit, colour, components, colours);
  const auto rank = [&](Index n) {  // the closing colour after all others
    const Index c = colour[at(n)];
    return c == closing[at(g.component[at(n)])] ? static_cast<Index>(colours) : c;
  };
  std::vector<Index> rest;
  for (Index n = 0; n < count; ++n) (visit[at(n)] == Visit::none ? rest : g.node).push_back(n);
  sort_by(g.node, most_ring + 1, [&](Index n) { return valence[at(n)]; });
  sort_by(g.node, colours + 1, rank);
  sort_by(g.node, components, [&](Index n) { return g.component[at(n)]; });
  const std::size_t moving = g.node.size();
  g.node.insert(g.node.end(), rest.begin(), rest.end());
  g.slot.resize(at(count));
  for (std::size_t s = 0; s < g.node.size(); ++s) g.slot[at(g.node[s])] = static_cast<std::uint32_t>(s);

  g.components.resize(components);
  g.ring_slots.reserve(g.around.item.size());
  for (std::size_t s = 0, e = 0; s < moving; s = e) {
    const Index n = g.node[s];
    const auto same = [&](Index m) {
      return g.component[at(m)] == g.component[at(n)] && colour[at(m)] == colour[at(n)] &&
             valence[at(m)] == valence[at(n)];
    };
    for (e = s; e < moving && same(g.node[e]);) ++e;
    ComponentGroups& range = g.components[at(g.component[at(n)])];
    if (range.end == 0) range.begin = range.closing = g.groups.size();
    const std::uint32_t k = valence[at(n)];
    g.groups.push_back(
        {static_cast<std::uint32_t>(s), static_cast<std::uint32_t>(e - s), k, g.ring_slots.size()});
    range.end = g.groups.size();
    if (rank(n) < static_cast<Index>(colours)) range.closing = range.end;
    for (std::size_t b = s; b < e && k > 0;) {
      const std::size_t width = e - b >= widest ? widest : 1;
      for (std::uint32_t i = 0; i < k; ++i)
        for (std::size_t lane = 0; lane < width; ++lane) {
          const auto from = at(g.around.offset[at(g.node[b + lane])]);
          g.ring_slots.push_back(lane_stride * g.slot[at(rings[from + i])]);
        }
      b += width;
    }
  }
  return g;
}

}  // namespace tunica::meshing::detail
