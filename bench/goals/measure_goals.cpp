// SPDX-License-Identifier: MIT
// Prints the goals table, a line a goal with its outcome last, and writes its rows: measure_goals ROWS.csv
#include "goals/goal.hpp"
#include "support/provenance.hpp"

#include <array>
#include <cstdarg>
#include <cstdio>
#include <exception>
#include <fstream>
#include <string_view>

namespace tunica::bench {

std::string text(const char* format, ...) {
  std::array<char, 512> buffer{};
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(buffer.data(), buffer.size(), format, arguments);
  va_end(arguments);
  return buffer.data();
}

namespace {

constexpr std::string_view name(Outcome outcome) {
  switch (outcome) {
    case Outcome::reached: return "ok";
    case Outcome::missed: return "short";
    case Outcome::unmatched: return "no peer";
  }
  return "short";
}

/// A field of a CSV file: no separator in it.
std::string field(std::string text) {
  for (char& c : text)
    if (c == ',') c = ' ';
  return text;
}

void run(const char* path) {
  std::ofstream rows(path);
  rows << "goal,measured,target,ratio,outcome,flags,commit\n";
  std::printf("%-40s| %-60s| %-56s| %-46s| %s\n", "goal", "measured", "target", "ratio to the peer",
              "(outcome)");
  for (const auto& lines : {contour_goals, dual_goals, smoothing_goals, filling_goals, hex_goals, solid_goals,
                            fluid_goals, la_goals, assembly_goals, kernel_goals})
    for (const Goal& g : lines()) {
      std::printf("%-40s| %-60s| %-56s| %-46s| %s\n", g.name.c_str(), g.measured.c_str(), g.target.c_str(),
                  g.ratio.c_str(), name(g.outcome).data());
      std::fflush(stdout);
      rows << field(g.name) << ',' << field(g.measured) << ',' << field(g.target) << ',' << field(g.ratio)
           << ',' << name(g.outcome) << ',' << field(flags()) << ',' << commit() << '\n';
    }
  if (!rows.flush()) std::fprintf(stderr, "error: %s could not be written\n", path);
}

}  // namespace
}  // namespace tunica::bench

int main(int count, char** arguments) {
  if (count != 2) {
    std::fprintf(stderr, "usage: measure_goals ROWS.csv\n");
    return 2;
  }
  try {
    tunica::bench::run(arguments[1]);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "error: %s\n", e.what());
    return 1;
  }
}
