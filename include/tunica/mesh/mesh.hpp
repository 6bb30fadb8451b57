// SPDX-License-Identifier: MIT
// Mesh<Cell, Dim>: nodes, cells, named regions of cells and named patches of boundary faces.
#pragma once

#include "tunica/core/error.hpp"
#include "tunica/core/types.hpp"
#include "tunica/mesh/cell.hpp"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace tunica::mesh {

/// A named set of boundary faces, oriented outward: one column a face, global node numbers.
template <class Face>
struct Patch {
  std::string name;
  Connectivity<Face::nodes> faces;  // Face::nodes x n
};

template <Cell C, int Dim = 3>
struct Mesh {
  using cell_type = C;
  static constexpr int dim = Dim;

  Points<Dim> nodes;             // Dim x nodes, in the unit of its source ([m] for the solvers)
  Connectivity<C::nodes> cells;  // C::nodes x cells
  std::vector<Index> region;     // one label a cell, an index of region_names; empty: one region
  std::vector<std::string> region_names;
  std::vector<Patch<typename C::Face>> patches;

  [[nodiscard]] Index node_count() const { return static_cast<Index>(nodes.cols()); }
  [[nodiscard]] Index cell_count() const { return static_cast<Index>(cells.cols()); }
  [[nodiscard]] Index region_of(Index cell) const {
    return region.empty() ? 0 : region[static_cast<std::size_t>(cell)];
  }

  /// The patch of that name; MeshError with the names there are when there is none.
  [[nodiscard]] const Patch<typename C::Face>& patch(std::string_view name) const {
    std::string known;
    for (const auto& p : patches) {
      if (p.name == name) return p;
      known += (known.empty() ? "" : ", ") + p.name;
    }
    throw MeshError("no patch named \"" + std::string(name) + "\"; there are: " + known);
  }
};

/// A surface of triangles. Its regions become the patches of the volume that it bounds:
/// "wall" first, then the cuts in their order, then the borders of the image.
using Surface = Mesh<Tri3, 3>;
using QuadSurface = Mesh<Quad4, 3>;
using TetMesh = Mesh<Tet4, 3>;
using HexMesh = Mesh<Hex8, 3>;

}  // namespace tunica::mesh
