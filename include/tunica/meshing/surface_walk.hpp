// SPDX-License-Identifier: MIT
// Points that slide on a triangulated surface: the nearest point is found by walking downhill from the
// triangle where the point was.
#pragma once

#include "tunica/core/vec.hpp"
#include "tunica/mesh/adjacency.hpp"
#include "tunica/mesh/measures.hpp"
#include "tunica/mesh/mesh.hpp"
#include "tunica/search/octree.hpp"

#include <cstddef>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace tunica::meshing {

/// A point of a triangle.
struct SurfacePoint {
  Index triangle = -1;
  Vec3 point;
};

/// Points stay on the facet where they are: triangles of another one are not entered.
class SurfaceWalk {
 public:
  /// facet: of each triangle of the closed surface, which must outlive the walk.
  SurfaceWalk(const mesh::Surface& surface, std::span<const Index> facet)
      : surface_(surface),
        facet_(facet.begin(), facet.end()),
        twin_(mesh::twins(surface.cells, surface.node_count())),
        around_(mesh::cells_of_nodes(surface.cells, surface.node_count())) {
    std::vector<Box> boxes;
    boxes.reserve(static_cast<std::size_t>(surface.cell_count()));
    for (Index t = 0; t < surface.cell_count(); ++t) boxes.push_back(mesh::triangle(surface, t).box());
    tree_ = search::Octree(boxes);
  }

  /// The nearest point of a facet.
  [[nodiscard]] SurfacePoint nearest(const Vec3& x, Index facet) const {
    const auto found = tree_.nearest(x, [&](Index t) {
      if (facet_[static_cast<std::size_t>(t)] != facet) return std::numeric_limits<double>::infinity();
      return on(t, x).squared;
    });
    return found.item < 0 ? SurfacePoint{-1, x} : SurfacePoint{found.item, on(found.item, x).point};
  }

  /// The point nearest to x that no neighbouring triangle betters, from a triangle of the facet.
  [[nodiscard]] SurfacePoint slide(Index triangle, const Vec3& x) const {
    Spot best = on(triangle, x);
    for (int step = 0; step < most_steps; ++step) {
      const Index from = triangle;
      const auto consider = [&](Index t) {
        if (t == from || facet_[static_cast<std::size_t>(t)] != facet_[static_cast<std::size_t>(from)])
          return;
        const Spot spot = on(t, x);
        if (spot.squared < best.squared) best = spot, triangle = t;
      };
      int zeros = 0, corner = 0, side = 0;
      for (int k = 0; k < 3; ++k) {
        if (best.weights[k] > 0)
          corner = k;
        else
          ++zeros, side = k;
      }
      if (zeros == 0) break;
      if (zeros == 1) {
        consider(twin_[static_cast<std::size_t>(3 * from + (side + 1) % 3)] / 3);
      } else {
        for (const Index t : around_[surface_.cells(corner, from)]) consider(t);
      }
      if (triangle == from) break;
    }
    return {triangle, best.point};
  }

  /// Outward normal, not of unit length.
  [[nodiscard]] Vec3 normal(Index triangle) const { return mesh::triangle(surface_, triangle).area_vector(); }

 private:
  struct Spot {
    Vec3 weights, point;
    double squared;
  };
  static constexpr int most_steps = 200;

  [[nodiscard]] Spot on(Index t, const Vec3& x) const {
    const mesh::Triangle f = mesh::triangle(surface_, t);
    const Vec3 w = f.nearest(x), p = f.at(w);
    return {w, p, vec::squared(vec::minus(p, x))};
  }

  const mesh::Surface& surface_;
  std::vector<Index> facet_;
  std::vector<Index> twin_;
  mesh::Rows around_;
  search::Octree tree_;
};

}  // namespace tunica::meshing
