// SPDX-License-Identifier: MIT
// Hermite data: the signs at the nodes of a rectilinear grid, and point, normal and region where the
// surface crosses an edge of it. [JU02, 2]
#pragma once

#include "tunica/core/error.hpp"
#include "tunica/core/expect.hpp"
#include "tunica/core/types.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace tunica::meshing {

/// Where the surface crosses an edge of the grid; the normal is a unit vector that points outward.
struct Crossing {
  Vec3 point, normal;
  Index region = 0;
};

/// A part of the surface. A flat one lies in the plane through `point`: it stays there exactly.
struct HermiteRegion {
  std::string name = "wall";
  bool flat = false;
  Vec3 point{0, 0, 0}, normal{0, 0, 0};
};

/// An edge is 3 * node + axis: it leads from the node to the next one along the axis. Every edge with
/// two signs has one crossing, no other has; all nodes on the border of the grid are outside.
struct HermiteGrid {
  std::array<std::vector<double>, 3> axes;  // strictly increasing
  std::vector<std::uint8_t> inside;         // nx*ny*nz, x fastest
  std::vector<std::size_t> edges;           // ascending
  std::vector<Crossing> crossings;          // one an edge
  std::vector<HermiteRegion> regions;

  [[nodiscard]] std::size_t size(std::size_t axis) const { return axes[axis].size(); }
  [[nodiscard]] std::array<std::size_t, 3> strides() const { return {1, size(0), size(0) * size(1)}; }
  [[nodiscard]] std::array<std::size_t, 3> position(std::size_t node) const {
    return {node % size(0), node / size(0) % size(1), node / size(0) / size(1)};
  }
  [[nodiscard]] Vec3 point(std::size_t node) const {
    const auto p = position(node);
    return {axes[0][p[0]], axes[1][p[1]], axes[2][p[2]]};
  }
};

/// Crossings keep this share of an edge from its nodes, so that no two of them coincide.
inline constexpr double crossing_margin = 1e-4;

namespace detail {

/// Calls visit(edge, node, other, axis) for the edges with two signs, in ascending order.
template <class Visit>
void for_crossed_edges(const HermiteGrid& grid, Visit&& visit) {
  const auto stride = grid.strides();
  std::size_t node = 0;
  for (std::size_t k = 0; k < grid.size(2); ++k)
    for (std::size_t j = 0; j < grid.size(1); ++j)
      for (std::size_t i = 0; i < grid.size(0); ++i, ++node) {
        const std::array<bool, 3> last{i + 1 == grid.size(0), j + 1 == grid.size(1), k + 1 == grid.size(2)};
        for (std::size_t a = 0; a < 3; ++a)
          if (!last[a] && grid.inside[node] != grid.inside[node + stride[a]])
            visit(3 * node + a, node, node + stride[a], a);
      }
}

}  // namespace detail

}  // namespace tunica::meshing
