// SPDX-License-Identifier: MIT
// The parts of a VTK legacy file: arrays in ASCII or big-endian binary, taken or passed over. Sizes are
// held by division against the bytes that are there, before anything is allocated.
#pragma once

#include "tunica/core/text.hpp"
#include "tunica/io/cursor.hpp"
#include "tunica/io/vtk_types.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace tunica::io {

class LegacyFile {
 public:
  /// Reads the three lines of the header. InputError if it is not a VTK legacy file.
  LegacyFile(std::string name, std::string_view bytes) : at(std::move(name), bytes) {
    constexpr std::string_view magic = "# vtk DataFile Version ";
    if (bytes.empty()) throw InputError(at.name() + ": file is empty");
    const auto first = at.line();
    if (first.substr(0, magic.size()) != magic)
      at.fail("expected \"" + std::string(magic) + "\", found " + in_quotes(first));
    (void)at.line();  // the title: anything
    const auto word = at.word();
    const std::string format = upper(word);
    if (format != "ASCII" && format != "BINARY")
      at.fail("expected ASCII or BINARY, found " + in_quotes(word));
    binary = format == "BINARY";
    at.end_of_line();
  }

  Cursor at;
  bool binary = false;

  /// Product of counts, refused when it does not fit.
  [[nodiscard]] std::size_t product(std::size_t a, std::size_t b) const {
    if (b != 0 && a > std::numeric_limits<std::size_t>::max() / b)
      at.fail("the count " + std::to_string(a) + " x " + std::to_string(b) + " overflows");
    return a * b;
  }

  /// The scalar type of that name, or refused with the list of those there are.
  [[nodiscard]] ScalarType type(std::string_view name) const {
    std::string lower(name);
    for (char& c : lower)
      if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    if (const auto t = scalar_type(lower)) return *t;
    at.fail("scalar type " + in_quotes(name) + " not supported; supported are " + supported_types());
  }

  /// Numbers of a type of the file as T. Integers must be exact; NaN and Inf are counted and refused.
  template <class T>
  [[nodiscard]] std::vector<T> values(ScalarType stored, std::size_t count, const std::string& what) {
    return with_scalar(stored, [&]<class S>(S) { return values_of<T, S>(count, what); });
  }

  /// Passes over an array, of any type of the format.
  void skip(std::string_view name, std::size_t count) {
    const std::string kind = upper(name);
    if (kind == "STRING" || kind == "UTF8_STRING") return skip_strings(count);
    if (kind == "BIT") {
      if (binary) return skip_bytes(count / 8 + (count % 8 != 0));
      return skip_words(count);
    }
    const std::size_t size = with_scalar(type(name), [](auto s) { return sizeof(s); });
    if (!binary) return skip_words(count);
    require_bytes(count, size, "array data");
    (void)at.binary(count * size);
  }
  void skip_bytes(std::size_t n) {
    require_bytes(n, 1, "array data");
    (void)at.binary(n);
  }
  void skip_words(std::size_t n) {
    for (std::size_t i = 0; i < n; ++i)
      if (at.word().empty()) too_few(n, i, "array data");
  }

  /// Passes over the lines of a METADATA block, to the empty one.
  void skip_metadata() {
    at.end_of_line();
    while (at.left() > 0 && !at.line().empty()) {
    }
  }

 private:
  void require_bytes(std::size_t count, std::size_t size, const std::string& what) const {
    if (at.left() / size >= count) return;
    const std::string expected = count <= std::numeric_limits<std::size_t>::max() / size
                                     ? std::to_string(count * size) + " bytes"
                                     : std::to_string(count) + " times " + std::to_string(size) + " bytes";
    at.fail(at.offset(), "expected " + expected + " of " + what + ", got " + std::to_string(at.left()));
  }
  [[noreturn]] void too_few(std::size_t expected, std::size_t got, const std::string& what) const {
    at.fail("expected " + std::to_string(expected) + " values of " + what + ", got " + std::to_string(got));
  }

  template <class S>
  [[noreturn]] void not_held(S value, std::size_t i, const std::string& what) const {
    std::string text;
    if constexpr (std::is_floating_point_v<S>)
      text = seven_digits(static_cast<double>(value));
    else
      text = std::to_string(value);
    at.fail("value " + text + " of " + what + " " + std::to_string(i) +
            " cannot be held exactly; read the image as double");
  }

  template <class T, class S>
  [[nodiscard]] T converted(S value, std::size_t i, const std::string& what) const {
    // A sample that T cannot hold would move the surface without a word; a double in a float is only rounded.
    if constexpr (std::is_same_v<T, S>) return value;
    if constexpr (std::is_floating_point_v<S>) {
      constexpr auto least = static_cast<double>(std::numeric_limits<T>::lowest());
      constexpr auto most = static_cast<double>(std::numeric_limits<T>::max());
      const auto v = static_cast<double>(value);
      const bool whole = std::is_floating_point_v<T> || std::trunc(v) == v;
      if (!std::isfinite(v) ? std::is_integral_v<T> : !whole || v < least || v > most)
        not_held(value, i, what);
      return static_cast<T>(value);
    } else {
      const T v = static_cast<T>(value);
      if (static_cast<long double>(v) != static_cast<long double>(value)) not_held(value, i, what);
      return v;
    }
  }

  template <class T, class S>
  [[nodiscard]] std::vector<T> values_of(std::size_t count, const std::string& what) {
    std::vector<T> out;
    if (binary) {
      require_bytes(count, sizeof(S), what);
      const std::string_view bytes = at.binary(count * sizeof(S));
      out.resize(count);
      for (std::size_t i = 0; i < count; ++i)
        out[i] = converted<T>(big_endian<S>(bytes.data() + i * sizeof(S)), i, what);
    } else {
      const std::size_t most = (at.left() + 1) / 2;  // a digit and a space each
      if (count > most)
        at.fail(at.offset(), "expected " + std::to_string(count) + " values of " + what +
                                 ", but there is room for at most " + std::to_string(most));
      out.reserve(count);
      for (std::size_t i = 0; i < count; ++i) {
        const auto word = at.word();
        if (word.empty()) too_few(count, i, what);
        S value{};
        if (!parse_number(word, value))
          at.fail("expected value " + std::to_string(i) + " of " + what + ", found " + in_quotes(word));
        out.push_back(converted<T>(value, i, what));
      }
    }
    if constexpr (std::is_floating_point_v<S>) require_finite(out, what);
    return out;
  }

  template <class T>
  void require_finite(const std::vector<T>& values, const std::string& what) const {
    std::size_t nan = 0, plus = 0, minus = 0, first = values.size();
    for (std::size_t i = 0; i < values.size(); ++i) {
      const auto v = static_cast<double>(values[i]);
      if (std::isfinite(v)) continue;
      first = std::min(first, i);
      ++(std::isnan(v) ? nan : v > 0 ? plus : minus);
    }
    if (first == values.size()) return;
    throw InputError(at.name(), what,
                     std::to_string(nan + plus + minus) + " values are not finite (" + std::to_string(nan) +
                         " NaN, " + std::to_string(plus) + " +Inf, " + std::to_string(minus) +
                         " -Inf), the first at index " + std::to_string(first));
  }

  /// In binary each string has its length before it, whose first two bits tell its size.
  void skip_strings(std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      if (!binary) {
        if (at.left() == 0) too_few(count, i, "strings");
        (void)at.line();
        continue;
      }
      if (at.left() == 0) too_few(count, i, "strings");
      const auto head = static_cast<unsigned char>(at.rest()[0]);
      const std::size_t bytes = std::size_t{1} << (3 - (head >> 6));
      require_bytes(bytes, 1, "string length");
      std::size_t length = head & 0x3f;
      for (const char c : at.binary(bytes).substr(1)) length = length << 8 | static_cast<unsigned char>(c);
      require_bytes(length, 1, "string data");
      (void)at.binary(length);
    }
  }
};

}  // namespace tunica::io
