// SPDX-License-Identifier: MIT
// An eighth of a thick hollow sphere of hexahedra, and what a neo-Hookean one of it bears.
#pragma once

#include "tunica/mesh/mesh.hpp"
#include "tunica/meshing/faces_on.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <numbers>
#include <vector>

namespace tunica::test {

/// The octant x, y, z >= 0: three times across^2 columns over the faces of a cube, cells radial through
/// the wall. Patches "inner", "outer", "sym_x", "sym_y", "sym_z".
[[nodiscard]] inline mesh::HexMesh octant(double inner, double outer, int across, int radial) {
  std::map<std::array<Index, 3>, Index> number;  // of the points of the cube's three far faces
  std::vector<std::array<Index, 3>> key;
  const auto column = [&](const std::array<Index, 3>& at) {
    const auto [it, made] = number.try_emplace(at, static_cast<Index>(key.size()));
    if (made) key.push_back(at);
    return it->second;
  };
  std::vector<std::array<Index, 4>> quads;
  const Index n = across;
  for (std::size_t face = 0; face < 3; ++face)
    for (Index i = 0; i < n; ++i)
      for (Index j = 0; j < n; ++j) {
        const auto corner = [&](Index a, Index b) {
          std::array<Index, 3> at{};
          at[face] = n;
          at[(face + 1) % 3] = i + a;
          at[(face + 2) % 3] = j + b;
          return column(at);
        };
        quads.push_back({corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)});  // outward
      }
  mesh::HexMesh mesh;
  const Index rows = radial + 1;
  mesh.nodes.resize(3, static_cast<Eigen::Index>(key.size()) * rows);
  for (std::size_t c = 0; c < key.size(); ++c) {
    Vec3 direction;
    for (std::size_t a = 0; a < 3; ++a)
      direction[static_cast<int>(a)] =
          key[c][a] == 0 ? 0 : std::tan(std::numbers::pi / 4 * static_cast<double>(key[c][a]) / n);
    direction.normalize();
    for (Index i = 0; i < rows; ++i)
      mesh.nodes.col(static_cast<Index>(c) * rows + i) = (inner + (outer - inner) * i / radial) * direction;
  }
  mesh.cells.resize(8, static_cast<Eigen::Index>(quads.size()) * radial);
  for (std::size_t q = 0; q < quads.size(); ++q)
    for (Index i = 0; i < radial; ++i)
      for (std::size_t c = 0; c < 4; ++c) {
        const auto cell = static_cast<Eigen::Index>(q) * radial + i;
        mesh.cells(static_cast<Eigen::Index>(c), cell) = quads[q][c] * rows + i;
        mesh.cells(static_cast<Eigen::Index>(c) + 4, cell) = quads[q][c] * rows + i + 1;
      }
  const auto name = [&](const char* patch, auto on) {
    mesh.patches.push_back(meshing::faces_on(mesh, patch, on));
  };
  name("inner", [&](Index k) { return k % rows == 0; });
  name("outer", [&](Index k) { return k % rows == radial; });
  name("sym_x", [&](Index k) { return key[static_cast<std::size_t>(k / rows)][0] == 0; });
  name("sym_y", [&](Index k) { return key[static_cast<std::size_t>(k / rows)][1] == 0; });
  name("sym_z", [&](Index k) { return key[static_cast<std::size_t>(k / rows)][2] == 0; });
  return mesh;
}

/// p/mu = [2/l + 1/(2 l^4)] from l_i to l_o, l_o^3 = 1 + (l_i^3 - 1)/ratio^3: incompressible, neo-Hookean.
struct Balloon {
  double ratio;  // of the outer to the inner radius

  [[nodiscard]] double pressure(double inner_stretch) const {
    const auto primitive = [](double l) { return 2 / l + 0.5 / (l * l * l * l); };
    const double outer = std::cbrt(1 + (std::pow(inner_stretch, 3) - 1) / std::pow(ratio, 3));
    return primitive(outer) - primitive(inner_stretch);
  }
};

}  // namespace tunica::test
