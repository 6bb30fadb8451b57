// SPDX-License-Identifier: MIT
// SAYS: the shape functions of this cell stand in tunica/fem/shape_quadratic.hpp or shape_wedge.hpp
#include "tunica/solid/body.hpp"
#include "tunica/solid/laws.hpp"
#include "tunica/solid/volumetric.hpp"
#ifdef RIGHT
#include "tunica/fem/shape_quadratic.hpp"
#endif

using namespace tunica;

using Material = solid::Hyperelastic<solid::NeoHooke, solid::Quadratic>;

std::size_t size() {
  return sizeof(solid::Body<mesh::Tet10, Material>);
}
