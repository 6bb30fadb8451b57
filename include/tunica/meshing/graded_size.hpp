// SPDX-License-Identifier: MIT
// Sizes at the nodes of a surface that grow slowly along it, and the size field that carries them into space:
// h(x) = min over the triangles of h(y) + growth |x - y|, y the nearest point of each. [PERSSON06]
#pragma once

#include "tunica/core/expect.hpp"
#include "tunica/mesh/adjacency.hpp"
#include "tunica/mesh/measures.hpp"
#include "tunica/meshing/triangle_tree.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <queue>
#include <utility>
#include <vector>

namespace tunica::meshing {

/// A size field that grows from sized triangles and points by `growth` per distance, up to `most`. Where
/// sizes also grow along the triangles by that rate, its slope is sqrt(2) times it at most. It owns what it
/// needs; empty, it is `most` everywhere.
class GradedSize {
 public:
  GradedSize(std::vector<ValuedTriangle> places, double growth, double most)
      : tree_(std::move(places)), growth_(growth), most_(most) {}

  [[nodiscard]] double operator()(const Vec3& x) const { return tree_.least(x, growth_, most_); }

 private:
  TriangleTree tree_;
  double growth_, most_;
};

namespace detail {

/// The least size that c can have from those at a and b with the linear size between: min over t of
/// (1-t) p + t q + growth |a + t (b - a) - c|, in closed form.
[[nodiscard]] inline double carried(const Vec3& a, const Vec3& b, const Vec3& c, double p, double q,
                                    double growth) {
  const double ac = vec::distance(a, c), bc = vec::distance(b, c);
  double least = std::min(p + growth * ac, q + growth * bc);
  const Vec3 along = vec::minus(b, a);
  const double l = vec::length(along);
  if (!(l > 0)) return least;
  const double foot = vec::dot(vec::minus(c, a), along) / l;
  const double height = std::sqrt(std::max(ac * ac - foot * foot, 0.0));
  const double slope = (q - p) / l;  // the best place sees c at this sine over growth
  if (!(std::abs(slope) < growth)) return least;
  const double t = foot - height * slope / std::sqrt(growth * growth - slope * slope);
  if (t > 0 && t < l)
    least = std::min(least, p + slope * t + growth * std::sqrt(height * height + (foot - t) * (foot - t)));
  return least;
}

}  // namespace detail

/// Lowers sizes at the nodes until none grows faster than `growth` per length along the surface: from each
/// node in the order of the sizes over edges and across triangles (a fast marching that corrects itself).
[[nodiscard]] inline std::vector<double> graded(const mesh::Surface& s, std::vector<double> size,
                                                double growth) {
  TUNICA_EXPECT(size.size() == static_cast<std::size_t>(s.node_count()), "one size a node");
  const mesh::Rows around = mesh::cells_of_nodes(s.cells, s.node_count());
  using Entry = std::pair<double, Index>;
  const auto later = [](const Entry& a, const Entry& b) { return b < a; };
  std::priority_queue<Entry, std::vector<Entry>, decltype(later)> front(later);
  for (Index n = 0; n < s.node_count(); ++n)
    if (std::isfinite(size[static_cast<std::size_t>(n)])) front.push({size[static_cast<std::size_t>(n)], n});
  while (!front.empty()) {
    const auto [h, n] = front.top();
    front.pop();
    if (h > size[static_cast<std::size_t>(n)]) continue;  // lowered since
    for (const Index t : around[n])
      for (int k = 0; k < 3; ++k) {
        const Index to = s.cells(k, t);
        if (to == n) continue;
        const Index other = s.cells(0, t) + s.cells(1, t) + s.cells(2, t) - n - to;
        const double from_other = size[static_cast<std::size_t>(other)];
        double& now = size[static_cast<std::size_t>(to)];
        const double lower = std::isfinite(from_other)
                                 ? detail::carried(mesh::node(s, n), mesh::node(s, other), mesh::node(s, to),
                                                   h, from_other, growth)
                                 : h + growth * vec::distance(mesh::node(s, n), mesh::node(s, to));
        constexpr double step = 1 - 1e-12;  // rounding is no reason to go on
        if (lower < step * now) now = lower, front.push({lower, to});
      }
  }
  return size;
}

/// The field of sizes at the nodes of a surface, graded along it and into space, from the triangles that
/// counts(triangle) picks.
template <class Counts>
[[nodiscard]] GradedSize graded_size(const mesh::Surface& s, std::vector<double> size, double growth,
                                     double most, Counts&& counts) {
  TUNICA_EXPECT(growth > 0 && most > 0, "growth and the largest size are positive");
  size = graded(s, std::move(size), growth);
  std::vector<ValuedTriangle> places;
  for (Index t = 0; t < s.cell_count(); ++t) {
    if (!counts(t)) continue;
    ValuedTriangle place{mesh::triangle(s, t)};
    for (std::size_t k = 0; k < 3; ++k)
      place.value[k] =
          std::min(most, size[static_cast<std::size_t>(s.cells(static_cast<Eigen::Index>(k), t))]);
    places.push_back(place);
  }
  return {std::move(places), growth, most};
}

}  // namespace tunica::meshing
