// SPDX-License-Identifier: MIT
// The point of a face nearest to a given one, as the values of the face's shape functions there.
#pragma once

#include "tunica/core/types.hpp"
#include "tunica/mesh/cell.hpp"
#include "tunica/mesh/triangle.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace tunica::coupling {

/// Weights of the nodes of a face at the nearest point; they are >= 0 and sum to 1.
template <class Face>
struct ClosestPoint {
  Eigen::Matrix<double, Face::nodes, 1> weights;
  double squared_distance = std::numeric_limits<double>::infinity();  // in the unit of the nodes, squared
};

template <class Face>
using FaceNodes = Eigen::Matrix<double, 3, Face::nodes>;  // one column a node

/// The point of a triangle nearest to x.
[[nodiscard]] inline ClosestPoint<mesh::Tri3> closest_point(const mesh::Tri3&,
                                                            const FaceNodes<mesh::Tri3>& nodes,
                                                            const Vec3& x) {
  const Vec3 w = mesh::Triangle{nodes.col(0), nodes.col(1), nodes.col(2)}.nearest(x);
  return {w, (nodes * w - x).squaredNorm()};
}

namespace detail {

/// x(s,t) = (1-s)(1-t) x0 + s (1-t) x1 + s t x2 + (1-s) t x3 for 0 <= s, t <= 1.
[[nodiscard]] inline Eigen::Vector4d bilinear(double s, double t) {
  return {(1 - s) * (1 - t), s * (1 - t), s * t, (1 - s) * t};
}

/// The best point of the four edges of a quadrilateral.
[[nodiscard]] inline ClosestPoint<mesh::Quad4> closest_on_edges(const FaceNodes<mesh::Quad4>& nodes,
                                                                const Vec3& x) {
  ClosestPoint<mesh::Quad4> best;
  for (const auto& edge : mesh::Quad4::faces) {
    const Vec3 a = nodes.col(edge[0]), ab = nodes.col(edge[1]) - a;
    const double length = ab.squaredNorm();
    const double s = length > 0 ? std::clamp((x - a).dot(ab) / length, 0.0, 1.0) : 0.0;
    const double distance = (a + s * ab - x).squaredNorm();
    if (!(distance < best.squared_distance)) continue;
    best.squared_distance = distance;
    best.weights.setZero();
    best.weights[edge[0]] = 1 - s;
    best.weights[edge[1]] = s;
  }
  return best;
}

}  // namespace detail

/// The point of a bilinear quadrilateral nearest to x: the best of its edges and of the interior
/// minima that Newton's method finds from the centre and the centres of the four quarters.
[[nodiscard]] inline ClosestPoint<mesh::Quad4> closest_point(const mesh::Quad4&,
                                                             const FaceNodes<mesh::Quad4>& nodes,
                                                             const Vec3& x) {
  constexpr std::array<std::array<double, 2>, 5> starts{
      {{0.5, 0.5}, {0.25, 0.25}, {0.75, 0.25}, {0.75, 0.75}, {0.25, 0.75}}};
  constexpr int most_iterations = 30;
  constexpr double tolerance = 1e-15;  // of (s,t), which are of order 1
  const Vec3 twist = nodes.col(0) - nodes.col(1) + nodes.col(2) - nodes.col(3);  // d2x / ds dt
  ClosestPoint<mesh::Quad4> best = detail::closest_on_edges(nodes, x);
  for (const auto& start : starts) {
    Eigen::Vector2d st(start[0], start[1]);
    for (int k = 0; k < most_iterations; ++k) {
      const Vec3 gap = nodes * detail::bilinear(st[0], st[1]) - x;
      const Vec3 xs = (1 - st[1]) * (nodes.col(1) - nodes.col(0)) + st[1] * (nodes.col(2) - nodes.col(3));
      const Vec3 xt = (1 - st[0]) * (nodes.col(3) - nodes.col(0)) + st[0] * (nodes.col(2) - nodes.col(1));
      const double a = xs.squaredNorm(), b = xt.squaredNorm(), mixed = xs.dot(xt);
      double c = mixed + gap.dot(twist);               // d2/dsdt of |gap|^2 / 2
      if (!(a * b - c * c > 1e-3 * a * b)) c = mixed;  // Gauss-Newton where the Hessian is indefinite
      const double determinant = a * b - c * c;
      if (!(determinant > 0)) break;
      const double gs = xs.dot(gap), gt = xt.dot(gap);
      const Eigen::Vector2d step((b * gs - c * gt) / determinant, (a * gt - c * gs) / determinant);
      const Eigen::Vector2d next = (st - step).cwiseMax(0.0).cwiseMin(1.0);
      const double moved = (next - st).cwiseAbs().maxCoeff();
      st = next;
      if (!(moved > tolerance)) break;
    }
    const Eigen::Vector4d w = detail::bilinear(st[0], st[1]);
    const double distance = (nodes * w - x).squaredNorm();
    if (distance < best.squared_distance) best = {w, distance};
    if (twist.squaredNorm() == 0) break;  // a parallelogram has one minimum
  }
  return best;
}

}  // namespace tunica::coupling
