// SPDX-License-Identifier: MIT
// Eight boxes side by side in single precision, asked all at once.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace tunica::search::detail {

/// A box in single precision; an empty one overlaps none and is infinitely far from every point.
struct SmallBox {
  static constexpr float far = std::numeric_limits<float>::infinity();
  std::array<float, 3> lo{far, far, far}, hi{-far, -far, -far};

  void extend(const SmallBox& b) {
    for (std::size_t a = 0; a < 3; ++a) lo[a] = std::min(lo[a], b.lo[a]), hi[a] = std::max(hi[a], b.hi[a]);
  }
  [[nodiscard]] bool empty() const { return lo[0] > hi[0]; }
};

struct alignas(16) EightBoxes {
  static constexpr std::size_t count = 8;
  std::array<std::array<float, count>, 3> lo, hi;

  EightBoxes() {
    for (std::size_t i = 0; i < count; ++i) put(i, SmallBox{});
  }
  [[nodiscard]] SmallBox at(std::size_t i) const {
    return {{lo[0][i], lo[1][i], lo[2][i]}, {hi[0][i], hi[1][i], hi[2][i]}};
  }
  void put(std::size_t i, const SmallBox& b) {
    for (std::size_t a = 0; a < 3; ++a) lo[a][i] = b.lo[a], hi[a][i] = b.hi[a];
  }
  [[nodiscard]] SmallBox all() const {
    SmallBox box;
    for (std::size_t i = 0; i < count; ++i) box.extend(at(i));
    return box;
  }

  /// Bit i: box i overlaps b or touches it.
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

  /// Squares of the distances from x, and as bits which of them are not above the bound.
  struct Near {
    alignas(16) std::array<float, count> square;
    unsigned bits = 0;
  };
  [[nodiscard]] Near near(const std::array<float, 3>& x, float bound) const {
    Near result;
#if defined(__SSE2__)
    for (std::size_t four = 0; four < count; four += 4) {
      __m128 sum = _mm_setzero_ps();
      for (std::size_t a = 0; a < 3; ++a) {
        const __m128 at = _mm_set1_ps(x[a]);
        const __m128 below = _mm_sub_ps(_mm_load_ps(lo[a].data() + four), at),
                     above = _mm_sub_ps(at, _mm_load_ps(hi[a].data() + four));
        const __m128 away = _mm_max_ps(_mm_max_ps(below, above), _mm_setzero_ps());
        sum = _mm_add_ps(sum, _mm_mul_ps(away, away));
      }
      _mm_store_ps(result.square.data() + four, sum);
      result.bits |= static_cast<unsigned>(_mm_movemask_ps(_mm_cmple_ps(sum, _mm_set1_ps(bound)))) << four;
    }
#else
    for (std::size_t i = 0; i < count; ++i) {
      float sum = 0;
      for (std::size_t a = 0; a < 3; ++a) {
        const float away = std::max({lo[a][i] - x[a], x[a] - hi[a][i], 0.0F});
        sum += away * away;
      }
      result.square[i] = sum;
      result.bits |= unsigned{sum <= bound} << i;
    }
#endif
    return result;
  }
};

}  // namespace tunica::search::detail
