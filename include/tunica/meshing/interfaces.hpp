// SPDX-License-Identifier: MIT
// Interfaces: the triangles between several regions, which meet along curves and in points; every region's
// boundary is a closed surface of them.
#pragma once

#include "tunica/core/vec.hpp"
#include "tunica/mesh/mesh.hpp"
#include "tunica/mesh/sorted_halves.hpp"
#include "tunica/mesh/triangle.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace tunica::meshing {

/// What lies on both sides of a triangle, whose normal points from the first to the second: regions, or as
/// the second a face of the image's box.
using Sides = std::array<Index, 2>;

[[nodiscard]] constexpr Index border_side(int face) {
  return -1 - face;
}
/// The face of the box, in the order of image::face_names, -1: a region.
[[nodiscard]] constexpr int border_face(Index side) {
  return side < 0 ? -1 - side : -1;
}

struct Interfaces {
  std::vector<Vec3> nodes;
  std::vector<Vec3> anchor, reach;          // of each node: how far from where its coordinates may move
  std::vector<std::uint8_t> frozen;         // of each node: bit a, coordinate a stays (faces of the box)
  std::vector<std::array<Index, 3>> faces;  // triangles
  std::vector<Sides> sides;                 // of each triangle

  [[nodiscard]] Index node_count() const { return static_cast<Index>(nodes.size()); }
  [[nodiscard]] const Vec3& at(Index n) const { return nodes[static_cast<std::size_t>(n)]; }
  [[nodiscard]] mesh::Triangle triangle(std::size_t t) const {
    return {at(faces[t][0]), at(faces[t][1]), at(faces[t][2])};
  }
  /// All triangles as one surface, for the exact test of intersections.
  [[nodiscard]] mesh::Surface surface() const {
    mesh::Surface s;
    s.nodes = vec::columns(nodes);
    s.cells.resize(3, static_cast<Eigen::Index>(faces.size()));
    for (std::size_t t = 0; t < faces.size(); ++t)
      for (std::size_t i = 0; i < 3; ++i)
        s.cells(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(t)) = faces[t][i];
    return s;
  }
};

/// An edge with the triangles that share it, in ascending order.
struct InterfaceEdge {
  Index a, b;         // a < b
  Index first, last;  // of InterfaceEdges::triangle
  bool junction;      // not just two triangles between the same two sides
};

struct InterfaceEdges {
  std::vector<InterfaceEdge> edges;  // by (a, b)
  std::vector<Index> triangle;
};

[[nodiscard]] inline InterfaceEdges edges_of(const Interfaces& s) {
  const auto halves = mesh::sorted_halves(
      static_cast<Index>(s.faces.size()), s.node_count(),
      [&](Index t, Index i) { return s.faces[static_cast<std::size_t>(t)][static_cast<std::size_t>(i)]; });
  InterfaceEdges r;
  for (std::size_t i = 0; i < halves.size();) {
    InterfaceEdge e{halves[i].a, halves[i].b, static_cast<Index>(i), static_cast<Index>(i), false};
    for (; i < halves.size() && halves[i].a == e.a && halves[i].b == e.b; ++i)
      r.triangle.push_back(halves[i].triangle);
    e.last = static_cast<Index>(i);
    const auto sides = [&](Index k) {
      return s.sides[static_cast<std::size_t>(r.triangle[static_cast<std::size_t>(k)])];
    };
    e.junction = e.last - e.first != 2 || sides(e.first) != sides(e.first + 1);
    r.edges.push_back(e);
  }
  return r;
}

/// Signed volumes that the triangles of each region enclose: of meaning where they close.
[[nodiscard]] inline std::vector<double> volumes_of(const Interfaces& s, std::size_t regions) {
  std::vector<long double> sum(regions, 0);
  Box box;
  for (const Vec3& x : s.nodes) box.extend(x);
  const Vec3 o = box.centre();
  for (std::size_t t = 0; t < s.faces.size(); ++t) {
    const mesh::Triangle f = s.triangle(t);
    const long double v = static_cast<long double>(
        vec::dot(vec::minus(f.a, o), vec::cross(vec::minus(f.b, o), vec::minus(f.c, o))));
    sum[static_cast<std::size_t>(s.sides[t][0])] += v / 6;
    if (s.sides[t][1] >= 0) sum[static_cast<std::size_t>(s.sides[t][1])] -= v / 6;
  }
  std::vector<double> volume;
  for (const long double v : sum) volume.push_back(static_cast<double>(v));
  return volume;
}

}  // namespace tunica::meshing
