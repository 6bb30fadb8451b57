// SPDX-License-Identifier: MIT
// The thick tube of law (17) inflated to a stretch that is known: what the solid's figures are measured on.
#pragma once

#include "support/thick_tube.hpp"
#include "tunica/mesh/mesh.hpp"
#include "tunica/mesh/patch_nodes.hpp"
#include "tunica/meshing/tube.hpp"
#include "tunica/solid/laws.hpp"
#include "tunica/solid/statics.hpp"

namespace tunica::bench {

/// A quarter of a slice of the tube with that many cells through its wall, four times as many around.
[[nodiscard]] inline mesh::HexMesh tube_mesh(const test::ThickTube& tube, int radial) {
  return meshing::quarter_tube({.inner_radius = tube.inner,
                                .thickness = tube.outer - tube.inner,
                                .length = 1e-3,
                                .cells = {radial, 4 * radial, 1}});
}

struct [[nodiscard]] Inflation {
  bool converged = false;
  double stretch = 0;  // of the inner radius, mean over its nodes
};

/// At the exact pressure of that inner stretch; kappa [Pa].
inline Inflation inflate(const mesh::HexMesh& mesh, const test::ThickTube& tube, double stretch,
                         double kappa) {
  solid::Statics wall{mesh, solid::Hyperelastic{solid::Yeoh{.c10 = tube.c10, .c20 = tube.c20},
                                                solid::Quadratic{.kappa = kappa}}};
  wall.fix(mesh.patch("ends"), solid::Axis::z);
  wall.fix(mesh.patch("sym_x"), solid::Axis::x);
  wall.fix(mesh.patch("sym_y"), solid::Axis::y);
  wall.pressure(mesh.patch("inner"), tube.pressure(stretch));
  Inflation reached{.converged = static_cast<bool>(wall.solve())};
  const Points<3> x = mesh.nodes + wall.displacement();
  const auto nodes = mesh::patch_nodes(mesh.patch("inner"));
  for (const Index n : nodes)
    reached.stretch += x.col(n).head<2>().norm() / (tube.inner * static_cast<double>(nodes.size()));
  return reached;
}

}  // namespace tunica::bench
