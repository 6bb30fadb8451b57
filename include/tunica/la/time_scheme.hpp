// SPDX-License-Identifier: MIT
// Coefficients of time schemes: generalised-alpha and Newmark for second order, BDF for first order.
#pragma once

#include "tunica/core/expect.hpp"

#include <array>
#include <concepts>

namespace tunica::la {

/// A scheme says at compile time how many old levels it reads.
///   struct Euler { static constexpr int depth = 1; };
template <class T>
concept TimeScheme = requires {
  { T::depth } -> std::convertible_to<int>;  // a scheme says how many old levels it reads
};

/// The equation of motion is met at M a^{n+am} + f(u^{n+af}) = 0, x^{n+c} = (1-c) x^n + c x^{n+1}, with
///   u^{n+1} = u^n + dt v^n + dt^2 ((1/2-beta) a^n + beta a^{n+1}),
///   v^{n+1} = v^n + dt ((1-gamma) a^n + gamma a^{n+1}).
struct SecondOrder {
  double am, af, gamma, beta;
};

template <class T>
concept SecondOrderScheme = TimeScheme<T> && requires(const T& scheme) {
  { scheme.second_order() } -> std::same_as<SecondOrder>;
};

/// [CHUNG93] in the convention "evaluate at n + alpha": their own alphas are 1 - am and 1 - af.
/// Second order accurate and unconditionally stable on linear problems for each rho_inf in [0, 1]:
/// rho_inf = 1 damps nothing (the midpoint rule), 0 kills the highest frequencies in one step.
struct GeneralizedAlpha {
  double rho_inf = 0.5;  // spectral radius at infinite frequency [-]

  static constexpr int depth = 1;

  [[nodiscard]] SecondOrder second_order() const {
    TUNICA_EXPECT(rho_inf >= 0 && rho_inf <= 1, "a spectral radius lies in [0, 1]");
    const double am = (2 - rho_inf) / (1 + rho_inf), af = 1 / (1 + rho_inf);
    const double root = 1 + am - af;
    return {.am = am, .af = af, .gamma = 0.5 + am - af, .beta = 0.25 * root * root};
  }
};

/// gamma = 1/2, beta = 1/4 is the trapezoidal rule: second order, no damping.
struct Newmark {
  double gamma = 0.5;
  double beta = 0.25;

  static constexpr int depth = 1;

  [[nodiscard]] SecondOrder second_order() const { return {.am = 1, .af = 1, .gamma = gamma, .beta = beta}; }
};

/// dx/dt at n+1 is (w[0] x^{n+1} + w[1] x^n + ...)/dt, dt being the step from n to n+1.
struct Bdf1 {
  static constexpr int depth = 1;
  [[nodiscard]] static constexpr std::array<double, 2> weights() { return {1, -1}; }
};

struct Bdf2 {
  static constexpr int depth = 2;
  /// ratio = dt / (step from n-1 to n); 1 gives (3/2, -2, 1/2).
  [[nodiscard]] static constexpr std::array<double, 3> weights(double ratio = 1) {
    return {(1 + 2 * ratio) / (1 + ratio), -(1 + ratio), ratio * ratio / (1 + ratio)};
  }
};

static_assert(SecondOrderScheme<GeneralizedAlpha> && SecondOrderScheme<Newmark>);
static_assert(TimeScheme<Bdf1> && TimeScheme<Bdf2>);

}  // namespace tunica::la
