// SPDX-License-Identifier: MIT
// What holds at the borders of blood and wall in the scene of the paper. [PEREZ08, 7.1]
#pragma once

#include "artery_scene.hpp"
#include "tunica/core/types.hpp"
#include "tunica/core/vec.hpp"
#include "tunica/fluid/inlet.hpp"
#include "tunica/mesh/mesh.hpp"
#include "tunica/mesh/triangle.hpp"

#include <cmath>
#include <cstddef>
#include <numbers>

namespace tunica::artery {

/// Patches of the lumen, in the order of the cuts.
inline constexpr std::size_t wall_patch = 0, inlet_patch = 1, first_outlet = 2;

/// Radius [m] of the disc with the area of the inlet.
[[nodiscard]] inline double inlet_radius(const mesh::TetMesh& lumen) {
  const auto& faces = lumen.patches.at(inlet_patch).faces;
  const auto corner = [&](int c, Eigen::Index f) { return vec::column(lumen.nodes, faces(c, f)); };
  double area = 0;
  for (Eigen::Index f = 0; f < faces.cols(); ++f)
    area += mesh::Triangle{corner(0, f), corner(1, f), corner(2, f)}.area();
  return std::sqrt(area / std::numbers::pi);
}

/// Blood at rest: a velocity at the inlet, pressures at the outlets, and the wall that it pushes.
template <class Fluid>
void set_conditions(Fluid& blood, const mesh::TetMesh& lumen) {
  const auto& inlet = lumen.patches.at(inlet_patch).name;
  blood.velocity(inlet, fluid::inlet_profile(lumen, inlet), &inlet_velocity);
  for (std::size_t k = first_outlet; k < lumen.patches.size(); ++k)
    blood.pressure(lumen.patches[k].name, &outlet_pressure, {.backflow = 0.5});
  blood.interface(lumen.patches.at(wall_patch).name);
  blood.set(Points<3>::Zero(3, lumen.node_count()), Eigen::VectorXd::Zero(lumen.node_count()));
}

/// A wall that is held at its end rings, pushed from inside and free outside.
template <class Structure>
void set_conditions(Structure& wall, const mesh::HexMesh& mesh) {
  wall.fix(mesh.patch("ends"));
  wall.interface(mesh.patch("inner"));
}

}  // namespace tunica::artery
