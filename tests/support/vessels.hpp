// SPDX-License-Identifier: MIT
// Closed lumens with flat, named ends for the tests of walls: a tilted tube and the phantom's bifurcation.
#pragma once

#include "support/ports.hpp"
#include "tunica/image/phantom.hpp"
#include "tunica/mesh/mesh.hpp"
#include "tunica/meshing/tube.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace tunica::test::vessels {

inline Eigen::Matrix3d tilt() {
  return Eigen::AngleAxisd(0.5, Vec3(1, 2, 0.5).normalized()).toRotationMatrix();
}

/// The surface of meshing::lumen: regions "wall", "inlet", "outlet"; the axis is the third column of tilt().
inline mesh::Surface cylinder(double radius, double length, int around) {
  const auto tets =
      meshing::lumen(meshing::Lumen{.radius = radius,
                                    .length = length,
                                    .cells = {3, around, static_cast<int>(around * length / (6 * radius))}});
  mesh::Surface s;
  s.nodes = tilt() * tets.nodes;
  for (const auto& p : tets.patches) {
    const Eigen::Index before = s.cells.cols();
    s.cells.conservativeResize(3, before + p.faces.cols());
    s.cells.rightCols(p.faces.cols()) = p.faces;
    s.region.insert(s.region.end(), static_cast<std::size_t>(p.faces.cols()),
                    static_cast<Index>(s.region_names.size()));
    s.region_names.push_back(p.name);
  }
  return s;
}

/// The phantom between its ports, from its analytic level, with triangles of about h [mm].
inline mesh::Surface bifurcation(double h) {
  const image::Phantom phantom;
  const auto field = [&](const Vec3& x) { return -phantom.level(x).value; };
  return between_ports(field, image::Phantom::ports(), {Vec3(195, 88, 8), Vec3(255, 170, 42)}, h);
}

}  // namespace tunica::test::vessels
