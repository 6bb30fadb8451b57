// SPDX-License-Identifier: MIT
// What the parameters of laws may be, asked when a body is composed: InputError names law, parameter and
// value.
#pragma once

#include "tunica/core/error.hpp"
#include "tunica/core/text.hpp"

#include <cmath>
#include <string>

namespace tunica::solid {

/// A parameter of a law; `wanted` says what it has to be.
inline void require_parameter(bool right, const char* law, const char* name, double found,
                              const char* wanted) {
  if (!right) throw InputError(law, name, seven_digits(found) + ", " + wanted);
}
inline void require_positive(const char* law, const char* name, double found) {
  require_parameter(std::isfinite(found) && found > 0, law, name, found, "expected a number above 0");
}
inline void require_not_negative(const char* law, const char* name, double found) {
  require_parameter(std::isfinite(found) && found >= 0, law, name, found, "expected a number not below 0");
}
inline void require_finite(const char* law, const char* name, double found) {
  require_parameter(std::isfinite(found), law, name, found, "expected a number");
}

/// Of a law by its check(), where it has one, and of the laws inside it. InputError as above.
template <class Law>
void check_parameters(const Law& law) {
  if constexpr (requires { law.check(); }) law.check();
  if constexpr (requires { law.isochoric; }) check_parameters(law.isochoric);
  if constexpr (requires { law.volumetric; }) check_parameters(law.volumetric);
  if constexpr (requires { law.law; }) check_parameters(law.law);
}

}  // namespace tunica::solid
