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
#include <span>
#include <type_traits>
#include <vector>

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

/// Bits from the tests of so many values at a time.
template <unsigned lanes, class T, class Test>
[[nodiscard]] std::uint64_t word_of(const T* v, Test&& test) {
  std::uint64_t word = 0;
  for (unsigned n = 0; n < word_bits; n += lanes) word |= static_cast<std::uint64_t>(test(v + n)) << n;
  return word;
}

/// Bit n: v[n] >= least, of 64 values.
template <class T>
[[nodiscard]] std::uint64_t word_reaching(const T* v, T least) {
#if defined(__SSE2__)
  if constexpr (std::is_same_v<T, float>)
    return word_of<4>(v, [bound = _mm_set1_ps(least)](const float* four) {
      return _mm_movemask_ps(_mm_cmpge_ps(_mm_loadu_ps(four), bound));
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

/// The same of fewer values.
template <class T>
[[nodiscard]] std::uint64_t word_reaching(const T* v, T least, std::size_t count) {
  if (count == word_bits) return word_reaching(v, least);
  std::uint64_t word = 0;
  for (std::size_t n = 0; n < count; ++n) word |= std::uint64_t{v[n] >= least} << n;
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
        bits_(words_ * ny_ * image.axes[2].size(), 0),
        any_(ny_ * image.axes[2].size(), 0) {
    const Reach<T> reach(iso);
    if (reach.none) return;
    const auto rows = static_cast<std::ptrdiff_t>(ny_ * image.axes[2].size());
    parallel_chunks(rows, detail::rows_a_chunk, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      for (auto r = static_cast<std::size_t>(begin); r < static_cast<std::size_t>(end); ++r)
        for (std::size_t w = 0; w < words_; ++w) {
          const std::size_t first = nx_ * r + detail::word_bits * w;
          const std::size_t count = std::min(detail::word_bits, nx_ - detail::word_bits * w);
          std::uint64_t word = detail::word_reaching(image.values.data() + first, reach.least, count);
          if (word != 0 && !kept.empty())
            word &= detail::word_reaching(kept.data() + first, std::uint8_t{1}, count);
          bits_[words_ * r + w] = word;
          if (word != 0) any_[r] = 1;
        }
    });
  }

  [[nodiscard]] std::size_t words() const { return words_; }  // a row
  [[nodiscard]] const std::uint64_t* row(std::size_t j, std::size_t k) const {
    return bits_.data() + words_ * (j + ny_ * k);
  }
  [[nodiscard]] bool inside(std::size_t i, std::size_t j, std::size_t k) const {
    return (row(j, k)[i / detail::word_bits] >> i % detail::word_bits & 1U) != 0;
  }
  /// Some node of the row is inside; some node of all.
  [[nodiscard]] bool any(std::size_t j, std::size_t k) const { return any_[j + ny_ * k] != 0; }
  [[nodiscard]] bool any() const { return std::find(any_.begin(), any_.end(), 1) != any_.end(); }

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
  std::size_t nx_, ny_, words_;
  std::vector<std::uint64_t> bits_;
  std::vector<std::uint8_t> any_;  // of a row
};

}  // namespace tunica::meshing
