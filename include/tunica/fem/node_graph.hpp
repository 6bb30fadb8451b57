// SPDX-License-Identifier: MIT
// Which nodes of a mesh share a cell: the sparsity pattern of everything that is assembled on it.
#pragma once

#include "tunica/core/error.hpp"
#include "tunica/core/expect.hpp"
#include "tunica/core/types.hpp"

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

namespace tunica::fem {

/// Which nodes share a cell with which, in compressed columns, each ascending and with the node itself.
struct NodeGraph {
  std::vector<Index> start;  // node count + 1
  std::vector<Index> neighbour;

  [[nodiscard]] Index degree(Index node) const {
    return start[static_cast<std::size_t>(node) + 1] - start[static_cast<std::size_t>(node)];
  }
  /// Place of the pair in `neighbour`; the two nodes share a cell.
  [[nodiscard]] Index find(Index row, Index column) const {
    const auto begin = neighbour.begin() + start[static_cast<std::size_t>(column)];
    const auto end = neighbour.begin() + start[static_cast<std::size_t>(column) + 1];
    const auto it = std::lower_bound(begin, end, row);
    TUNICA_EXPECT(it != end && *it == row, "the two nodes share no cell");
    return static_cast<Index>(it - neighbour.begin());
  }
};

namespace detail {
/// MeshError names the first cell with a node that is not there.
template <int Nodes>
void require_nodes(const Connectivity<Nodes>& cells, Index node_count) {
  const auto missing = [&](Index n) { return n < 0 || n >= node_count; };
  const Index* const end = cells.data() + cells.size();
  const Index* const found = std::find_if(cells.data(), end, missing);
  if (found != end)
    throw MeshError("cell " + std::to_string((found - cells.data()) / Nodes) + " names node " +
                    std::to_string(*found) + "; the mesh has " + std::to_string(node_count));
}
}  // namespace detail

/// The graph of a mesh. MeshError names the first cell with a node that the mesh does not have.
template <int Nodes>
[[nodiscard]] NodeGraph node_graph(const Connectivity<Nodes>& cells, Index node_count) {
  detail::require_nodes(cells, node_count);
  const auto n = static_cast<std::size_t>(node_count);
  std::vector<Index> first(n + 1, 0), cell_of(static_cast<std::size_t>(cells.size()));
  for (Eigen::Index k = 0; k < cells.size(); ++k) ++first[static_cast<std::size_t>(cells.data()[k]) + 1];
  for (std::size_t i = 0; i < n; ++i) first[i + 1] += first[i];
  std::vector<Index> fill(first.begin(), first.end() - 1);
  for (Eigen::Index e = 0; e < cells.cols(); ++e)
    for (int a = 0; a < Nodes; ++a)
      cell_of[static_cast<std::size_t>(fill[static_cast<std::size_t>(cells(a, e))]++)] =
          static_cast<Index>(e);
  NodeGraph graph;
  graph.start.assign(n + 1, 0);
  graph.neighbour.reserve(n + static_cast<std::size_t>(cells.size()) * (Nodes > 4 ? 2 : 1));
  std::vector<Index> around, seen_from(n, -1);  // the node whose neighbour it was found to be last
  for (std::size_t i = 0; i < n; ++i) {
    const auto node = static_cast<Index>(i);
    around.assign(1, node);
    seen_from[i] = node;
    for (Index k = first[i]; k < first[i + 1]; ++k) {
      const Index* const corner = cells.data() + std::ptrdiff_t{Nodes} * cell_of[static_cast<std::size_t>(k)];
      for (int a = 0; a < Nodes; ++a) {
        Index& seen = seen_from[static_cast<std::size_t>(corner[a])];
        if (seen != node) around.push_back(corner[a]);
        seen = node;
      }
    }
    std::sort(around.begin(), around.end());
    graph.neighbour.insert(graph.neighbour.end(), around.begin(), around.end());
    graph.start[i + 1] = static_cast<Index>(graph.neighbour.size());
  }
  return graph;
}

/// Keeps of each node the neighbours from itself on: the upper triangle of a symmetric pattern.
inline void keep_upper(NodeGraph& graph) {
  std::size_t kept = 0;
  Index begin = 0;
  for (std::size_t i = 0; i + 1 < graph.start.size(); ++i) {
    const Index end = graph.start[i + 1];
    for (Index k = begin; k < end; ++k)
      if (const Index j = graph.neighbour[static_cast<std::size_t>(k)]; j >= static_cast<Index>(i))
        graph.neighbour[kept++] = j;
    begin = end;
    graph.start[i + 1] = static_cast<Index>(kept);
  }
  graph.neighbour.resize(kept);
}

}  // namespace tunica::fem
