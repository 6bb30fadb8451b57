// SPDX-License-Identifier: MIT
// The output files of one run: all of them, or none when it fails.
#pragma once

#include <filesystem>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace tunica::examples {

/// Files that write() has made are removed again unless keep() is reached.
class OutputFiles {
 public:
  OutputFiles() = default;
  OutputFiles(const OutputFiles&) = delete;
  OutputFiles& operator=(const OutputFiles&) = delete;
  ~OutputFiles() {
    std::error_code ignored;
    for (const auto& path : made_) std::filesystem::remove(path, ignored);
  }

  template <class Write>
  void write(const std::filesystem::path& path, Write&& write_to) {
    std::forward<Write>(write_to)(path);
    made_.push_back(path);
  }
  void keep() { made_.clear(); }

 private:
  std::vector<std::filesystem::path> made_;
};

}  // namespace tunica::examples
