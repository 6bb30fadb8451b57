// SPDX-License-Identifier: MIT
#include "tunica/search/octree.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <random>
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
}
