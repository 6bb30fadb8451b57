// SPDX-License-Identifier: MIT
// All pairs of boxes that overlap, by a tree of packed boxes that is walked against itself.
#pragma once

#include "tunica/core/types.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace tunica::search {

namespace detail {

/// Boxes in single precision, in coordinates that run from 0 to 1 over all of them; `slack` wider on all
/// sides than they are, which is more than what is lost by rounding.
struct SmallBox {
  static constexpr float slack = 0x1p-21F, nowhere = 4;
  std::array<float, 3> lo{nowhere, nowhere, nowhere}, hi{-nowhere, -nowhere, -nowhere};

  void extend(const SmallBox& b) {
    for (std::size_t a = 0; a < 3; ++a) lo[a] = std::min(lo[a], b.lo[a]), hi[a] = std::max(hi[a], b.hi[a]);
  }
  [[nodiscard]] bool empty() const { return lo[0] > hi[0]; }
};

/// Eight boxes side by side.
struct alignas(16) EightBoxes {
  static constexpr std::size_t count = 8;
  std::array<std::array<float, count>, 3> lo, hi;

  EightBoxes() {
    for (std::size_t i = 0; i < count; ++i) put(i, SmallBox{});
  }
  [[nodiscard]] SmallBox all() const {
    SmallBox box;
    for (std::size_t i = 0; i < count; ++i) box.extend(at(i));
    return box;
  }
  [[nodiscard]] SmallBox at(std::size_t i) const {
    return {{lo[0][i], lo[1][i], lo[2][i]}, {hi[0][i], hi[1][i], hi[2][i]}};
  }
  void put(std::size_t i, const SmallBox& b) {
    for (std::size_t a = 0; a < 3; ++a) lo[a][i] = b.lo[a], hi[a][i] = b.hi[a];
  }
  /// Bit i: box i overlaps b.
  [[nodiscard]] unsigned overlapping(const SmallBox& b) const {
    unsigned bits = 0;
#if defined(__SSE2__)
    for (std::size_t four = 0; four < count; four += 4) {
      __m128 all = _mm_castsi128_ps(_mm_set1_epi32(-1));
      for (std::size_t a = 0; a < 3; ++a) {
        const __m128 below = _mm_cmple_ps(_mm_load_ps(lo[a].data() + four), _mm_set1_ps(b.hi[a]));
        const __m128 above = _mm_cmple_ps(_mm_set1_ps(b.lo[a]), _mm_load_ps(hi[a].data() + four));
        all = _mm_and_ps(all, _mm_and_ps(below, above));
      }
      bits |= static_cast<unsigned>(_mm_movemask_ps(all)) << four;
    }
#else
    for (std::size_t i = 0; i < count; ++i) {
      bool all = true;
      for (std::size_t a = 0; a < 3; ++a) all = all && lo[a][i] <= b.hi[a] && b.lo[a] <= hi[a][i];
      bits |= unsigned{all} << i;
    }
#endif
    return bits;
  }
};

/// Boxes in the order of a curve through space [MORTON66], in packs of eight; those of the packs in packs
/// again.
class PackedBoxes {
 public:
  explicit PackedBoxes(std::span<const Box> boxes) {
    Box all;
    for (const Box& b : boxes) all.extend(b);
    for (std::size_t a = 0; a < 3; ++a) {
      const auto e = static_cast<Eigen::Index>(a);
      from_[a] = all.lo[e], scale_[a] = all.hi[e] > all.lo[e] ? 1 / (all.hi[e] - all.lo[e]) : 0;
    }
    std::vector<Key> keys(boxes.size());
    for (std::size_t i = 0; i < boxes.size(); ++i) keys[i] = {code(boxes[i]), static_cast<Index>(i)};
    sort(keys);
    items_.resize(packs_of(keys.size()) * EightBoxes::count);
    levels_.emplace_back(packs_of(keys.size()));
    for (std::size_t i = 0; i < keys.size(); ++i) {
      items_[i] = keys[i].item;
      put(levels_[0], i, small(boxes[static_cast<std::size_t>(keys[i].item)]));
    }
    while (levels_.back().size() > 1) {
      const auto& below = levels_.back();
      std::vector<EightBoxes> above(packs_of(below.size()));
      for (std::size_t n = 0; n < below.size(); ++n) put(above, n, below[n].all());
      levels_.push_back(std::move(above));
    }
  }

  template <class Visit>
  void pairs(Visit&& visit) const {
    if (!items_.empty()) within(levels_.size() - 1, 0, visit);
  }

 private:
  struct Key {
    std::uint32_t code;
    Index item;
  };
  static constexpr unsigned bits = 10;  // of the curve along each axis, and of a digit when sorting

  [[nodiscard]] SmallBox small(const Box& b) const {
    SmallBox s;
    for (std::size_t a = 0; a < 3; ++a) {
      const auto e = static_cast<Eigen::Index>(a);
      s.lo[a] = static_cast<float>((b.lo[e] - from_[a]) * scale_[a]) - SmallBox::slack;
      s.hi[a] = static_cast<float>((b.hi[e] - from_[a]) * scale_[a]) + SmallBox::slack;
    }
    return s;
  }

  /// The bits of the cell of its centre, of the three axes in turn.
  [[nodiscard]] std::uint32_t code(const Box& b) const {
    std::uint32_t result = 0;
    for (std::size_t a = 0; a < 3; ++a) {
      const auto e = static_cast<Eigen::Index>(a);
      constexpr double last = (1U << bits) - 1;
      const double cell = (0.5 * (b.lo[e] + b.hi[e]) - from_[a]) * scale_[a] * last;
      auto x = cell > 0 ? static_cast<std::uint32_t>(std::min(cell, last)) : 0U;  // NaN: 0
      x = (x | x << 16U) & 0x030000FFU;
      x = (x | x << 8U) & 0x0300F00FU;
      x = (x | x << 4U) & 0x030C30C3U;
      x = (x | x << 2U) & 0x09249249U;
      result |= x << a;
    }
    return result;
  }

  /// By their codes, equal ones as they stand.
  static void sort(std::vector<Key>& keys) {
    std::vector<Key> other(keys.size());
    for (unsigned shift = 0; shift < 3 * bits; shift += bits) {
      std::array<std::uint32_t, 1U << bits> first{};
      const auto digit = [shift](const Key& k) { return k.code >> shift & ((1U << bits) - 1); };
      for (const Key& k : keys) ++first[digit(k)];
      std::uint32_t sum = 0;
      for (std::uint32_t& f : first) sum += std::exchange(f, sum);
      for (const Key& k : keys) other[first[digit(k)]++] = k;
      keys.swap(other);
    }
  }

  [[nodiscard]] static std::size_t packs_of(std::size_t boxes) {
    return (boxes + EightBoxes::count - 1) / EightBoxes::count;
  }
  static void put(std::vector<EightBoxes>& packs, std::size_t i, const SmallBox& b) {
    packs[i / EightBoxes::count].put(i % EightBoxes::count, b);
  }

  /// Pairs within pack n of a level.
  template <class Visit>
  void within(std::size_t level, std::size_t n, Visit& visit) const {
    const EightBoxes& pack = levels_[level][n];
    for (std::size_t i = 0; i < EightBoxes::count; ++i) {
      const SmallBox box = pack.at(i);
      if (box.empty()) continue;
      if (level > 0) within(level - 1, EightBoxes::count * n + i, visit);
      meet(level, n, i, n, pack.overlapping(box) & ~0U << (i + 1), visit);
    }
  }

  /// Pairs of one box of pack n and one of pack m; `bounds` are those of pack m.
  template <class Visit>
  void between(std::size_t level, std::size_t n, std::size_t m, const SmallBox& bounds, Visit& visit) const {
    const EightBoxes &some = levels_[level][n], &others = levels_[level][m];
    for (unsigned near = some.overlapping(bounds); near != 0; near &= near - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(near));
      meet(level, n, i, m, others.overlapping(some.at(i)), visit);
    }
  }

  /// Box i of pack n and those of pack m whose bits are set.
  template <class Visit>
  void meet(std::size_t level, std::size_t n, std::size_t i, std::size_t m, unsigned found,
            Visit& visit) const {
    for (; found != 0; found &= found - 1) {
      const auto j = static_cast<std::size_t>(std::countr_zero(found));
      const std::size_t p = EightBoxes::count * n + i, q = EightBoxes::count * m + j;
      if (level > 0)
        between(level - 1, p, q, levels_[level][m].at(j), visit);
      else
        visit(std::min(items_[p], items_[q]), std::max(items_[p], items_[q]));
    }
  }

  std::array<double, 3> from_{}, scale_{};
  std::vector<Index> items_;                     // of the boxes of level 0
  std::vector<std::vector<EightBoxes>> levels_;  // the boxes first, then those of eight below, the root last
};

}  // namespace detail

/// Calls visit(i, j), i < j, once for each two boxes that overlap or touch, and for some that miss each other
/// by less than a millionth of the size of all of them. The order depends on the boxes alone.
template <class Visit>
void overlapping_pairs(std::span<const Box> boxes, Visit&& visit) {
  detail::PackedBoxes(boxes).pairs(visit);
}

}  // namespace tunica::search
