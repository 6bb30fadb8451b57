// SPDX-License-Identifier: MIT
// Tubes with one blind branch, thick or thin, straight or leaning: what a wall's edges may be too long for.
#pragma once

#include "support/ports.hpp"
#include "tunica/mesh/mesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace tunica::test::stubs {

struct Branch {
  double radius, length;  // beyond the tube
  double lean = 0;        // angle from the tube's normal [rad]
};

/// A tube of radius 6 and length 20 along z, the branch at half its length, with triangles of about h.
/// Regions "wall", "inlet", "outlet".
inline mesh::Surface tube(const Branch& branch, double h) {
  constexpr double radius = 6, length = 20, blend = 0.3;
  const Vec3 root(0, 0, length / 2);
  const Vec3 way =
      Vec3(std::cos(branch.lean), 0.3 * std::sin(branch.lean), std::sin(branch.lean)).normalized();
  const double reach = radius / way[0] + branch.length - branch.radius;  // to the centre of the tip
  struct Port {
    const char* name;
    Vec3 point, normal;
  };
  const std::array<Port, 2> ports{
      {{"inlet", Vec3(0, 0, 0), Vec3(0, 0, -1)}, {"outlet", Vec3(0, 0, length), Vec3(0, 0, 1)}}};
  const auto field = [&](const Vec3& x) {
    const double a = radius - std::hypot(x[0], x[1]);
    const double t = std::clamp((x - root).dot(way), 0.0, reach),
                 b = branch.radius - (x - root - t * way).norm();
    const double d = std::max(blend - std::abs(a - b), 0.0);
    return std::max(a, b) + d * d / (4 * blend);
  };
  return between_ports(field, ports, {Vec3(-7, -7, -1), Vec3(7 + branch.length, 7, length + 1)}, h);
}

}  // namespace tunica::test::stubs
