// SPDX-License-Identifier: MIT
// A quadrilateral as the bilinear face between its corners: its points and its distance from others.
#pragma once

#include "tunica/core/vec.hpp"
#include "tunica/mesh/mesh.hpp"
#include "tunica/mesh/triangle.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

namespace tunica::meshing {

struct QuadFace {
  std::array<Vec3, 4> x;  // corners in their order

  /// (1-u)(1-v) x0 + u (1-v) x1 + u v x2 + (1-u) v x3
  [[nodiscard]] Vec3 at(double u, double v) const {
    return vec::between(vec::between(x[0], x[1], u), vec::between(x[3], x[2], u), v);
  }

  /// Square of the distance from the box around the corners, in which the face lies.
  [[nodiscard]] double squared_distance_of_box(const Vec3& p) const {
    Box box;
    for (const Vec3& corner : x) box.extend(corner);
    return box.squared_distance(p);
  }

  /// Square of the distance: from the nearest point of the four triangles around the middle, two steps of
  /// Gauss and Newton on the face itself.
  [[nodiscard]] double squared_distance(const Vec3& p) const {
    constexpr std::array<double, 5> corner_u{0, 1, 1, 0, 0}, corner_v{0, 0, 1, 1, 0};
    const Vec3 middle = at(0.5, 0.5);
    double least = std::numeric_limits<double>::infinity(), u = 0, v = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      const mesh::Triangle t{x[k], x[(k + 1) % 4], middle};
      const Vec3 w = t.nearest(p);
      const double square = vec::squared(vec::minus(t.at(w), p));
      if (!(square < least)) continue;
      least = square;
      u = w[0] * corner_u[k] + w[1] * corner_u[k + 1] + 0.5 * w[2];
      v = w[0] * corner_v[k] + w[1] * corner_v[k + 1] + 0.5 * w[2];
    }
    Vec3 r = vec::minus(p, at(u, v));
    least = vec::squared(r);
    for (int step = 0; step < 2; ++step) {
      const Vec3 along = vec::between(vec::minus(x[1], x[0]), vec::minus(x[2], x[3]), v),
                 across = vec::between(vec::minus(x[3], x[0]), vec::minus(x[2], x[1]), u);
      const double aa = vec::dot(along, along), ab = vec::dot(along, across), bb = vec::dot(across, across),
                   ra = vec::dot(along, r), rb = vec::dot(across, r), det = aa * bb - ab * ab;
      if (!(det > 0)) break;
      u = std::clamp(u + (bb * ra - ab * rb) / det, 0.0, 1.0);
      v = std::clamp(v + (aa * rb - ab * ra) / det, 0.0, 1.0);
      r = vec::minus(p, at(u, v));
      least = std::min(least, vec::squared(r));
    }
    return least;
  }
};

[[nodiscard]] inline QuadFace quad_face(const Points<3>& nodes, const Connectivity<4>& cells, Index q) {
  return {{vec::column(nodes, cells(0, q)), vec::column(nodes, cells(1, q)), vec::column(nodes, cells(2, q)),
           vec::column(nodes, cells(3, q))}};
}

}  // namespace tunica::meshing
