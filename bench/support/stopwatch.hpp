// SPDX-License-Identifier: MIT
// CPU time and peak memory of a piece of work.
#pragma once

#include <sys/resource.h>

#include <algorithm>
#include <ctime>
#include <limits>

namespace tunica::bench {

/// CPU time of this process, all threads [s].
[[nodiscard]] inline double cpu_seconds() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// The least CPU time of `repeats` runs [s].
template <class Work>
[[nodiscard]] double best_cpu_seconds(int repeats, Work&& work) {
  double best = std::numeric_limits<double>::infinity();
  for (int i = 0; i < repeats; ++i) {
    const double start = cpu_seconds();
    work();
    best = std::min(best, cpu_seconds() - start);
  }
  return best;
}

/// Largest resident memory of the process so far [MB].
[[nodiscard]] inline double peak_megabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

}  // namespace tunica::bench
