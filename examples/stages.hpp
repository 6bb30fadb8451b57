// SPDX-License-Identifier: MIT
// The stages of a program: each is announced when it begins and timed.
#pragma once

#include "json.hpp"
#include "progress.hpp"
#include "stopwatch.hpp"

#include <string>
#include <utility>

namespace tunica::examples {

/// Time and progress of the stages of a program.
class Stages {
 public:
  explicit Stages(int count) : progress_(count) {}

  template <class F>
  decltype(auto) operator()(const std::string& name, F&& call) {
    progress_.tell(done_++, name);
    return watch_.time(name, std::forward<F>(call));
  }
  void finish(Json& report) {
    progress_.tell(done_, "done");
    watch_.report(report);
  }
  [[nodiscard]] Stopwatch& watch() { return watch_; }

 private:
  Progress progress_;
  Stopwatch watch_;
  int done_ = 0;
};

}  // namespace tunica::examples
