// SPDX-License-Identifier: MIT
// A line of the goals table: what was measured, with its error, against a target and a peer.
#pragma once

#include <string>
#include <vector>

namespace tunica::bench {

enum class Outcome { reached, missed, unmatched };  // printed as: ok, short, no peer

struct Goal {
  std::string name;
  std::string measured;  // with units, its error beside its time
  std::string target;
  std::string ratio;  // to the peer, with the peer's name, version and figures; "-" for an absolute target
  Outcome outcome = Outcome::missed;
};

[[nodiscard]] constexpr Outcome reached_if(bool reached) {
  return reached ? Outcome::reached : Outcome::missed;
}

/// printf into a string.
[[gnu::format(printf, 1, 2)]] [[nodiscard]] std::string text(const char* format, ...);

// One function a module; each line costs at most some seconds.
[[nodiscard]] std::vector<Goal> contour_goals();
[[nodiscard]] std::vector<Goal> dual_goals();
[[nodiscard]] std::vector<Goal> smoothing_goals();
[[nodiscard]] std::vector<Goal> filling_goals();
[[nodiscard]] std::vector<Goal> hex_goals();
[[nodiscard]] std::vector<Goal> solid_goals();
[[nodiscard]] std::vector<Goal> fluid_goals();
[[nodiscard]] std::vector<Goal> la_goals();
[[nodiscard]] std::vector<Goal> assembly_goals();
[[nodiscard]] std::vector<Goal> kernel_goals();

}  // namespace tunica::bench
