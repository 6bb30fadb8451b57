// SPDX-License-Identifier: MIT
// The viscosity of the fluid as a function of the shear rate. [PEREZ08, (1)]
#pragma once

#include <concepts>

namespace tunica::fluid {

/// Density [kg/m3] and dynamic viscosity [Pa s] at a shear rate sqrt(2 eps:eps) [1/s].
///   struct Water { double density = 998; double viscosity_at(double) const { return 1.0e-3; } };
template <class R>
concept Rheology = requires(const R& r, double rate) {
  { r.density } -> std::convertible_to<double>;             // a fluid has a density
  { r.viscosity_at(rate) } -> std::convertible_to<double>;  // a fluid has a viscosity at a shear rate
};

struct Newtonian {
  double density;    // [kg/m3]
  double viscosity;  // [Pa s]

  [[nodiscard]] double viscosity_at(double) const { return viscosity; }
};

/// The shear rate is not evaluated for a rheology of constant viscosity.
template <class R>
inline constexpr bool constant_viscosity = requires(const R& r) {
  r.viscosity;
};

}  // namespace tunica::fluid
