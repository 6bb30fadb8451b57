// SPDX-License-Identifier: MIT
// How a node of an editable surface is bound: inside a facet, on the rim of two, or where more meet.
#pragma once

#include "tunica/meshing/editable_surface.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace tunica::meshing {

enum class NodeKind : std::uint8_t { facet, rim, corner };

/// Facets at a node, ascending.
[[nodiscard]] inline std::vector<Index> facets_at(const EditableSurface& s, Index n) {
  std::vector<Index> f;
  for (const Index t : s.ring(n)) f.push_back(s.facet(t));
  std::sort(f.begin(), f.end());
  f.erase(std::unique(f.begin(), f.end()), f.end());
  return f;
}

/// Neighbours along rims.
[[nodiscard]] inline std::vector<Index> rim_neighbours(const EditableSurface& s, Index n) {
  std::vector<Index> r;
  for (const Index m : s.neighbours(n))
    if (s.on_rim(n, m)) r.push_back(m);
  return r;
}

[[nodiscard]] inline NodeKind kind_of(const EditableSurface& s, Index n) {
  const Index first = s.facet(s.ring(n).front());
  bool one = true;
  for (const Index t : s.ring(n)) one = one && s.facet(t) == first;
  if (one) return NodeKind::facet;
  return facets_at(s, n).size() == 2 && rim_neighbours(s, n).size() == 2 ? NodeKind::rim : NodeKind::corner;
}

}  // namespace tunica::meshing
