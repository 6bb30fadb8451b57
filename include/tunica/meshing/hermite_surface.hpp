// SPDX-License-Identifier: MIT
// Hermite data of a closed triangulated surface: signs by the parity of crossings along grid lines,
// a crossing labelled with the region of its triangle. [JU02, 2]
#pragma once

#include "tunica/core/error.hpp"
#include "tunica/core/vec.hpp"
#include "tunica/mesh/mesh.hpp"
#include "tunica/meshing/flat_regions.hpp"
#include "tunica/meshing/hermite.hpp"
#include "tunica/meshing/vertex_normals.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace tunica::meshing {

struct SurfaceGridOptions {
  double spacing;     // of the grid [length]
  int attempts = 16;  // at a place of the grid that no line of it shares with an edge of the surface
};

namespace detail {

/// Where a grid line meets a triangle.
struct LineHit {
  std::size_t line;  // number of the line: u + nu * v over the other two axes
  double at;         // coordinate along it
  Index triangle;
  Vec3 weights;  // barycentric
};

/// The hit of an edge of the grid that the surface crosses.
struct EdgeHit {
  std::size_t edge;
  const LineHit* hit;
};

/// Twice the signed area of (o, p, q) in the plane; empty where rounding could change its sign.
[[nodiscard]] inline std::optional<double> certain_area(const std::array<double, 2>& p,
                                                        const std::array<double, 2>& q,
                                                        const std::array<double, 2>& o) {
  const double left = (p[0] - o[0]) * (q[1] - o[1]), right = (p[1] - o[1]) * (q[0] - o[0]),
               area = left - right;
  const double bound = 8 * std::numeric_limits<double>::epsilon() * (std::abs(left) + std::abs(right));
  if (!(std::abs(area) > bound)) return std::nullopt;
  return area;
}

/// All hits of the lines along one axis, by line and coordinate; empty if one cannot be told.
[[nodiscard]] inline std::optional<std::vector<LineHit>> line_hits(const mesh::Surface& surface,
                                                                   const HermiteGrid& grid,
                                                                   std::size_t axis) {
  const std::size_t b = (axis + 1) % 3, c = (axis + 2) % 3;
  const auto ea = static_cast<Eigen::Index>(axis), eb = static_cast<Eigen::Index>(b),
             ec = static_cast<Eigen::Index>(c);
  const auto first = [](const std::vector<double>& x, double from) {
    return static_cast<std::size_t>(std::lower_bound(x.begin(), x.end(), from) - x.begin());
  };
  std::vector<LineHit> hits;
  for (Index t = 0; t < surface.cell_count(); ++t) {
    std::array<Vec3, 3> x;
    Box box;
    for (int k = 0; k < 3; ++k)
      box.extend(x[static_cast<std::size_t>(k)] = vec::column(surface.nodes, surface.cells(k, t)));
    for (std::size_t v = first(grid.axes[c], box.lo[ec]); v < grid.size(c) && grid.axes[c][v] <= box.hi[ec];
         ++v)
      for (std::size_t u = first(grid.axes[b], box.lo[eb]); u < grid.size(b) && grid.axes[b][u] <= box.hi[eb];
           ++u) {
        const std::array o{grid.axes[b][u], grid.axes[c][v]};
        std::array<std::optional<double>, 3> w;
        for (std::size_t k = 0; k < 3; ++k) {
          const Vec3 &p = x[(k + 1) % 3], &q = x[(k + 2) % 3];
          w[k] = certain_area({p[eb], p[ec]}, {q[eb], q[ec]}, o);
        }
        // one certain pair of opposite signs is enough to miss
        const auto opposite = [&](std::size_t k, std::size_t l) {
          return w[k] && w[l] && (*w[k] > 0) != (*w[l] > 0);
        };
        if (opposite(0, 1) || opposite(1, 2) || opposite(2, 0)) continue;
        if (!w[0] || !w[1] || !w[2]) return std::nullopt;
        const Vec3 weights = vec::divided(Vec3(*w[0], *w[1], *w[2]), *w[0] + *w[1] + *w[2]);
        hits.push_back({u + grid.size(b) * v,
                        weights[0] * x[0][ea] + weights[1] * x[1][ea] + weights[2] * x[2][ea], t, weights});
      }
  }
  std::sort(hits.begin(), hits.end(), [](const LineHit& p, const LineHit& q) {
    if (p.line != q.line) return p.line < q.line;
    return p.at != q.at ? p.at < q.at : p.triangle < q.triangle;
  });
  return hits;
}

/// A hit on each edge that the surface crosses an odd number of times, as (edge, hit); the signs of
/// the nodes along x where axis is 0. False where a node is too near to the surface, or where the
/// parities of this axis contradict the signs.
[[nodiscard]] inline bool mark_line(HermiteGrid& grid, std::size_t axis, const std::vector<LineHit>& hits,
                                    std::vector<EdgeHit>& found) {
  const auto stride = grid.strides();
  const std::size_t b = (axis + 1) % 3, c = (axis + 2) % 3;
  const auto& x = grid.axes[axis];
  std::size_t next = 0;
  for (std::size_t line = 0; line < grid.size(b) * grid.size(c); ++line) {
    const std::size_t start = line % grid.size(b) * stride[b] + line / grid.size(b) * stride[c];
    bool inside = false;
    for (std::size_t i = 0; i < x.size(); ++i) {
      const std::size_t node = start + i * stride[axis], from = next;
      while (next < hits.size() && hits[next].line == line && hits[next].at < x[i]) ++next;
      const double near = 1e-9 * (i > 0 ? x[i] - x[i - 1] : x[1] - x[0]);
      if (next > from && x[i] - hits[next - 1].at < near) return false;
      if (next < hits.size() && hits[next].line == line && hits[next].at - x[i] < near) return false;
      if ((next - from) % 2 == 1) {
        inside = !inside;
        if (i == 0) return false;
        found.push_back({3 * (node - stride[axis]) + axis, &hits[from + (next - from) / 2]});
      }
      if (axis == 0)
        grid.inside[node] = inside ? 1 : 0;
      else if ((grid.inside[node] != 0) != inside)
        return false;
    }
    if (inside || (next < hits.size() && hits[next].line == line)) return false;
  }
  return true;
}

}  // namespace detail

/// Signs and crossings on a uniform grid that covers the surface. The normal of a flat region is that
/// of its plane, elsewhere normals of the vertices (weighted by angle) are interpolated. The grid
/// is shifted until every crossing is certain. MeshError if the surface is not closed.
[[nodiscard]] inline HermiteGrid hermite_of_surface(const mesh::Surface& surface,
                                                    const SurfaceGridOptions& options) {
  TUNICA_EXPECT(options.spacing > 0, "a grid has a positive spacing");
  if (surface.cell_count() == 0) throw MeshError("an empty surface has no contour");
  Box box;
  for (Index n = 0; n < surface.node_count(); ++n) box.extend(vec::column(surface.nodes, n));
  const auto flat = flat_regions(surface);
  std::vector<std::vector<Vec3>> normals(flat.size());  // of the curved regions
  for (std::size_t r = 0; r < flat.size(); ++r)
    if (!flat[r]) normals[r] = vertex_normals(surface, static_cast<Index>(r));
  for (int attempt = 0; attempt < options.attempts; ++attempt) {
    HermiteGrid grid;
    for (std::size_t a = 0; a < 3; ++a) {
      const auto e = static_cast<Eigen::Index>(a);
      // the fractional parts of multiples of the golden ratio never come near to each other
      const double shift = std::fmod(0.37 + 0.6180339887498949 * (3 * attempt + static_cast<double>(a)), 1.0);
      const double start = box.lo[e] - (1 + shift) * options.spacing;
      const auto cells = static_cast<int>(std::ceil((box.hi[e] - start) / options.spacing)) + 1;
      for (int i = 0; i <= cells; ++i) grid.axes[a].push_back(start + i * options.spacing);
    }
    grid.inside.assign(grid.size(0) * grid.size(1) * grid.size(2), 0);
    std::array<std::optional<std::vector<detail::LineHit>>, 3> hits;
    std::vector<detail::EdgeHit> found;
    bool good = true;
    for (std::size_t a = 0; a < 3 && good; ++a) {
      hits[a] = detail::line_hits(surface, grid, a);
      good = hits[a] && detail::mark_line(grid, a, *hits[a], found);
    }
    if (!good) continue;
    std::sort(found.begin(), found.end(),
              [](const detail::EdgeHit& p, const detail::EdgeHit& q) { return p.edge < q.edge; });
    if (found.empty())
      throw MeshError("the surface is thinner than the grid's spacing of " + std::to_string(options.spacing) +
                      " everywhere");
    for (const auto& [edge, hit] : found) {
      const Index region = surface.region_of(hit->triangle);
      Crossing x{Vec3(0, 0, 0), Vec3(0, 0, 0), region};
      for (int k = 0; k < 3; ++k) {
        const Index n = surface.cells(k, hit->triangle);
        x.point = vec::along(x.point, hit->weights[k], vec::column(surface.nodes, n));
        if (!flat[static_cast<std::size_t>(region)])
          x.normal = vec::along(x.normal, hit->weights[k],
                                normals[static_cast<std::size_t>(region)][static_cast<std::size_t>(n)]);
      }
      const auto along = static_cast<Eigen::Index>(edge % 3);
      const std::size_t low = edge / 3;
      for (Eigen::Index e = 0; e < 3; ++e) x.point[e] = e == along ? hit->at : grid.point(low)[e];
      if (flat[static_cast<std::size_t>(region)]) x.normal = flat[static_cast<std::size_t>(region)]->normal;
      if (vec::length(x.normal) > 0)
        x.normal = vec::unit(x.normal);
      else
        x.normal[along] = grid.inside[low] != 0 ? 1 : -1;
      grid.edges.push_back(edge);
      grid.crossings.push_back(x);
    }
    for (std::size_t r = 0; r < flat.size(); ++r) {
      HermiteRegion region{
          r < surface.region_names.size() ? surface.region_names[r] : "region " + std::to_string(r),
          false,
          {},
          {}};
      if (flat[r]) region.flat = true, region.point = flat[r]->point, region.normal = flat[r]->normal;
      grid.regions.push_back(region);
    }
    return grid;
  }
  throw MeshError("the surface is not closed: the grid lines do not agree on its inside");
}

}  // namespace tunica::meshing
