// SPDX-License-Identifier: MIT
// Hexahedra that fill a closed surface: the interior dual mesh of a grid [PEREZ08, 3.2.2], with a layer of
// cells on the surface, improved.
#pragma once

#include "tunica/mesh/measures.hpp"
#include "tunica/mesh/quality.hpp"
#include "tunica/meshing/dual_complex.hpp"
#include "tunica/meshing/grid_specks.hpp"
#include "tunica/meshing/hermite_surface.hpp"
#include "tunica/meshing/hex_guide.hpp"
#include "tunica/meshing/improve_hexahedra.hpp"
#include "tunica/meshing/level_hexahedra.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace tunica::meshing {

struct HexFillOptions {
  double edge;               // of the grid [unit of the surface]
  double sharp_angle = 180;  // edges of the surface that turn by more are kept [degrees]
  HexImproveOptions improve{};
};

struct [[nodiscard]] HexFillReport {
  Index cells = 0;
  Index inverted = 0;         // cells whose determinant is not positive everywhere
  double least_jacobian = 0;  // scaled Jacobian of the worst cell
  Vec3 worst_place{0, 0, 0};  // its centre
  double mean_jacobian = 0;
  double first_percentile = 0;  // of the scaled Jacobians
  Index below_sound = 0;        // cells with a scaled Jacobian below 0.2
  double volume = 0;            // of the cells
  GridSpecks specks;            // parts and gaps of less than eight nodes of the grid, left out and filled
  double surface_volume = 0;    // that the surface encloses
  double distance_rms = 0, distance_max = 0;  // of the border's nodes and face centres from the surface
  Vec3 distance_place{0, 0, 0};               // where it is largest
  Index released = 0;                         // nodes that had to leave the surface, by half an edge or more
};

struct [[nodiscard]] HexFill {
  mesh::HexMesh mesh;  // patches of the names of the surface's regions, in their order
  HexFillReport report;
};

namespace detail {

/// The grid of a surface with its facets as regions. Where lines of the grid run along triangles wherever it
/// is shifted, as they may on integer data, the spacing is a little less.
[[nodiscard]] inline HermiteGrid grid_of(const mesh::Surface& surface, const Facets& facets, double spacing) {
  constexpr int attempts = 4;
  constexpr double less = 0.983;
  mesh::Surface labelled = surface;
  labelled.region = facets.of;
  labelled.region_names.assign(facets.region.size(), "");
  for (int attempt = 1;; ++attempt, spacing *= less) {
    try {
      return hermite_of_surface(labelled, {.spacing = spacing});
    } catch (const MeshError&) {
      if (attempt == attempts) throw;
    }
  }
}

[[nodiscard]] inline mesh::HexMesh mesh_of(const HexComplex& hexes, const mesh::Surface& surface,
                                           const Facets& facets) {
  mesh::HexMesh mesh;
  mesh.nodes = vec::columns(hexes.nodes);
  mesh.cells.resize(8, static_cast<Eigen::Index>(hexes.cells.size()));
  for (std::size_t c = 0; c < hexes.cells.size(); ++c)
    for (std::size_t k = 0; k < 8; ++k)
      mesh.cells(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(c)) = hexes.cells[c][k];
  const std::size_t regions = std::max<std::size_t>(1, surface.region_names.size());
  std::vector<std::vector<Index>> faces(regions);
  for (std::size_t f = 0; f < hexes.border.size(); ++f) {
    auto& list = faces[static_cast<std::size_t>(facets.region[static_cast<std::size_t>(hexes.facet[f])])];
    list.insert(list.end(), hexes.border[f].begin(), hexes.border[f].end());
  }
  for (std::size_t r = 0; r < regions; ++r)
    mesh.patches.push_back(
        {surface.region_names.empty() ? "wall" : surface.region_names[r], vec::quads(faces[r])});
  return mesh;
}

inline void measure(const HexComplex& hexes, const SurfaceGuide& guide, const mesh::Surface& surface,
                    HexFill& fill) {
  HexFillReport& r = fill.report;
  const auto q = mesh::quality(fill.mesh);
  r.cells = fill.mesh.cell_count();
  for (const auto& cell : hexes.cells) r.inverted += positive_everywhere(hexes.nodes, cell) ? 0 : 1;
  r.least_jacobian = q.scaled_jacobian.least, r.worst_place = q.worst_place;
  r.mean_jacobian = q.scaled_jacobian.mean;
  r.first_percentile = q.scaled_jacobian.quantile(0.01);
  r.below_sound = static_cast<Index>(
      std::lower_bound(q.scaled_jacobian.sorted.begin(), q.scaled_jacobian.sorted.end(), 0.2) -
      q.scaled_jacobian.sorted.begin());
  r.volume = mesh::volume(fill.mesh);
  r.surface_volume = mesh::enclosed_volume(surface);
  double sum = 0;
  std::size_t count = 0;
  const auto add = [&](const Vec3& lack, const Vec3& place) {
    const double d = vec::length(lack);
    sum += d * d, ++count;
    if (d > r.distance_max) r.distance_max = d, r.distance_place = place;
  };
  for (std::size_t n = 0; n < hexes.nodes.size(); ++n) {
    const auto& site = guide.site(static_cast<Index>(n));
    if (!site.inside() && !site.corner)
      add(guide.lack(static_cast<Index>(n), hexes.nodes[n]), hexes.nodes[n]);
  }
  for (std::size_t f = 0; f < hexes.border.size(); ++f) {
    Vec3 centre(0, 0, 0);
    for (const Index n : hexes.border[f])
      centre = vec::along(centre, 0.25, hexes.nodes[static_cast<std::size_t>(n)]);
    const Index near = guide.node_on(hexes.border[f], hexes.facet[f]);
    add(near >= 0 ? guide.lack(near, centre)
                  : vec::minus(guide.walk().nearest(centre, hexes.facet[f]).point, centre),
        centre);
  }
  if (count > 0) r.distance_rms = std::sqrt(sum / static_cast<double>(count));
}

/// Cells must not get worse for it: where one falls below what is good, and below what it was, its nodes
/// stay.
inline void level(HexComplex& hexes, SurfaceGuide& guide, const HexFillOptions& options) {
  std::vector<Vec3> x = level_places(hexes, guide, options.edge);
  std::swap(hexes.nodes, x);
  const double good = 0.9 * options.improve.target;
  for (bool again = true; again;) {
    again = false;
    for (const auto& cell : hexes.cells) {
      const double now = hex_jacobian(hexes.nodes, cell);
      if ((now >= good || now >= hex_jacobian(x, cell)) &&
          (positive_everywhere(hexes.nodes, cell) || !positive_everywhere(x, cell)))
        continue;
      for (const Index n : cell) {
        const auto i = static_cast<std::size_t>(n);
        if (vec::distance(hexes.nodes[i], x[i]) > 0) hexes.nodes[i] = x[i], again = true;
      }
    }
  }
}

}  // namespace detail

/// surface: closed, oriented outward. Flat regions stay flat, their faces lie in their planes exactly.
/// MeshError where the surface is open or inward, or thinner than the grid everywhere.
[[nodiscard]] inline HexFill dual_hexahedra(const mesh::Surface& surface, const HexFillOptions& options) {
  TUNICA_EXPECT(options.edge > 0, "hexahedra have an edge length");
  const Facets facet = facets(surface, options.sharp_angle);
  if (!(mesh::enclosed_volume(surface) > 0))
    throw MeshError("the surface is oriented inward: it has no inside to fill with hexahedra");
  HermiteGrid grid = detail::grid_of(surface, facet, options.edge);
  GridSpecks specks = remove_specks(grid, 8);
  const mesh::QuadSurface contour = dual_contour(grid);
  HexComplex hexes = dual_complex(grid, contour);
  SurfaceGuide guide(surface, facet, hexes.sites);
  const auto improved = improve_hexahedra(hexes, guide, options.edge, options.improve);
  detail::level(hexes, guide, options);
  HexFill fill;
  fill.report.specks = std::move(specks);
  fill.report.released = improved.released;
  fill.mesh = detail::mesh_of(hexes, surface, facet);
  detail::measure(hexes, guide, surface, fill);
  return fill;
}

}  // namespace tunica::meshing
