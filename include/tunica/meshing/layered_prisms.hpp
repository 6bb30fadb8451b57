// SPDX-License-Identifier: MIT
// layered_prisms(surface, fill): boundary layers kept as the prisms that they grew as, the core of
// tetrahedra. Where a column has vanished a prism is a pyramid or a tetrahedron: the cells conform.
#pragma once

#include "tunica/mesh/wedge.hpp"
#include "tunica/meshing/layer_assembly.hpp"
#include "tunica/meshing/layer_options.hpp"
#include "tunica/meshing/layer_sheet.hpp"

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <utility>
#include <vector>

namespace tunica::meshing {

/// What layered_tetrahedra gives.
///   struct LayeredFill { mesh::TetMesh mesh; mesh::Surface outer; std::vector<Index> end; LayerReport
///   report; };
template <class F>
concept LayerFilling = requires(const F& f) {
  { f.mesh } -> std::convertible_to<const mesh::TetMesh&>;      // tetrahedra of the layers first
  { f.outer } -> std::convertible_to<const mesh::Surface&>;     // its border
  { f.end } -> std::convertible_to<const std::vector<Index>&>;  // of the column above each node
  { f.report.layer.tetrahedra } -> std::convertible_to<Index>;  // how many are of the layers
};

/// The three meshes have the same nodes, numbered as in LayeredFill, and together fill the surface.
struct [[nodiscard]] LayeredPrisms {
  mesh::WedgeMesh prisms;      // layer by layer from the wall inward
  mesh::PyramidMesh pyramids;  // beside columns that have vanished
  mesh::TetMesh tets;          // those where two columns have vanished, then the core
  mesh::Surface triangles;     // of the border, with the regions of the surface
  mesh::QuadSurface quads;     // the other faces of the border: sides of the layers in flat ends
};

/// The layers of fill = layered_tetrahedra(surface, options), with the same promises: all corners of all
/// prisms are positive by exact signs, whichever way they are split.
template <LayerFilling Fill>
[[nodiscard]] LayeredPrisms layered_prisms(const mesh::Surface& surface, const Fill& fill,
                                           const LayerOptions& options = {}) {
  const LayerSheet sheet = layer_sheet(surface, options.regions);
  const auto has_column = [&](Index n) { return fill.end[static_cast<std::size_t>(n)] != n; };
  const auto number = [&](Index n, int level) {
    const Index end = fill.end[static_cast<std::size_t>(n)];
    return level == 0 || end == n ? n : end - options.layers + level;
  };

  std::vector<Index> prisms, pyramids, tets, triangles, quads;
  LayeredPrisms result;
  for (int level = 0; level < options.layers; ++level)
    for (const Index t : sheet.triangles) {
      const auto c = sheet.corners(t);
      std::array<Index, 3> n{c[0], c[2], c[1]};  // the normal to the inside
      const auto columns = has_column(n[0]) + has_column(n[1]) + has_column(n[2]);
      // Turned so that a column that has vanished comes first, one that has not last.
      while (columns > 0 && columns < 3 && !(!has_column(n[0]) && has_column(n[2])))
        std::rotate(n.begin(), n.begin() + 1, n.end());
      const auto at = [&](std::size_t k, int up) { return number(n[k], level + up); };
      if (columns == 3)
        prisms.insert(prisms.end(), {at(0, 0), at(1, 0), at(2, 0), at(0, 1), at(1, 1), at(2, 1)});
      if (columns == 2)  // (1, 2) and what is above, seen from 0: its normal to 0
        pyramids.insert(pyramids.end(), {at(1, 0), at(1, 1), at(2, 1), at(2, 0), at(0, 0)});
      if (columns == 1) tets.insert(tets.end(), {at(0, 0), at(1, 0), at(2, 0), at(2, 1)});
    }
  const auto fill_cells = [](auto& cells, const std::vector<Index>& list) {
    cells.resize(cells.rows(), static_cast<Eigen::Index>(list.size()) / cells.rows());
    std::copy(list.begin(), list.end(), cells.data());
  };
  const Index in_layers = fill.report.layer.tetrahedra;
  const Index* const cells = fill.mesh.cells.data();
  tets.insert(tets.end(), cells + 4 * in_layers, cells + 4 * fill.mesh.cell_count());

  // The border: the triangles of the surface come first in `outer`, then the sides, which are joined again.
  const Index given = surface.cell_count();
  for (Index t = 0; t < given; ++t) {
    for (int k = 0; k < 3; ++k) triangles.push_back(fill.outer.cells(k, t));
    if (!surface.region.empty()) result.triangles.region.push_back(surface.region_of(t));
  }
  for (const LayerRim& r : layer_rims(sheet))
    for (int level = 0; level < options.layers && (has_column(r.a) || has_column(r.b)); ++level) {
      const Index a = number(r.a, level), b = number(r.b, level), c = number(r.a, level + 1),
                  d = number(r.b, level + 1);
      if (a != c && b != d) {
        quads.insert(quads.end(), {a, b, d, c});
        result.quads.region.push_back(r.region);
      } else {
        triangles.insert(triangles.end(), {a, b, a == c ? d : c});
        result.triangles.region.push_back(r.region);
      }
    }
  fill_cells(result.prisms.cells, prisms), fill_cells(result.pyramids.cells, pyramids);
  fill_cells(result.tets.cells, tets);
  fill_cells(result.triangles.cells, triangles), fill_cells(result.quads.cells, quads);
  result.prisms.nodes = result.pyramids.nodes = result.tets.nodes = fill.mesh.nodes;
  result.triangles.nodes = result.quads.nodes = fill.outer.nodes;
  result.triangles.region_names = result.quads.region_names = surface.region_names;
  return result;
}

}  // namespace tunica::meshing
