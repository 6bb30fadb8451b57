// SPDX-License-Identifier: MIT
// The registers that packs are made of: how wide they are on the machine at hand, and their square root.
#pragma once

#include <cmath>
#include <type_traits>

#if defined(__SSE2__)
#include <immintrin.h>
#endif

// A pack is an array of machine registers (GCC's vector extension, never wider than the machine's: wider
// ones are emulated badly). TUNICA_PLAIN_PACKS, and compilers without it, give arrays of numbers instead.
#if defined(TUNICA_PLAIN_PACKS) || !defined(__GNUC__)
#define TUNICA_REGISTER_BYTES 0
#elif defined(__AVX512F__)
#define TUNICA_REGISTER_BYTES 64
#elif defined(__AVX__)
#define TUNICA_REGISTER_BYTES 32
#else
#define TUNICA_REGISTER_BYTES 16
#endif

#if defined(__GNUC__)
#define TUNICA_INLINE [[gnu::always_inline]] inline  // a call that is left in a kernel costs half its speed
#else
#define TUNICA_INLINE inline
#endif

/// Registers of W lanes; W = 1 is the number itself.
namespace tunica::registers {

inline constexpr int bytes = TUNICA_REGISTER_BYTES;

/// Lanes of a register in a pack of n numbers of type T.
template <class T>
[[nodiscard]] consteval int width(int n) {
  const int most = bytes / static_cast<int>(sizeof(T));
  int w = 1;
  while (2 * w <= most && n % (2 * w) == 0) w *= 2;
  return w;
}

template <class T, int W>
struct Register {
#if defined(__GNUC__)
  typedef T type __attribute__((vector_size(W * sizeof(T))));  // no alias declaration takes the attribute
#endif
};
template <class T>
struct Register<T, 1> {
  using type = T;
};

template <class T, int W>
TUNICA_INLINE typename Register<T, W>::type square_root(const typename Register<T, W>::type& x) {
  if constexpr (W == 1) {
    return std::sqrt(x);
  } else {
#if defined(__AVX512F__)
    if constexpr (std::is_same_v<T, double> && W == 8)
      return (typename Register<T, W>::type)_mm512_maskz_sqrt_pd(0xff, (__m512d)x);
    if constexpr (std::is_same_v<T, float> && W == 16)
      return (typename Register<T, W>::type)_mm512_maskz_sqrt_ps(0xffff, (__m512)x);
#endif
#if defined(__AVX__)
    if constexpr (std::is_same_v<T, double> && W == 4)
      return (typename Register<T, W>::type)_mm256_sqrt_pd((__m256d)x);
    if constexpr (std::is_same_v<T, float> && W == 8)
      return (typename Register<T, W>::type)_mm256_sqrt_ps((__m256)x);
#endif
#if defined(__SSE2__)
    if constexpr (std::is_same_v<T, double> && W == 2)
      return (typename Register<T, W>::type)_mm_sqrt_pd((__m128d)x);
    if constexpr (std::is_same_v<T, float> && W == 4)
      return (typename Register<T, W>::type)_mm_sqrt_ps((__m128)x);
#endif
    typename Register<T, W>::type root{};
    for (int l = 0; l < W; ++l) root[l] = std::sqrt(x[l]);
    return root;
  }
}

}  // namespace tunica::registers
