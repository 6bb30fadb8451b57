// SPDX-License-Identifier: MIT
// The order in which points enter a triangulation: random rounds of doubling size [AMENTA03], each
// along a Hilbert curve [SKILLING04].
#pragma once

#include "tunica/core/types.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tunica::meshing {

/// Place along a Hilbert curve of 3 x 16 bits. [SKILLING04, AxestoTranspose]
[[nodiscard]] inline std::uint64_t hilbert_index(std::array<std::uint32_t, 3> x) {
  constexpr std::uint32_t top = 1u << 15;
  for (std::uint32_t q = top; q > 1; q >>= 1) {
    const std::uint32_t p = q - 1;
    for (std::size_t i = 0; i < 3; ++i) {
      if (x[i] & q) {
        x[0] ^= p;
      } else {
        const std::uint32_t t = (x[0] ^ x[i]) & p;
        x[0] ^= t, x[i] ^= t;
      }
    }
  }
  x[1] ^= x[0], x[2] ^= x[1];
  std::uint32_t t = 0;
  for (std::uint32_t q = top; q > 1; q >>= 1)
    if (x[2] & q) t ^= q - 1;
  for (auto& v : x) v ^= t;
  std::uint64_t index = 0;
  for (int bit = 15; bit >= 0; --bit)
    for (const auto v : x) index = index << 1 | (v >> bit & 1);
  return index;
}

/// A fixed mixing of the bits of i: the random numbers of the filler depend on indices alone.
[[nodiscard]] inline std::uint64_t mixed(std::uint64_t i) {
  i += 0x9e3779b97f4a7c15u;
  i = (i ^ i >> 30) * 0xbf58476d1ce4e5b9u;
  i = (i ^ i >> 27) * 0x94d049bb133111ebu;
  return i ^ i >> 31;
}

/// The first `count` of the points.
[[nodiscard]] inline std::vector<Index> insertion_order(const std::vector<Vec3>& points, std::size_t count,
                                                        const Box& box) {
  struct Key {
    std::uint64_t round_and_place;
    Index point;
  };
  const double side = std::max({box.hi[0] - box.lo[0], box.hi[1] - box.lo[1], box.hi[2] - box.lo[2], 1e-300});
  std::vector<Key> keys(count);
  for (std::size_t i = 0; i < count; ++i) {
    std::array<std::uint32_t, 3> x{};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<Eigen::Index>(k);
      x[k] = static_cast<std::uint32_t>(65535.0 * ((points[i][axis] - box.lo[axis]) / side));
    }
    // The last round holds half of the points, the one before it a quarter, and so on.
    std::uint64_t round = 15;
    for (std::uint64_t h = mixed(i); round > 0 && (h & 1) != 0; h >>= 1) --round;
    keys[i] = {round << 48 | hilbert_index(x), static_cast<Index>(i)};
  }
  std::sort(keys.begin(), keys.end(), [](const Key& a, const Key& b) {
    return a.round_and_place != b.round_and_place ? a.round_and_place < b.round_and_place : a.point < b.point;
  });
  std::vector<Index> order;
  order.reserve(keys.size());
  for (const Key& k : keys) order.push_back(k.point);
  return order;
}

}  // namespace tunica::meshing
