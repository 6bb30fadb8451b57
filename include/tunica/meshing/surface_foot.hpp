// SPDX-License-Identifier: MIT
// The point of a triangulated surface nearest to a given one, with the smooth normal there.
#pragma once

#include "tunica/core/expect.hpp"
#include "tunica/core/vec.hpp"
#include "tunica/mesh/measures.hpp"
#include "tunica/mesh/mesh.hpp"
#include "tunica/meshing/vertex_normals.hpp"
#include "tunica/search/octree.hpp"

#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <vector>

namespace tunica::meshing {

/// The nearest point, the interpolated unit normal there, and the distance.
struct Foot {
  Vec3 point, normal;
  double distance = std::numeric_limits<double>::infinity();
};

/// The nearest point as a combination of the nodes of its triangle.
struct FootWeights {
  Index triangle = -1;  // of the surface
  Vec3 weights, point;
};

/// What nodes can be slid on: triangles (FootFinder), or a surface known in closed form.
template <class S>
concept FootSurface = requires(const S& s, const Vec3& x) {
  { s.nearest(x) } -> std::convertible_to<Foot>;
  { s.nearest_facing(x, x) } -> std::convertible_to<Foot>;
  { s.distance(x) } -> std::convertible_to<double>;
};

/// The distance of x where it is above `enough`; where it is not, that or another one that is not either.
template <FootSurface S>
[[nodiscard]] double distance_above(const S& surface, const Vec3& x, double enough) {
  if constexpr (requires { surface.distance(x, enough); })
    return surface.distance(x, enough);
  else
    return surface.distance(x);
}

/// The triangles of one region of a surface, ready to be asked for what is nearest.
class TriangleFinder {
 public:
  explicit TriangleFinder(const mesh::Surface& surface, Index region = 0) {
    std::vector<Box> boxes;
    for (Index t = 0; t < surface.cell_count(); ++t) {
      if (surface.region_of(t) != region) continue;
      triangles_.push_back(t);
      shape_.push_back(mesh::triangle(surface, t));
      boxes.push_back(shape_.back().box());
    }
    tree_ = search::Octree(boxes);
  }

  [[nodiscard]] bool empty() const { return triangles_.empty(); }

  /// Where it is not above `enough` it may be that of another triangle within that distance.
  [[nodiscard]] double distance(const Vec3& x, double enough = 0) const {
    constexpr double unbounded = std::numeric_limits<double>::infinity();
    const auto found = tree_.nearest(
        x, [&](Index i) { return squared(x, i); }, unbounded, enough * enough);
    return std::sqrt(found.squared_distance);
  }

  /// Of a surface that is not empty.
  [[nodiscard]] FootWeights nearest_weights(const Vec3& x) const {
    const auto found = tree_.nearest(x, [&](Index i) { return squared(x, i); });
    const auto& t = shape(found.item);
    const Vec3 weights = t.nearest(x);
    return {triangle(found.item), weights, t.at(weights)};
  }

 protected:
  /// Of an item of the tree: its number in the surface, its corners, the squared distance of a point.
  [[nodiscard]] Index triangle(Index item) const { return triangles_[static_cast<std::size_t>(item)]; }
  [[nodiscard]] const mesh::Triangle& shape(Index item) const {
    return shape_[static_cast<std::size_t>(item)];
  }
  [[nodiscard]] double squared(const Vec3& x, Index item) const {
    const auto& t = shape(item);
    const Vec3 way = vec::minus(t.at(t.nearest(x)), x);
    return vec::dot(way, way);
  }
  [[nodiscard]] const search::Octree& tree() const { return tree_; }

 private:
  std::vector<Index> triangles_;
  std::vector<mesh::Triangle> shape_;
  search::Octree tree_;
};

/// The same with the normals of the surface.
class FootFinder : public TriangleFinder {
 public:
  explicit FootFinder(const mesh::Surface& surface, Index region = 0)
      : TriangleFinder(surface, region), surface_(surface), normals_(vertex_normals(surface, region)) {
    for (Index t = 0; t < surface.cell_count(); ++t)
      if (surface.region_of(t) == region) area_.push_back(mesh::triangle(surface, t).area_vector());
  }

  [[nodiscard]] Foot nearest(const Vec3& x, double bound = std::numeric_limits<double>::infinity()) const {
    return foot(x, tree().nearest(
                       x, [&](Index i) { return squared(x, i); }, bound * bound));
  }

  /// The nearest among the triangles that face the same way as the normal: not the far side of a fold.
  [[nodiscard]] Foot nearest_facing(const Vec3& x, const Vec3& normal) const {
    const auto found = tree().nearest(x, [&](Index i) {
      const bool facing = vec::dot(area_[static_cast<std::size_t>(i)], normal) > 0;
      return facing ? squared(x, i) : std::numeric_limits<double>::infinity();
    });
    return found.item >= 0 && std::isfinite(found.squared_distance) ? foot(x, found) : nearest(x);
  }

 private:
  [[nodiscard]] Foot foot(const Vec3& x, const search::Nearest& found) const {
    if (found.item < 0) return {x, Vec3::Zero()};
    const auto& t = shape(found.item);
    const Vec3 weights = t.nearest(x);
    Vec3 n = Vec3::Zero();
    for (int k = 0; k < 3; ++k)
      n = vec::along(n, weights[k],
                     normals_[static_cast<std::size_t>(surface_.cells(k, triangle(found.item)))]);
    const Vec3 p = t.at(weights);
    return {p, vec::length(n) > 0 ? vec::unit(n) : vec::unit(t.area_vector()), vec::distance(p, x)};
  }

  const mesh::Surface& surface_;
  std::vector<Vec3> normals_, area_;  // of nodes; of the triangles of the region
};

}  // namespace tunica::meshing
