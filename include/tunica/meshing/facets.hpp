// SPDX-License-Identifier: MIT
// Facets: the pieces into which rims of regions, and sharp edges if wanted, part a surface.
#pragma once

#include "tunica/meshing/flat_regions.hpp"

#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tunica::meshing {

struct Facets {
  std::vector<Index> of;                     // facet of each triangle
  std::vector<Index> region;                 // region of each facet
  std::vector<std::optional<Plane>> planes;  // of each facet, where it is flat
};

/// Facets of a closed surface. An edge is sharp when the normals of its triangles differ by more than the
/// angle [degrees]; sharp edges that end nowhere (chains with a loose end) do not count.
[[nodiscard]] inline Facets facets(const mesh::Surface& s, double sharp_angle) {
  const auto at = [](Index i) { return static_cast<std::size_t>(i); };
  const auto twin = mesh::twins(s.cells, s.node_count());
  std::vector<char> sharp(twin.size(), 0), rim(twin.size(), 0);
  std::vector<Index> degree(at(s.node_count()), 0);  // sharp half-edges that leave a node
  const double least_cosine = std::cos(sharp_angle * std::numbers::pi / 180);
  for (Index h = 0; h < static_cast<Index>(twin.size()); ++h) {
    const Index g = twin[at(h)];
    if (g < 0) throw MeshError("only a closed manifold surface has facets");
    rim[at(h)] = s.region_of(h / 3) != s.region_of(g / 3);
    const Vec3 p = mesh::triangle(s, h / 3).area_vector(), q = mesh::triangle(s, g / 3).area_vector();
    sharp[at(h)] = rim[at(h)] || (sharp_angle < 180 && p.dot(q) < least_cosine * p.norm() * q.norm());
    if (sharp[at(h)]) ++degree[at(mesh::half_edge(s.cells, h).from)];
  }
  std::vector<Index> loose;
  for (Index h = 0; h < static_cast<Index>(twin.size()); ++h)
    if (sharp[at(h)] && !rim[at(h)]) loose.push_back(h);
  for (bool changed = true; changed;) {  // prune chains from their loose ends
    changed = false;
    for (const Index h : loose) {
      const auto e = mesh::half_edge(s.cells, h);
      if (!sharp[at(h)] || (degree[at(e.from)] > 1 && degree[at(e.to)] > 1)) continue;
      sharp[at(h)] = sharp[at(twin[at(h)])] = 0;
      --degree[at(e.from)], --degree[at(e.to)];
      changed = true;
    }
  }
  Facets f;
  f.of.assign(at(s.cell_count()), -1);
  std::vector<Index> stack;
  for (Index t = 0; t < s.cell_count(); ++t) {
    if (f.of[at(t)] >= 0) continue;
    const auto label = static_cast<Index>(f.region.size());
    f.region.push_back(s.region_of(t));
    stack.assign(1, t), f.of[at(t)] = label;
    while (!stack.empty()) {
      const Index u = stack.back();
      stack.pop_back();
      for (Index h = 3 * u; h < 3 * u + 3; ++h)
        if (const Index g = twin[at(h)]; !sharp[at(h)] && f.of[at(g / 3)] < 0)
          f.of[at(g / 3)] = label, stack.push_back(g / 3);
    }
  }
  mesh::Surface labelled{s.nodes, s.cells, f.of, std::vector<std::string>(f.region.size()), {}};
  f.planes = flat_regions(labelled);
  return f;
}

}  // namespace tunica::meshing
