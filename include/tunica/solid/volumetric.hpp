// SPDX-License-Identifier: MIT
// Volumetric energies U(J) with bulk modulus kappa = U''(1).
#pragma once

#include "tunica/solid/energy.hpp"
#include "tunica/solid/hyperelastic.hpp"

#include <cmath>

namespace tunica::solid {

/// U = kappa/2 (J - 1)^2: linear in J, so a constrained pressure is exactly kappa (J - 1).
struct Quadratic {
  double kappa;  // [Pa]

  template <class S>
  [[nodiscard]] S energy(const S& J) const {
    return S(0.5 * kappa) * (J - S(1)) * (J - S(1));
  }
  template <class S>
  [[nodiscard]] S slope(const S& J) const {
    return S(kappa) * (J - S(1));
  }
  template <class S>
  [[nodiscard]] S curvature(const S&) const {
    return S(kappa);
  }
};

/// U = kappa/2 ln^2 J: grows without bound as J -> 0; its slope falls again beyond J = e.
struct Logarithmic {
  double kappa;  // [Pa]

  template <class S>
  [[nodiscard]] S energy(const S& J) const {
    using std::log;
    const S l = log(J);
    return S(0.5 * kappa) * l * l;
  }
  template <class S>
  [[nodiscard]] S slope(const S& J) const {
    using std::log;
    return S(kappa) * log(J) / J;
  }
  template <class S>
  [[nodiscard]] S curvature(const S& J) const {
    using std::log;
    return S(kappa) * (S(1) - log(J)) / (J * J);
  }
};

/// U = kappa/4 (J^2 - 1 - 2 ln J): convex, unbounded at both ends   [SIMO91]
struct SimoTaylor {
  double kappa;  // [Pa]

  template <class S>
  [[nodiscard]] S energy(const S& J) const {
    using std::log;
    return S(0.25 * kappa) * (J * J - S(1) - S(2) * log(J));
  }
  template <class S>
  [[nodiscard]] S slope(const S& J) const {
    return S(0.5 * kappa) * (J - S(1) / J);
  }
  template <class S>
  [[nodiscard]] S curvature(const S& J) const {
    return S(0.5 * kappa) * (S(1) + S(1) / (J * J));
  }
};

static_assert(VolumetricEnergy<Quadratic> && VolumetricEnergy<Logarithmic> && VolumetricEnergy<SimoTaylor>);

}  // namespace tunica::solid
