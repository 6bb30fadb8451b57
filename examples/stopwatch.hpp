// SPDX-License-Identifier: MIT
// Where the time of a program goes: what passed on the clock, and what the processors worked.
#pragma once

#include "json.hpp"

#include <chrono>
#include <ctime>
#include <string>
#include <utility>
#include <vector>

namespace tunica::examples {

/// Elapsed depends on what else the machine does; cpu, of all threads together, hardly.
struct Seconds {
  double elapsed = 0, cpu = 0;
};

/// Seconds of the stages of a program, in the order of their first start.
class Stopwatch {
 public:
  /// Counts for a stage until it is stopped or ends.
  class Running {
   public:
    Running(Stopwatch& watch, std::string stage) : watch_(&watch), stage_(std::move(stage)) {}
    Running(const Running&) = delete;
    Running& operator=(const Running&) = delete;
    ~Running() { stop(); }

    void stop() {
      if (watch_ == nullptr) return;
      Seconds& sum = watch_->of(stage_);
      sum.elapsed += std::chrono::duration<double>(Clock::now() - begin_).count();
      sum.cpu += static_cast<double>(std::clock() - cpu_begin_) / CLOCKS_PER_SEC;
      watch_ = nullptr;
    }

   private:
    using Clock = std::chrono::steady_clock;
    Stopwatch* watch_;
    std::string stage_;
    Clock::time_point begin_ = Clock::now();
    std::clock_t cpu_begin_ = std::clock();
  };

  [[nodiscard]] Running start(std::string stage) { return {*this, std::move(stage)}; }

  /// Adds the time of a call to a stage and hands on what the call returns.
  template <class F>
  decltype(auto) time(const std::string& stage, F&& call) {
    const Running running(*this, stage);
    return std::forward<F>(call)();
  }

  [[nodiscard]] const std::vector<std::pair<std::string, Seconds>>& stages() const { return stages_; }

  void report(Json& j) const {
    for (const auto& [name, s] : stages_) j["seconds"][name] = s.elapsed;
    for (const auto& [name, s] : stages_) j["cpu_seconds"][name] = s.cpu;
  }

 private:
  Seconds& of(const std::string& stage) {
    for (auto& [name, sum] : stages_)
      if (name == stage) return sum;
    return stages_.emplace_back(stage, Seconds{}).second;
  }

  std::vector<std::pair<std::string, Seconds>> stages_;
};

}  // namespace tunica::examples
