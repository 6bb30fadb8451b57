// SPDX-License-Identifier: MIT
// Flat ends of a surface from elsewhere: parts in one plane with a sharp rim become regions of their own.
#pragma once

#include "tunica/mesh/adjacency.hpp"
#include "tunica/mesh/measures.hpp"
#include "tunica/meshing/flat_regions.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

namespace tunica::examples {

struct FlatEndOptions {
  double least_area = 1e-3;  // over the area of the surface
  double rim_cosine = 0.86;  // of the turn at the rim: 30 degrees, along nine tenths of its length
};

namespace detail {

/// Triangles joined to the seed whose nodes lie in its plane.
[[nodiscard]] inline std::vector<Index> in_plane(const mesh::Surface& s, const std::vector<Index>& twin,
                                                 Index seed, double reach) {
  const mesh::Triangle f = mesh::triangle(s, seed);
  const Vec3 normal = f.area_vector().normalized();
  const auto lies = [&](Index t) {
    for (int k = 0; k < 3; ++k)
      if (std::abs(normal.dot(s.nodes.col(s.cells(k, t)) - f.a)) > reach) return false;
    return mesh::triangle(s, t).area_vector().dot(normal) > 0;
  };
  std::vector<Index> part{seed};
  std::vector<char> seen(static_cast<std::size_t>(s.cell_count()), 0);
  seen[static_cast<std::size_t>(seed)] = 1;
  for (std::size_t i = 0; i < part.size(); ++i)
    for (Index h = 3 * part[i]; h < 3 * part[i] + 3; ++h) {
      const Index t = twin[static_cast<std::size_t>(h)] / 3;
      if (seen[static_cast<std::size_t>(t)] != 0 || !lies(t)) continue;
      seen[static_cast<std::size_t>(t)] = 1;
      part.push_back(t);
    }
  std::sort(part.begin(), part.end());
  return part;
}

}  // namespace detail

/// Names the flat ends of a closed surface "flat 1", "flat 2" ... in the order of their first triangles;
/// all else is "wall". Returns how many there are.
inline Index name_flat_ends(mesh::Surface& s, const FlatEndOptions& how = {}) {
  const auto twin = mesh::twins(s.cells, s.node_count());
  // half of what a flat region may be off its mean plane: here it is held against one triangle's
  const double reach = 0.5 * meshing::flat_tolerance * mesh::bounding_box(s.nodes).diagonal();
  const double all = mesh::area(s);
  std::vector<Index> order(static_cast<std::size_t>(s.cell_count()));
  std::iota(order.begin(), order.end(), Index{0});
  const auto size = [&](Index t) { return mesh::triangle(s, t).area(); };
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return size(a) > size(b); });
  constexpr std::size_t most_seeds = 256;  // a flat end of any weight has a triangle among the largest
  std::vector<char> taken(order.size(), 0);
  std::vector<std::vector<Index>> ends;
  for (std::size_t i = 0; i < std::min(order.size(), most_seeds); ++i) {
    if (taken[static_cast<std::size_t>(order[i])] != 0) continue;
    auto part = detail::in_plane(s, twin, order[i], reach);
    const Vec3 normal = mesh::triangle(s, order[i]).area_vector().normalized();
    double area = 0, rim = 0, sharp = 0;
    for (const Index t : part) {
      taken[static_cast<std::size_t>(t)] = 1;
      area += size(t);
      for (Index h = 3 * t; h < 3 * t + 3; ++h) {
        const Index u = twin[static_cast<std::size_t>(h)] / 3;
        if (std::binary_search(part.begin(), part.end(), u)) continue;
        const auto [from, to] = mesh::half_edge(s.cells, h);
        const double l = (s.nodes.col(to) - s.nodes.col(from)).norm();
        const Vec3 n = mesh::triangle(s, u).area_vector();
        rim += l, sharp += n.dot(normal) < how.rim_cosine * n.norm() ? l : 0;
      }
    }
    if (area >= how.least_area * all && sharp > 0.9 * rim) ends.push_back(std::move(part));
  }
  std::sort(ends.begin(), ends.end());
  s.region.assign(order.size(), 0);
  s.region_names = {"wall"};
  for (const auto& part : ends) {
    const auto region = static_cast<Index>(s.region_names.size());
    s.region_names.push_back("flat " + std::to_string(region));
    for (const Index t : part) s.region[static_cast<std::size_t>(t)] = region;
  }
  return static_cast<Index>(ends.size());
}

}  // namespace tunica::examples
