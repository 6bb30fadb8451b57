// SPDX-License-Identifier: MIT
#include "tunica/core/parallel.hpp"
#include "tunica/core/types.hpp"

int main() {
  tunica::thread_count() = 2;
  const double sum = tunica::parallel_sum(100, 10, [](auto begin, auto end) { return double(end - begin); });
  return sum == 100 && tunica::Vec3(1, 0, 0).norm() == 1 ? 0 : 1;
}
