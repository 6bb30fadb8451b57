// SPDX-License-Identifier: MIT
// Flat caps: the open edges of a surface that lie in a plane are closed by triangles in it.
#pragma once

#include "tunica/meshing/polygon.hpp"
#include "tunica/meshing/section.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace tunica::meshing {

/// Triangles that close the surface behind a plane along half-edges of its triangles: the caps run those the
/// other way, and their normal is `normal`. MeshError when the edges are no simple loops.
[[nodiscard]] inline std::vector<std::array<Index, 3>> caps(const Points<3>& nodes,
                                                            const std::vector<mesh::HalfEdge>& open,
                                                            const Vec3& point, const Vec3& normal) {
  if (open.empty()) return {};
  const PlaneFrame frame(point, normal);
  std::vector<Index> number;  // of the nodes of the loops, ascending
  for (const auto& e : open) number.push_back(e.from);
  std::sort(number.begin(), number.end());
  const auto local = [&](Index n) {
    const auto at = std::lower_bound(number.begin(), number.end(), n);
    if (at == number.end() || *at != n) throw MeshError("the edges of a section do not close");
    return static_cast<Index>(at - number.begin());
  };
  const auto count = static_cast<Index>(number.size());
  Points<2> x(2, count);
  for (Index i = 0; i < count; ++i) {
    const Point<2> p = frame(vec::column(nodes, number[static_cast<std::size_t>(i)]));
    x(0, i) = p[0], x(1, i) = p[1];
  }
  std::vector<Index> next(number.size(), -1);
  for (const auto& e : open) {
    Index& n = next[static_cast<std::size_t>(local(e.to))];
    if (n >= 0) throw MeshError("two loops of a section touch");
    n = local(e.from);
  }
  std::vector<Corners> loops;
  for (Index i = 0; i < count; ++i) {
    Corners loop;
    for (Index n = i; next[static_cast<std::size_t>(n)] >= 0;) {
      loop.push_back(n);
      const Index to = next[static_cast<std::size_t>(n)];
      next[static_cast<std::size_t>(n)] = -1;
      n = to;
    }
    if (!loop.empty()) loops.push_back(std::move(loop));
  }
  auto triangles = triangulate(x, loops);
  for (auto& t : triangles)
    for (Index& n : t) n = number[static_cast<std::size_t>(n)];
  return triangles;
}

}  // namespace tunica::meshing
