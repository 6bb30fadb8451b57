// SPDX-License-Identifier: MIT
// Numbers and places in messages and files: seven digits whatever the unit, or all that there are.
#pragma once

#include "tunica/core/types.hpp"

#include <array>
#include <charconv>
#include <cstdio>
#include <string>

namespace tunica {

/// "0.2500001", "1e-09".
[[nodiscard]] inline std::string seven_digits(double x) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.7g", x);
  return text.data();
}

/// "1299.5", "1e6": the shortest text that reads back to the same bits, on any machine and in any locale.
[[nodiscard]] inline std::string number_text(double x) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), x).ptr;
  std::string number(text.data(), end);
  if (const auto e = number.find("e+"); e != std::string::npos) {  // 1e+06 is written 1e6
    const auto digits = number.find_first_not_of('0', e + 2);
    number.erase(e + 1, digits - e - 1);
  }
  return number;
}

/// "(221.484, 150.293, 22.501)".
[[nodiscard]] inline std::string place(const Vec3& x) {
  return "(" + seven_digits(x[0]) + ", " + seven_digits(x[1]) + ", " + seven_digits(x[2]) + ")";
}

}  // namespace tunica
