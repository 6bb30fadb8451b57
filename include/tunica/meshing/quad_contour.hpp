// SPDX-License-Identifier: MIT
// The quadrilaterals of a lumen's wall on a grid that lenses draw together, and where to put the lenses.
#pragma once

#include "tunica/core/vec.hpp"
#include "tunica/mesh/measures.hpp"
#include "tunica/mesh/mesh.hpp"
#include "tunica/meshing/dual_contouring.hpp"
#include "tunica/meshing/hermite_surface.hpp"
#include "tunica/meshing/interface_distance.hpp"
#include "tunica/meshing/quad_lens.hpp"
#include "tunica/meshing/rim_curve.hpp"
#include "tunica/meshing/wall_quads.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace tunica::meshing::detail {

/// The grid where no lens is: as wide as without lenses, or so much wider that they do not change the number
/// of quadrilaterals.
enum class Elsewhere { kept, widened };

/// The wall's quadrilaterals on a grid of that spacing as the lenses draw it together.
[[nodiscard]] inline WallQuads quads_through(const Lenses& lenses, const mesh::Surface& lumen, double spacing,
                                             const Rims& rims, Elsewhere elsewhere = Elsewhere::kept) {
  if (lenses.empty())
    return wall_quads(dual_contour(hermite_of_surface(lumen, {.spacing = spacing}), {.hold = -0.5}), rims);
  mesh::Surface magnified = lumen;
  for (Index n = 0; n < lumen.node_count(); ++n)
    vec::set_column(magnified.nodes, n, lenses.magnified(vec::column(lumen.nodes, n)));
  // their number is that of the crossings: the area that the grid sees over the square of its spacing
  if (elsewhere == Elsewhere::widened)
    spacing *= std::sqrt(mesh::area_of_region(magnified, 0) / mesh::area_of_region(lumen, 0));
  mesh::QuadSurface contour =
      dual_contour(hermite_of_surface(magnified, {.spacing = spacing}), {.hold = -0.5});
  for (Index n = 0; n < contour.node_count(); ++n)
    vec::set_column(contour.nodes, n, lenses.restored(vec::column(contour.nodes, n)));
  return wall_quads(contour, rims);
}

/// A lens for each group of places that lie within an edge of each other; false if there is none to add.
inline bool add_lenses(Lenses& lenses, const std::vector<FarPlace>& far, double edge, double tolerance,
                       double most) {
  std::vector<char> used(far.size(), 0);
  std::vector<Lens> added;
  for (std::size_t i = 0; i < far.size(); ++i) {
    if (used[i] != 0) continue;
    std::vector<std::size_t> group{i};
    used[i] = 1;
    for (std::size_t g = 0; g < group.size(); ++g)
      for (std::size_t j = 0; j < far.size(); ++j)
        if (used[j] == 0 && vec::distance(far[group[g]].place, far[j].place) < edge)
          used[j] = 1, group.push_back(j);
    Vec3 sum = Vec3::Zero();
    double weight = 0, radius = edge, worst = 0;
    for (const std::size_t g : group) {
      const double w = far[g].distance - 0.9 * tolerance;
      sum = vec::along(sum, w, far[g].place), weight += w;
      worst = std::max(worst, far[g].distance);
    }
    const Vec3 centre = vec::scaled(1 / weight, sum);
    for (const std::size_t g : group) radius = std::max(radius, vec::distance(far[g].place, centre));
    // distances go with the square of the spacing
    const double power = std::clamp(std::sqrt(worst / tolerance) - 0.8, 0.25, 1.0);
    added.push_back({centre, std::min(radius, 3 * edge), power});
  }
  bool any = false;
  for (Lens& lens : added) {
    lens.power = std::min(lens.power, most / lenses.magnification(lens.centre) - 1);
    if (!(lens.power > 0.1)) continue;
    lenses.add(lens);
    any = true;
  }
  return any;
}

}  // namespace tunica::meshing::detail
