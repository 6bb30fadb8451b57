// SPDX-License-Identifier: MIT
// Registers of packs: their widths divide the pack and fit the machine; roots lane by lane; unrolled loops.
#include "tunica/core/pack_registers.hpp"
#include "tunica/core/unroll.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <type_traits>

using namespace tunica;

namespace {

template <class T, int N>
void check_width() {
  constexpr int w = registers::width<T>(N);
  static_assert(w >= 1 && N % w == 0 && (w & (w - 1)) == 0);
  static_assert(w == 1 || w * static_cast<int>(sizeof(T)) <= registers::bytes);
  // As wide as it can be.
  static_assert(N % (2 * w) != 0 || 2 * w * static_cast<int>(sizeof(T)) > registers::bytes);
  using Part = typename registers::Register<T, w>::type;
  CHECK(sizeof(Part) == static_cast<std::size_t>(w) * sizeof(T));
}

template <class T, int W>
void check_root() {
  typename registers::Register<T, W>::type x{}, root{};
  std::array<T, static_cast<std::size_t>(W)> of{};
  for (int l = 0; l < W; ++l) {
    of[static_cast<std::size_t>(l)] = l == 1   ? T(-1)
                                      : l == 2 ? std::numeric_limits<T>::infinity()
                                               : T(0.1) + T(l) * T(l) * T(l);
    if constexpr (W == 1)
      x = of[0];
    else
      x[l] = of[static_cast<std::size_t>(l)];
  }
  root = registers::square_root<T, W>(x);
  for (int l = 0; l < W; ++l) {
    T value{};
    if constexpr (W == 1)
      value = root;
    else
      value = root[l];
    if (l == 1)
      CHECK(std::isnan(value));
    else
      CHECK(value == std::sqrt(of[static_cast<std::size_t>(l)]));  // IEEE 754 rounds it correctly
  }
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("core: registers are as wide as the machine and the pack allow") {
    check_width<double, 1>(), check_width<double, 2>(), check_width<double, 3>(), check_width<double, 4>();
    check_width<double, 6>(), check_width<double, 8>(), check_width<double, 16>();
    check_width<float, 1>(), check_width<float, 4>(), check_width<float, 12>(), check_width<float, 16>();
    static_assert(registers::width<double>(1) == 1 && registers::width<double>(3) == 1);
    static_assert(std::is_same_v<registers::Register<double, 1>::type, double>);
#if defined(__SSE2__) && !defined(TUNICA_PLAIN_PACKS)
    static_assert(registers::bytes >= 16 && registers::width<double>(2) == 2);
#endif
    CHECK((registers::bytes == 0 || registers::bytes == 16 || registers::bytes == 32 ||
           registers::bytes == 64));
  }

  TEST_CASE("core: the root of a register is the root of each lane") {
    check_root<double, 1>(), check_root<float, 1>();
    check_root<double, registers::width<double>(16)>(), check_root<float, registers::width<float>(16)>();
#if defined(__GNUC__) && !defined(TUNICA_PLAIN_PACKS)
    if constexpr (registers::bytes >= 16)
      check_root<double, 2>(), check_root<float, 4>(), check_root<float, 2>();
#endif
  }

  TEST_CASE("core: an unrolled loop runs as often as it says") {
    int sum = 0;
    TUNICA_UNROLL
    for (int i = 0; i < 9; ++i) sum += i * i;
    CHECK(sum == 204);
    int nested = 0;
    TUNICA_UNROLL
    for (int i = 0; i < 3; ++i) TUNICA_UNROLL
    for (int j = i; j < 12; ++j) ++nested;  // longer than it is unrolled
    CHECK(nested == 33);
  }
}
