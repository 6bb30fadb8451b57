// SPDX-License-Identifier: MIT
// Dual contouring: a vertex for each sheet of the surface in a cell, where its quadratic error is
// least; a quadrilateral for each crossed edge. Closed and manifold for any signs. [JU02, SCHAEFER07]
#pragma once

#include "tunica/core/error.hpp"
#include "tunica/core/parallel.hpp"
#include "tunica/core/vec.hpp"
#include "tunica/mesh/mesh.hpp"
#include "tunica/meshing/cell_loops.hpp"
#include "tunica/meshing/dual_topology.hpp"
#include "tunica/meshing/hermite.hpp"
#include "tunica/meshing/padded_bits.hpp"
#include "tunica/meshing/part_sheets.hpp"
#include "tunica/meshing/qef.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace tunica::meshing {

struct DualContouringOptions {
  QefOptions qef{};
  /// Vertices keep this share of their cell from its sides; a negative one lets them go wherever their error
  /// is least: sharp edges that pass just outside are met, at the price of overlaps on rough data.
  double hold = 1e-3;
};

namespace detail {

/// Finds the crossing of an edge, row by row.
class CrossingLookup {
 public:
  CrossingLookup(const HermiteGrid& grid, const DualTopology& topology) : grid_(grid), topology_(topology) {}

  [[nodiscard]] const Crossing& operator()(std::size_t edge) const {
    const auto at = grid_.position(edge / 3);
    const Index first = topology_.first_quad(at[1], at[2]), end = topology_.end_quad(at[1], at[2]);
    const auto found = std::lower_bound(grid_.edges.begin() + first, grid_.edges.begin() + end, edge);
    return grid_.crossings[static_cast<std::size_t>(found - grid_.edges.begin())];
  }

 private:
  const HermiteGrid& grid_;
  const DualTopology& topology_;
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

/// The vertices of one cell: `at` is its lowest node.
inline void place_vertices(const HermiteGrid& grid, const DualTopology& topology,
                           const CrossingLookup& crossing, std::size_t cell,
                           const std::array<std::size_t, 3>& at, const DualContouringOptions& options,
                           Points<3>& nodes) {
  const auto stride = grid.strides();
  const std::size_t lowest = at[0] * stride[0] + at[1] * stride[1] + at[2] * stride[2];
  Box hold;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto e = static_cast<Eigen::Index>(a);
    const double lo = grid.axes[a][at[a]], hi = grid.axes[a][at[a] + 1], margin = options.hold * (hi - lo);
    hold.lo[e] = lo + margin, hold.hi[e] = hi - margin;
  }
  const CellLoops& loops = topology.loops(cell);
  Sheets sheets;
  for (int loop = 0; loop < loops.count; ++loop) {
    std::array<const Crossing*, 12> around{};
    int count = 0;
    for (int e = 0; e < 12; ++e) {
      if (loops.loop[static_cast<std::size_t>(e)] != loop) continue;
      const auto axis = static_cast<std::size_t>(e / 4);
      const std::size_t node =
          lowest + (e & 1 ? stride[(axis + 1) % 3] : 0) + (e & 2 ? stride[(axis + 2) % 3] : 0);
      around[static_cast<std::size_t>(count++)] = &crossing(3 * node + axis);
    }
    const Vec3 x = dual_vertex(grid, around, count, hold, options);
    sheets.mean[sheets.count] = stays(grid, around, count) ? x : mean_in(hold, around, count);
    sheets.place[sheets.count++] = x;
  }
  if (options.hold >= 0) part(sheets, vec::distance(hold.lo, hold.hi));
  for (std::size_t s = 0; s < sheets.count; ++s)
    vec::set_column(nodes, topology.first_vertex(cell) + static_cast<Index>(s), sheets.place[s]);
}

}  // namespace detail

/// Quadrilaterals with outward normals; the regions of the surface are those of the crossings.
/// MeshError if the signs on the border of the grid leave the surface open.
[[nodiscard]] inline mesh::QuadSurface dual_contour(const HermiteGrid& grid,
                                                    const DualContouringOptions& options = {}) {
  TUNICA_EXPECT(grid.size(0) > 2 && grid.size(1) > 2 && grid.size(2) > 2,
                "a grid needs three nodes along each axis");
  TUNICA_EXPECT(grid.edges.size() == grid.crossings.size(), "one crossing a crossed edge");
  for (const std::size_t edge : grid.edges) {
    const std::size_t a = edge % 3, b = (a + 1) % 3, c = (a + 2) % 3;
    const auto at = grid.position(edge / 3);
    if (at[b] == 0 || at[c] == 0 || at[b] + 1 == grid.size(b) || at[c] + 1 == grid.size(c))
      throw MeshError("the surface leaves the grid of the dual contouring");
  }
  const detail::PaddedBits bits(grid.inside, {grid.size(0), grid.size(1), grid.size(2)});
  const detail::DualTopology topology(bits);
  TUNICA_EXPECT(grid.edges.size() == static_cast<std::size_t>(topology.quad_count()),
                "one crossing a crossed edge");
  const detail::CrossingLookup crossing(grid, topology);
  const std::size_t ny = grid.size(1), nz = grid.size(2);
  mesh::QuadSurface surface;
  surface.nodes.resize(3, topology.vertex_count());
  parallel_chunks(static_cast<std::ptrdiff_t>((ny - 1) * (nz - 1)), detail::rows_a_chunk,
                  [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
                    for (auto r = static_cast<std::size_t>(begin); r < static_cast<std::size_t>(end); ++r) {
                      const std::size_t j = r % (ny - 1), k = r / (ny - 1);
                      const auto [first, beyond] = topology.cells(j, k);
                      for (std::size_t c = first; c < beyond; ++c)
                        detail::place_vertices(grid, topology, crossing, c, {topology.i(c), j, k}, options,
                                               surface.nodes);
                    }
                  });

  surface.cells.resize(4, static_cast<Eigen::Index>(grid.edges.size()));
  surface.region.resize(grid.edges.size());
  for (const auto& region : grid.regions) surface.region_names.push_back(region.name);
  for (std::size_t q = 0; q < grid.edges.size(); ++q) {
    const std::size_t a = grid.edges[q] % 3, b = (a + 1) % 3, c = (a + 2) % 3;
    const auto at = grid.position(grid.edges[q] / 3);
    // The cells around the edge, counter-clockwise seen against axis a, each with its edge number.
    static constexpr std::array<std::array<std::size_t, 3>, 4> ring{
        {{1, 1, 3}, {0, 1, 2}, {0, 0, 0}, {1, 0, 1}}};
    const bool outward = grid.inside[grid.edges[q] / 3] != 0;
    for (std::size_t n = 0; n < 4; ++n) {
      const auto& [back_b, back_c, offsets] = ring[outward ? n : 3 - n];
      auto low = at;
      low[b] -= back_b, low[c] -= back_c;
      const std::size_t cell = topology.find(low[0], low[1], low[2]);
      surface.cells(static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(q)) =
          topology.first_vertex(cell) + topology.loops(cell).loop[4 * a + offsets];
    }
    surface.region[q] = grid.crossings[q].region;
  }
  return surface;
}

}  // namespace tunica::meshing
