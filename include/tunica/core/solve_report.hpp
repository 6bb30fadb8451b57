// SPDX-License-Identifier: MIT
// How an iteration ended: numerical trouble is a status, never silent and never an exception.
#pragma once

#include <string_view>

namespace tunica {

enum class Status { converged, stalled, diverged, max_iterations };

[[nodiscard]] constexpr std::string_view name(Status s) {
  switch (s) {
    case Status::converged: return "converged";
    case Status::stalled: return "stalled";
    case Status::diverged: return "diverged";
    case Status::max_iterations: return "max_iterations";
  }
  return "unknown";
}

struct [[nodiscard]] SolveReport {
  Status status = Status::diverged;
  int iterations = 0;
  double residual = 0;  // relative to the start, in the norm the solver names

  [[nodiscard]] constexpr explicit operator bool() const { return status == Status::converged; }
};

}  // namespace tunica
