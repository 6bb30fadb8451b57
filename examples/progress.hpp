// SPDX-License-Identifier: MIT
// Progress of a long run: a bar on a terminal, a line every twentieth of the way in a log.
#pragma once

#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>

namespace tunica::examples {

class Progress {
 public:
  explicit Progress(int total) : total_(std::max(1, total)), terminal_(isatty(fileno(stderr)) != 0) {}

  /// Tells that `done` of the total are done; note says what the last one was like.
  void tell(int done, const std::string& note) {
    const auto part = [&](std::int64_t whole) { return static_cast<int>(whole * done / total_); };
    const int percent = part(100);
    if (terminal_) {
      constexpr int width = 40;
      const auto filled = static_cast<std::size_t>(part(width));
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

}  // namespace tunica::examples
