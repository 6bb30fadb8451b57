// SPDX-License-Identifier: MIT
// The scene of the paper as numbers, in SI: blood, wall and waveforms. [PEREZ08, 7.1]
#pragma once

#include "tunica/core/units.hpp"

#include <cmath>
#include <numbers>

namespace tunica::artery {

using namespace tunica::literals;

inline constexpr double blood_density = 1050_kg_m3;
inline constexpr double blood_viscosity = 3.5_mPas;
inline constexpr double wall_density = 1100_kg_m3;
inline constexpr double c10 = 174_kPa, c20 = 1880_kPa;  // law (17)
inline constexpr double kappa = 348_MPa;                // bulk modulus: 1000 times 2 c10
inline constexpr double thickness = 1.5_mm;
inline constexpr double reference_pressure = 80_mmHg;  // p0: the imaged shape is free of stress at it

/// Moens and Korteweg's speed of pressure waves, sqrt(E h / (2 rho R)) with E = 6 c10, R [m] the radius.
[[nodiscard]] inline double wave_speed(double radius) {
  return std::sqrt(6 * c10 * thickness / (2 * blood_density * radius));
}

/// Every load starts from rest: (1 - cos(pi t / 20 ms)) / 2 until 20 ms, then 1.
[[nodiscard]] inline double ramp(double t) {
  return t < 20_ms ? 0.5 * (1 - std::cos(std::numbers::pi * t / 20_ms)) : 1.0;
}

[[nodiscard]] inline double sin2(double x) {
  return std::sin(x) * std::sin(x);
}

/// Mean velocity over the inlet [m/s], period 0.8 s (Fig. 13a).
[[nodiscard]] inline double inlet_velocity(double t) {
  const double beat = std::fmod(t, 0.8_s);
  return ramp(t) * (0.10_m_s + (beat < 0.3_s ? 0.30_m_s * sin2(std::numbers::pi * beat / 0.3_s) : 0.0));
}

/// p - p0 at the outlets [Pa] (Fig. 13b).
[[nodiscard]] inline double outlet_pressure(double t) {
  const double beat = std::fmod(t, 0.8_s);
  return ramp(t) * (beat < 0.4_s ? 5.3_kPa * sin2(std::numbers::pi * beat / 0.4_s) : 0.0);
}

}  // namespace tunica::artery
