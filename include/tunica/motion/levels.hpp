// SPDX-License-Identifier: MIT
// Mesh motion by levels: the displacement of the wall is handed inward from node to node. [PEREZ08, 6.1 b]
#pragma once

#include "tunica/core/expect.hpp"
#include "tunica/fem/assembly.hpp"
#include "tunica/mesh/mesh.hpp"
#include "tunica/mesh/patch_nodes.hpp"

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace tunica::motion {

struct LevelsOptions {
  std::string wall = "wall";  // the patch that moves
  int sweeps = 20;            // of Laplacian smoothing after the diffusion by levels
};

/// Level 0 is the wall, level l the nodes connected to level l-1. Going inward a node takes the mean
/// of its neighbours of the level before; that is scaled down linearly to the last level, and smoothed.
/// The other patches stay. No equation is solved: cheap, less smooth than Laplace.
class Levels {
 public:
  explicit Levels(const mesh::TetMesh& mesh, LevelsOptions options = {})
      : wall_(mesh::patch_nodes(mesh.patch(options.wall))),
        graph_(fem::node_graph<4>(mesh.cells, mesh.node_count())),
        level_(static_cast<std::size_t>(mesh.node_count()), -1),
        held_(level_.size(), 0),
        sweeps_(options.sweeps) {
    for (const auto& patch : mesh.patches)
      for (const Index n : mesh::patch_nodes(patch)) held_[static_cast<std::size_t>(n)] = 1;
    std::vector<Index> front = wall_;
    for (const Index n : wall_) level_[static_cast<std::size_t>(n)] = 0;
    for (int l = 1; !front.empty(); ++l) {
      std::vector<Index> next;
      for (const Index n : front)
        for_neighbours(n, [&](Index m) {
          int& level = level_[static_cast<std::size_t>(m)];
          if (level < 0) level = l, next.push_back(m);
        });
      std::sort(next.begin(), next.end());
      for (const Index n : next) order_.push_back(n);
      front = std::move(next);
      if (!front.empty()) last_ = l;
    }
  }

  /// Displacements of the wall's nodes (3 x wall nodes, ascending) to those of all nodes (3 x nodes) [m].
  [[nodiscard]] Points<3> extend(const Points<3>& wall_displacement) const {
    TUNICA_EXPECT(wall_displacement.cols() == static_cast<Eigen::Index>(wall_.size()),
                  "one column a wall node");
    Points<3> d = Points<3>::Zero(3, static_cast<Eigen::Index>(level_.size()));
    for (std::size_t k = 0; k < wall_.size(); ++k)
      d.col(wall_[k]) = wall_displacement.col(static_cast<Eigen::Index>(k));
    for (const Index n : order_) {
      Vec3 sum = Vec3::Zero();
      int count = 0;
      for_neighbours(n, [&](Index m) {
        if (level_[static_cast<std::size_t>(m)] == level_[static_cast<std::size_t>(n)] - 1)
          sum += d.col(m), ++count;
      });
      d.col(n) = sum / count;
    }
    for (const Index n : order_)
      d.col(n) *= held(n) ? 0.0 : 1 - double(level_[static_cast<std::size_t>(n)]) / (last_ + 1);
    for (int s = 0; s < sweeps_; ++s)
      for (const Index n : order_) {
        if (held(n)) continue;
        Vec3 sum = Vec3::Zero();
        int count = 0;
        for_neighbours(n, [&](Index m) { sum += d.col(m), ++count; });
        d.col(n) = sum / count;
      }
    return d;
  }

  [[nodiscard]] const std::vector<Index>& wall_nodes() const { return wall_; }  // ascending

 private:
  [[nodiscard]] bool held(Index n) const { return held_[static_cast<std::size_t>(n)] != 0; }

  template <class Body>
  void for_neighbours(Index n, Body&& body) const {
    const auto i = static_cast<std::size_t>(n);
    for (Index k = graph_.start[i]; k < graph_.start[i + 1]; ++k)
      if (const Index m = graph_.neighbour[static_cast<std::size_t>(k)]; m != n) body(m);
  }

  std::vector<Index> wall_, order_;  // order_: the nodes inside, level by level
  fem::NodeGraph graph_;
  std::vector<int> level_;
  std::vector<char> held_;  // nodes of any patch
  int sweeps_;
  int last_ = 0;
};

}  // namespace tunica::motion
