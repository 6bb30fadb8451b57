// SPDX-License-Identifier: MIT
// SAYS: a rule has a weight for each of its points
#include "tunica/fem/geometry.hpp"

using namespace tunica;

/// The midpoint of a tetrahedron, without its weight.
struct Midpoint {
  using cell = mesh::Tet4;
  static constexpr int degree = 1, size = 1;
  static constexpr std::array<fem::LocalPoint<3>, 1> points{{{0.25, 0.25, 0.25}}};
#ifdef RIGHT
  static constexpr std::array<double, 1> weights{1.0 / 6};
#endif
};

fem::Tables<fem::Lagrange<mesh::Tet4>, Midpoint> tables;
