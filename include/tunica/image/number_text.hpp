// SPDX-License-Identifier: MIT
// A number as the shortest text that reads back to it: 1299.5, 2346, 1e6.
#pragma once

#include <array>
#include <charconv>
#include <string>

namespace tunica::image {

/// Shortest decimal text of x that reads back to the same bits; the same on any machine and locale.
[[nodiscard]] inline std::string number_text(double x) {
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), x).ptr;
  std::string text(buffer.data(), end);
  if (const auto e = text.find("e+"); e != std::string::npos) {  // 1e+06 is written 1e6
    const auto digits = text.find_first_not_of('0', e + 2);
    text.erase(e + 1, digits - e - 1);
  }
  return text;
}

}  // namespace tunica::image
