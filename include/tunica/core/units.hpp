// SPDX-License-Identifier: MIT
// Literals that turn the units of the trade into SI: everything inside tunica is SI.
#pragma once

namespace tunica::literals {

#define TUNICA_UNIT(suffix, factor)                                     \
  constexpr double operator""_##suffix(long double v) {                 \
    return static_cast<double>(v * (factor));                           \
  }                                                                     \
  constexpr double operator""_##suffix(unsigned long long v) {          \
    return static_cast<double>(static_cast<long double>(v) * (factor)); \
  }

TUNICA_UNIT(m, 1.0L)  // length [m]
TUNICA_UNIT(mm, 1.0e-3L)
TUNICA_UNIT(um, 1.0e-6L)
TUNICA_UNIT(s, 1.0L)  // time [s]
TUNICA_UNIT(ms, 1.0e-3L)
TUNICA_UNIT(Pa, 1.0L)  // pressure, stress, modulus [Pa]
TUNICA_UNIT(kPa, 1.0e3L)
TUNICA_UNIT(MPa, 1.0e6L)
TUNICA_UNIT(mmHg, 133.322387415L)
TUNICA_UNIT(kg_m3, 1.0L)  // density [kg/m3]
TUNICA_UNIT(Pas, 1.0L)    // dynamic viscosity [Pa s]
TUNICA_UNIT(mPas, 1.0e-3L)
TUNICA_UNIT(m_s, 1.0L)  // velocity [m/s]

#undef TUNICA_UNIT

}  // namespace tunica::literals
