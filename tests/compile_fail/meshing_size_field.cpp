// SPDX-License-Identifier: MIT
// SAYS: a size field gives an edge length at a point
#include "tunica/meshing/lattice.hpp"

using namespace tunica;

#ifdef RIGHT
const auto size = [](const Vec3&) { return 1e-3; };
#else
const auto size = [](const Vec3&) { return "1 mm"; };
#endif

meshing::Lattice<decltype(size)>* points = nullptr;
