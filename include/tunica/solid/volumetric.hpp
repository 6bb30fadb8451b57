// SPDX-License-Identifier: MIT
// Volumetric energies U(J) with bulk modulus kappa = U''(1).
#pragma once

#include "tunica/core/select.hpp"
#include "tunica/solid/energy.hpp"
#include "tunica/solid/hyperelastic.hpp"
#include "tunica/solid/parameters.hpp"

#include <cmath>

namespace tunica::solid {

/// Of U at a pressure p = U'(J) [Pa]: U*(p) = max_J [p (J - 1) - U(J)], its slope and its curvature. Laws
/// whose U' has an inverse may give it as complement(p), as NodalPressure asks; all three are 0 where kappa
/// is infinite.
template <class S>
struct Complement {
  S energy;      // [Pa]
  S dilatation;  // J - 1
  S compliance;  // dJ/dp [1/Pa]
};

namespace detail {
/// Infinity is for formulations that take complement(p).
inline void check_kappa(const char* law, double kappa) {
  require_parameter(kappa > 0, law, "kappa", kappa, "expected a bulk modulus above 0");
}
}  // namespace detail

/// U = kappa/2 (J - 1)^2: linear in J, so a constrained pressure is exactly kappa (J - 1).
struct Quadratic {
  double kappa;  // [Pa]

  void check() const { detail::check_kappa("Quadratic", kappa); }

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
  template <class S>
  [[nodiscard]] Complement<S> complement(const S& p) const {
    const S c(1 / kappa), e = c * p;
    return {.energy = S(0.5) * p * e, .dilatation = e, .compliance = c};
  }
};

/// U = kappa/2 ln^2 J: grows without bound as J -> 0; its slope falls again beyond J = e.
struct Logarithmic {
  double kappa;  // [Pa]

  void check() const { detail::check_kappa("Logarithmic", kappa); }

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

  void check() const { detail::check_kappa("SimoTaylor", kappa); }

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
  /// J = s + sqrt(1 + s^2) with s = p/kappa, U* = kappa/2 (s J - 2 s + ln J); a series of it for small s.
  template <class S>
  [[nodiscard]] Complement<S> complement(const S& p) const {
    using std::abs;
    using std::log;
    using std::sqrt;
    const S s = S(1 / kappa) * p, ss = s * s, root = sqrt(S(1) + ss), J = s + root;
    const S few = s * (S(0.5) + s * (S(1. / 6) + ss * (S(1. / 112) * ss - S(1. / 40))));
    const auto small = abs(s) < S(0.01);
    const S whole = S(0.5) * (J - S(2) + log(J) / select(small, S(1), s));
    return {.energy = p * select(small, few, whole),
            .dilatation = s + ss / (S(1) + root),
            .compliance = S(1 / kappa) * (J / root)};
  }
};

static_assert(VolumetricEnergy<Quadratic> && VolumetricEnergy<Logarithmic> && VolumetricEnergy<SimoTaylor>);

}  // namespace tunica::solid
