// SPDX-License-Identifier: MIT
// Dual contouring: a vertex for each sheet of the surface in a cell, where its quadratic error is
// least; a quadrilateral for each crossed edge. Closed and manifold for any signs. [JU02, SCHAEFER07]
#pragma once

#include "tunica/core/error.hpp"
#include "tunica/core/parallel.hpp"
#include "tunica/core/vec.hpp"
#include "tunica/mesh/mesh.hpp"
#include "tunica/meshing/cell_loops.hpp"
#include "tunica/meshing/hermite.hpp"
#include "tunica/meshing/part_sheets.hpp"
#include "tunica/meshing/qef.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace tunica::meshing {

struct DualContouringOptions {
  QefOptions qef{};
  /// Vertices keep this share of their cell from its sides; a negative one lets them go wherever their error
  /// is least: sharp edges that pass just outside are met, at the price of overlaps on rough data.
  double hold = 1e-3;
};

namespace detail {

/// The cells that the surface crosses, in ascending order, each with its loops and its first vertex.
class DualCells {
 public:
  explicit DualCells(const HermiteGrid& grid) : grid_(grid), stride_(grid.strides()) {
    collect();
    for (std::size_t c = 0; c < cells_.size(); ++c) loops_[c] = cell_loops(signs_[c], 0);
    separate();
    vertex_.resize(cells_.size() + 1, 0);
    for (std::size_t c = 0; c < cells_.size(); ++c) vertex_[c + 1] = vertex_[c] + loops_[c].count;
  }

  [[nodiscard]] std::size_t count() const { return cells_.size(); }
  [[nodiscard]] Index vertex_count() const { return vertex_.back(); }
  [[nodiscard]] std::size_t node(std::size_t c) const { return cells_[c]; }
  [[nodiscard]] const CellLoops& loops(std::size_t c) const { return loops_[c]; }
  [[nodiscard]] Index vertex(std::size_t c, int edge) const {
    return vertex_[c] + loops_[c].loop[static_cast<std::size_t>(edge)];
  }

  /// The place in the list of the cell whose lowest node is that one; it must be there.
  [[nodiscard]] std::size_t find(std::size_t node) const {
    const std::size_t row = node / grid_.size(0);
    const auto from = cells_.begin() + row_[row], to = cells_.begin() + row_[row + 1];
    return static_cast<std::size_t>(std::lower_bound(from, to, node) - cells_.begin());
  }

 private:
  void collect() {
    const std::size_t nx = grid_.size(0), ny = grid_.size(1), nz = grid_.size(2);
    row_.assign(ny * nz + 1, 0);
    for (std::size_t k = 0; k < nz; ++k)
      for (std::size_t j = 0; j < ny; ++j) {
        if (j + 1 < ny && k + 1 < nz) {
          const std::uint8_t* at = grid_.inside.data() + nx * (j + ny * k);
          const auto column = [&](std::size_t i) {
            return unsigned(at[i] | at[i + stride_[1]] << 2 | at[i + stride_[2]] << 4 |
                            at[i + stride_[1] + stride_[2]] << 6);
          };
          unsigned low = column(0);
          for (std::size_t i = 0; i + 1 < nx; ++i) {
            const unsigned high = column(i + 1), signs = low | high << 1;
            low = high;
            if (signs == 0 || signs == 255) continue;
            cells_.push_back(i + nx * (j + ny * k));
            signs_.push_back(static_cast<std::uint8_t>(signs));
          }
        }
        row_[j + ny * k + 1] = static_cast<std::ptrdiff_t>(cells_.size());
      }
    loops_.resize(cells_.size());
  }

  /// An edge of the dual mesh would be shared by four quadrilaterals where all strands on an
  /// ambiguous face are one loop in both of its cells. There the strands are paired the other way:
  /// that splits an oriented loop in two, in both cells, and so never makes another such face.
  void separate() {
    std::vector<std::uint8_t> joined(cells_.size(), 0);
    for (std::size_t c = 0; c < cells_.size(); ++c)
      for (std::size_t a = 0; a < 3; ++a) {
        const std::size_t high = 2 * a + 1, low = 2 * a;
        if (!ambiguous(signs_[c], high) || !strands_meet(loops_[c], high)) continue;
        const std::size_t d = find(cells_[c] + stride_[a]);
        if (!strands_meet(loops_[d], low)) continue;
        joined[c] = static_cast<std::uint8_t>(joined[c] | 1U << high);
        joined[d] = static_cast<std::uint8_t>(joined[d] | 1U << low);
        loops_[c] = cell_loops(signs_[c], joined[c]);
        loops_[d] = cell_loops(signs_[d], joined[d]);
      }
  }

  const HermiteGrid& grid_;
  std::array<std::size_t, 3> stride_;
  std::vector<std::size_t> cells_;   // lowest nodes
  std::vector<std::uint8_t> signs_;  // a bit a corner
  std::vector<CellLoops> loops_;
  std::vector<std::ptrdiff_t> row_;  // range of cells_ of each row of nodes
  std::vector<Index> vertex_;        // first vertex of each cell
};

/// Finds the crossing of an edge, row by row.
class CrossingLookup {
 public:
  explicit CrossingLookup(const HermiteGrid& grid) : grid_(grid), row_(grid.size(1) * grid.size(2) + 1, 0) {
    for (const std::size_t e : grid.edges) ++row_[e / 3 / grid.size(0) + 1];
    for (std::size_t r = 1; r < row_.size(); ++r) row_[r] += row_[r - 1];
  }
  [[nodiscard]] const Crossing& operator()(std::size_t edge) const {
    const std::size_t row = edge / 3 / grid_.size(0);
    const auto at =
        std::lower_bound(grid_.edges.begin() + row_[row], grid_.edges.begin() + row_[row + 1], edge);
    return grid_.crossings[static_cast<std::size_t>(at - grid_.edges.begin())];
  }

 private:
  const HermiteGrid& grid_;
  std::vector<std::ptrdiff_t> row_;
};

/// Where one loop of a cell has its vertex: least error, held in the cell, then moved by the least
/// step into the planes of the flat regions that meet there.
[[nodiscard]] inline Vec3 dual_vertex(const HermiteGrid& grid, const std::array<const Crossing*, 12>& around,
                                      int count, const Box& hold, const DualContouringOptions& options) {
  Qef qef, planes;
  std::array<Index, 12> flat{};
  int flats = 0;
  for (int n = 0; n < count; ++n) {
    const Crossing& x = *around[static_cast<std::size_t>(n)];
    qef.add(x.point, x.normal);
    const auto known = flat.begin() + flats;
    if (!grid.regions[static_cast<std::size_t>(x.region)].flat ||
        std::find(flat.begin(), known, x.region) != known)
      continue;
    flat[static_cast<std::size_t>(flats++)] = x.region;
    const auto& plane = grid.regions[static_cast<std::size_t>(x.region)];
    planes.add(plane.point, plane.normal);
  }
  const Vec3 best =
      options.hold < 0 ? qef.minimum(options.qef).position : qef.minimum_in(hold, options.qef).position;
  return flats == 0 ? best : planes.minimum(best, options.qef).position;
}

/// A vertex in a flat region.
[[nodiscard]] inline bool stays(const HermiteGrid& grid, const std::array<const Crossing*, 12>& around,
                                int count) {
  return std::any_of(around.begin(), around.begin() + count, [&](const Crossing* x) {
    return grid.regions[static_cast<std::size_t>(x->region)].flat;
  });
}

[[nodiscard]] inline Vec3 mean_in(const Box& hold, const std::array<const Crossing*, 12>& around, int count) {
  Vec3 sum(0, 0, 0);
  for (int n = 0; n < count; ++n) sum = vec::plus(sum, around[static_cast<std::size_t>(n)]->point);
  return held_in(hold, vec::divided(sum, count));
}

}  // namespace detail

/// Quadrilaterals with outward normals; the regions of the surface are those of the crossings.
/// MeshError if the signs on the border of the grid leave the surface open.
[[nodiscard]] inline mesh::QuadSurface dual_contour(const HermiteGrid& grid,
                                                    const DualContouringOptions& options = {}) {
  TUNICA_EXPECT(grid.size(0) > 2 && grid.size(1) > 2 && grid.size(2) > 2,
                "a grid needs three nodes along each axis");
  TUNICA_EXPECT(grid.edges.size() == grid.crossings.size(), "one crossing a crossed edge");
  const detail::DualCells cells(grid);
  const detail::CrossingLookup crossing(grid);
  const auto stride = grid.strides();
  mesh::QuadSurface surface;
  surface.nodes.resize(3, cells.vertex_count());
  parallel_chunks(
      static_cast<std::ptrdiff_t>(cells.count()), 4096, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        for (auto c = static_cast<std::size_t>(begin); c < static_cast<std::size_t>(end); ++c) {
          const auto at = grid.position(cells.node(c));
          Box hold;
          for (std::size_t a = 0; a < 3; ++a) {
            const auto e = static_cast<Eigen::Index>(a);
            const double lo = grid.axes[a][at[a]], hi = grid.axes[a][at[a] + 1],
                         margin = options.hold * (hi - lo);
            hold.lo[e] = lo + margin, hold.hi[e] = hi - margin;
          }
          const auto& loops = cells.loops(c);
          detail::Sheets sheets;
          Index first = 0;
          for (int loop = 0; loop < loops.count; ++loop) {
            std::array<const Crossing*, 12> around{};
            int count = 0;
            Index vertex = 0;
            for (int e = 0; e < 12; ++e) {
              if (loops.loop[static_cast<std::size_t>(e)] != loop) continue;
              const auto axis = static_cast<std::size_t>(e / 4);
              const std::size_t node =
                  cells.node(c) + (e & 1 ? stride[(axis + 1) % 3] : 0) + (e & 2 ? stride[(axis + 2) % 3] : 0);
              around[static_cast<std::size_t>(count++)] = &crossing(3 * node + axis);
              vertex = cells.vertex(c, e);
            }
            const Vec3 x = detail::dual_vertex(grid, around, count, hold, options);
            surface.nodes.col(vertex) = x;
            if (loop == 0) first = vertex;
            sheets.mean[sheets.count] =
                detail::stays(grid, around, count) ? x : detail::mean_in(hold, around, count);
            sheets.place[sheets.count++] = x;
          }
          if (sheets.count < 2 || options.hold < 0) continue;
          detail::part(sheets, vec::distance(hold.lo, hold.hi));
          for (std::size_t s = 0; s < sheets.count; ++s)
            vec::set_column(surface.nodes, first + static_cast<Index>(s), sheets.place[s]);
        }
      });

  surface.cells.resize(4, static_cast<Eigen::Index>(grid.edges.size()));
  surface.region.resize(grid.edges.size());
  for (const auto& region : grid.regions) surface.region_names.push_back(region.name);
  for (std::size_t q = 0; q < grid.edges.size(); ++q) {
    const std::size_t node = grid.edges[q] / 3, a = grid.edges[q] % 3, b = (a + 1) % 3, c = (a + 2) % 3;
    const auto at = grid.position(node);
    if (at[b] == 0 || at[c] == 0 || at[b] + 1 == grid.size(b) || at[c] + 1 == grid.size(c))
      throw MeshError("the surface leaves the grid of the dual contouring");
    // The cells around the edge, counter-clockwise seen against axis a, each with its edge number.
    const std::array<std::pair<std::size_t, int>, 4> ring{
        {{node - stride[b] - stride[c], 3}, {node - stride[c], 2}, {node, 0}, {node - stride[b], 1}}};
    const bool outward = grid.inside[node] != 0;
    for (std::size_t n = 0; n < 4; ++n) {
      const auto& [cell, offsets] = ring[outward ? n : 3 - n];
      surface.cells(static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(q)) =
          cells.vertex(cells.find(cell), static_cast<int>(4 * a) + offsets);
    }
    surface.region[q] = grid.crossings[q].region;
  }
  return surface;
}

}  // namespace tunica::meshing
