// SPDX-License-Identifier: MIT
// Isotropic isochoric energies: neo-Hooke, Mooney-Rivlin, Demiray and Yeoh, the law (17) of [PEREZ08].
#pragma once

#include "tunica/solid/energy.hpp"
#include "tunica/solid/parameters.hpp"

#include <array>
#include <cmath>

namespace tunica::solid {

/// Phi = c10 (I1 - 3), shear modulus 2 c10.
struct NeoHooke {
  double c10;  // [Pa]

  void check() const { require_not_negative("NeoHooke", "c10", c10); }

  static constexpr std::array reads{Invariant::I1};
  static constexpr std::array<Invariant, 0> curved{};

  template <class S>
  [[nodiscard]] S energy(const std::array<S, 1>& I) const {
    return S(c10) * (I[0] - S(3));
  }
  template <class S>
  [[nodiscard]] Slopes<S, 1> slopes(const std::array<S, 1>&) const {
    return {.first = {S(c10)}, .second = {}};
  }
};

/// Phi = c10 (I1 - 3) + c20 (I1 - 3)^2   [PEREZ08, (17)], after [RAGHAVAN00]; shear modulus 2 c10.
struct Yeoh {
  double c10;      // [Pa]
  double c20 = 0;  // [Pa]

  void check() const {
    require_not_negative("Yeoh", "c10", c10);
    require_finite("Yeoh", "c20", c20);
  }

  static constexpr std::array reads{Invariant::I1};

  template <class S>
  [[nodiscard]] S energy(const std::array<S, 1>& I) const {
    const S e = I[0] - S(3);
    return (S(c10) + S(c20) * e) * e;
  }
  template <class S>
  [[nodiscard]] Slopes<S, 1> slopes(const std::array<S, 1>& I) const {
    Slopes<S, 1> s;
    s.first[0] = S(c10) + S(2 * c20) * (I[0] - S(3));
    s.second[0][0] = S(2 * c20);
    return s;
  }
};

/// Phi = c10 (I1 - 3) + c01 (I2 - 3), shear modulus 2 (c10 + c01).
struct MooneyRivlin {
  double c10;  // [Pa]
  double c01;  // [Pa]

  void check() const {
    require_finite("MooneyRivlin", "c10", c10);
    require_finite("MooneyRivlin", "c01", c01);
    require_not_negative("MooneyRivlin", "c10 + c01", c10 + c01);
  }

  static constexpr std::array reads{Invariant::I1, Invariant::I2};
  static constexpr std::array<Invariant, 0> curved{};

  template <class S>
  [[nodiscard]] S energy(const std::array<S, 2>& I) const {
    return S(c10) * (I[0] - S(3)) + S(c01) * (I[1] - S(3));
  }
  template <class S>
  [[nodiscard]] Slopes<S, 2> slopes(const std::array<S, 2>&) const {
    return {.first = {S(c10), S(c01)}, .second = {}};
  }
};

/// Phi = mu/(2 a) (exp(a (I1 - 3)) - 1), Fung's exponential of I1   [DEMIRAY72]; shear modulus mu.
struct Demiray {
  double mu;  // [Pa]
  double a;   // stiffening [-], not 0: that is NeoHooke{mu/2}

  void check() const {
    require_not_negative("Demiray", "mu", mu);
    require_positive("Demiray", "a", a);
  }

  static constexpr std::array reads{Invariant::I1};

  template <class S>
  [[nodiscard]] S energy(const std::array<S, 1>& I) const {
    using std::exp;
    return S(mu / (2 * a)) * (exp(S(a) * (I[0] - S(3))) - S(1));
  }
  template <class S>
  [[nodiscard]] Slopes<S, 1> slopes(const std::array<S, 1>& I) const {
    using std::exp;
    Slopes<S, 1> s;
    s.first[0] = S(0.5 * mu) * exp(S(a) * (I[0] - S(3)));
    s.second[0][0] = S(a) * s.first[0];
    return s;
  }
};

static_assert(IsochoricEnergy<NeoHooke> && IsochoricEnergy<Yeoh> && IsochoricEnergy<MooneyRivlin> &&
              IsochoricEnergy<Demiray>);

}  // namespace tunica::solid
