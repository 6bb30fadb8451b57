// SPDX-License-Identifier: MIT
// Two families of fibres in a soft ground: Holzapfel-Gasser-Ogden, and Gasser's law with their dispersion.
#pragma once

#include "tunica/core/select.hpp"
#include "tunica/solid/energy.hpp"
#include "tunica/solid/fibres.hpp"
#include "tunica/solid/parameters.hpp"

#include <array>
#include <cmath>
#include <cstddef>

namespace tunica::solid {

/// k1/(2 k2) (exp(k2 E^2) - 1) of a family with strain E, and nothing where E <= 0. This is the switch of
/// tension: by E, not by the stretch along the mean direction (with dispersion they differ). Energy and
/// stress are continuous there; the second derivative jumps from 0 to k1, never below 0.
struct FibreEnergy {
  double k1;  // [Pa]
  double k2;  // stiffening [-]; 0: k1/2 E^2

  /// As k1/2 E^2 (exp(x) - 1)/x with x = k2 E^2; a series of it for small x.
  template <class S>
  [[nodiscard]] S energy(const S& strain) const {
    using std::exp;
    const S E =
        select(strain > S(0), strain, S(0));  // a branch for every lane; its derivatives vanish as well
    const S x = S(k2) * E * E;
    const auto small = x < S(1e-3);
    const S few = S(1) + x * (S(0.5) + x * (S(1. / 6) + x * (S(1. / 24) + x * S(1. / 120))));
    return S(0.5 * k1) * E * E * select(small, few, (exp(x) - S(1)) / select(small, S(1), x));
  }
  template <class S>
  struct Slope {
    S first, second;
  };
  template <class S>
  [[nodiscard]] Slope<S> slopes(const S& strain) const {
    using std::exp;
    const auto tension = strain > S(0);
    const S E = select(tension, strain, S(0)), k2E2 = S(k2) * E * E, k = S(k1) * exp(k2E2);
    return {.first = k * E, .second = select(tension, k * (S(1) + k2E2 + k2E2), S(0))};
  }
  void check(const char* law) const {
    require_not_negative(law, "k1", k1);
    require_not_negative(law, "k2", k2);
  }
};

/// Phi = c/2 (I1 - 3) + sum_{4,6} k1/(2 k2) (exp(k2 E^2) - 1) with E = I_i - 1, where E > 0   [HGO00].
/// Invariants of the isochoric C; shear modulus of the ground c. A point holds the two unit vectors of the
/// families; a zero vector stands for a family that is not there.
struct HolzapfelGasserOgden {
  double c;   // [Pa]
  double k1;  // [Pa]
  double k2;  // [-]

  void check() const {
    require_not_negative("HolzapfelGasserOgden", "c", c);
    FibreEnergy{k1, k2}.check("HolzapfelGasserOgden");
  }

  static constexpr std::array reads{Invariant::I1, Invariant::I4, Invariant::I6};
  static constexpr std::array curved{Invariant::I4, Invariant::I6};
  template <class S>
  using Point = Fibres<S, 2>;

  template <class S>
  [[nodiscard]] S energy(const std::array<S, 3>& I) const {
    const FibreEnergy fibre{k1, k2};
    return S(0.5 * c) * (I[0] - S(3)) + fibre.energy(I[1] - S(1)) + fibre.energy(I[2] - S(1));
  }
  template <class S>
  [[nodiscard]] Slopes<S, 3> slopes(const std::array<S, 3>& I) const {
    const FibreEnergy fibre{k1, k2};
    Slopes<S, 3> s;
    s.first[0] = S(0.5 * c);
    for (std::size_t k = 1; k < 3; ++k) {
      const auto f = fibre.slopes(I[k] - S(1));
      s.first[k] = f.first;
      s.second[k][k] = f.second;
    }
    return s;
  }
};

/// The same with fibres spread about their mean direction: E = kappa (I1 - 3) + (1 - 3 kappa) (I_i - 1),
/// where E > 0   [GASSER06]. kappa from 0 (all aligned, [HGO00]) to 1/3 (spread evenly).
struct GasserOgdenHolzapfel {
  double c;      // [Pa]
  double k1;     // [Pa]
  double k2;     // [-]
  double kappa;  // dispersion [-], in [0, 1/3]

  void check() const {
    require_not_negative("GasserOgdenHolzapfel", "c", c);
    FibreEnergy{k1, k2}.check("GasserOgdenHolzapfel");
    require_parameter(kappa >= 0 && kappa <= 1. / 3, "GasserOgdenHolzapfel", "kappa", kappa,
                      "expected a dispersion in [0, 1/3]");
  }

  static constexpr std::array reads{Invariant::I1, Invariant::I4, Invariant::I6};
  template <class S>
  using Point = Fibres<S, 2>;

  template <class S>
  [[nodiscard]] S energy(const std::array<S, 3>& I) const {
    const FibreEnergy fibre{k1, k2};
    return S(0.5 * c) * (I[0] - S(3)) + fibre.energy(strain(I, 1)) + fibre.energy(strain(I, 2));
  }
  template <class S>
  [[nodiscard]] Slopes<S, 3> slopes(const std::array<S, 3>& I) const {
    const FibreEnergy fibre{k1, k2};
    const double along = 1 - 3 * kappa;
    Slopes<S, 3> s;
    s.first[0] = S(0.5 * c);
    for (std::size_t k = 1; k < 3; ++k) {
      const auto f = fibre.slopes(strain(I, k));
      s.first[0] += S(kappa) * f.first;
      s.first[k] = S(along) * f.first;
      s.second[0][0] += S(kappa * kappa) * f.second;
      s.second[0][k] = s.second[k][0] = S(kappa * along) * f.second;
      s.second[k][k] = S(along * along) * f.second;
    }
    return s;
  }

 private:
  template <class S>
  [[nodiscard]] S strain(const std::array<S, 3>& I, std::size_t k) const {
    const S E = S(kappa) * (I[0] - S(3)) + S(1 - 3 * kappa) * (I[k] - S(1));
    return select(I[k] > S(0), E, S(0));  // no family, no fibres spread about it
  }
};

static_assert(IsochoricEnergy<HolzapfelGasserOgden> && IsochoricEnergy<GasserOgdenHolzapfel>);

}  // namespace tunica::solid
