// SPDX-License-Identifier: MIT
// Takes out the places where a closed surface crosses itself: their nodes are drawn to the means of their
// neighbours, in ever wider surroundings, until an exact test finds no crossing.
#pragma once

#include "tunica/meshing/flat_regions.hpp"
#include "tunica/meshing/intersections.hpp"
#include "tunica/meshing/repair_orient.hpp"

#include <cstddef>
#include <vector>

namespace tunica::meshing {

struct [[nodiscard]] UntangleReport {
  std::size_t crossings_before = 0, crossings_after = 0;  // pairs of triangles
  Index moved = 0;                                        // nodes
  Index released = 0;  // of them, those that left the planes of flat regions
  Index turned = 0;    // components that came out inside out, or beyond another one, and are turned
};

/// Flat regions and their rims stay in their planes; where that leaves crossings after `most_rounds`, as the
/// caps of noise may, these nodes move freely in as many rounds more. What is still tangled then is told. A
/// component that came out inside out is turned: outward, within an odd number of others inward.
inline UntangleReport untangle(mesh::Surface& s, int most_rounds = 60) {
  UntangleReport report;
  auto pairs = self_intersections(s);
  report.crossings_before = report.crossings_after = pairs.size();
  if (pairs.empty()) return report;
  const auto at = [](Index i) { return static_cast<std::size_t>(i); };
  const auto planes = flat_regions(s);
  const Bonds bound = bonds(s, planes);
  const mesh::Rows near = mesh::neighbours_of_nodes(s.cells, s.node_count());
  std::vector<char> touched(at(s.node_count()), 0), released = touched;
  constexpr int rounds_a_ring = 5;
  const int all_rounds = bound.any() ? 2 * most_rounds : most_rounds;
  for (int all = 0; !pairs.empty() && all < all_rounds; ++all) {
    const bool bonds_hold = all < most_rounds;
    const int round = bonds_hold ? all : all - most_rounds;
    std::vector<char> active(touched.size(), 0);
    for (const auto& [t, u] : pairs)
      for (int k = 0; k < 3; ++k) active[at(s.cells(k, t))] = active[at(s.cells(k, u))] = 1;
    for (int ring = 0; ring < round / rounds_a_ring; ++ring) {
      const std::vector<char> inner = active;
      for (Index n = 0; n < s.node_count(); ++n)
        if (inner[at(n)] != 0)
          for (const Index m : near[n]) active[at(m)] = 1;
    }
    const Points<3> old = s.nodes;
    for (Index n = 0; n < s.node_count(); ++n) {
      const Bond bond = bonds_hold ? bound.of(n) : Bond::none;
      if (active[at(n)] == 0 || bond == Bond::corner) continue;
      Vec3 mean(0, 0, 0);
      if (bond == Bond::rim) {
        const auto& [p, q] = bound.along[at(n)];
        mean = vec::between(vec::column(old, p), vec::column(old, q), 0.5);
      } else {
        for (const Index m : near[n]) mean = vec::plus(mean, vec::column(old, m));
        mean = vec::divided(mean, static_cast<double>(near[n].size()));
      }
      vec::set_column(s.nodes, n, vec::between(vec::column(old, n), mean, 0.5));
      touched[at(n)] = 1, released[at(n)] = bond != bound.of(n) ? 1 : 0;
    }
    pairs = self_intersections(s);
  }
  for (const char c : touched) report.moved += c;
  for (const char c : released) report.released += c;
  report.crossings_after = pairs.size();
  if (pairs.empty()) {
    RepairReport repair;
    detail::face_outward(s, repair);
    report.turned = repair.parts_turned.count;
  }
  return report;
}

}  // namespace tunica::meshing
