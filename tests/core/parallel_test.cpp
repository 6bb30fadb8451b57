// SPDX-License-Identifier: MIT
#include "tunica/core/parallel.hpp"

#include <doctest/doctest.h>

#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <stdexcept>
#include <vector>

namespace {

namespace parts {}

using namespace tunica;
namespace detail = parts;  // the library keeps no name space of that name where a user would look into it

/// Sets the number of threads for one scope.
struct Threads {
  explicit Threads(int n) : before(thread_count().load()) { thread_count() = n; }
  Threads(const Threads&) = delete;
  Threads& operator=(const Threads&) = delete;
  ~Threads() { thread_count() = before; }
  int before;
};

double rough_sum(int threads, std::ptrdiff_t n) {
  const Threads scope(threads);
  return parallel_sum(n, 1000, [](std::ptrdiff_t begin, std::ptrdiff_t end) {
    double sum = 0;
    for (std::ptrdiff_t i = begin; i < end; ++i) sum += std::sin(static_cast<double>(i)) * std::exp2(i % 60);
    return sum;
  });
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("core: a parallel sum has the same bits on any number of threads") {
    for (const std::ptrdiff_t n : {0, 1, 999, 1000, 1001, 123457}) {
      const double one = rough_sum(1, n);
      for (const int threads : {2, 3, 8}) {
        const double many = rough_sum(threads, n);
        CHECK(std::memcmp(&one, &many, sizeof one) == 0);
      }
    }
  }

  TEST_CASE("core: parallel chunks cover the range exactly once") {
    for (const int threads : {1, 2, 5}) {
      const Threads scope(threads);
      for (const std::ptrdiff_t n : {0, 1, 7, 64, 1000}) {
        std::vector<int> visits(static_cast<std::size_t>(n));
        parallel_chunks(n, 7, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
          CHECK(begin % 7 == 0);
          CHECK(end - begin <= 7);
          for (std::ptrdiff_t i = begin; i < end; ++i) ++visits[static_cast<std::size_t>(i)];
        });
        for (const int v : visits) CHECK(v == 1);
      }
    }
  }

  TEST_CASE("core: a team takes every unit once and ends before a failure is reported") {
    struct Work {
      std::vector<std::atomic<int>> taken = std::vector<std::atomic<int>>(500);
      std::atomic<int> busy{0};
      std::ptrdiff_t bad = -1;
    };
    const auto unit = [](const void* context, std::ptrdiff_t c) {
      auto& work = *static_cast<Work*>(const_cast<void*>(context));
      ++work.busy;
      ++work.taken[static_cast<std::size_t>(c)];
      --work.busy;
      if (c == work.bad) throw std::runtime_error("unit 100");
    };
    for (const std::ptrdiff_t threads : {1, 2, 7, 600}) {
      Work work;
      run_team(threads, 500, unit, &work);
      for (const auto& n : work.taken) CHECK(n == 1);
      Work bad;
      bad.bad = 100;
      CHECK_THROWS_WITH_AS(run_team(threads, 500, unit, &bad), "unit 100", std::runtime_error);
      CHECK(bad.busy == 0);
      for (std::size_t c = 0; c < 500; ++c) CHECK(bad.taken[c] <= 1);
      for (std::size_t c = 0; c <= 100; ++c) CHECK(bad.taken[c] == 1);
    }
    Work none;
    run_team(3, 0, unit, &none);
    for (const auto& n : none.taken) CHECK(n == 0);
  }

  TEST_CASE("core: an exception of a chunk reaches the caller on any number of threads") {
    for (const int threads : {1, 2, 4}) {
      const Threads scope(threads);
      const auto loop = [] {
        parallel_chunks(10000, 10, [](std::ptrdiff_t begin, std::ptrdiff_t) {
          if (begin == 500) throw std::runtime_error("chunk 50");
        });
      };
      CHECK_THROWS_WITH_AS(loop(), "chunk 50", std::runtime_error);
      CHECK(rough_sum(threads, 5000) == rough_sum(1, 5000));  // the next loop is as good as new
    }
  }
}
