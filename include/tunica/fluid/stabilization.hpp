// SPDX-License-Identifier: MIT
// Stabilisation times of the finite increment calculus; none contains the time step. [ONATE06]
#pragma once

#include <concepts>

namespace tunica::fluid {

/// Times tau of the mass and t_m of the momentum balance, divided by the density [m3 s/kg], for an
/// element of size h [m], of size h_a along the velocity, at speed |a| [m/s].
///   struct Mine { double mass(double rho, double mu, double h, double speed) const; double momentum(...)
///   const; };
template <class S>
concept Stabilization = requires(const S& s, double v) {
  { s.mass(v, v, v, v) } -> std::convertible_to<double>;         // it has a time for the mass
  { s.momentum(v, v, v, v, v) } -> std::convertible_to<double>;  // it has a time for the momentum
};

/// tau = [8 mu/h^2 + 2 rho max(|a|, c)/h]^-1, t_m = min([8 mu/h^2 + 2 rho |a|/h]^-1, h_a / (2 rho |a|)):
/// a time step in tau would undo the stability of the pressure as the step goes to zero. In a vessel
/// that yields, pressure travels at c: where the blood is slow a tau of |a| alone outlasts the passage
/// of a wave through the element by far, and what it lets through damps the wave (docs/coupling.md).
struct Fic {
  double viscous = 8;     // c1
  double convective = 2;  // c2
  double wave_speed = 0;  // c of pressure waves in the vessel [m/s]; 0: rigid walls

  [[nodiscard]] double mass(double rho, double mu, double h, double speed) const {
    return convection_time(rho, mu, h, speed > wave_speed ? speed : wave_speed);
  }
  [[nodiscard]] double momentum(double rho, double mu, double h, double h_a, double speed) const {
    const double tau = convection_time(rho, mu, h, speed);
    return 2 * rho * speed * tau > h_a ? h_a / (2 * rho * speed) : tau;
  }

 private:
  [[nodiscard]] double convection_time(double rho, double mu, double h, double speed) const {
    return 1 / (viscous * mu / (h * h) + convective * rho * speed / h);
  }
};

/// No stabilisation at all: shows the checkerboard and the wiggles that the others prevent.
struct Unstabilized {
  [[nodiscard]] double mass(double, double, double, double) const { return 0; }
  [[nodiscard]] double momentum(double, double, double, double, double) const { return 0; }
};

}  // namespace tunica::fluid
