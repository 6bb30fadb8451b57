// SPDX-License-Identifier: MIT
// Between packs (a number of every element in one) and elements (all numbers of one in a row), register-wise.
#pragma once

#include "tunica/core/pack.hpp"
#include "tunica/core/types.hpp"

#include <cstddef>

namespace tunica::fem {

namespace detail {

/// In place: number j of row i goes to place i of row j, in each group of Rows lanes by itself. log2 Rows
/// steps of exchanges [EKLUNDH72].
template <class Part, class Order, int W, int Rows>
TUNICA_INLINE void transpose_square(Part (&row)[Rows]) {
  if constexpr (Rows > 1) {
#pragma GCC unroll 8
    for (int d = 1; d < Rows; d *= 2) {
      Order low, high;  // lanes of the two rows, those of the second from W on
#pragma GCC unroll 16
      for (int l = 0; l < W; ++l) {
        low[l] = (l & d) == 0 ? l : W + l - d;
        high[l] = (l & d) == 0 ? l + d : W + l;
      }
#pragma GCC unroll 16
      for (int i = 0; i < Rows; ++i) {
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

/// True if triples_to_lanes() works for S: double in registers of four lanes or more.
template <class S>
inline constexpr bool has_wide_registers = false;
template <int N, int W>
inline constexpr bool has_wide_registers<Pack<double, N, W>> = W >= 4;

/// Lane l of to[c] = values[3 node(l) + c], c < 3. Four numbers are read at once: one beyond those of a node.
template <class S, class Node>
TUNICA_INLINE void triples_to_lanes(const double* values, Node&& node, S (&to)[3]) {
  using Four = typename registers::Register<double, 4>::type;
  constexpr int W = S::size / S::parts;
  const auto load = [&](Index n) {
    Four x;
    __builtin_memcpy(&x, values + std::ptrdiff_t{3} * n, sizeof x);
    return x;
  };
  for (int p = 0; p < S::parts; ++p) {
    typename S::Part row[4];
#pragma GCC unroll 4
    for (int i = 0; i < 4; ++i) {
      if constexpr (W == 4)
        row[i] = load(node(p * W + i));
      else
        row[i] =
            __builtin_shufflevector(load(node(p * W + i)), load(node(p * W + i + 4)), 0, 1, 2, 3, 4, 5, 6, 7);
    }
    detail::transpose_square<typename S::Part, typename S::Mask::Part, W>(row);
    for (int c = 0; c < 3; ++c) to[c].part[p] = row[c];
  }
}

}  // namespace tunica::fem
