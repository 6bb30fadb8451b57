// SPDX-License-Identifier: MIT
// Data that lies beside the project: a test that does not find it is skipped with a sentence.
#pragma once

#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>

#ifndef TUNICA_SHARED_DIR
#define TUNICA_SHARED_DIR "../shared"
#endif

namespace tunica::test {

/// The path of a file of the shared data; prints the line by which CTest knows a skipped test.
inline std::optional<std::filesystem::path> shared(const std::string& name) {
  const std::filesystem::path path = std::filesystem::path(TUNICA_SHARED_DIR) / name;
  if (std::filesystem::exists(path)) return path;
  std::printf("SKIPPED: %s is not there\n", path.string().c_str());
  return std::nullopt;
}

}  // namespace tunica::test
