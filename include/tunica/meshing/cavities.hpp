// SPDX-License-Identifier: MIT
// Small cavities of a closed surface are filled: specks of noise within a vessel, whose tiny triangles would
// ask for millions of tetrahedra.
#pragma once

#include "tunica/core/vec.hpp"
#include "tunica/mesh/topology.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace tunica::meshing {

struct Cavity {
  double volume = 0;  // in the unit of the surface cubed
  Vec3 centre{0, 0, 0};
};

struct [[nodiscard]] WithoutCavities {
  mesh::Surface surface;
  std::vector<Cavity> filled;  // in the order of their first triangles
};

/// The boundary of one connected body without its cavities of less than `least_volume`: all components but
/// the one that encloses most, also where a contour of few voxels came out inside out. The others keep their
/// nodes, triangles and regions, in order; `topology` is that of the surface.
[[nodiscard]] inline WithoutCavities fill_cavities(mesh::Surface surface, const mesh::Topology& topology,
                                                   double least_volume) {
  WithoutCavities r;
  double most = 0;
  for (const mesh::Component& c : topology.components) most = std::max(most, c.volume);
  std::vector<char> filled;  // of each component
  for (const mesh::Component& c : topology.components) {
    const double volume = std::abs(c.volume);
    filled.push_back(c.loops == 0 && c.volume < most && volume < least_volume);
    if (filled.back() != 0) r.filled.push_back({volume, c.centre});
  }
  if (r.filled.empty()) {
    r.surface = std::move(surface);
    return r;
  }
  const auto at = [](Index i) { return static_cast<std::size_t>(i); };
  std::vector<Index> number(at(surface.node_count()), -1);
  Index triangles = 0;
  for (Index t = 0; t < surface.cell_count(); ++t) {
    if (filled[at(topology.component_of[at(t)])] != 0) continue;
    for (int k = 0; k < 3; ++k) number[at(surface.cells(k, t))] = 0;
    ++triangles;
  }
  Index nodes = 0;
  for (Index& n : number)
    if (n == 0) n = nodes++;
  mesh::Surface& s = r.surface;
  s.nodes.resize(3, nodes), s.cells.resize(3, triangles);
  s.region_names = std::move(surface.region_names);
  for (Index n = 0; n < surface.node_count(); ++n)
    if (number[at(n)] >= 0) vec::set_column(s.nodes, number[at(n)], vec::column(surface.nodes, n));
  Index to = 0;
  for (Index t = 0; t < surface.cell_count(); ++t) {
    if (filled[at(topology.component_of[at(t)])] != 0) continue;
    for (int k = 0; k < 3; ++k) s.cells(k, to) = number[at(surface.cells(k, t))];
    if (!surface.region.empty()) s.region.push_back(surface.region[at(t)]);
    ++to;
  }
  return r;
}

}  // namespace tunica::meshing
