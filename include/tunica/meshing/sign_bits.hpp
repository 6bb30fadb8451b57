// SPDX-License-Identifier: MIT
// Which nodes of an image are inside, a bit each: a row of 64 nodes is compared and handled as one word.
#pragma once

#include "tunica/core/parallel.hpp"
#include "tunica/image/image.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <span>
#include <type_traits>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace tunica::meshing {

/// What a value of type T is compared with instead of the iso-value: least is the least T that is not below
/// it; none: there is no such value.
template <class T>
struct Reach {
  T least{};
  bool none = false;

  explicit Reach(double iso) {
    using Limits = std::numeric_limits<T>;
    if (!(iso <= static_cast<double>(Limits::max()))) {
      least = Limits::has_infinity ? Limits::infinity() : Limits::max();
      none = std::isnan(iso) || !Limits::has_infinity;
    } else if (iso <= static_cast<double>(Limits::lowest())) {
      least = std::isinf(iso) && Limits::has_infinity ? -Limits::infinity() : Limits::lowest();
    } else if constexpr (std::is_integral_v<T>) {
      least = static_cast<T>(std::ceil(iso));
    } else {
      least = static_cast<T>(iso);
      if (static_cast<double>(least) < iso) least = std::nextafter(least, Limits::infinity());
    }
  }
};

namespace detail {

inline constexpr std::size_t word_bits = 64;

/// Rows of nodes or cells that a thread takes at a time: enough work to be worth the asking, few enough that
/// all threads have some. What comes out does not depend on it.
inline constexpr std::ptrdiff_t rows_a_chunk = 256;

/// Bit n is byte n, each of them 0 or 1.
[[nodiscard]] inline std::uint64_t packed(const std::array<std::uint8_t, word_bits>& bytes) {
  static_assert(std::endian::native == std::endian::little, "bytes are packed in the order of little-endian");
  std::uint64_t word = 0;
  for (std::size_t group = 0; group < 8; ++group) {
    std::uint64_t eight;
    std::memcpy(&eight, bytes.data() + 8 * group, 8);
    word |= eight * 0x0102040810204080U >> 56U << 8 * group;  // byte i moves to bit 56 + i
  }
  return word;
}

/// How many bits are set; quick without an instruction for it.
[[nodiscard]] inline int bits_set(std::uint64_t word) {
#if defined(__POPCNT__)
  return std::popcount(word);
#else
  word -= word >> 1U & 0x5555555555555555U;
  word = (word & 0x3333333333333333U) + (word >> 2U & 0x3333333333333333U);
  return static_cast<int>(((word + (word >> 4U)) & 0x0f0f0f0f0f0f0f0fU) * 0x0101010101010101U >> 56U);
#endif
}

/// Bits from the tests of so many values at a time.
template <unsigned lanes, class T, class Test>
[[nodiscard]] std::uint64_t word_of(const T* v, Test&& test) {
  std::uint64_t word = 0;
  for (unsigned n = 0; n < word_bits; n += lanes) word |= static_cast<std::uint64_t>(test(v + n)) << n;
  return word;
}

/// Bit n: v[n] >= least, of 64 values. What a row of words ahead will need is called for from memory, beyond
/// the end of a page too, where the machine itself would not look ahead.
template <class T>
[[nodiscard]] std::uint64_t word_reaching(const T* v, T least) {
#if defined(__SSE2__)
  constexpr std::size_t line = 64, ahead = 3072;  // [B]
  for (std::size_t b = 0; b < word_bits * sizeof(T); b += line)
    _mm_prefetch(reinterpret_cast<const char*>(reinterpret_cast<std::uintptr_t>(v) + ahead + b), _MM_HINT_T0);
  if constexpr (std::is_same_v<T, float>)
    return word_of<16>(v, [bound = _mm_set1_ps(least)](const float* sixteen) {
      const auto four = [&](std::size_t n) {
        return _mm_castps_si128(_mm_cmpge_ps(_mm_loadu_ps(sixteen + n), bound));
      };
      return static_cast<unsigned>(_mm_movemask_epi8(
          _mm_packs_epi16(_mm_packs_epi32(four(0), four(4)), _mm_packs_epi32(four(8), four(12)))));
    });
  if constexpr (std::is_same_v<T, std::int16_t>)
    return ~word_of<16>(v, [bound = _mm_set1_epi16(least)](const std::int16_t* sixteen) {
      const auto eight = [&](std::size_t n) {
        return _mm_cmplt_epi16(_mm_loadu_si128(reinterpret_cast<const __m128i*>(sixteen + n)), bound);
      };
      return static_cast<unsigned>(_mm_movemask_epi8(_mm_packs_epi16(eight(0), eight(8))));
    });
  if constexpr (std::is_same_v<T, double>)
    return word_of<2>(v, [bound = _mm_set1_pd(least)](const double* two) {
      return _mm_movemask_pd(_mm_cmpge_pd(_mm_loadu_pd(two), bound));
    });
#endif
  std::array<std::uint8_t, word_bits> bytes;
  for (std::size_t n = 0; n < word_bits; ++n) bytes[n] = v[n] >= least;
  return packed(bytes);
}

/// The same of the last count values, fewer than 64, of a row that ends at `end` and has size values.
template <class T>
[[nodiscard]] std::uint64_t last_word_reaching(const T* end, T least, std::size_t count, std::size_t size) {
  if (size >= word_bits) return word_reaching(end - word_bits, least) >> (word_bits - count);
  std::uint64_t word = 0;
  for (std::size_t n = 0; n < count; ++n) word |= std::uint64_t{end[n - count] >= least} << n;
  return word;
}

}  // namespace detail

/// A bit a node, rows along x: bit i % 64 of word i / 64; bits beyond the row are 0.
class SignBits {
 public:
  /// Inside: value >= iso and kept (one byte a node, 0 is dropped; empty keeps all).
  template <class T>
  SignBits(const image::Image<T>& image, std::span<const std::uint8_t> kept, double iso)
      : nx_(image.axes[0].size()),
        ny_(image.axes[1].size()),
        words_((nx_ + detail::word_bits - 1) / detail::word_bits),
        rows_(ny_ * image.axes[2].size()),
        bits_(std::make_unique_for_overwrite<std::uint64_t[]>(words_ * rows_)),
        sides_(std::make_unique_for_overwrite<std::uint8_t[]>(rows_)) {
    const Reach<T> reach(iso);
    parallel_chunks(static_cast<std::ptrdiff_t>(rows_), detail::rows_a_chunk,
                    [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
                      for (auto r = static_cast<std::size_t>(begin); r < static_cast<std::size_t>(end); ++r)
                        set_row(r, image.values.data() + nx_ * r,
                                kept.empty() ? nullptr : kept.data() + nx_ * r, reach);
                    });
  }

  [[nodiscard]] std::size_t words() const { return words_; }  // a row
  [[nodiscard]] const std::uint64_t* row(std::size_t j, std::size_t k) const {
    return bits_.get() + words_ * (j + ny_ * k);
  }
  [[nodiscard]] bool inside(std::size_t i, std::size_t j, std::size_t k) const {
    return (row(j, k)[i / detail::word_bits] >> i % detail::word_bits & 1U) != 0;
  }
  /// Some node of the row is inside; some node of all.
  [[nodiscard]] bool any(std::size_t j, std::size_t k) const { return (sides(j, k) & some_inside) != 0; }
  [[nodiscard]] bool any() const {
    return std::any_of(sides_.get(), sides_.get() + rows_,
                       [](std::uint8_t s) { return (s & some_inside) != 0; });
  }
  /// On which sides of the surface the nodes of a row are.
  static constexpr std::uint8_t some_inside = 1, some_outside = 2, both_sides = some_inside | some_outside;
  [[nodiscard]] std::uint8_t sides(std::size_t j, std::size_t k) const { return sides_[j + ny_ * k]; }

  /// Word w of a row moved down by a node: bit n is that of node n + 1.
  [[nodiscard]] std::uint64_t next(const std::uint64_t* row, std::size_t w) const {
    return row[w] >> 1U | (w + 1 < words_ ? row[w + 1] << (detail::word_bits - 1) : 0U);
  }
  /// The nodes of word w that have a neighbour in +x.
  [[nodiscard]] std::uint64_t with_next(std::size_t w) const {
    const std::size_t count = nx_ - 1 - std::min(nx_ - 1, detail::word_bits * w);
    return count >= detail::word_bits ? ~std::uint64_t{0} : (std::uint64_t{1} << count) - 1;
  }

 private:
  template <class T>
  void set_row(std::size_t r, const T* values, const std::uint8_t* kept, const Reach<T>& reach) {
    std::uint64_t* row = bits_.get() + words_ * r;
    std::uint64_t inside = 0, outside = 0;
    const auto set = [&](std::size_t w, std::uint64_t word, std::uint64_t all) {
      if (reach.none) word = 0;
      row[w] = word;
      inside |= word, outside |= word ^ all;
    };
    const std::size_t full = nx_ / detail::word_bits, rest = nx_ % detail::word_bits;
    for (std::size_t w = 0; w < full; ++w) {
      std::uint64_t word = detail::word_reaching(values + detail::word_bits * w, reach.least);
      if (kept != nullptr && word != 0)
        word &= detail::word_reaching(kept + detail::word_bits * w, std::uint8_t{1});
      set(w, word, ~std::uint64_t{0});
    }
    if (rest != 0) {
      std::uint64_t word = detail::last_word_reaching(values + nx_, reach.least, rest, nx_);
      if (kept != nullptr && word != 0)
        word &= detail::last_word_reaching(kept + nx_, std::uint8_t{1}, rest, nx_);
      set(full, word, (std::uint64_t{1} << rest) - 1);
    }
    sides_[r] =
        static_cast<std::uint8_t>((inside != 0 ? some_inside : 0) | (outside != 0 ? some_outside : 0));
  }

  std::size_t nx_, ny_, words_, rows_;
  std::unique_ptr<std::uint64_t[]> bits_;  // not touched before they are known
  std::unique_ptr<std::uint8_t[]> sides_;  // of a row
};

}  // namespace tunica::meshing
