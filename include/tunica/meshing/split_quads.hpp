// SPDX-License-Identifier: MIT
// Quadrilaterals cut into triangles along the diagonal that leaves the larger smallest angle.
#pragma once

#include "tunica/core/vec.hpp"
#include "tunica/mesh/mesh.hpp"
#include "tunica/mesh/triangle.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace tunica::meshing {

/// Two triangles a quadrilateral, with its orientation and its region. Triangles 2q and 2q+1 are those of q.
[[nodiscard]] inline mesh::Surface split_quads(const mesh::QuadSurface& quads) {
  static constexpr std::array<std::array<int, 6>, 2> ways{{{0, 1, 2, 0, 2, 3}, {1, 2, 3, 1, 3, 0}}};
  mesh::Surface surface;
  surface.nodes = quads.nodes;
  surface.cells.resize(3, 2 * quads.cells.cols());
  surface.region_names = quads.region_names;
  for (Index q = 0; q < quads.cell_count(); ++q) {
    const auto corner = [&](int k) { return vec::column(quads.nodes, quads.cells(k, q)); };
    std::array<double, 2> angle{};
    for (std::size_t w = 0; w < 2; ++w) {
      const auto& k = ways[w];
      const mesh::Triangle first{corner(k[0]), corner(k[1]), corner(k[2])},
          second{corner(k[3]), corner(k[4]), corner(k[5])};
      angle[w] = std::min(first.smallest_angle(), second.smallest_angle());
    }
    const auto& k = ways[angle[1] > angle[0] ? 1 : 0];
    for (int n = 0; n < 6; ++n)
      surface.cells(n % 3, 2 * q + n / 3) = quads.cells(k[static_cast<std::size_t>(n)], q);
    if (!quads.region.empty()) surface.region.insert(surface.region.end(), 2, quads.region_of(q));
  }
  return surface;
}

}  // namespace tunica::meshing
