// SPDX-License-Identifier: MIT
// Runs a command-line program in a folder of its own and keeps what it said and left there.
#pragma once

#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#ifndef TUNICA_PROGRAM_DIR
#define TUNICA_PROGRAM_DIR "bin"
#endif
#ifndef TUNICA_VTK_PYTHON
#define TUNICA_VTK_PYTHON ""
#endif

namespace tunica::test {

[[nodiscard]] inline std::string text_of(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

[[nodiscard]] inline bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// A folder that is removed at the end; files() are those left in it.
class Folder {
 public:
  Folder() {
    static std::atomic<int> count{0};
    path_ = std::filesystem::temp_directory_path() /
            ("tunica_run_" + std::to_string(::getpid()) + "_" + std::to_string(count++));
    std::filesystem::create_directories(path_);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  ~Folder() { std::filesystem::remove_all(path_); }

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] std::set<std::string> files() const {
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(path_))
      names.insert(entry.path().filename());
    return names;
  }

 private:
  std::filesystem::path path_;
};

struct Outcome {
  int status = -1;       // of the program; 128 + signal when it was killed
  std::string out, err;  // what it said
};

/// Runs a command of the shell in the folder; its output goes beside the folder and is read back.
[[nodiscard]] inline Outcome run(const Folder& folder, const std::string& command) {
  const std::string log = folder.path().string() + ".log";
  const int raw = std::system(
      ("cd \"" + folder.path().string() + "\" && " + command + " >\"" + log + ".out\" 2>\"" + log + ".err\"")
          .c_str());
  Outcome o;
  o.status = WIFEXITED(raw) ? WEXITSTATUS(raw) : 128 + WTERMSIG(raw);
  o.out = text_of(log + ".out"), o.err = text_of(log + ".err");
  std::filesystem::remove(log + ".out"), std::filesystem::remove(log + ".err");
  return o;
}

/// The path of a program, in quotes; empty, with the line of a skipped test, when it was not built.
[[nodiscard]] inline std::string program(const std::string& name) {
  const auto path = std::filesystem::path(TUNICA_PROGRAM_DIR) / name;
  if (std::filesystem::exists(path)) return "\"" + path.string() + "\"";
  std::printf("SKIPPED: %s was not built\n", path.string().c_str());
  return "";
}

/// The number that follows keys, sought one after the other in a report; NaN when one is missing.
[[nodiscard]] inline double figure(const std::string& report, const std::vector<std::string>& keys) {
  std::size_t at = 0;
  for (const auto& key : keys) {
    at = report.find("\"" + key + "\": ", at);
    if (at == std::string::npos) return std::nan("");
    at += key.size() + 4;
  }
  return std::strtod(report.c_str() + at, nullptr);
}

/// Holds a mesh against the independent checker beside the project: empty when there is no fault or the
/// checker cannot run, else what it found.
[[nodiscard]] inline std::string faults(const std::filesystem::path& checker, const Folder& folder,
                                        const std::string& arguments) {
  const std::string python = TUNICA_VTK_PYTHON;
  if (python.empty() || run(folder, python + " -c 'import scipy'").status != 0) {
    std::printf("SKIPPED: no Python with VTK and scipy for the checker\n");
    return "";
  }
  const auto o = run(folder, python + " \"" + checker.string() + "\" " + arguments);
  return o.status == 0 ? "" : "status " + std::to_string(o.status) + "\n" + o.out + o.err;
}

}  // namespace tunica::test
