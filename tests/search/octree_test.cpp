// SPDX-License-Identifier: MIT
#include "tunica/search/octree.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <random>
#include <utility>
#include <vector>

namespace {

using namespace tunica;
using search::Nearest;
using search::Octree;

double uniform(std::mt19937& random) {
  return static_cast<double>(random()) / 4294967296.0;
}
Vec3 point(std::mt19937& random) {
  return {uniform(random), uniform(random), uniform(random)};
}

/// Boxes of very different sizes, some of them points, some twice there, some on common planes.
std::vector<Box> boxes(int n, std::mt19937& random) {
  std::vector<Box> result;
  for (int i = 0; i < n; ++i) {
    if (i % 11 == 10) {
      result.push_back(result[static_cast<std::size_t>(i / 2)]);
      continue;
    }
    Vec3 at = point(random);
    if (i % 5 == 0) at[2] = 0.5;
    Box box;
    box.extend(at);
    const double size = i % 3 == 0 ? 0 : i % 97 == 1 ? 0.5 : 0.02;
    box.extend(at + size * point(random));
    result.push_back(box);
  }
  return result;
}

Nearest nearest_by_force(const std::vector<Box>& all, const Vec3& x) {
  Nearest best;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double d = all[i].squared_distance(x);
    if (d < best.squared_distance) best = {static_cast<Index>(i), d};
  }
  return best;
}

/// Every two boxes that the octree pairs, in ascending order.
std::vector<std::pair<Index, Index>> pairs_of(const std::vector<Box>& all) {
  std::vector<std::pair<Index, Index>> pairs;
  Octree(all).pairs([&](Index i, Index j) { pairs.emplace_back(i, j); });
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

/// Boxes as above somewhere else and of another size, some of them empty.
std::vector<Box> scattered(std::size_t n, const Vec3& from, double extent) {
  std::mt19937 random(static_cast<unsigned>(n));
  auto result = boxes(static_cast<int>(n), random);
  for (std::size_t i = 0; i < n; ++i) {
    Box box;
    if (i % 23 != 22) box.extend(from + extent * result[i].lo), box.extend(from + extent * result[i].hi);
    result[i] = box;
  }
  return result;
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("search: the octree finds what brute force finds") {
    std::mt19937 random(7);
    for (const int n : {0, 1, 8, 9, 100, 2000}) {
      const auto all = boxes(n, random);
      const Octree tree(all);
      CHECK(tree.empty() == (n == 0));
      for (int query = 0; query < 200; ++query) {
        Box box;
        const Vec3 at = 1.4 * point(random) - Vec3::Constant(0.2);
        box.extend(at);
        box.extend(at + (query % 4 == 0 ? 0.0 : 0.1) * point(random));
        std::vector<Index> found, expected;
        tree.overlapping(box, [&](Index item) { found.push_back(item); });
        for (Index i = 0; i < n; ++i)
          if (all[static_cast<std::size_t>(i)].overlaps(box)) expected.push_back(i);
        std::sort(found.begin(), found.end());
        CHECK(found == expected);

        const auto distance = [&](Index i) { return all[static_cast<std::size_t>(i)].squared_distance(at); };
        const Nearest a = tree.nearest(at, distance), b = nearest_by_force(all, at);
        CHECK(a.item == b.item);  // ties too: the lower item
        CHECK(a.squared_distance == b.squared_distance);
      }
    }
  }

  TEST_CASE("search: nothing is nearest beyond the bound") {
    std::vector<Box> all(3);
    for (std::size_t i = 0; i < 3; ++i) all[i].extend(Vec3(static_cast<double>(i), 0, 0));
    const Octree tree(all);
    const Vec3 x(5, 0, 0);
    const auto distance = [&](Index i) { return all[static_cast<std::size_t>(i)].squared_distance(x); };
    CHECK(tree.nearest(x, distance, 8.99).item == -1);
    CHECK(tree.nearest(x, distance, 9.01).item == 2);
    CHECK(Octree().nearest(x, distance).item == -1);
  }

  TEST_CASE("search: many equal boxes do not make the octree deep or slow") {
    std::vector<Box> all(5000);
    for (Box& box : all) box.extend(Vec3(0.1, 0.2, 0.3));
    const Octree tree(all);
    int count = 0;
    Box box;
    box.extend(Vec3(0.1, 0.2, 0.3));
    tree.overlapping(box, [&](Index) { ++count; });
    CHECK(count == 5000);
    const auto distance = [&](Index i) {
      return all[static_cast<std::size_t>(i)].squared_distance(Vec3::Zero());
    };
    CHECK(tree.nearest(Vec3::Zero(), distance).item == 0);
  }

  TEST_CASE("search: the nearest is found from anywhere and at any size") {
    std::mt19937 random(11);
    for (const double extent : {1e-25, 1.0, 1e25})
      for (const std::size_t n : {1U, 7U, 9U, 500U}) {
        const Vec3 from = 3 * extent * Vec3(1, -2, 0.5);
        const auto all = scattered(n, from, extent);
        const Octree tree(all);
        for (int query = 0; query < 100; ++query) {
          const double away = std::pow(10.0, query % 25);  // up to 1e24 times the size of all
          const Vec3 at = from + extent * away * (point(random) - Vec3::Constant(0.5));
          const auto distance = [&](Index i) {
            return all[static_cast<std::size_t>(i)].squared_distance(at);
          };
          const Nearest a = tree.nearest(at, distance), b = nearest_by_force(all, at);
          CHECK(a.squared_distance == b.squared_distance);
          CHECK(a.item == b.item);
        }
      }
  }

  TEST_CASE("search: what is near enough ends the search and nothing farther is given") {
    std::mt19937 random(13);
    const auto all = boxes(2000, random);
    const Octree tree(all);
    int calls = 0, exact_calls = 0, some_calls = 0;
    for (int query = 0; query < 200; ++query) {
      const Vec3 at = point(random);
      const auto distance = [&](Index i) {
        ++calls;
        return all[static_cast<std::size_t>(i)].squared_distance(at);
      };
      const Nearest exact = tree.nearest(at, distance);
      exact_calls += std::exchange(calls, 0);
      const double enough = 0.01;
      const Nearest some = tree.nearest(at, distance, 1e9, enough);
      some_calls += std::exchange(calls, 0);
      CHECK(some.squared_distance >= exact.squared_distance);
      CHECK((some.squared_distance <= enough || some.squared_distance == exact.squared_distance));
    }
    CHECK(some_calls < exact_calls);
  }

  TEST_CASE("search: all pairs of overlapping boxes are found once and no others but near ones") {
    for (const std::size_t n : {0U, 1U, 2U, 7U, 8U, 9U, 64U, 65U, 300U, 1500U})
      for (const double extent : {1e-20, 1.0, 1e20}) {
        CAPTURE(n);
        const auto some = scattered(n, Vec3(3, -2, 1) * extent, extent);
        const auto pairs = pairs_of(some);
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
    std::vector<Box> plane(40), places(20);
    for (std::size_t i = 0; i < plane.size(); ++i) {
      const auto x = static_cast<double>(i);
      plane[i].extend(Vec3(x, 0, 7)), plane[i].extend(Vec3(x + 1, 1, 7));
    }
    for (Box& b : places) b.extend(Vec3(1, 2, 3));
    CHECK(pairs_of(plane).size() == plane.size() - 1);  // neighbours touch
    CHECK(pairs_of(places).size() == places.size() * (places.size() - 1) / 2);
  }
}
