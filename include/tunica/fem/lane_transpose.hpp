// SPDX-License-Identifier: MIT
// Between packs (a number of every element in one) and elements (all numbers of one in a row), register-wise.
#pragma once

#include "tunica/core/pack.hpp"

#include <cstddef>

namespace tunica::fem {

namespace detail {

/// In place: number j of row i goes to place i of row j. log2 W steps of exchanges [EKLUNDH72].
template <class Part, class Order, int W>
TUNICA_INLINE void transpose_square(Part (&row)[W]) {
  if constexpr (W > 1) {
#pragma GCC unroll 8
    for (int d = 1; d < W; d *= 2) {
      Order low, high;  // lanes of the two rows, those of the second from W on
#pragma GCC unroll 16
      for (int l = 0; l < W; ++l) {
        low[l] = (l & d) == 0 ? l : W + l - d;
        high[l] = (l & d) == 0 ? l + d : W + l;
      }
#pragma GCC unroll 16
      for (int i = 0; i < W; ++i) {
        if ((i & d) != 0) continue;
        const Part a = row[i], b = row[i + d];
        row[i] = __builtin_shuffle(a, b, low);
        row[i + d] = __builtin_shuffle(a, b, high);
      }
    }
  }
}

}  // namespace detail

/// to[l * stride + k] = lane l of from[k], for k < Count and all lanes. Of a single number: a copy.
template <int Count, class S>
TUNICA_INLINE void lanes_to_rows(const S* from, typename Lanes<S>::type* to, std::size_t stride) {
  if constexpr (Lanes<S>::count == 1) {
    for (int k = 0; k < Count; ++k) to[k] = from[k];
  } else {
    constexpr int W = S::size / S::parts;
    if constexpr (W == 1 || Count < W) {
      for (int k = 0; k < Count; ++k)
        for (int l = 0; l < S::size; ++l) to[static_cast<std::size_t>(l) * stride + k] = from[k][l];
    } else {
      for (int k = 0; k < Count; k += W) {
        const int first = k + W <= Count ? k : Count - W;  // the last square overlaps the one before it
        for (int p = 0; p < S::parts; ++p) {
          typename S::Part row[W];
          for (int i = 0; i < W; ++i) row[i] = from[first + i].part[p];
          detail::transpose_square<typename S::Part, typename S::Mask::Part, W>(row);
          for (int i = 0; i < W; ++i)
            __builtin_memcpy(to + static_cast<std::size_t>(p * W + i) * stride + first, &row[i],
                             sizeof row[i]);
        }
      }
    }
  }
}

/// Lane l of to[k] = from[l * stride + k], for k < Count and all lanes. Of a single number: a copy.
template <int Count, class S>
TUNICA_INLINE void rows_to_lanes(const typename Lanes<S>::type* from, std::size_t stride, S* to) {
  if constexpr (Lanes<S>::count == 1) {
    for (int k = 0; k < Count; ++k) to[k] = from[k];
  } else {
    constexpr int W = S::size / S::parts;
    if constexpr (W == 1 || Count < W) {
      for (int k = 0; k < Count; ++k)
        for (int l = 0; l < S::size; ++l) to[k].set(l, from[static_cast<std::size_t>(l) * stride + k]);
    } else {
      for (int k = 0; k < Count; k += W) {
        const int first = k + W <= Count ? k : Count - W;
        for (int p = 0; p < S::parts; ++p) {
          typename S::Part row[W];
          for (int i = 0; i < W; ++i)
            __builtin_memcpy(&row[i], from + static_cast<std::size_t>(p * W + i) * stride + first,
                             sizeof row[i]);
          detail::transpose_square<typename S::Part, typename S::Mask::Part, W>(row);
          for (int i = 0; i < W; ++i) to[first + i].part[p] = row[i];
        }
      }
    }
  }
}

}  // namespace tunica::fem
