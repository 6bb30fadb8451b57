// SPDX-License-Identifier: MIT
// Hexahedra whose border is a dual contour, with layers laid between the lattice and the surface: what a
// mesh of them is before its nodes find their places.
#pragma once

#include "tunica/mesh/mesh.hpp"

#include <array>
#include <cstddef>
#include <vector>

namespace tunica::meshing {

/// Where a node may be: inside, on a facet of the surface, on the rim that two share, or at a corner.
struct HexSite {
  Index facet = -1, other = -1;  // other: the second facet of a rim
  bool corner = false;           // where more than two meet: it stays

  [[nodiscard]] bool inside() const { return facet < 0; }
  [[nodiscard]] bool rim() const { return other >= 0; }
};

struct HexComplex {
  std::vector<Vec3> nodes;
  std::vector<std::array<Index, 8>> cells;
  std::vector<HexSite> sites;                // of the nodes
  std::vector<std::array<Index, 4>> border;  // faces, outward
  std::vector<Index> facet;                  // of the faces of the border
  Index lattice_cells = 0;                   // they come first, the layers after them
};

namespace detail {

/// The corners of Hex8 as offsets along the axes of a grid.
inline constexpr std::array<std::array<std::size_t, 3>, 8> hex_offsets{
    {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}};

}  // namespace detail

}  // namespace tunica::meshing
