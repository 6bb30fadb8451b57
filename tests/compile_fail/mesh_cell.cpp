// SPDX-License-Identifier: MIT
// SAYS: a cell lists each edge once, from low to high node
#include "tunica/mesh/mesh.hpp"

/// A cell without its table of edges.
struct Pyramid5 {
  static constexpr int dim = 3, nodes = 5, vtk_type = 14;
  using Face = tunica::mesh::Quad4;
  static constexpr int faces = 5;
#ifdef RIGHT
  static constexpr int edges = 8;
#endif
};

tunica::mesh::Mesh<Pyramid5> mesh;
