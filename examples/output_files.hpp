// SPDX-License-Identifier: MIT
// The output files of one run: all of them, or none when it fails; what they are called.
#pragma once

#include "cli.hpp"
#include "json.hpp"
#include "stages.hpp"
#include "tunica/io/atomic_file.hpp"

#include <algorithm>
#include <cstdio>
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
    for (const auto& path : made_)
      if (std::filesystem::is_regular_file(path, ignored)) std::filesystem::remove(path, ignored);
  }

  template <class Write>
  void write(const std::filesystem::path& path, Write&& write_to) {
    if (std::find(made_.begin(), made_.end(), path) != made_.end())
      throw UsageError("two outputs are named \"" + path.string() + "\"");
    std::forward<Write>(write_to)(path);
    made_.push_back(path);
  }
  /// Tells their names.
  void keep() {
    std::string names;
    for (const auto& path : made_) names += (names.empty() ? "" : ", ") + path.string();
    std::printf("wrote %s\n", names.c_str());
    made_.clear();
  }

 private:
  std::vector<std::filesystem::path> made_;
};

/// OUT.vtu: the one given, or the input's name with .vtu in the present folder.
[[nodiscard]] inline std::filesystem::path mesh_file(const std::string& given,
                                                     const std::filesystem::path& input) {
  if (given.empty()) return input.filename().replace_extension(".vtu");
  if (std::filesystem::path(given).extension() != ".vtu")
    throw UsageError("-o: \"" + given + "\" does not end in .vtu");
  return given;
}

/// OUT.surface.vtp of OUT.vtu.
[[nodiscard]] inline std::filesystem::path surface_file(std::filesystem::path volume) {
  return volume.replace_extension(".surface.vtp");
}

/// A mesh, its surface or a report that cannot be written are found before the work, not after it.
inline void expect_outputs(const std::filesystem::path& volume, const std::string& report_file) {
  io::expect_writable(volume);
  io::expect_writable(surface_file(volume));
  if (!report_file.empty()) io::expect_writable(report_file);
}

/// Ends a run: the report last, then all files stay.
inline void finish(OutputFiles& files, Stages& stage, Json& report, const std::string& report_file) {
  stage.finish(report);
  if (!report_file.empty())
    files.write(report_file, [&](const auto& path) { io::write_file(path, report.text() + "\n"); });
  files.keep();
}

}  // namespace tunica::examples
