// SPDX-License-Identifier: MIT
// Orientation of a surface that may be broken: facets agree over edges of two, parts face outward, those that
// lie within an odd number of others inward.
#pragma once

#include "tunica/core/error.hpp"
#include "tunica/mesh/measures.hpp"
#include "tunica/meshing/predicates.hpp"
#include "tunica/meshing/repair_edges.hpp"
#include "tunica/meshing/repair_report.hpp"
#include "tunica/search/octree.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
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

/// In how many other parts of a surface a part lies: those that a vertical from one of its nodes crosses an
/// odd number of times. Neighbours decide alike whose side of their common edge the vertical is on.
class Nesting {
 public:
  Nesting(const mesh::Surface& s, const std::vector<Index>& part) : surface_(s), part_(part) {
    std::vector<Box> boxes;
    for (Index t = 0; t < s.cell_count(); ++t) boxes.push_back(mesh::triangle(s, t).box());
    for (const Box& b : boxes) top_ = std::max(top_, b.hi[2]);
    tree_ = search::Octree(boxes);
  }

  [[nodiscard]] int depth(const Vec3& x, Index own) const {
    Box up;
    up.extend(x), up.extend(Vec3(x[0], x[1], top_));
    std::vector<Index> crossed;
    tree_.overlapping(up, [&](Index t) {
      if (part_[static_cast<std::size_t>(t)] != own && above(mesh::triangle(surface_, t), x))
        crossed.push_back(part_[static_cast<std::size_t>(t)]);
    });
    std::sort(crossed.begin(), crossed.end());
    int odd = 0;
    for (std::size_t i = 0, j = 0; i < crossed.size(); i = j) {
      while (j < crossed.size() && crossed[j] == crossed[i]) ++j;
      odd += static_cast<int>((j - i) % 2);
    }
    return odd;
  }

 private:
  /// The vertical through x meets the triangle above x.
  [[nodiscard]] static bool above(const mesh::Triangle& f, const Vec3& x) {
    const std::array<const Vec3*, 3> v{&f.a, &f.b, &f.c};
    bool inside = false;
    for (std::size_t e = 0; e < 3; ++e) {
      const Vec3 &a = *v[e], &b = *v[(e + 1) % 3];
      if ((a[1] > x[1]) == (b[1] > x[1])) continue;
      const Vec3 &low = a[1] < b[1] ? a : b, &high = a[1] < b[1] ? b : a;
      inside ^= orient2d({low[0], low[1]}, {high[0], high[1]}, {x[0], x[1]}) > 0;
    }
    if (!inside) return false;
    // below the triangle x lies behind its normal where that points up
    const double up = orient2d({f.a[0], f.a[1]}, {f.b[0], f.b[1]}, {f.c[0], f.c[1]});
    return orient3d(f.a, f.b, f.c, x) * (up > 0 ? 1 : -1) < 0;
  }

  const mesh::Surface& surface_;
  const std::vector<Index>& part_;
  search::Octree tree_;
  double top_ = -std::numeric_limits<double>::infinity();
};

/// Turns whole parts (joined over edges of any number of facets) by the number of others that they lie in.
inline void face_outward(mesh::Surface& s, RepairReport& report) {
  if (s.cell_count() == 0) return;
  const SharedEdges edges(s.cells);
  const auto at = [](Index i) { return static_cast<std::size_t>(i); };
  std::vector<Index> part;
  const Index count = sheets(edges, s.cell_count(), part);
  std::vector<double> volume(at(count), 0);
  std::vector<Index> first(at(count), -1);
  const Vec3 o = mesh::bounding_box(s.nodes).centre();
  for (Index t = 0; t < s.cell_count(); ++t) {
    const auto k = at(part[at(t)]);
    volume[k] += mesh::cone_volume(mesh::triangle(s, t), o);
    if (first[k] < 0) first[k] = t;
  }
  const Nesting nesting(s, part);
  std::vector<char> turn(volume.size(), 0);
  for (std::size_t c = 0; c < volume.size(); ++c) {
    const int depth =
        count > 1 ? nesting.depth(mesh::node(s, s.cells(0, first[c])), static_cast<Index>(c)) : 0;
    turn[c] = volume[c] != 0 && (volume[c] < 0) != (depth % 2 != 0);
    if (turn[c] != 0) report.parts_turned.add(mesh::triangle(s, first[c]).centroid());
  }
  for (Index t = 0; t < s.cell_count(); ++t)
    if (turn[at(part[at(t)])] != 0) turn_facet(s, t);
}

}  // namespace tunica::meshing::detail
