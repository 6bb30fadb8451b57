// SPDX-License-Identifier: MIT
// What a row of results carries of its origin: compiler flags and commit.
#pragma once

#include <array>
#include <cstdio>
#include <string>

namespace tunica::bench {

/// Standard output of a command, without its last newline; empty where it fails.
[[nodiscard]] inline std::string output_of(const std::string& command) {
  std::string text;
  std::FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return text;
  std::array<char, 4096> part{};
  while (const std::size_t n = std::fread(part.data(), 1, part.size(), pipe)) text.append(part.data(), n);
  if (pclose(pipe) != 0) return {};
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text;
}

[[nodiscard]] inline std::string commit() {
  const std::string hash =
      output_of("git -c safe.directory='*' -C '" TUNICA_SOURCE_DIR "' rev-parse --short HEAD 2>/dev/null");
  return hash.empty() ? "unknown" : hash;
}

[[nodiscard]] inline std::string flags() {
  return TUNICA_FLAGS;
}

}  // namespace tunica::bench
