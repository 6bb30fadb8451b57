// SPDX-License-Identifier: MIT
// From heights and directions to a mesh: numbers of the columns' nodes, tetrahedra of the layers, the sides
// of the layers in flat ends, and the patches.
#pragma once

#include "tunica/core/vec.hpp"
#include "tunica/mesh/adjacency.hpp"
#include "tunica/meshing/layer_heights.hpp"
#include "tunica/meshing/layer_sheet.hpp"
#include "tunica/meshing/split_prisms.hpp"

#include <array>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace tunica::meshing {

/// An edge of the wall at a flat end, as the end's triangle runs it.
struct LayerRim {
  Index a, b, region;
};

/// The edges where layers stand on flat ends.
[[nodiscard]] inline std::vector<LayerRim> layer_rims(const LayerSheet& sheet) {
  const mesh::Surface& s = sheet.surface;
  const auto twin = mesh::twins(s.cells, s.node_count());
  std::vector<LayerRim> rims;
  for (Index h = 0; h < static_cast<Index>(twin.size()); ++h) {
    const Index g = twin[static_cast<std::size_t>(h)];
    if (g < 0 || sheet.carries[static_cast<std::size_t>(h / 3)] != 0) continue;
    if (sheet.carries[static_cast<std::size_t>(g / 3)] == 0) continue;
    const auto e = mesh::half_edge(s.cells, h);
    if (sheet.grows(e.from) || sheet.grows(e.to)) rims.push_back({e.from, e.to, s.region_of(h / 3)});
  }
  return rims;
}

/// Numbers of the nodes of all columns: after those of the surface, columns at flat ends first.
class LayerNumbers {
 public:
  LayerNumbers(const LayerSheet& sheet, const LayerHeights& heights, int layers)
      : layers_(layers), first_(static_cast<std::size_t>(sheet.surface.node_count()), -1) {
    count_ = sheet.surface.node_count();
    for (const bool bound : {true, false}) {
      for (Index n = 0; n < sheet.surface.node_count(); ++n) {
        const bool is_bound = sheet.foot[static_cast<std::size_t>(n)] != ColumnFoot::free;
        if (!(heights.height(n) > 0) || is_bound != bound) continue;
        first_[static_cast<std::size_t>(n)] = count_;
        count_ += layers;
      }
      if (bound) on_ends_ = count_;
    }
  }

  [[nodiscard]] Index count() const { return count_; }      // of all nodes
  [[nodiscard]] Index on_ends() const { return on_ends_; }  // of the surface and the columns on its flat ends
  [[nodiscard]] bool has_column(Index n) const { return first_[static_cast<std::size_t>(n)] >= 0; }
  /// The node of level k above node n, 0: n itself; n where there is no column.
  [[nodiscard]] Index operator()(Index n, int level) const {
    return level == 0 || !has_column(n) ? n : first_[static_cast<std::size_t>(n)] + level - 1;
  }
  [[nodiscard]] Index end(Index n) const { return (*this)(n, layers_); }

 private:
  int layers_;
  std::vector<Index> first_;  // node of level 1; -1 without a column
  Index count_ = 0, on_ends_ = 0;
};

namespace detail {

/// Calls emit(prism, rank) for each prism, layer by layer from the wall inward.
template <class Emit>
void each_prism(const LayerSheet& sheet, const LayerNumbers& number, int layers, Emit&& emit) {
  for (int level = 0; level < layers; ++level)
    for (const Index t : sheet.triangles) {
      const auto c = sheet.corners(t);
      if (!number.has_column(c[0]) && !number.has_column(c[1]) && !number.has_column(c[2])) continue;
      const std::array<Index, 3> rank{c[0], c[2], c[1]};  // the normal to the inside
      emit(Prism{number(c[0], level), number(c[2], level), number(c[1], level), number(c[0], level + 1),
                 number(c[2], level + 1), number(c[1], level + 1)},
           rank);
    }
}

/// The border of the mesh: the triangles of the surface, those of flat ends at their new places, then the
/// sides of the layers.
[[nodiscard]] inline mesh::Surface layer_border(const LayerSheet& sheet, const std::vector<LayerRim>& rims,
                                                const LayerNumbers& number, const Points<3>& nodes,
                                                int layers) {
  const mesh::Surface& s = sheet.surface;
  mesh::Surface outer;
  outer.nodes.resize(3, number.on_ends());
  for (Index n = 0; n < number.on_ends(); ++n) vec::set_column(outer.nodes, n, vec::column(nodes, n));
  outer.region_names = s.region_names;
  std::vector<std::array<Index, 3>> cells;
  for (Index t = 0; t < s.cell_count(); ++t) {
    std::array<Index, 3> c = sheet.corners(t);
    if (sheet.carries[static_cast<std::size_t>(t)] == 0)
      for (Index& n : c) n = number.end(n);
    cells.push_back(c);
    if (!s.region.empty()) outer.region.push_back(s.region_of(t));
  }
  for (const LayerRim& r : rims)
    for (int level = 0; level < layers; ++level)
      split_side(number(r.a, level), number(r.b, level), number(r.a, level + 1), number(r.b, level + 1),
                 r.a < r.b, [&](const std::array<Index, 3>& c) {
                   cells.push_back(c);
                   outer.region.push_back(r.region);
                 });
  outer.cells.resize(3, static_cast<Eigen::Index>(cells.size()));
  for (std::size_t t = 0; t < cells.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      outer.cells(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(t)) = cells[t][k];
  return outer;
}

/// One patch a region, in their order, with the triangles in theirs.
inline void add_patches(mesh::TetMesh& m, const mesh::Surface& border) {
  const std::size_t regions = std::max<std::size_t>(1, border.region_names.size());
  std::vector<Index> size(regions, 0);
  for (Index t = 0; t < border.cell_count(); ++t) ++size[static_cast<std::size_t>(border.region_of(t))];
  for (std::size_t r = 0; r < regions; ++r) {
    mesh::Patch<mesh::Tri3> patch{r < border.region_names.size() ? border.region_names[r] : "wall", {}};
    patch.faces.resize(3, size[r]);
    Index at = 0;
    for (Index t = 0; t < border.cell_count(); ++t) {
      if (static_cast<std::size_t>(border.region_of(t)) != r) continue;
      for (int k = 0; k < 3; ++k) patch.faces(k, at) = border.cells(k, t);
      ++at;
    }
    m.patches.push_back(std::move(patch));
  }
}

}  // namespace detail

}  // namespace tunica::meshing
