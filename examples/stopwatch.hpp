// SPDX-License-Identifier: MIT
// Where the time of a program goes.
#pragma once

#include <chrono>
#include <string>
#include <utility>
#include <vector>

namespace tunica::examples {

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
