// SPDX-License-Identifier: MIT
// What is promised of a filling, checked from the mesh alone: signs, border, nodes, volume.
#pragma once

#include "tunica/core/vec.hpp"
#include "tunica/mesh/mesh.hpp"
#include "tunica/mesh/topology.hpp"
#include "tunica/meshing/predicates.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <vector>

namespace tunica::test {

/// A triangle as it turns, from its smallest node on.
using TurnedFace = std::array<Index, 3>;
inline TurnedFace turned(TurnedFace f) {
  std::rotate(f.begin(), std::min_element(f.begin(), f.end()), f.end());
  return f;
}

inline std::vector<TurnedFace> turned_triangles(const mesh::Surface& s) {
  std::vector<TurnedFace> all;
  for (Index t = 0; t < s.cell_count(); ++t)
    all.push_back(turned({s.cells(0, t), s.cells(1, t), s.cells(2, t)}));
  std::sort(all.begin(), all.end());
  return all;
}

/// Faces whose reverse no other tetrahedron has, sorted.
inline std::vector<TurnedFace> turned_border(const mesh::TetMesh& m) {
  std::vector<TurnedFace> all, open;
  for (Index t = 0; t < m.cell_count(); ++t)
    for (const auto& f : mesh::Tet4::faces)
      all.push_back(turned({m.cells(f[0], t), m.cells(f[1], t), m.cells(f[2], t)}));
  std::sort(all.begin(), all.end());
  for (const TurnedFace& f : all)
    if (!std::binary_search(all.begin(), all.end(), turned({f[0], f[2], f[1]}))) open.push_back(f);
  return open;
}

/// Does every component enclose the inside of a body or, within one, of a cavity? Its volume is positive
/// where an even number of others encloses it, negative where an odd one does.
inline bool nested_outward(const mesh::Surface& s) {
  const auto t = mesh::topology(s);
  Index count = 0;
  for (const Index c : t.component_of) count = std::max(count, c + 1);
  const auto corner = [&](Index i, Index f) { return vec::column(s.nodes, s.cells(i, f)); };
  const auto at = [](Index i) { return static_cast<std::size_t>(i); };
  std::vector<long double> volume(at(count), 0);
  std::vector<Vec3> start(at(count));
  for (Index f = s.cell_count() - 1; f >= 0; --f) start[at(t.component_of[at(f)])] = corner(0, f);
  for (Index f = 0; f < s.cell_count(); ++f) {
    const Index c = t.component_of[at(f)];
    const Vec3 a = corner(0, f) - start[at(c)], b = corner(1, f) - start[at(c)],
               d = corner(2, f) - start[at(c)];
    volume[at(c)] += vec::dot(vec::cross(a, b), d);
  }
  for (Index c = 0; c < count; ++c) {
    double solid_angles = 0;  // [OOSTEROM83] of the other components as seen from this one
    for (Index f = 0; f < s.cell_count(); ++f) {
      if (t.component_of[at(f)] == c) continue;
      const Vec3 x = corner(0, f) - start[at(c)], y = corner(1, f) - start[at(c)],
                 z = corner(2, f) - start[at(c)];
      const double p = vec::length(x), q = vec::length(y), r = vec::length(z);
      solid_angles +=
          2 * std::atan2(vec::dot(vec::cross(x, y), z),
                         p * q * r + vec::dot(x, y) * r + vec::dot(y, z) * p + vec::dot(z, x) * q);
    }
    const bool inside = std::abs(solid_angles) > 2 * std::numbers::pi;
    if (inside ? !(volume[at(c)] < 0) : !(volume[at(c)] > 0)) return false;
  }
  return true;
}

/// The first promise that a filling breaks, empty: none. Signs are exact; the volume is summed in long
/// double.
inline std::string filling_fault(const mesh::Surface& s, const mesh::TetMesh& m) {
  if (m.node_count() < s.node_count() || m.nodes.leftCols(s.node_count()) != s.nodes)
    return "the nodes of the surface are not the first ones";
  const auto corner = [&](Index i, Index t) { return vec::column(m.nodes, m.cells(i, t)); };
  const auto six_volumes = [](const Vec3& o, const Vec3& a, const Vec3& b, const Vec3& c) {
    const auto d = [&o](const Vec3& p, Eigen::Index k) { return static_cast<long double>(p[k]) - o[k]; };
    return (d(a, 1) * d(b, 2) - d(a, 2) * d(b, 1)) * d(c, 0) +
           (d(a, 2) * d(b, 0) - d(a, 0) * d(b, 2)) * d(c, 1) +
           (d(a, 0) * d(b, 1) - d(a, 1) * d(b, 0)) * d(c, 2);
  };
  long double volume = 0, bounded = 0, size = 0;
  for (Index t = 0; t < m.cell_count(); ++t) {
    if (!(meshing::orient3d(corner(0, t), corner(1, t), corner(2, t), corner(3, t)) > 0))
      return "tetrahedron " + std::to_string(t) + " is inverted";
    volume += six_volumes(corner(0, t), corner(1, t), corner(2, t), corner(3, t));
  }
  const Vec3 origin = vec::column(s.nodes, s.cells(0, 0));
  for (Index t = 0; t < s.cell_count(); ++t) {
    const auto p = [&](Index i) { return vec::column(s.nodes, s.cells(i, t)); };
    const long double part = six_volumes(origin, p(0), p(1), p(2));
    bounded += part, size += std::abs(part);
  }
  // Thin surfaces enclose much less than the cones from the origin that add up to it.
  if (!(std::abs(volume - bounded) <= 1e-12L * bounded + 1e-17L * size)) return "the volume does not add up";
  if (turned_border(m) != turned_triangles(s)) return "the border is not the surface";
  return {};
}

}  // namespace tunica::test
