// SPDX-License-Identifier: MIT
// Loops over fixed chunks on any number of threads: the chunks, and so the bits, never depend on it.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace tunica {

/// Number of threads that parallel loops use; 1 until it is set. Set it outside of loops.
inline std::atomic<int>& thread_count() {
  static std::atomic<int> n{1};
  return n;
}

/// Calls work(context, c) for every c of [0, count) on `threads` threads, the calling one among them; which
/// thread takes which c is left open. The first exception is rethrown once all threads have ended.
inline void run_team(std::ptrdiff_t threads, std::ptrdiff_t count, void (*work)(const void*, std::ptrdiff_t),
                     const void* context) {
  std::atomic<std::ptrdiff_t> next{0};
  std::exception_ptr failure;
  std::mutex guard;
  const auto run = [&] {
    for (std::ptrdiff_t c; (c = next++) < count;) {
      try {
        work(context, c);
      } catch (...) {
        const std::lock_guard lock(guard);
        if (!failure) failure = std::current_exception();
        next = count;
      }
    }
  };
  {
    std::vector<std::jthread> team;
    for (std::ptrdiff_t t = 1; t < threads; ++t) team.emplace_back(run);
    run();
  }
  if (failure) std::rethrow_exception(failure);
}

/// Calls body(begin, end) for the chunks of [0, n); each chunk is a unit of work for one thread.
/// body must write only what belongs to its chunk; then the result has the same bits on any
/// number of threads. The first exception of a chunk is rethrown.
template <class Body>
void parallel_chunks(std::ptrdiff_t n, std::ptrdiff_t chunk, Body&& body) {
  const std::ptrdiff_t chunks = (n + chunk - 1) / chunk;
  const auto run = [&](std::ptrdiff_t c) { body(c * chunk, std::min(n, (c + 1) * chunk)); };
  const auto threads = std::min<std::ptrdiff_t>(thread_count().load(), chunks);
  if (threads <= 1) {
    for (std::ptrdiff_t c = 0; c < chunks; ++c) run(c);
    return;
  }
  run_team(
      threads, chunks,
      [](const void* context, std::ptrdiff_t c) { (*static_cast<const decltype(run)*>(context))(c); }, &run);
}

/// Sum of body(begin, end) over fixed chunks, added in the order of the chunks.
template <class Body>
[[nodiscard]] double parallel_sum(std::ptrdiff_t n, std::ptrdiff_t chunk, Body&& body) {
  std::vector<double> part(static_cast<std::size_t>((n + chunk - 1) / chunk));
  parallel_chunks(n, chunk, [&](std::ptrdiff_t b, std::ptrdiff_t e) {
    part[static_cast<std::size_t>(b / chunk)] = body(b, e);
  });
  double sum = 0;
  for (const double p : part) sum += p;
  return sum;
}

}  // namespace tunica
