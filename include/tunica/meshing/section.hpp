// SPDX-License-Identifier: MIT
// Sections of a closed surface by a plane: the parts that the plane opens, their loops, holes and distances.
#pragma once

#include "tunica/core/vec.hpp"
#include "tunica/mesh/adjacency.hpp"
#include "tunica/mesh/measures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace tunica::meshing {

/// Two unit vectors of a plane that make a right-handed frame with its normal.
struct PlaneFrame {
  Vec3 origin, u, v;

  PlaneFrame(const Vec3& point, const Vec3& normal)
      : origin(point), u(vec::orthogonal(normal)), v(vec::cross(normal, u)) {}
  [[nodiscard]] Point<2> operator()(const Vec3& x) const {
    const Vec3 d = vec::minus(x, origin);
    return {vec::dot(u, d), vec::dot(v, d)};
  }
  [[nodiscard]] Vec3 place(const Point<2>& p) const {
    return vec::along(vec::along(origin, p[0], u), p[1], v);
  }
};

/// One connected part of a section: an outer loop with its holes.
struct Section {
  std::vector<Index> triangles;  // that the plane crosses there, ascending
  double nearest = 0;            // distance of the part from the point of the plane: 0 where it covers it
  double farthest = 0;           // of its outer loop
  Vec3 centre{0, 0, 0};          // mean of the points of the outer loop
  double area = 0;               // without its holes
  double perimeter = 0;          // of all its loops
  Vec3 centroid{0, 0, 0};        // of its area
};

namespace detail {

/// A loop of crossed triangles, each with its segment in the plane.
struct SectionLoop {
  std::vector<Index> triangles;
  std::vector<std::array<Point<2>, 2>> segments;

  [[nodiscard]] bool holds(const Point<2>& p) const {
    bool inside = false;
    for (const auto& [a, b] : segments)
      if ((a[1] > p[1]) != (b[1] > p[1]) && p[0] < a[0] + (p[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0]))
        inside = !inside;
    return inside;
  }
  [[nodiscard]] double nearest_to_origin() const {
    double d = std::numeric_limits<double>::infinity();
    for (const auto& [a, b] : segments) {
      const double ex = b[0] - a[0], ey = b[1] - a[1], l2 = ex * ex + ey * ey;
      const double t = l2 > 0 ? std::clamp(-(a[0] * ex + a[1] * ey) / l2, 0.0, 1.0) : 0.0;
      d = std::min(d, std::hypot(a[0] + t * ex, a[1] + t * ey));
    }
    return d;
  }
  /// Moments of the inside: area and area times centroid, signed by the turn of the loop.
  struct Moments {
    double area = 0, x = 0, y = 0;
  };
  [[nodiscard]] Moments moments() const {
    Moments m;
    for (const auto& [a, b] : segments) {
      const double w = 0.5 * (a[0] * b[1] - a[1] * b[0]);
      m.area += w, m.x += w * (a[0] + b[0]) / 3, m.y += w * (a[1] + b[1]) / 3;
    }
    return m;
  }
  [[nodiscard]] double length() const {
    double l = 0;
    for (const auto& [a, b] : segments) l += std::hypot(b[0] - a[0], b[1] - a[1]);
    return l;
  }
  [[nodiscard]] double farthest_from_origin() const {
    double d = 0;
    for (const auto& [a, b] : segments) d = std::max({d, std::hypot(a[0], a[1]), std::hypot(b[0], b[1])});
    return d;
  }
};

[[nodiscard]] inline std::vector<SectionLoop> section_loops(const mesh::Surface& s,
                                                            const std::vector<Index>& twin,
                                                            const std::vector<double>& distance,
                                                            const PlaneFrame& frame) {
  const auto front = [&](Index n) { return distance[static_cast<std::size_t>(n)] >= 0; };
  const auto place = [&](Index a, Index b) {
    const double da = distance[static_cast<std::size_t>(a)], db = distance[static_cast<std::size_t>(b)];
    const Vec3 x = mesh::node(s, a);
    return frame(vec::along(x, da / (da - db), vec::minus(mesh::node(s, b), x)));
  };
  std::vector<SectionLoop> loops;
  std::vector<char> done(static_cast<std::size_t>(s.cell_count()), 0);
  for (Index first = 0; first < s.cell_count(); ++first) {
    SectionLoop loop;
    for (Index t = first; t >= 0 && !done[static_cast<std::size_t>(t)];) {
      // a crossed triangle is entered by one half-edge and left by the other: follow the one front -> behind
      std::array<Point<2>, 2> segment;
      Index leave = -1;
      for (Index h = 3 * t; h < 3 * t + 3; ++h) {
        const auto e = mesh::half_edge(s.cells, h);
        if (front(e.from) == front(e.to)) continue;
        segment[front(e.from) ? 1 : 0] = place(e.from, e.to);
        if (front(e.from)) leave = twin[static_cast<std::size_t>(h)];
      }
      done[static_cast<std::size_t>(t)] = 1;
      if (leave < 0) break;
      loop.triangles.push_back(t);
      loop.segments.push_back(segment);
      t = leave / 3;
    }
    if (!loop.triangles.empty()) loops.push_back(std::move(loop));
  }
  return loops;
}

}  // namespace detail

/// The sections of a closed surface by the plane of the frame; distance: of each node, > 0 in front. A node
/// in the plane counts as in front of it.
[[nodiscard]] inline std::vector<Section> sections(const mesh::Surface& s, const std::vector<Index>& twin,
                                                   const std::vector<double>& distance,
                                                   const PlaneFrame& frame) {
  const auto loops = detail::section_loops(s, twin, distance, frame);
  const Point<2> origin(0, 0);
  std::vector<std::vector<std::size_t>> holders(loops.size());  // loops that hold each loop
  for (std::size_t i = 0; i < loops.size(); ++i)
    for (std::size_t j = 0; j < loops.size(); ++j)
      if (i != j && loops[j].holds(loops[i].segments.front()[0])) holders[i].push_back(j);
  std::vector<Section> result;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    if (holders[i].size() % 2 != 0) continue;  // a hole
    Section part{.triangles = loops[i].triangles,
                 .nearest = loops[i].nearest_to_origin(),
                 .farthest = loops[i].farthest_from_origin()};
    bool covers = loops[i].holds(origin);
    auto moments = loops[i].moments();
    part.perimeter = loops[i].length();
    for (std::size_t h = 0; h < loops.size(); ++h) {  // its holes: one level deeper, within it
      if (holders[h].size() != holders[i].size() + 1) continue;
      if (std::find(holders[h].begin(), holders[h].end(), i) == holders[h].end()) continue;
      part.triangles.insert(part.triangles.end(), loops[h].triangles.begin(), loops[h].triangles.end());
      part.nearest = std::min(part.nearest, loops[h].nearest_to_origin());
      covers = covers && !loops[h].holds(origin);
      const auto hole = loops[h].moments();  // turns the other way
      moments.area += hole.area, moments.x += hole.x, moments.y += hole.y;
      part.perimeter += loops[h].length();
    }
    if (covers) part.nearest = 0;
    part.area = std::abs(moments.area);
    part.centroid = moments.area != 0 ? frame.place({moments.x / moments.area, moments.y / moments.area})
                                      : frame.place(loops[i].segments.front()[0]);
    std::sort(part.triangles.begin(), part.triangles.end());
    for (const auto& [a, b] : loops[i].segments)
      part.centre =
          vec::along(part.centre, 1 / static_cast<double>(loops[i].segments.size()), frame.place(a));
    result.push_back(std::move(part));
  }
  return result;
}

}  // namespace tunica::meshing
