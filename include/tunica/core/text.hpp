// SPDX-License-Identifier: MIT
// Numbers and places in messages: seven digits, whatever the unit.
#pragma once

#include "tunica/core/types.hpp"

#include <array>
#include <cstdio>
#include <string>

namespace tunica {

/// "0.2500001", "1e-09".
[[nodiscard]] inline std::string seven_digits(double x) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.7g", x);
  return text.data();
}

/// "(221.484, 150.293, 22.501)".
[[nodiscard]] inline std::string place(const Vec3& x) {
  return "(" + seven_digits(x[0]) + ", " + seven_digits(x[1]) + ", " + seven_digits(x[2]) + ")";
}

}  // namespace tunica
