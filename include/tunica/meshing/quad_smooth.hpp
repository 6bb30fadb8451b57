// SPDX-License-Identifier: MIT
// Smoothing of a sheet of quadrilaterals on a surface: nodes slide on it, rims slide on their curves;
// then the worst corners are improved by moves that are kept only if they raise the worst.
#pragma once

#include "tunica/meshing/quad_pin.hpp"
#include "tunica/meshing/quad_smoother.hpp"
#include "tunica/meshing/rim_curve.hpp"
#include "tunica/meshing/surface_foot.hpp"
#include "tunica/meshing/wall_quads.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace tunica::meshing {

/// Worst corner (sine of its angle about the surface's normal) before and after, and passes made.
struct [[nodiscard]] QuadSmoothReport {
  double worst_before = 0, worst_after = 0;
  int repairs = 0, releases = 0;
  std::size_t pins = 0;  // nodes laid onto points of the surface
};

/// Slides the nodes on the surface, the rims on their curves; nodes end on the surface. targets: points of
/// the surface; a node is laid on such a one that the sheet would miss.
template <FootSurface S>
QuadSmoothReport smooth_quads(WallQuads& wall, const S& lumen, const Rims& rims,
                              const QuadSmoothOptions& options = {}, const std::vector<Vec3>& targets = {}) {
  detail::QuadSmoother<S> smoother(wall, lumen, rims, options.reach);
  const auto worst = [&] {
    double least = 1;
    for (Index n = 0; n < static_cast<Index>(wall.nodes.cols()); ++n)
      least = std::min(least, smoother.worst_corner(n));
    return least;
  };
  QuadSmoothReport report;
  for (int i = 0; i < options.sweeps; ++i) smoother.sweep();
  const double edge = smoother.edge();
  for (int round = 0; round < options.pins && !targets.empty(); ++round) {
    const auto pins = quad_pins(wall, smoother.held(), targets, options.missed * edge, edge);
    for (const QuadPin& pin : pins) smoother.pin(pin.node, pin.place);
    if (pins.empty()) break;
    report.pins += pins.size();
    for (int i = 0; i < options.sweeps / 3; ++i) smoother.sweep();
    report.pins -= smoother.unpin(options.poor_corner);
  }
  report.worst_before = worst();
  while (report.repairs < options.repairs && smoother.repair(options) > 0) ++report.repairs;
  for (int round = 1; round <= options.releases && smoother.release(options.poor_corner, round); ++round) {
    ++report.releases;
    for (int i = 0; i < options.repairs && smoother.repair(options) > 0; ++i) ++report.repairs;
  }
  report.worst_after = worst();
  return report;
}

}  // namespace tunica::meshing
