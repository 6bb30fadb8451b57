// SPDX-License-Identifier: MIT
// The open edges of a surface as simple loops, and a triangulation of such a loop from its own nodes.
#pragma once

#include "tunica/core/error.hpp"
#include "tunica/mesh/quality.hpp"
#include "tunica/meshing/cavity_polygon.hpp"
#include "tunica/meshing/polygon.hpp"
#include "tunica/meshing/repair_edges.hpp"
#include "tunica/meshing/section.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace tunica::meshing::detail {

/// Nodes of each hole, in the order in which its filling runs them; a walk that comes back to a node is cut
/// there. Edges whose neighbourhood is not a fan are in no loop.
[[nodiscard]] inline std::vector<std::vector<Index>> hole_loops(const mesh::Surface& s,
                                                                const SharedEdges& edges) {
  const auto half_edges = 3 * s.cell_count();
  std::vector<char> done(static_cast<std::size_t>(half_edges), 0);
  std::vector<Index> place(static_cast<std::size_t>(s.node_count()), -1);  // of a node in the walk
  std::vector<std::vector<Index>> loops;
  const auto open = [&](Index h) { return edges.facets(edges.edge(h)) == 1; };
  for (Index first = 0; first < half_edges; ++first) {
    if (!open(first) || done[static_cast<std::size_t>(first)] != 0) continue;
    std::vector<Index> walk;
    for (Index h = first; h >= 0 && done[static_cast<std::size_t>(h)] == 0;) {
      done[static_cast<std::size_t>(h)] = 1;
      const Index n = mesh::half_edge(s.cells, h).from;
      if (const Index at = place[static_cast<std::size_t>(n)]; at >= 0) {
        std::vector<Index> loop(walk.begin() + at, walk.end());
        for (const Index m : loop) place[static_cast<std::size_t>(m)] = -1;
        walk.resize(static_cast<std::size_t>(at));
        loops.push_back(std::move(loop));
      }
      place[static_cast<std::size_t>(n)] = static_cast<Index>(walk.size());
      walk.push_back(n);
      Index g = mesh::next_in_triangle(h);  // round the end of h to the next open edge
      while (g >= 0 && !open(g)) {
        g = edges.across(g);
        if (g >= 0) g = mesh::next_in_triangle(g);
      }
      if (g < 0) walk.clear();
      h = g;
    }
    for (const Index m : walk) place[static_cast<std::size_t>(m)] = -1;
    if (walk.size() > 2) loops.push_back(std::move(walk));
  }
  for (auto& l : loops) std::reverse(l.begin(), l.end());
  loops.erase(std::remove_if(loops.begin(), loops.end(), [](const auto& l) { return l.size() < 3; }),
              loops.end());
  return loops;
}

/// Twice the area vector of a loop (Newell's sum).
[[nodiscard]] inline Vec3 loop_normal(const std::vector<Vec3>& x) {
  Vec3 sum(0, 0, 0);
  for (std::size_t i = 1; i + 1 < x.size(); ++i)
    sum = vec::plus(sum, vec::cross(vec::minus(x[i], x[0]), vec::minus(x[i + 1], x[0])));
  return sum;
}

/// Triangles (numbers of the loop's corners) that turn as the loop does; free_chord(i, j) tells which chords
/// may be used. Nearly plane loops are triangulated in their plane, others by the best worst triangle.
template <class FreeChord>
[[nodiscard]] std::vector<std::array<Index, 3>> loop_triangles(const std::vector<Vec3>& x,
                                                               const FreeChord& free_chord) {
  const auto n = static_cast<Index>(x.size());
  const auto is_free = [&](Index i, Index j) {
    const Index step = (j - i + n) % n;
    return step == 1 || step == n - 1 || free_chord(i, j);
  };
  const Vec3 normal = vec::unit(loop_normal(x));
  Vec3 middle(0, 0, 0);
  for (const Vec3& p : x) middle = vec::along(middle, 1.0 / n, p);
  double off = 0, size = 0;
  for (const Vec3& p : x) {
    const Vec3 d = vec::minus(p, middle);
    off = std::max(off, std::abs(vec::dot(normal, d))), size = std::max(size, vec::length(d));
  }
  constexpr double plane = 0.15;  // off the mean plane over the size of the loop
  if (vec::squared(normal) > 0 && off <= plane * size) {
    const PlaneFrame frame(middle, normal);
    Points<2> flat(2, n);
    Corners walk;
    for (Index i = 0; i < n; ++i) {
      const Point<2> p = frame(x[static_cast<std::size_t>(i)]);
      flat(0, i) = p[0], flat(1, i) = p[1];
      walk.push_back(i);
    }
    try {
      auto made = triangulate(flat, {walk});
      const bool good = std::all_of(made.begin(), made.end(), [&](const auto& t) {
        return is_free(t[0], t[1]) && is_free(t[1], t[2]) && is_free(t[2], t[0]);
      });
      if (good) return made;
    } catch (const MeshError&) {
      // seen along its normal the loop crosses itself: it is filled in space
    }
  }
  constexpr Index most = 400;  // the cube of the corners
  if (n > most) return {};
  CavityPolygon fill;
  const double worst = fill.triangulate(static_cast<int>(n), 0, [&](int i, int k, int j) {
    if (!is_free(i, k) || !is_free(k, j) || !is_free(i, j)) return -1.0;
    return mesh::mean_ratio(mesh::Triangle{x[static_cast<std::size_t>(i)], x[static_cast<std::size_t>(k)],
                                           x[static_cast<std::size_t>(j)]});
  });
  std::vector<std::array<Index, 3>> made;
  if (worst > 0)
    for (const auto& t : fill.triangles) made.push_back({t[0], t[1], t[2]});
  return made;
}

}  // namespace tunica::meshing::detail
