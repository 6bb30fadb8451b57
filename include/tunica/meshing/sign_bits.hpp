// SPDX-License-Identifier: MIT
// Which nodes of an image are inside, a bit each: a row of 64 nodes is compared
// and handled as one word.
#pragma once

#include "tunica/core/parallel.hpp"
#include "tunica/image/image.hpp"
#include "tunica/meshing/large_pages.hpp"

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
#include <utility>
#include <vector>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace tunica::meshing {

/// What a value of type T is compared with instead of the iso-value: least is
/// the least T that is not below it; none: there is no such value.
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

/// Rows of nodes or cells that a thread takes at a time: enough work to be
/// worth the asking, few enough that all threads have some. What comes out does
/// not depend on it.
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

/// So many of the lowest bits, 64 if there are more.
[[nodiscard]] inline std::uint64_t first_bits(std::size_t count) {
  return count >= word_bits ? ~std::uint64_t{0} : (std::uint64_t{1} << count) - 1;
}

/// Bits from the tests of so many values at a time, word after word. What a
/// later row needs is called for from memory: the machine by itself does not
/// look beyond the end of a page.
template <unsigned lanes, class T, class Test>
void set_words(const T* v, std::size_t words, std::uint64_t* out, Test&& test) {
  for (std::size_t w = 0; w < words; ++w, v += word_bits) {
#if defined(__SSE2__)
    constexpr std::size_t line = 64, ahead = 3072;  // [B]
    for (std::size_t b = 0; b < word_bits * sizeof(T); b += line)
      _mm_prefetch(static_cast<const char*>(static_cast<const void*>(v)) + ahead + b, _MM_HINT_T0);
#endif
    out[w] = [&]<std::size_t... n>(std::index_sequence<n...>) {
      return (... | (std::uint64_t{test(v + lanes * n)} << lanes * n));
    }
    (std::make_index_sequence<word_bits / lanes>{});
  }
}

/// Bit n: v[n] >= least, of 64 values a word.
template <class T>
void set_words_reaching(const T* v, T least, std::size_t words, std::uint64_t* out) {
#if defined(__SSE2__)
  if constexpr (std::is_same_v<T, float>)
    return set_words<16>(v, words, out, [bound = _mm_set1_ps(least)](const float* sixteen) {
      const auto four = [&](std::size_t n) {
        return _mm_castps_si128(_mm_cmpge_ps(_mm_loadu_ps(sixteen + n), bound));
      };
      return static_cast<unsigned>(_mm_movemask_epi8(
          _mm_packs_epi16(_mm_packs_epi32(four(0), four(4)), _mm_packs_epi32(four(8), four(12)))));
    });
  if constexpr (std::is_same_v<T, std::int16_t>)
    return set_words<16>(v, words, out, [bound = _mm_set1_epi16(least)](const std::int16_t* sixteen) {
      const auto below = [&](std::size_t n) {
        return _mm_cmplt_epi16(_mm_loadu_si128(reinterpret_cast<const __m128i*>(sixteen + n)), bound);
      };
      return ~static_cast<unsigned>(_mm_movemask_epi8(_mm_packs_epi16(below(0), below(8)))) & 0xffffU;
    });
  if constexpr (std::is_same_v<T, double>)
    return set_words<2>(v, words, out, [bound = _mm_set1_pd(least)](const double* two) {
      return static_cast<unsigned>(_mm_movemask_pd(_mm_cmpge_pd(_mm_loadu_pd(two), bound)));
    });
#endif
  set_words<word_bits>(v, words, out, [least](const T* all) {
    std::array<std::uint8_t, word_bits> bytes;
    for (std::size_t n = 0; n < word_bits; ++n) bytes[n] = all[n] >= least;
    return packed(bytes);
  });
}

/// The same of the `rest` values, fewer than 64, that end a row of `size`.
template <class T>
[[nodiscard]] std::uint64_t last_word_reaching(const T* end, T least, std::size_t rest, std::size_t size) {
  std::uint64_t word = 0;
  if (size >= word_bits) {
    set_words_reaching(end - word_bits, least, 1, &word);
    return word >> (word_bits - rest);
  }
  for (std::size_t n = 0; n < rest; ++n) word |= std::uint64_t{*(end - rest + n) >= least} << n;
  return word;
}

}  // namespace detail

/// A bit a node, rows along x: bit i % 64 of word i / 64; bits beyond the row are 0.
class SignBits {
 public:
  /// On which sides of the surface the nodes of a row are.
  static constexpr std::uint8_t some_inside = 1, some_outside = 2, both_sides = some_inside | some_outside;

  /// Of so many nodes along each axis; nothing is known of them before set().
  explicit SignBits(const std::array<std::size_t, 3>& size)
      : nx_(size[0]),
        ny_(size[1]),
        words_((nx_ + detail::word_bits - 1) / detail::word_bits),
        rows_(ny_ * size[2]),
        bits_(std::make_unique_for_overwrite<std::uint64_t[]>(words_ * rows_)),
        sides_(std::make_unique_for_overwrite<std::uint8_t[]>(rows_)) {
    detail::large_pages(bits_.get(), words_ * rows_ * sizeof(std::uint64_t));
  }

  /// Inside: value >= iso and kept (one byte a node, 0 is dropped; empty keeps all).
  template <class T>
  SignBits(const image::Image<T>& image, std::span<const std::uint8_t> kept, double iso)
      : SignBits({image.axes[0].size(), image.axes[1].size(), image.axes[2].size()}) {
    const Reach<T> reach(iso);
    parallel_chunks(static_cast<std::ptrdiff_t>(rows_), detail::rows_a_chunk,
                    [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
                      const auto first = static_cast<std::size_t>(begin);
                      set(reach, image.values.data() + nx_ * first,
                          kept.empty() ? nullptr : kept.data() + nx_ * first, first,
                          static_cast<std::size_t>(end - begin));
                    });
  }

  /// Sets so many rows from `first` on by their values and, unless it is null, their mask.
  template <class T>
  void set(const Reach<T>& reach, const T* values, const std::uint8_t* kept, std::size_t first,
           std::size_t rows) {
    std::uint64_t* bits = bits_.get() + words_ * first;
    if (reach.none)
      std::fill(bits, bits + words_ * rows, 0U);
    else
      set_rows(values, reach.least, rows, bits);
    if (kept != nullptr) mask_rows(kept, rows, bits);
    set_sides(first, rows);
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
  [[nodiscard]] std::uint8_t sides(std::size_t j, std::size_t k) const { return sides_[j + ny_ * k]; }
  [[nodiscard]] const std::uint8_t* sides(std::size_t k) const { return sides_.get() + ny_ * k; }

  /// Word w of a row moved down by a node: bit n is that of node n + 1.
  [[nodiscard]] std::uint64_t next(const std::uint64_t* row, std::size_t w) const {
    return row[w] >> 1U | (w + 1 < words_ ? row[w + 1] << (detail::word_bits - 1) : 0U);
  }
  /// The nodes of word w that have a neighbour in +x.
  [[nodiscard]] std::uint64_t with_next(std::size_t w) const {
    const std::size_t count = nx_ - 1 - std::min(nx_ - 1, detail::word_bits * w);
    return detail::first_bits(count);
  }

 private:
  template <class T>
  void set_rows(const T* values, T least, std::size_t rows, std::uint64_t* bits) const {
    const std::size_t full = nx_ / detail::word_bits, rest = nx_ % detail::word_bits;
    if (rest == 0) return detail::set_words_reaching(values, least, full * rows, bits);
    for (std::size_t r = 0; r < rows; ++r, values += nx_, bits += words_) {
      detail::set_words_reaching(values, least, full, bits);
      bits[full] = detail::last_word_reaching(values + nx_, least, rest, nx_);
    }
  }

  void mask_rows(const std::uint8_t* kept, std::size_t rows, std::uint64_t* bits) const {
    std::vector<std::uint64_t> mask(words_ * rows);
    set_rows(kept, std::uint8_t{1}, rows, mask.data());
    for (std::size_t w = 0; w < mask.size(); ++w) bits[w] &= mask[w];
  }

  void set_sides(std::size_t first, std::size_t rows) {
    const std::uint64_t last = detail::first_bits(nx_ - detail::word_bits * (words_ - 1));
    const std::uint64_t* row = bits_.get() + words_ * first;
    for (std::size_t r = first; r < first + rows; ++r, row += words_) {
      std::uint64_t inside = row[words_ - 1], outside = row[words_ - 1] ^ last;
      for (std::size_t w = 0; w + 1 < words_; ++w) inside |= row[w], outside |= ~row[w];
      sides_[r] = static_cast<std::uint8_t>((inside != 0) * some_inside | (outside != 0) * some_outside);
    }
  }

  std::size_t nx_, ny_, words_, rows_;
  std::unique_ptr<std::uint64_t[]> bits_;  // not touched before they are known
  std::unique_ptr<std::uint8_t[]> sides_;  // of a row
};

}  // namespace tunica::meshing
