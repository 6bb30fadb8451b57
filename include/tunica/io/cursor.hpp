// SPDX-License-Identifier: MIT
// A place in the bytes of a file: words, lines and numbers are taken from it whole or refused by place.
#pragma once

#include "tunica/core/error.hpp"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <string>
#include <string_view>
#include <system_error>
#include <type_traits>
#include <utility>

namespace tunica::io {

/// Printable form of bytes of a file, at most 40 of them, in quotes.
[[nodiscard]] inline std::string in_quotes(std::string_view bytes) {
  std::string text = "\"";
  for (const char c : bytes.substr(0, 40)) text += c >= ' ' && c <= '~' ? c : '?';
  return text + (bytes.size() > 40 ? "...\"" : "\"");
}

[[nodiscard]] inline std::string upper(std::string_view word) {
  std::string text(word);
  for (char& c : text)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  return text;
}

/// The whole word as a number; false if anything of it is left or it is out of range.
template <class T>
[[nodiscard]] bool parse_number(std::string_view word, T& value) {
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  const auto r = std::from_chars(word.data(), word.data() + word.size(), value);
  return r.ec == std::errc{} && r.ptr == word.data() + word.size() && !word.empty();
}

class Cursor {
 public:
  Cursor(std::string name, std::string_view bytes) : name_(std::move(name)), bytes_(bytes) {}

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] std::size_t offset() const { return at_; }
  [[nodiscard]] std::size_t left() const { return bytes_.size() - at_; }
  [[nodiscard]] std::string_view rest() const { return bytes_.substr(at_); }

  /// "line 8 (byte 131)"; lines mean nothing behind binary data.
  [[nodiscard]] std::string place(std::size_t at) const {
    const std::string byte = "byte " + std::to_string(at);
    if (binary_) return byte;
    const auto line = 1 + std::count(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(at), '\n');
    return "line " + std::to_string(line) + " (" + byte + ")";
  }
  [[noreturn]] void fail(const std::string& found) const { fail(word_at_, found); }
  [[noreturn]] void fail(std::size_t at, const std::string& found) const {
    throw InputError(name_, place(at), found);
  }

  void skip_space() {
    while (at_ < bytes_.size() && is_space(bytes_[at_])) ++at_;
  }
  [[nodiscard]] bool at_end() {
    skip_space();
    return at_ == bytes_.size();
  }
  /// The next word of any line; empty at the end of the file.
  std::string_view word() {
    skip_space();
    return bare_word();
  }
  /// The next word of this line; empty at its end.
  std::string_view word_of_line() {
    while (at_ < bytes_.size() && is_space(bytes_[at_]) && bytes_[at_] != '\n') ++at_;
    return bare_word();
  }
  /// The rest of this line without its end (LF or CR LF); the next line follows.
  std::string_view line() {
    word_at_ = at_;
    const auto end = std::min(bytes_.find('\n', at_), bytes_.size());
    auto text = bytes_.substr(at_, end - at_);
    at_ = std::min(end + 1, bytes_.size());
    if (!text.empty() && text.back() == '\r') text.remove_suffix(1);
    return text;
  }
  /// Passes the end of this line; refuses anything else on it.
  void end_of_line() {
    const auto word = word_of_line();
    if (!word.empty()) fail("expected the end of the line, found " + in_quotes(word));
    if (at_ < bytes_.size()) ++at_;
  }
  template <class T>
  T number(const std::string& what) {
    return number_of<T>(word(), what);
  }
  template <class T>
  T number_of(std::string_view text, const std::string& what) const {
    T value{};
    if (text.empty()) fail("expected " + what + ", found the end of the file");
    if (!parse_number(text, value))
      fail("expected " + what + (std::is_unsigned_v<T> ? " (a whole number, not negative)" : "") +
           ", found " + in_quotes(text));
    return value;
  }
  /// The next n bytes, which the caller has checked against left().
  std::string_view binary(std::size_t n) {
    binary_ = true;
    const auto bytes = bytes_.substr(at_, n);
    at_ += bytes.size();
    return bytes;
  }

 private:
  [[nodiscard]] static bool is_space(char c) {
    return c == ' ' || c == '\n' || c == '\r' || c == '\t' || c == '\f' || c == '\v';
  }
  std::string_view bare_word() {
    word_at_ = at_;
    while (at_ < bytes_.size() && !is_space(bytes_[at_])) ++at_;
    return bytes_.substr(word_at_, at_ - word_at_);
  }

  std::string name_;
  std::string_view bytes_;
  std::size_t at_ = 0, word_at_ = 0;
  bool binary_ = false;
};

}  // namespace tunica::io
