// SPDX-License-Identifier: MIT
#include "tunica/meshing/sign_bits.hpp"
#include "tunica/meshing/cut_numbers.hpp"

#include "support/work_cases.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

using namespace tunica;

namespace {

/// A box of nx * ny * nz nodes with values by number.
template <class T, class Value>
image::Image<T> box(std::size_t nx, std::size_t ny, std::size_t nz, Value&& value) {
  image::Image<T> im;
  const std::array<std::size_t, 3> n{nx, ny, nz};
  for (std::size_t a = 0; a < 3; ++a)
    for (std::size_t i = 0; i < n[a]; ++i) im.axes[a].push_back(static_cast<double>(i));
  for (std::size_t i = 0; i < nx * ny * nz; ++i) im.values.push_back(static_cast<T>(value(i)));
  return im;
}

/// Every node against value >= iso and the mask, and no bit beyond a row.
template <class T>
void check_bits(const image::Image<T>& im, double iso, std::span<const std::uint8_t> kept = {}) {
  const meshing::SignBits bits(im, kept, iso);
  const std::size_t nx = im.axes[0].size(), ny = im.axes[1].size(), nz = im.axes[2].size();
  Index wrong = 0;
  bool some = false;
  for (std::size_t k = 0; k < nz; ++k)
    for (std::size_t j = 0; j < ny; ++j) {
      bool in_row = false;
      for (std::size_t i = 0; i < nx; ++i) {
        const std::size_t n = i + nx * (j + ny * k);
        const bool inside = static_cast<double>(im.values[n]) >= iso && (kept.empty() || kept[n] != 0);
        wrong += bits.inside(i, j, k) != inside;
        in_row = in_row || inside;
      }
      wrong += bits.any(j, k) != in_row;
      some = some || in_row;
      if (nx % 64 != 0) wrong += (bits.row(j, k)[bits.words() - 1] >> nx % 64) != 0;
    }
  CHECK(bits.any() == some);
  CHECK(wrong == 0);
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("meshing: a bit a node says which side of the iso-value it is on, whatever the type") {
    const auto value = [](std::size_t i) { return 100 * test::noise(i + 1); };
    for (const std::size_t nx : {2U, 63U, 64U, 65U, 130U}) {
      for (const double iso : {-7.0, 0.0, 0.5, 41.999, 1e300, -1e300, std::nan("")}) {
        check_bits(box<float>(nx, 3, 2, value), iso);
        check_bits(box<double>(nx, 3, 2, value), iso);
        check_bits(box<short>(nx, 3, 2, value), iso);
        check_bits(box<std::int8_t>(nx, 3, 2, value), iso);
        check_bits(box<std::int64_t>(nx, 3, 2, value), iso);
        check_bits(box<std::uint16_t>(nx, 3, 2, [&](std::size_t i) { return 300 + value(i); }), iso + 300);
      }
      const auto im = box<float>(nx, 3, 2, value);
      std::vector<std::uint8_t> kept(im.values.size());
      for (std::size_t i = 0; i < kept.size(); ++i) kept[i] = static_cast<std::uint8_t>(i % 3 * 100);
      check_bits(im, 0.5, kept);
    }
    // What is no number is outside; the ends of the types are where they belong.
    const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
    const auto special = box<float>(66, 2, 2, [&](std::size_t i) {
      return i % 3 == 0 ? nan : i % 3 == 1 ? inf : -inf;
    });
    for (const float iso : {1.0F, inf, -inf, std::numeric_limits<float>::lowest()}) check_bits(special, iso);
    for (const double iso : {-32768.0, -32768.5, 32767.0, 32767.5, 32768.0})
      check_bits(box<short>(66, 2, 2, [&](std::size_t i) { return i % 2 == 0 ? -32768 : 32767; }), iso);
    // 2^53 + 1 rounds to 2^53 as a double: what counts is the double.
    const std::int64_t big = std::int64_t{1} << 53;
    for (const double iso : {static_cast<double>(big), static_cast<double>(big) + 2})
      check_bits(
          box<std::int64_t>(66, 2, 2, [&](std::size_t i) { return big + static_cast<std::int64_t>(i % 4); }),
          iso);
  }

  TEST_CASE("meshing: the number of a cut edge is its rank, found row by row or one by one") {
    const auto im = box<float>(70, 5, 4, [](std::size_t i) { return test::noise(i + 1); });
    const meshing::SignBits bits(im, {}, 0);
    const meshing::CutNumbers cuts(bits, 5, 4);
    Index next = 0;
    const auto flat = [&](std::size_t k) {
      for (std::size_t j = 0; j < 5; ++j) {
        CHECK(cuts.starts(j, k).x == next);
        for (std::size_t i = 0; i + 1 < 70; ++i)
          if (bits.inside(i, j, k) != bits.inside(i + 1, j, k)) CHECK(cuts.number(0, i, j, k) == next++);
        CHECK(cuts.starts(j, k).y == next);
        for (std::size_t i = 0; i < 70 && j + 1 < 5; ++i)
          if (bits.inside(i, j, k) != bits.inside(i, j + 1, k)) CHECK(cuts.number(1, i, j, k) == next++);
        CHECK(cuts.starts(j + 1, k).x == next);
      }
    };
    flat(0);
    for (std::size_t k = 0; k + 1 < 4; ++k) {
      flat(k + 1);
      for (std::size_t j = 0; j < 5; ++j) {
        CHECK(cuts.starts(j, k).z == next);
        for (std::size_t i = 0; i < 70; ++i)
          if (bits.inside(i, j, k) != bits.inside(i, j, k + 1)) CHECK(cuts.number(2, i, j, k) == next++);
        CHECK(cuts.starts(j + 1, k).z == next);
      }
    }
    CHECK(cuts.count() == next);
  }
}
