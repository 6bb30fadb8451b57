// SPDX-License-Identifier: MIT
// The inside of a body by its cell, its law and its cure of locking, and what such a law must give.
#pragma once

#include "tunica/mesh/mesh.hpp"
#include "tunica/solid/formulation.hpp"
#include "tunica/solid/interior.hpp"
#include "tunica/solid/mixed_interior.hpp"

namespace tunica::solid::detail {

/// True, or it does not compile, in one sentence.
template <class Law>
inline constexpr bool law_is_complete = [] {
  if constexpr (requires(const Law& law) { law.isochoric, law.volumetric; }) {
    static_assert(IsochoricEnergy<PointLaw<Law>> || Material<PointLaw<Law>>,
                  "the isochoric law needs `reads` and energy(invariants)");
    static_assert(VolumetricEnergy<decltype(Law::volumetric)>,
                  "the volumetric law needs energy(J), slope(J) and curvature(J)");
  } else {
    static_assert(Material<Law>, "a material gives energy(F), stress(F) or response(F) [Pa] of any scalar");
  }
  return true;
}();

template <mesh::Cell C, class Law, class Locking>
struct InteriorOf {
  using type = Interior<C, Law, Locking>;
};
template <mesh::Cell C, class Law>
struct InteriorOf<C, Law, NodalPressure> {
  static_assert(C::vtk_type == mesh::Tet4::vtk_type, "nodal pressures are those of linear tetrahedra");
  using type = MixedInterior<Law>;
};

}  // namespace tunica::solid::detail
