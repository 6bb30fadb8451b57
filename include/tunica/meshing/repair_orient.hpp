// SPDX-License-Identifier: MIT
// Orientation of a surface that may be broken: facets agree over edges of two, parts face outward, those that
// lie within an odd number of others inward.
#pragma once

#include "tunica/core/error.hpp"
#include "tunica/mesh/measures.hpp"
#include "tunica/mesh/solid_angle.hpp"
#include "tunica/meshing/repair_edges.hpp"
#include "tunica/meshing/repair_report.hpp"

#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>
#include <vector>

namespace tunica::meshing::detail {

inline void turn_facet(mesh::Surface& s, Index t) {
  std::swap(s.cells(1, t), s.cells(2, t));
}

/// Turns the fewer facets of each sheet so that neighbours agree. MeshError, with an edge, where a sheet has
/// one side only.
inline void agree(mesh::Surface& s, RepairReport& report) {
  const SharedEdges edges(s.cells);
  const auto at = [](Index i) { return static_cast<std::size_t>(i); };
  std::vector<int> turn(at(s.cell_count()), -1);  // 1: against the first of its sheet
  std::vector<Index> sheet;
  for (Index seed = 0; seed < s.cell_count(); ++seed) {
    if (turn[at(seed)] >= 0) continue;
    sheet.assign(1, seed);
    turn[at(seed)] = 0;
    Index turned = 0;
    for (std::size_t i = 0; i < sheet.size(); ++i)
      for (Index h = 3 * sheet[i]; h < 3 * sheet[i] + 3; ++h) {
        const Index g = edges.across(h);
        if (g < 0 || g / 3 == sheet[i]) continue;
        const auto [a, b] = mesh::half_edge(s.cells, h);
        const int wanted = turn[at(sheet[i])] ^ (mesh::half_edge(s.cells, g).from == a ? 1 : 0);
        int& found = turn[at(g / 3)];
        if (found < 0) found = wanted, turned += wanted, sheet.push_back(g / 3);
        if (found != wanted)
          throw MeshError("the surface has one side only: facets cannot agree across the edge from " +
                          place(mesh::node(s, a)) + " to " + place(mesh::node(s, b)));
      }
    if (2 * turned > static_cast<Index>(sheet.size()))
      for (const Index t : sheet) turn[at(t)] ^= 1;
  }
  for (Index t = 0; t < s.cell_count(); ++t)
    if (turn[at(t)] == 1) turn_facet(s, t), report.turned.add(mesh::triangle(s, t).centroid());
}

/// Turns whole parts (joined over edges of any number of facets) by the number of others that they lie in.
inline void face_outward(mesh::Surface& s, RepairReport& report) {
  const SharedEdges edges(s.cells);
  const auto at = [](Index i) { return static_cast<std::size_t>(i); };
  std::vector<Index> part;
  const Index count = sheets(edges, s.cell_count(), part);
  std::vector<Box> box(at(count));
  std::vector<double> volume(at(count), 0);
  std::vector<Index> first(at(count), -1);
  if (s.cell_count() == 0) return;
  const Vec3 o = mesh::bounding_box(s.nodes).centre();
  for (Index t = 0; t < s.cell_count(); ++t) {
    const auto k = at(part[at(t)]);
    box[k].extend(mesh::triangle(s, t).box());
    volume[k] += mesh::cone_volume(mesh::triangle(s, t), o);
    if (first[k] < 0) first[k] = t;
  }
  std::vector<char> turn(box.size(), 0);
  for (std::size_t c = 0; c < box.size(); ++c) {
    int depth = 0;
    const Vec3 x = mesh::node(s, s.cells(0, first[c]));
    for (std::size_t d = 0; d < box.size(); ++d) {
      if (d == c || box[d].squared_distance(box[c].lo) > 0 || box[d].squared_distance(box[c].hi) > 0)
        continue;
      double angle = 0;
      for (Index t = 0; t < s.cell_count(); ++t)
        if (at(part[at(t)]) == d) angle += mesh::solid_angle(mesh::triangle(s, t), x);
      depth += static_cast<int>(std::lround(std::abs(angle) / (4 * std::numbers::pi)));
    }
    turn[c] = (volume[c] < 0) != (depth % 2 != 0) && volume[c] != 0;
    if (turn[c] != 0) report.parts_turned.add(mesh::triangle(s, first[c]).centroid());
  }
  for (Index t = 0; t < s.cell_count(); ++t)
    if (turn[at(part[at(t)])] != 0) turn_facet(s, t);
}

}  // namespace tunica::meshing::detail
