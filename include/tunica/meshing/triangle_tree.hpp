// SPDX-License-Identifier: MIT
// A binary tree of boxes over triangles with a value at each corner: the least of value plus slope times
// distance at a point, and where a ray leaves the volume that the triangles bound.
#pragma once

#include "tunica/core/types.hpp"
#include "tunica/core/vec.hpp"
#include "tunica/mesh/triangle.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace tunica::meshing {

/// A triangle (or a point, where its corners coincide) with a value at each corner, linear in between.
struct ValuedTriangle {
  mesh::Triangle shape;
  std::array<double, 3> value{0, 0, 0};

  [[nodiscard]] double least() const { return std::min({value[0], value[1], value[2]}); }
  [[nodiscard]] double at(const Vec3& weights) const {
    return weights[0] * value[0] + weights[1] * value[1] + weights[2] * value[2];
  }
};

/// Halved at the median of the centres along the longest side of their box: the order depends on the
/// triangles alone.
class TriangleTree {
 public:
  TriangleTree() = default;
  explicit TriangleTree(std::vector<ValuedTriangle> items) : items_(std::move(items)) {
    if (!items_.empty()) build(0, static_cast<Index>(items_.size()));
  }

  [[nodiscard]] bool empty() const { return items_.empty(); }

  /// The least of value(y) + slope |x - y| over the triangles, y the point of each nearest to x; `most` if
  /// none is below it.
  [[nodiscard]] double least(const Vec3& x, double slope, double most) const {
    double best = most;
    if (empty()) return best;
    std::array<Waiting, most_waiting> stack;
    std::size_t waiting = 0;
    stack[waiting++] = {0, slope * slope * nodes_[0].box.squared_distance(x)};
    while (waiting > 0) {
      const Waiting top = stack[--waiting];
      const Node* node = &nodes_[at(top.node)];
      if (!below(*node, top.rise, best)) continue;
      if (node->count == 0) {
        Waiting near{top.node + 1, 0}, far{node->next, 0};
        near.rise = slope * slope * nodes_[at(near.node)].box.squared_distance(x);
        far.rise = slope * slope * nodes_[at(far.node)].box.squared_distance(x);
        if (far.rise < near.rise ||
            (far.rise == near.rise && nodes_[at(far.node)].least < nodes_[at(near.node)].least))
          std::swap(near, far);
        stack[waiting++] = far, stack[waiting++] = near;
        continue;
      }
      for (Index i = node->next; i < node->next + node->count; ++i) {
        const ValuedTriangle& item = items_[at(i)];
        const Vec3 weights = item.shape.nearest(x);
        best = std::min(best, item.at(weights) + slope * vec::distance(item.shape.at(weights), x));
      }
    }
    return best;
  }

  /// Distance along the unit direction to the first triangle beyond `from` that the ray leaves through its
  /// outer side; infinite when there is none.
  [[nodiscard]] double exit(const Vec3& origin, const Vec3& direction, double from) const {
    double best = std::numeric_limits<double>::infinity();
    if (empty()) return best;
    const Vec3 inverse(1 / direction[0], 1 / direction[1], 1 / direction[2]);
    std::array<Index, most_waiting> stack;
    std::size_t waiting = 0;
    stack[waiting++] = 0;
    while (waiting > 0) {
      const Index n = stack[--waiting];
      const Node& node = nodes_[at(n)];
      if (!meets(node.box, origin, inverse, best)) continue;
      if (node.count == 0) {
        stack[waiting++] = node.next, stack[waiting++] = n + 1;
        continue;
      }
      for (Index i = node.next; i < node.next + node.count; ++i) {
        const double t = exit(items_[at(i)].shape, origin, direction);
        if (t > from && t < best) best = t;
      }
    }
    return best;
  }

 private:
  struct Node {  // a leaf has `count` items from `next`; else its children are the following node and `next`
    Box box;
    double least = 0;
    Index next = 0, count = 0;
  };
  struct Waiting {
    Index node = 0;
    double rise = 0;  // the square of slope times distance
  };
  static constexpr Index leaf_size = 4;
  static constexpr std::size_t most_waiting = 64;  // two for each halving

  [[nodiscard]] static std::size_t at(Index i) { return static_cast<std::size_t>(i); }

  /// Something in the node may be less than best: least + slope d < best, without a root.
  [[nodiscard]] static bool below(const Node& n, double rise, double best) {
    const double room = best - n.least;
    return room > 0 && rise < room * room;
  }

  void build(Index begin, Index end) {
    const std::size_t me = nodes_.size();
    nodes_.emplace_back();
    Box box, centres;
    double least = std::numeric_limits<double>::infinity();
    for (Index i = begin; i < end; ++i) {
      const ValuedTriangle& item = items_[at(i)];
      box.extend(item.shape.box());
      centres.extend(item.shape.centroid());
      least = std::min(least, item.least());
    }
    nodes_[me].box = box, nodes_[me].least = least;
    if (end - begin <= leaf_size) {
      nodes_[me].next = begin, nodes_[me].count = end - begin;
      return;
    }
    int axis = 0;
    for (int a = 1; a < 3; ++a)
      if (centres.hi[a] - centres.lo[a] > centres.hi[axis] - centres.lo[axis]) axis = a;
    const Index middle = begin + (end - begin) / 2;
    std::nth_element(items_.begin() + begin, items_.begin() + middle, items_.begin() + end,
                     [axis](const ValuedTriangle& p, const ValuedTriangle& q) {
                       return p.shape.a[axis] + p.shape.b[axis] + p.shape.c[axis] <
                              q.shape.a[axis] + q.shape.b[axis] + q.shape.c[axis];
                     });
    build(begin, middle);
    nodes_[me].next = static_cast<Index>(nodes_.size());
    build(middle, end);
  }

  [[nodiscard]] static bool meets(const Box& box, const Vec3& origin, const Vec3& inverse, double most) {
    double from = 0, to = most;
    for (int a = 0; a < 3; ++a) {
      const double p = (box.lo[a] - origin[a]) * inverse[a], q = (box.hi[a] - origin[a]) * inverse[a];
      from = std::max(from, std::min(p, q)),
      to = std::min(to, std::max(p, q));  // NaN leaves both as they are
    }
    return from <= to;
  }

  /// [MOELLER97]: det of the edges and the direction; -1 when the ray misses or enters.
  [[nodiscard]] static double exit(const mesh::Triangle& f, const Vec3& origin, const Vec3& direction) {
    const Vec3 u = vec::minus(f.b, f.a), v = vec::minus(f.c, f.a), p = vec::cross(direction, v);
    const double det = -vec::dot(u, p);  // direction . (u x v): positive where the ray leaves
    if (!(det > 0)) return -1;
    const Vec3 r = vec::minus(origin, f.a);
    const double b = -vec::dot(r, p);
    if (!(b >= 0 && b <= det)) return -1;
    const Vec3 q = vec::cross(r, u);
    const double c = -vec::dot(direction, q);
    if (!(c >= 0 && b + c <= det)) return -1;
    return -vec::dot(v, q) / det;
  }

  std::vector<ValuedTriangle> items_;
  std::vector<Node> nodes_;
};

}  // namespace tunica::meshing
