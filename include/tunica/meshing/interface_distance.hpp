// SPDX-License-Identifier: MIT
// How far two meshes of one interface lie apart, measured both ways.
#pragma once

#include "tunica/core/vec.hpp"
#include "tunica/mesh/mesh.hpp"
#include "tunica/meshing/quad_diagonals.hpp"
#include "tunica/meshing/quad_face.hpp"
#include "tunica/meshing/surface_foot.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace tunica::meshing {

/// Distances in the unit of the nodes, with the places where they are greatest.
struct InterfaceDistance {
  double quads_max = 0, quads_rms = 0;       // from points of the quadrilaterals to the wall
  double wall_max = 0, wall_rms = 0;         // from nodes of the wall to the quadrilaterals
  double quads_beyond = 0, wall_beyond = 0;  // share of them farther away than the tolerance
  Vec3 quads_place = Vec3::Zero(), wall_place = Vec3::Zero();
};

/// A point of one mesh that lies farther from the other than the tolerance.
struct FarPlace {
  Vec3 place;
  double distance;
};

/// The nodes of region 0.
[[nodiscard]] inline std::vector<Vec3> wall_points(const mesh::Surface& lumen) {
  std::vector<char> wall(static_cast<std::size_t>(lumen.node_count()), 0);
  for (Index t = 0; t < lumen.cell_count(); ++t)
    if (lumen.region_of(t) == 0)
      for (int k = 0; k < 3; ++k) wall[static_cast<std::size_t>(lumen.cells(k, t))] = 1;
  std::vector<Vec3> points;
  for (Index n = 0; n < lumen.node_count(); ++n)
    if (wall[static_cast<std::size_t>(n)] != 0) points.push_back(vec::column(lumen.nodes, n));
  return points;
}

/// Of the tolerance: a face whose 5 x 5 points all lie nearer than that is not looked at more finely.
inline constexpr double suspect = 0.5;

/// Of the points (i / steps, j / steps) of a face the first that is farthest from the surface. A distance
/// changes by no more than the way from point to point, so few of them are asked for it.
template <FootSurface S>
[[nodiscard]] FarPlace farthest_of(const QuadFace& face, int steps, const S& surface) {
  FarPlace farthest{face.at(0, 0), 0}, last{farthest.place, std::numeric_limits<double>::infinity()};
  for (int j = 0; j <= steps; ++j)
    for (int i = 0; i <= steps; ++i) {
      const Vec3 p = face.at(static_cast<double>(i) / steps, static_cast<double>(j) / steps);
      if (last.distance + vec::distance(p, last.place) <= farthest.distance) continue;
      last = {p, distance_above(surface, p, farthest.distance)};
      if (last.distance > farthest.distance) farthest = last;
    }
  return farthest;
}

/// Bilinear points, 5 x 5 a quadrilateral, against the lumen; the points of its wall against the
/// quadrilaterals, each cut into 4 x 4 smaller ones. `far` receives the places beyond the tolerance. finer:
/// suspect faces are searched for their farthest point among (4 finer + 1)^2.
template <FootSurface S>
[[nodiscard]] InterfaceDistance interface_distance(const mesh::QuadSurface& quads,
                                                   const std::vector<Vec3>& wall, const S& finder,
                                                   double tolerance, std::vector<FarPlace>* far = nullptr,
                                                   int finer = 1) {
  constexpr int parts = 4;
  InterfaceDistance d;
  mesh::QuadSurface fine;
  fine.nodes.resize(3, quads.cells.cols() * (parts + 1) * (parts + 1));
  fine.cells.resize(4, quads.cells.cols() * parts * parts);
  Index node = 0, cell = 0;
  for (Index q = 0; q < quads.cell_count(); ++q) {
    const QuadFace face = quad_face(quads.nodes, quads.cells, q);
    const Index first = node;
    double worst = 0;
    for (int j = 0; j <= parts; ++j)
      for (int i = 0; i <= parts; ++i) {
        const double u = static_cast<double>(i) / parts, v = static_cast<double>(j) / parts;
        const Vec3 p = face.at(u, v);
        vec::set_column(fine.nodes, node++, p);
        const double away = finder.distance(p);
        d.quads_rms += away * away;
        d.quads_beyond += away > tolerance ? 1 : 0;
        if (far != nullptr && away > tolerance) far->push_back({p, away});
        worst = std::max(worst, away);
        if (away > d.quads_max) d.quads_max = away, d.quads_place = p;
      }
    if (finer > 1 && worst > suspect * tolerance) {
      const FarPlace farthest = farthest_of(face, parts * finer, finder);
      if (far != nullptr && farthest.distance > tolerance) far->push_back(farthest);
      if (farthest.distance > d.quads_max) d.quads_max = farthest.distance, d.quads_place = farthest.place;
    }
    for (int j = 0; j < parts; ++j)
      for (int i = 0; i < parts; ++i) {
        const Index a = first + i + (parts + 1) * j;
        fine.cells(0, cell) = a, fine.cells(1, cell) = a + 1;
        fine.cells(2, cell) = a + parts + 2, fine.cells(3, cell) = a + parts + 1;
        ++cell;
      }
  }
  if (node > 0) d.quads_rms = std::sqrt(d.quads_rms / node), d.quads_beyond /= node;

  const mesh::Surface triangles = triangles_of(fine);
  const TriangleFinder back(triangles);
  for (const Vec3& x : wall) {
    const double away = back.distance(x);
    d.wall_rms += away * away;
    d.wall_beyond += away > tolerance ? 1 : 0;
    if (far != nullptr && away > tolerance) far->push_back({x, away});
    if (away > d.wall_max) d.wall_max = away, d.wall_place = x;
  }
  const auto count = static_cast<double>(wall.size());
  if (!wall.empty()) d.wall_rms = std::sqrt(d.wall_rms / count), d.wall_beyond /= count;
  return d;
}

}  // namespace tunica::meshing
