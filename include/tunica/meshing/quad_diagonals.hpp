// SPDX-License-Identifier: MIT
// Quadrilaterals cut into triangles along the diagonal that leaves the larger smallest angle, compared by
// squares of sines: no triangle is degenerate where the corners lie in four cells around an edge of a grid.
#pragma once

#include "tunica/core/parallel.hpp"
#include "tunica/core/vec.hpp"
#include "tunica/mesh/mesh.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

namespace tunica::meshing {

namespace detail {

/// sin^2 of the smallest angle of a triangle, which lies opposite to its shortest side: 4 area^2 over the
/// product of the other two sides squared. normal: twice the area; sides: squared.
[[nodiscard]] inline double smallest_sine(const Vec3& normal, double p, double q, double r) {
  const double longest = std::max(p, std::max(q, r)), shortest = std::min(p, std::min(q, r));
  const double middle = std::max(std::min(p, q), std::min(std::max(p, q), r));
  const double area = vec::squared(normal);
  return shortest > 0 && area > 0 ? area / (longest * middle) : 0;
}

/// Whether the diagonal 1-3 is better than 0-2.
[[nodiscard]] inline bool other_diagonal(const double* a, const double* b, const double* c, const double* d) {
  const auto side = [](const double* p, const double* q) {
    return Vec3(q[0] - p[0], q[1] - p[1], q[2] - p[2]);
  };
  const Vec3 ab = side(a, b), bc = side(b, c), cd = side(c, d), da = side(d, a), ac = side(a, c),
             bd = side(b, d);
  const double lab = vec::squared(ab), lbc = vec::squared(bc), lcd = vec::squared(cd), lda = vec::squared(da),
               lac = vec::squared(ac), lbd = vec::squared(bd);
  const double first = std::min(smallest_sine(vec::cross(ab, bc), lab, lbc, lac),
                                smallest_sine(vec::cross(cd, da), lcd, lda, lac));
  const double second = std::min(smallest_sine(vec::cross(bc, cd), lbc, lcd, lbd),
                                 smallest_sine(vec::cross(da, ab), lda, lab, lbd));
  return second > first;
}

}  // namespace detail

/// Two triangles a quadrilateral, with its orientation and its region. Triangles 2q and 2q+1 are those of q.
[[nodiscard]] inline mesh::Surface triangles_of(mesh::QuadSurface quads) {
  mesh::Surface surface;
  surface.nodes = std::move(quads.nodes);
  surface.cells.resize(3, 2 * quads.cells.cols());
  surface.region_names = std::move(quads.region_names);
  if (!quads.region.empty()) surface.region.resize(2 * quads.region.size());
  constexpr std::ptrdiff_t chunk = 4096;
  parallel_chunks(quads.cells.cols(), chunk, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    const double* x = surface.nodes.data();
    for (std::ptrdiff_t q = begin; q < end; ++q) {
      const Index* v = quads.cells.data() + 4 * q;
      Index* t = surface.cells.data() + 6 * q;
      const auto node = [&](int k) { return x + 3 * std::ptrdiff_t{v[k]}; };
      if (detail::other_diagonal(node(0), node(1), node(2), node(3)))
        t[0] = v[1], t[1] = v[2], t[2] = v[3], t[3] = v[1], t[4] = v[3], t[5] = v[0];
      else
        t[0] = v[0], t[1] = v[1], t[2] = v[2], t[3] = v[0], t[4] = v[2], t[5] = v[3];
      if (quads.region.empty()) continue;
      const auto r = static_cast<std::size_t>(q);
      surface.region[2 * r] = surface.region[2 * r + 1] = quads.region[r];
    }
  });
  return surface;
}

}  // namespace tunica::meshing
