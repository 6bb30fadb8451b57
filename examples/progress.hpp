// SPDX-License-Identifier: MIT
// Progress of a long run: a bar on a terminal, a line every twentieth of the way in a log.
#pragma once

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

namespace tunica::examples {

class Progress {
 public:
  explicit Progress(int total) : total_(std::max(1, total)), terminal_(isatty(fileno(stderr)) != 0) {}

  /// Tells that `done` of the total are done; note says what the last one was like.
  void tell(int done, const std::string& note) {
    const int percent = 100 * done / total_;
    if (terminal_) {
      constexpr int width = 40;
      const auto filled = static_cast<std::size_t>(width * done / total_);
      std::fprintf(stderr, "\r[%s%s] %3d %%  %s\033[K%s", std::string(filled, '#').c_str(),
                   std::string(static_cast<std::size_t>(width) - filled, '.').c_str(), percent, note.c_str(),
                   done >= total_ ? "\n" : "");
    } else if (percent / 5 > told_) {
      std::fprintf(stderr, "%3d %%  %s\n", percent, note.c_str());
      told_ = percent / 5;
    }
    std::fflush(stderr);
  }

 private:
  int total_, told_ = -1;
  bool terminal_;
};

/// Wall-clock seconds of the stages of a program, in the order of their first start.
class Stopwatch {
 public:
  using Clock = std::chrono::steady_clock;

  /// Adds the time of a call to a stage and hands on what the call returns.
  template <class F>
  decltype(auto) time(const std::string& stage, F&& call) {
    struct Stop {
      Stopwatch& watch;
      const std::string& stage;
      Clock::time_point start = Clock::now();
      ~Stop() { watch.add(stage, std::chrono::duration<double>(Clock::now() - start).count()); }
    } stop{*this, stage};
    return std::forward<F>(call)();
  }

  void add(const std::string& stage, double seconds) {
    for (auto& [name, sum] : stages_)
      if (name == stage) {
        sum += seconds;
        return;
      }
    stages_.emplace_back(stage, seconds);
  }

  [[nodiscard]] const std::vector<std::pair<std::string, double>>& stages() const { return stages_; }

 private:
  std::vector<std::pair<std::string, double>> stages_;  // [s]
};

}  // namespace tunica::examples
