// SPDX-License-Identifier: MIT
// Surfaces of fields that planes cut off: region 0 is the wall, then one flat region a plane.
#pragma once

#include "tunica/core/types.hpp"
#include "tunica/mesh/mesh.hpp"
#include "tunica/meshing/dual_contouring.hpp"
#include "tunica/meshing/hermite_field.hpp"
#include "tunica/meshing/quad_diagonals.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace tunica::test {

/// level(x) > 0 inside; ports: .name, .point, .normal, outward. Triangles of about h.
template <class Level, class Ports>
mesh::Surface between_ports(const Level& level, const Ports& ports, const Box& box, double h) {
  const auto field = [&](const Vec3& x) {
    double v = level(x);
    for (const auto& p : ports) v = std::min(v, -p.normal.dot(x - p.point));
    return v;
  };
  auto grid = meshing::hermite_of_field(field, meshing::uniform_axes(box, h));
  for (const auto& p : ports) grid.regions.push_back({p.name, true, p.point, p.normal});
  for (auto& c : grid.crossings)
    for (std::size_t k = 0; k < ports.size(); ++k)
      if (std::abs(ports[k].normal.dot(c.point - ports[k].point)) < 1e-8 &&
          c.normal.dot(ports[k].normal) > 0.9999)
        c.region = 1 + static_cast<Index>(k);
  return meshing::triangles_of(meshing::dual_contour(grid, {.hold = -0.5}));
}

}  // namespace tunica::test
