// SPDX-License-Identifier: MIT
// Target edge lengths: the concept, and the field that a surface carries into its inside.
#pragma once

#include "tunica/core/types.hpp"
#include "tunica/core/vec.hpp"
#include "tunica/mesh/sorted_halves.hpp"
#include "tunica/mesh/triangle.hpp"
#include "tunica/search/octree.hpp"

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <vector>

namespace tunica::meshing {

/// Target edge length at a point, in the unit of the mesh; positive and finite.
///   [](const Vec3& x) { return 0.5 + 0.1 * x[2]; }
template <class S>
concept SizeField = requires(const S& size, const Vec3& x) {
  { size(x) } -> std::convertible_to<double>;  // a size field gives an edge length at a point
};

/// The same length everywhere.
struct ConstantSize {
  double edge;
  [[nodiscard]] double operator()(const Vec3&) const { return edge; }
};

/// Distance to a closed oriented surface, the side, and the size of its triangles, at any point.
/// As a size field: the smoothed edge length of the surface at its nearest point, plus growth
/// times the distance.
class SurfaceSize {
 public:
  SurfaceSize(const Points<3>& points, const Connectivity<3>& triangles, double growth)
      : points_(points), triangles_(triangles), growth_(growth) {
    std::vector<Box> boxes;
    for (Eigen::Index t = 0; t < triangles.cols(); ++t)
      boxes.push_back(triangle(static_cast<Index>(t)).box());
    for (Eigen::Index n = 0; n < points.cols(); ++n) box_.extend(node(static_cast<Index>(n)));
    tree_ = search::Octree(boxes);
    find_sizes();
    find_normals();
  }

  struct Near {
    double distance, size;  // to the surface; smoothed edge length there
    bool inside;
  };
  [[nodiscard]] Near nearest(const Vec3& x) const {
    const auto hit = tree_.nearest(x, [&](Index t) {
      const mesh::Triangle tri = triangle(t);
      return vec::squared(vec::minus(tri.at(tri.nearest(x)), x));
    });
    const mesh::Triangle tri = triangle(hit.item);
    const Vec3 w = tri.nearest(x), foot = tri.at(w);
    // The normal of the feature that is nearest: face, edge or node; angle-weighted at a node.
    Vec3 normal = vec::unit(tri.area_vector());
    double size = 0;
    int zeros = 0;
    Eigen::Index zero = 0, one = 0;
    for (Eigen::Index i = 0; i < 3; ++i) {
      size += w[i] * size_[at(triangles_(i, hit.item))];
      if (w[i] == 0) ++zeros, zero = i;
      if (w[i] > w[one]) one = i;
    }
    if (zeros == 2) normal = normal_[at(triangles_(one, hit.item))];
    if (zeros == 1) normal = edge_normal_[at(hit.item)][at(zero)];
    return {std::sqrt(hit.squared_distance), size, vec::dot(vec::minus(x, foot), normal) < 0};
  }

  [[nodiscard]] double operator()(const Vec3& x) const {
    const Near near = nearest(x);
    return near.size + growth_ * near.distance;
  }

  [[nodiscard]] const Box& box() const { return box_; }
  [[nodiscard]] const std::vector<double>& node_sizes() const { return size_; }
  [[nodiscard]] Vec3 node(Index n) const { return vec::column(points_, n); }

 private:
  template <class I>
  [[nodiscard]] static std::size_t at(I i) {
    return static_cast<std::size_t>(i);
  }
  [[nodiscard]] mesh::Triangle triangle(Index t) const {
    return {node(triangles_(0, t)), node(triangles_(1, t)), node(triangles_(2, t))};
  }

  /// Mean length of the edges at each node, then averaged with the neighbours: slivers do not show.
  void find_sizes() {
    constexpr int sweeps = 5;
    const auto n = at(points_.cols());
    std::vector<double> weight(n, 0), sum(n, 0);
    for (Eigen::Index t = 0; t < triangles_.cols(); ++t)
      for (Eigen::Index i = 0; i < 3; ++i) {
        const Index a = triangles_(i, t), b = triangles_((i + 1) % 3, t);
        const double l = vec::distance(node(a), node(b));
        sum[at(a)] += l, sum[at(b)] += l, ++weight[at(a)], ++weight[at(b)];
      }
    size_.resize(n);
    for (std::size_t i = 0; i < n; ++i) size_[i] = sum[i] / std::max(weight[i], 1.0);
    for (int sweep = 0; sweep < sweeps; ++sweep) {
      std::fill(sum.begin(), sum.end(), 0.0);
      for (Eigen::Index t = 0; t < triangles_.cols(); ++t)
        for (Eigen::Index i = 0; i < 3; ++i) {
          const Index a = triangles_(i, t), b = triangles_((i + 1) % 3, t);
          sum[at(a)] += size_[at(b)], sum[at(b)] += size_[at(a)];
        }
      for (std::size_t i = 0; i < n; ++i) size_[i] = 0.5 * (size_[i] + sum[i] / std::max(weight[i], 1.0));
    }
  }

  /// Angle-weighted normals of nodes and normals of edges: they tell the side [BAERENTZEN05].
  void find_normals() {
    normal_.assign(at(points_.cols()), Vec3(0, 0, 0));
    std::vector<Vec3> unit;  // normals of the triangles
    edge_normal_.resize(at(triangles_.cols()));
    for (Index t = 0; t < static_cast<Index>(triangles_.cols()); ++t) {
      const mesh::Triangle tri = triangle(t);
      const Vec3 n = vec::unit(tri.area_vector());
      const std::array<Vec3, 3> p{tri.a, tri.b, tri.c};
      for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 u = vec::minus(p[(i + 1) % 3], p[i]), v = vec::minus(p[(i + 2) % 3], p[i]);
        Vec3& sum = normal_[at(triangles_(static_cast<Eigen::Index>(i), t))];
        sum = vec::along(sum, std::atan2(vec::length(vec::cross(u, v)), vec::dot(u, v)), n);
      }
      unit.push_back(n);
    }
    const auto halves =
        mesh::sorted_halves(static_cast<Index>(triangles_.cols()), static_cast<Index>(points_.cols()),
                            [&](Index t, Index i) { return triangles_(i, t); });
    for (std::size_t i = 0; i < halves.size();) {
      std::size_t end = i;
      Vec3 sum(0, 0, 0);
      for (; end < halves.size() && halves[end].a == halves[i].a && halves[end].b == halves[i].b; ++end)
        sum = vec::plus(sum, unit[at(halves[end].triangle)]);
      for (; i < end; ++i)  // of a corner: that of the edge opposite to it
        edge_normal_[at(halves[i].triangle)][at((halves[i].corner + 2) % 3)] = sum;
    }
  }

  const Points<3>& points_;
  const Connectivity<3>& triangles_;
  double growth_;
  Box box_;
  search::Octree tree_;
  std::vector<double> size_;
  std::vector<Vec3> normal_;
  std::vector<std::array<Vec3, 3>> edge_normal_;
};

/// A size field, but no longer than the triangles of a surface near it, which it outgrows at the rate of
/// SurfaceSize. The size that a surface carries inside is left as it is.
template <SizeField Size>
class SizeWithin {
 public:
  static constexpr bool of_surface = std::same_as<Size, SurfaceSize>;

  /// The rate for SurfaceSize: that asked for, and for a field in space a third when none is.
  [[nodiscard]] static double growth(double asked) {
    constexpr double usual = 0.3;
    return of_surface || asked > 0 ? asked : usual;
  }

  SizeWithin(const SurfaceSize& surface, const Size& field) : surface_(surface), field_(field) {
    for (const double h : surface.node_sizes()) least_ = std::min(least_, h);
  }

  [[nodiscard]] double operator()(const Vec3& x) const {
    const double h = field_(x);
    return of_surface || h <= least_ ? h : std::min(h, surface_(x));
  }

 private:
  const SurfaceSize& surface_;
  const Size& field_;
  double least_ = std::numeric_limits<double>::infinity();
};

}  // namespace tunica::meshing
