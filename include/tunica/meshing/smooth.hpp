// SPDX-License-Identifier: MIT
// Volume-preserving Laplacian smoothing [PEREZ08, 3.2.1]: a Laplace sweep, its normal part taken back where
// it moves the neighbourhood as a whole (after [VOLLMER99]), and an offset that keeps the volume to rounding.
#pragma once

#include "tunica/core/expect.hpp"
#include "tunica/meshing/flat_regions.hpp"
#include "tunica/meshing/intersections.hpp"
#include "tunica/meshing/smooth_sweeps.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace tunica::meshing {

struct SmoothOptions {
  int sweeps = 20;
  double factor = 0.5;  // of the way to the mean of the neighbours in a sweep, 0 < factor <= 0.5 [-]
};

struct [[nodiscard]] SmoothReport {
  double volume_before = 0, volume_after = 0;  // in the unit of the surface cubed
  Index held_back = 0;      // moves left out because a triangle would have turned over, over all sweeps
  Index frozen = 0;         // nodes that stayed because the smoothed surface would have crossed itself there
  double largest_move = 0;  // from the start, in the unit of the surface
};

namespace detail {

/// Holds the nodes of crossing triangles, and a ring about them.
inline void hold(std::vector<char>& held, const mesh::Surface& s, const mesh::Rows& around,
                 const std::vector<std::pair<Index, Index>>& crossing) {
  for (const auto& [t, u] : crossing)
    for (const Index f : {t, u})
      for (int k = 0; k < 3; ++k)
        for (const Index near : around[s.cells(k, f)])
          for (int j = 0; j < 3; ++j) held[static_cast<std::size_t>(s.cells(j, near))] = 1;
}

}  // namespace detail

/// Smooths a closed surface in place. The volume of each component is kept to rounding in every sweep; flat
/// regions stay in their planes and their rims on them; a surface that does not cross itself does not
/// afterwards.
inline SmoothReport smooth(mesh::Surface& s, const SmoothOptions& options = {}) {
  TUNICA_EXPECT(options.factor > 0 && options.factor <= 0.5, "the factor of a sweep is in (0, 0.5]");
  SmoothReport report{.volume_before = mesh::enclosed_volume(s)};
  const Points<3> start = s.nodes;
  const auto planes = flat_regions(s);
  const bool any_plane =
      std::any_of(planes.begin(), planes.end(), [](const auto& p) { return p.has_value(); });
  const Bonds bound = any_plane ? bonds(s, planes) : Bonds{};
  std::vector<char> held(static_cast<std::size_t>(s.node_count()), 0);
  constexpr int most_rounds = 20;
  for (int round = 0; options.sweeps > 0; ++round) {
    // from the start, with the places that would cross held where they were
    s.nodes = start;
    detail::Sweeps sweeps(s, planes, bound, held);
    report.held_back = 0;
    for (int n = 0; n < options.sweeps; ++n) report.held_back += sweeps.sweep(options.factor);
    sweeps.write(s.nodes);
    const auto crossing = self_intersections(s);
    if (crossing.empty()) break;
    if (round == 0) {  // what crosses itself at the start is none of ours
      mesh::Surface before = s;
      before.nodes = start;
      if (!self_intersections(before, 1).empty()) break;
    }
    if (round < most_rounds)
      detail::hold(held, s, sweeps.around(), crossing);
    else
      std::fill(held.begin(), held.end(), char{1});
  }
  report.frozen = static_cast<Index>(std::count(held.begin(), held.end(), char{1}));
  report.volume_after = mesh::enclosed_volume(s);
  for (Index n = 0; n < s.node_count(); ++n)
    report.largest_move =
        std::max(report.largest_move, vec::distance(vec::column(s.nodes, n), vec::column(start, n)));
  return report;
}

}  // namespace tunica::meshing
