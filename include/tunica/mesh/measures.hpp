// SPDX-License-Identifier: MIT
// Lengths, areas and volumes: V = 1/3 of the integral of x.n over the boundary (divergence theorem).
#pragma once

#include "tunica/core/vec.hpp"
#include "tunica/mesh/mesh.hpp"
#include "tunica/mesh/triangle.hpp"

#include <array>
#include <concepts>
#include <cstddef>

namespace tunica::mesh {

[[nodiscard]] inline Triangle triangle(const Surface& s, Index t) {
  return {vec::column(s.nodes, s.cells(0, t)), vec::column(s.nodes, s.cells(1, t)),
          vec::column(s.nodes, s.cells(2, t))};
}

/// Place of a node.
[[nodiscard]] inline Vec3 node(const Surface& s, Index n) {
  return vec::column(s.nodes, n);
}

template <int Dim>
[[nodiscard]] Box bounding_box(const Points<Dim>& nodes) {
  Box box;
  for (Eigen::Index n = 0; n < nodes.cols(); ++n) {
    Vec3 x(0, 0, 0);
    for (Eigen::Index a = 0; a < Dim; ++a) x[a] = nodes(a, n);
    box.extend(x);
  }
  return box;
}

/// Area, in the unit of the nodes squared.
[[nodiscard]] inline double area(const Surface& s) {
  double sum = 0;
  for (Index t = 0; t < s.cell_count(); ++t) sum += triangle(s, t).area();
  return sum;
}

/// Area of the triangles of one region.
[[nodiscard]] inline double area_of_region(const Surface& s, Index region) {
  double sum = 0;
  for (Index t = 0; t < s.cell_count(); ++t)
    if (s.region_of(t) == region) sum += triangle(s, t).area();
  return sum;
}

/// Signed volume of the cone from o over a triangle: det(a-o, b-o, c-o)/6.
[[nodiscard]] inline double cone_volume(const Triangle& f, const Vec3& o) {
  return vec::dot(vec::minus(f.a, o), vec::cross(vec::minus(f.b, o), vec::minus(f.c, o))) / 6;
}

/// Volume that a closed surface encloses: positive where its normals point outward.
/// V = sum det(a-o, b-o, c-o)/6; the origin o is the centre of the box, so that the sum does not cancel.
[[nodiscard]] inline double enclosed_volume(const Surface& s) {
  const Vec3 o = s.node_count() == 0 ? Vec3(0, 0, 0) : bounding_box(s.nodes).centre();
  double sum = 0, carry = 0;  // compensated: drifts of 1e-12 are measured with it
  for (Index t = 0; t < s.cell_count(); ++t) {
    const double term = cone_volume(triangle(s, t), o) - carry;
    const double next = sum + term;
    carry = (next - sum) - term;
    sum = next;
  }
  return sum;
}

/// Signed volume of a tetrahedron: positive when d lies where the normal of (a, b, c) points.
[[nodiscard]] inline double tet_volume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return vec::dot(vec::cross(vec::minus(b, a), vec::minus(c, a)), vec::minus(d, a)) / 6;
}

[[nodiscard]] inline double volume(const TetMesh& m) {
  double sum = 0;
  for (Index t = 0; t < m.cell_count(); ++t)
    sum += tet_volume(vec::column(m.nodes, m.cells(0, t)), vec::column(m.nodes, m.cells(1, t)),
                      vec::column(m.nodes, m.cells(2, t)), vec::column(m.nodes, m.cells(3, t)));
  return sum;
}

/// Volume of the trilinear hexahedra: exact with 2x2x2 Gauss points, det J is at most quadratic an axis.
template <std::same_as<Hex8> C>
[[nodiscard]] double volume(const Mesh<C>& m) {
  constexpr double g = 0.57735026918962576;  // 1/sqrt(3)
  constexpr std::array<std::array<int, 3>, 8> corner{
      {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1}, {-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}}};
  double sum = 0;
  for (Index c = 0; c < m.cell_count(); ++c)
    for (const auto& p : corner) {
      Vec3 xi(0, 0, 0), eta(0, 0, 0), zeta(0, 0, 0);  // derivatives of x by the local coordinates
      for (std::size_t n = 0; n < 8; ++n) {
        const auto& q = corner[n];
        const double u = 1 + g * p[0] * q[0], v = 1 + g * p[1] * q[1], w = 1 + g * p[2] * q[2];
        const Vec3 x = vec::column(m.nodes, m.cells(static_cast<Eigen::Index>(n), c));
        xi = vec::along(xi, q[0] * v * w / 8, x), eta = vec::along(eta, u * q[1] * w / 8, x);
        zeta = vec::along(zeta, u * v * q[2] / 8, x);
      }
      sum += vec::dot(xi, vec::cross(eta, zeta));
    }
  return sum;
}

}  // namespace tunica::mesh
