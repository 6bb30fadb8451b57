// SPDX-License-Identifier: MIT
// SAYS: a shape has values at a point
#include "tunica/fem/geometry.hpp"

using namespace tunica;

/// A function that is one everywhere, without its values.
struct Constant {
  using cell = mesh::Tet4;
  static constexpr int nodes = 1;
#ifdef RIGHT
  static constexpr std::array<double, 1> values(const fem::LocalPoint<3>&) {
    return {1};
  }
#endif
  static constexpr std::array<fem::LocalPoint<3>, 1> gradients(const fem::LocalPoint<3>&) {
    return {};
  }
};

fem::Tables<Constant, fem::Gauss<mesh::Tet4, 1>> tables;
