// SPDX-License-Identifier: MIT
// The patches of a volume mesh as one surface, for a file.
#pragma once

#include "tunica/mesh/mesh.hpp"

#include <cstddef>
#include <vector>

namespace tunica::examples {

/// Triangles of tetrahedra, quadrilaterals of hexahedra; regions are the patches in their order.
template <class Cell>
[[nodiscard]] auto surface_of_patches(const mesh::Mesh<Cell, 3>& volume) {
  using Face = typename Cell::Face;
  mesh::Mesh<Face, 3> s;
  Eigen::Index faces = 0;
  for (const auto& p : volume.patches) faces += p.faces.cols();
  s.cells.resize(Face::nodes, faces);
  std::vector<Index> number(static_cast<std::size_t>(volume.node_count()), -1), nodes;
  Eigen::Index at = 0;
  for (const auto& p : volume.patches) {
    for (Eigen::Index f = 0; f < p.faces.cols(); ++f, ++at) {
      for (Eigen::Index k = 0; k < Face::nodes; ++k) {
        Index& n = number[static_cast<std::size_t>(p.faces(k, f))];
        if (n < 0) n = static_cast<Index>(nodes.size()), nodes.push_back(p.faces(k, f));
        s.cells(k, at) = n;
      }
      s.region.push_back(static_cast<Index>(s.region_names.size()));
    }
    s.region_names.push_back(p.name);
  }
  s.nodes.resize(3, static_cast<Eigen::Index>(nodes.size()));
  for (std::size_t n = 0; n < nodes.size(); ++n)
    s.nodes.col(static_cast<Eigen::Index>(n)) = volume.nodes.col(nodes[n]);
  return s;
}

}  // namespace tunica::examples
