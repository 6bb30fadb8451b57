// SPDX-License-Identifier: MIT
#include "tunica/search/box_pairs.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstddef>
#include <random>
#include <utility>
#include <vector>

using namespace tunica;

namespace {

using Pairs = std::vector<std::pair<Index, Index>>;

Pairs found_in(const std::vector<Box>& boxes) {
  Pairs pairs;
  search::overlapping_pairs(boxes, [&](Index i, Index j) { pairs.emplace_back(i, j); });
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

/// Boxes of very different sizes, some of them points, some empty, some twice there.
std::vector<Box> boxes(std::size_t n, double size, const Vec3& from, double extent) {
  std::mt19937 random(static_cast<unsigned>(n));
  const auto uniform = [&] { return static_cast<double>(random()) / 4294967296.0; };
  const auto point = [&]() -> Vec3 { return {uniform(), uniform(), uniform()}; };
  std::vector<Box> result(n);
  for (std::size_t i = 0; i < n; ++i) {
    if (i % 23 == 22) continue;
    if (i % 11 == 10) {
      result[i] = result[i / 2];
      continue;
    }
    const Vec3 at = point();
    result[i].extend(from + extent * at);
    if (i % 3 != 0) result[i].extend(from + extent * (at + (i % 97 == 1 ? 0.5 : size) * point()));
  }
  return result;
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("search: all pairs of overlapping boxes are found once and no others but near ones") {
    for (const std::size_t n : {0U, 1U, 2U, 7U, 8U, 9U, 64U, 65U, 300U, 1500U})
      for (const double extent : {1e-20, 1.0, 1e20}) {
        CAPTURE(n);
        const auto some = boxes(n, 0.05, Vec3(3, -2, 1) * extent, extent);
        const Pairs pairs = found_in(some);
        CHECK(std::adjacent_find(pairs.begin(), pairs.end()) == pairs.end());
        std::size_t overlapping = 0, missed = 0, far = 0;
        for (std::size_t i = 0; i < n; ++i)
          for (std::size_t j = i + 1; j < n; ++j) {
            const bool told = std::binary_search(pairs.begin(), pairs.end(),
                                                 std::pair{static_cast<Index>(i), static_cast<Index>(j)});
            Box wider = some[i];
            wider.lo.array() -= 2e-6 * extent, wider.hi.array() += 2e-6 * extent;
            overlapping += some[i].overlaps(some[j]);
            missed += some[i].overlaps(some[j]) && !told;
            far += told && !wider.overlaps(some[j]);
          }
        CHECK(missed == 0);
        CHECK(far == 0);
        CHECK(pairs.size() >= overlapping);
        if (n > 100) CHECK(overlapping > n / 8);
      }
  }

  TEST_CASE("search: boxes in one plane or at one point are paired") {
    std::vector<Box> plane(40), point(20);
    for (std::size_t i = 0; i < plane.size(); ++i) {
      const auto x = static_cast<double>(i);
      plane[i].extend(Vec3(x, 0, 7)), plane[i].extend(Vec3(x + 1, 1, 7));
    }
    for (Box& b : point) b.extend(Vec3(1, 2, 3));
    CHECK(found_in(plane).size() == plane.size() - 1);  // neighbours touch
    CHECK(found_in(point).size() == point.size() * (point.size() - 1) / 2);
  }
}
